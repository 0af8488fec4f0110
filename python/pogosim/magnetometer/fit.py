"""The curve of a magnetometer: harmonics of the angle of the field in the robot's frame, and the ellipse in them.

The simulator fits the same curve to a table (`magnetometer: {source: csv}`, src/sim/magnetometer_fit.cpp), and looks
for the same rows that are far from the curve of the others (src/sim/magnetometer_fit.cpp).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pogosim.calibration.tracks import Floats
from pogosim.errors import CalibrationError
from pogosim.magnetometer.table import ReadingTable

LARGEST_CONDITION = 1e8  # of the squares of the basis
DIFFERENT_RAD = 1e-3
SIGNIFICANT = 4.0  # standard errors
LARGEST_GAP_RAD = math.pi / 2.0 + 1e-6  # between headings, beyond which the ellipse is a guess


@dataclass(frozen=True)
class CurveFit:
    """A fitted curve.

    Attributes:
        coefficients: Factors of 1, cos a, sin a, cos 2a, sin 2a, ...; shape (1 + 2 order, 3), counts.
        covariance: That of the coefficients of an axis, for readings with noise of variance 1.
        noise: Standard deviation of the residuals of each axis, counts.
        angle_rad: Angle of the field in the robot's frame, for each row.
        residual: Shape (rows, 3), counts.
    """

    coefficients: Floats
    covariance: Floats
    noise: Floats
    angle_rad: Floats
    residual: Floats

    @property
    def order(self) -> int:
        """Harmonics in use."""
        return (len(self.coefficients) - 1) // 2

    @property
    def rms_error(self) -> Floats:
        """Root of the mean squared residual of each axis, counts."""
        return np.asarray(np.sqrt(np.mean(self.residual**2, axis=0)), dtype=np.float64)

    def errors(self) -> Floats:
        """Return the standard errors of the coefficients, in their shape."""
        return np.sqrt(np.outer(np.diag(self.covariance), self.noise**2))

    def readings(self, angle_rad: Floats) -> Floats:
        """Return the readings at angles of the field in the robot's frame, shape (angles, 3)."""
        return np.asarray(basis(angle_rad, self.order) @ self.coefficients)


@dataclass(frozen=True)
class Ellipse:
    """The first harmonic, as the configuration describes it. Angles in rad, the rest in counts."""

    major: float
    minor: float
    rotation: float
    phase: float


def basis(angle_rad: Floats, order: int) -> Floats:
    """Return 1, cos a, sin a, cos 2a, ... at each angle; shape (angles, 1 + 2 order)."""
    columns = [np.ones_like(angle_rad)]
    for k in range(1, order + 1):
        columns += [np.cos(k * angle_rad), np.sin(k * angle_rad)]
    return np.column_stack(columns)


def fit_curve(table: ReadingTable, order: int, field_angle_rad: float) -> CurveFit:
    """Fit the curve by least squares.

    Args:
        table: Readings.
        order: Harmonics.
        field_angle_rad: Direction of the field where they were taken.

    Raises:
        CalibrationError: The headings do not determine the coefficients.
    """
    angle = field_angle_rad - table.angle_rad
    matrix = basis(angle, order)
    rows, count = matrix.shape
    different = len(np.unique(np.rint(np.mod(angle, 2.0 * math.pi) / DIFFERENT_RAD)))
    squares = matrix.T @ matrix
    if rows <= count or different < count or np.linalg.cond(squares) > LARGEST_CONDITION:
        covered = math.degrees(2.0 * math.pi - largest_gap(angle))
        raise CalibrationError(
            f"{table.source} has {rows} rows at {different} different headings, which cover {covered:.0f} of 360 "
            f"degrees; a curve of {order} harmonics needs more than {count} rows, at {count} headings or more all "
            "around the turn: take readings at more headings, or lower --harmonics"
        )
    if (gap := largest_gap(angle)) > LARGEST_GAP_RAD:
        raise CalibrationError(
            f"{table.source} has no readings in {math.degrees(gap):.0f} of 360 degrees: the curve is a guess there, "
            "and the ellipse may be wrong; take readings at headings all around the turn"
        )
    coefficients = np.asarray(np.linalg.solve(squares, matrix.T @ table.reading), dtype=np.float64)
    covariance = np.asarray(np.linalg.inv(squares), dtype=np.float64)
    residual = table.reading - matrix @ coefficients
    noise = np.sqrt(np.sum(residual**2, axis=0) / (rows - count))
    return CurveFit(coefficients, covariance, noise, angle, residual)


def largest_gap(angle_rad: Floats) -> float:
    """Return the largest angle between neighbouring headings around the turn."""
    sorted_angles = np.sort(np.mod(angle_rad, 2.0 * math.pi))
    return float(np.diff(np.append(sorted_angles, sorted_angles[0] + 2.0 * math.pi)).max())


def ellipse_of(coefficients: Floats) -> Ellipse:
    """Return the ellipse of x and y: M (cos a, sin a) with M = rotation(rotation) diag(major, minor) rotation(phase).

    Raises:
        CalibrationError: The curve runs against the angle.
    """
    matrix = coefficients[1:3, :2].T
    if np.linalg.det(matrix) < 0.0:
        raise CalibrationError(
            "as the angle of the table grows, readings run around the ellipse the other way than with source: "
            "procedural; if its angles count counter-clockwise seen from above, add --y-up. If they count clockwise, "
            "the sensor of this robot runs that way: use its table with source: csv, which fits it as it is"
        )
    left, (major, minor), right = np.linalg.svd(matrix)
    if np.linalg.det(left) < 0.0:  # both are reflections
        left, right = left * [1.0, -1.0], right * [[1.0], [-1.0]]
    rotation = math.atan2(left[1, 0], left[0, 0])
    if abs(rotation) > math.pi / 2.0:  # the same axis, the other end of it
        rotation, right = rotation - math.copysign(math.pi, rotation), -right
    return Ellipse(float(major), float(minor), rotation, math.atan2(right[1, 0], right[0, 0]))


def check_ellipse(fitted: CurveFit, source: str, doubt: str = "") -> None:
    """Raise CalibrationError if readings do not go around an ellipse; `doubt`: about rows that explain it."""
    size = math.sqrt(float(np.sum(fitted.coefficients[1:3, :2] ** 2)))
    error = math.sqrt(float(np.sum(fitted.errors()[1:3, :2] ** 2)))
    if size <= SIGNIFICANT * error or size < 1e-9 * (1.0 + float(np.abs(fitted.coefficients[0]).max())):
        unclear = (
            f"{source}: x and y hardly depend on the heading: the first harmonic has {size:.3g} +- {error:.2g} counts; "
            "check that the angles belong to the readings"
        )
        raise CalibrationError(doubt or unclear)
    minor = float(np.linalg.svd(fitted.coefficients[1:3, :2], compute_uv=False)[1])
    if minor <= SIGNIFICANT * error or minor < 1e-9 * size:
        raise CalibrationError(
            doubt
            or f"{source}: x and y move along a line as the robot turns, not around an ellipse: the short axis has "
            f"{minor:.3g} +- {error:.2g} counts; check the columns"
        )


def about_phase(fitted: CurveFit, phase: float) -> Floats:
    """Return the coefficients by the angle of the field plus a phase, as the ellipse of the configuration counts it."""
    turned = fitted.coefficients.copy()
    for k in range(1, fitted.order + 1):
        cosine, sine = math.cos(k * phase), math.sin(k * phase)
        a, b = fitted.coefficients[2 * k - 1], fitted.coefficients[2 * k]
        turned[2 * k - 1], turned[2 * k] = a * cosine - b * sine, a * sine + b * cosine
    return turned


def propagated(fitted: CurveFit, function: Callable[[Floats], Floats]) -> Floats:
    """Return the standard errors of functions of the coefficients, to first order; axes are independent."""
    start = function(fitted.coefficients)
    variance = np.zeros_like(start)
    step = 1e-4 * (1.0 + float(np.abs(fitted.coefficients[1:]).max()))
    for axis in range(fitted.coefficients.shape[1]):
        slopes = np.zeros((len(fitted.coefficients), len(start)))
        for row in range(len(fitted.coefficients)):
            moved = fitted.coefficients.copy()
            moved[row, axis] += step
            slopes[row] = (function(moved) - start) / step
        variance += fitted.noise[axis] ** 2 * np.einsum("ij,ik,kj->j", slopes, fitted.covariance, slopes)
    return np.sqrt(variance)


def ellipse_errors(fitted: CurveFit) -> Ellipse:
    """Return the standard errors of the ellipse."""
    at = ellipse_of(fitted.coefficients)

    def parts(coefficients: Floats) -> Floats:
        ellipse = ellipse_of(coefficients)
        rotation = at.rotation + math.remainder(ellipse.rotation - at.rotation, math.pi)
        phase = at.phase + math.remainder(ellipse.phase - at.phase, math.pi)
        return np.array([ellipse.major, ellipse.minor, rotation, phase])

    return Ellipse(*propagated(fitted, parts).tolist())


# ---- Rows that are far from the curve of the others ----

FAR = 3.0  # distances of the quartiles from each other
LEAST_WIDTH = 10.0  # of the quartiles, counts
OF_NORMAL = 1.4826  # standard deviation of a normal distribution over the median of its size
LEAST_SCALE = 1.0  # counts: readings are whole
NEAR, OUTLIER = 6.0, 10.0  # usual distances from the curve
ROUNDS = 10
MOST_SHARE = 0.25  # beyond it, the curve is wrong, not the rows


def outliers(table: ReadingTable, order: int, field_angle_rad: float) -> NDArray[np.int64]:
    """Return the numbers of the rows, from 0; none if they are many, or if the others do not determine the curve."""
    matrix = basis(field_angle_rad - table.angle_rad, order)
    low, high = np.percentile(table.reading, [25.0, 75.0], axis=0)
    far = FAR * np.maximum(high - low, LEAST_WIDTH)
    is_near = np.all((table.reading >= low - far) & (table.reading <= high + far), axis=1)
    # Rows that were near the curve of others give a better one.
    for _ in range(ROUNDS):
        if is_near.sum() <= matrix.shape[1] or np.linalg.matrix_rank(matrix[is_near]) < matrix.shape[1]:
            return np.zeros(0, dtype=np.int64)
        distance = distances(matrix, table.reading, is_near)
        if np.array_equal(distance <= NEAR, is_near):
            break
        is_near = distance <= NEAR
    found = np.flatnonzero(distance > OUTLIER)
    return found if len(found) <= MOST_SHARE * len(table.reading) else found[:0]


def distances(matrix: Floats, reading: Floats, is_near: NDArray[np.bool_]) -> Floats:
    """Return the distances of all rows from the curve of those that are near, in units of the usual one of these."""
    coefficients = np.linalg.lstsq(matrix[is_near], reading[is_near], rcond=None)[0]
    distance = np.abs(reading - matrix @ coefficients)
    scale = np.maximum(OF_NORMAL * np.median(distance[is_near], axis=0), LEAST_SCALE)
    return np.asarray(np.max(distance / scale, axis=1), dtype=np.float64)


def doubt(table: ReadingTable, order: int, field_angle_rad: float) -> str:
    """Return what is wrong with rows of a table; empty if nothing is."""
    found = outliers(table, order, field_angle_rad)
    if not len(found):
        return ""
    reading = ", ".join(f"{count:g}" for count in table.reading[found[0]])
    more = f", like {len(found) - 1} more" if len(found) > 1 else ""
    return (
        f"{table.source}: the reading {reading} at {math.degrees(table.angle_rad[found[0]]):g} degrees is far from the "
        f"curve of the other rows{more}; correct or delete it"
    )
