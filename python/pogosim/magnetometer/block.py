"""The lines of a configuration that reproduce a magnetometer."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pogosim.calibration.result import rounded
from pogosim.calibration.tracks import Floats
from pogosim.magnetometer.fit import (
    CurveFit,
    Ellipse,
    about_phase,
    ellipse_errors,
    ellipse_of,
    propagated,
)
from pogosim.magnetometer.table import AXES

COMMENTS_AT = 64  # column
UNKNOWN_RAD = 0.35  # standard error beyond which an angle says nothing


@dataclass(frozen=True)
class Line:
    """A line, and what is known of its values."""

    text: str
    comment: str = ""

    def __str__(self) -> str:
        """Return the line with its comment."""
        return f"{self.text:{COMMENTS_AT}}  # {self.comment}" if self.comment else self.text


def value(number: float, error: float) -> str:
    """Return a value that all robots share, with the digits that its error leaves."""
    return f"[{rounded(number, error):g}]"


def scalar(depth: int, key: str, number: float, error: float, unit: str, remark: str = "") -> Line:
    """Return the line of one value."""
    return Line(f"{'    ' * depth}{key}: {value(number, error)}", f"{unit}, +- {error:.2g}{remark}")


def axes(lead: str, numbers: Floats, errors: Floats) -> Line:
    """Return the line of the values of three axes; `lead`: what stands before them."""
    text = ", ".join(f"{axis}: {value(*pair)}" for axis, *pair in zip(AXES, numbers, errors, strict=True))
    return Line(f"{lead} {{{text}}}", f"counts, +- {', '.join(f'{error:.2g}' for error in errors)}")


def ellipse_lines(fitted: CurveFit, ellipse: Ellipse, turned: Floats, turned_errors: Floats) -> list[Line]:
    """Return the lines of the ellipse; it is turned by its phase."""
    error = ellipse_errors(fitted)
    degrees = 180.0 / math.pi
    alike = "; nearly a circle: it and sensor_phase_offset are known by their sum alone"
    remark = alike if error.rotation > UNKNOWN_RAD else ""
    return [
        axes("            center:", fitted.coefficients[0], fitted.errors()[0]),
        scalar(3, "major_radius", ellipse.major, error.major, "counts"),
        scalar(3, "minor_radius", ellipse.minor, error.minor, "counts"),
        scalar(3, "ellipse_rotation", ellipse.rotation * degrees, error.rotation * degrees, "degrees", remark),
        scalar(3, "sensor_phase_offset", ellipse.phase * degrees, error.phase * degrees, "degrees"),
        scalar(3, "z_cos_amplitude", turned[1, 2], turned_errors[1, 2], "counts"),
        scalar(3, "z_sin_amplitude", turned[2, 2], turned_errors[2, 2], "counts"),
    ]


def harmonic_lines(turned: Floats, errors: Floats) -> list[Line]:
    """Return the lines of the harmonics from the second on."""
    order = (len(turned) - 1) // 2
    lines = [Line(f"        distortion_harmonics:{' []' if order == 1 else ''}")]
    for k in range(2, order + 1):
        lines += [
            Line(f"            - order: {k}"),
            axes("              cos:", turned[2 * k - 1], errors[2 * k - 1]),
            axes("              sin:", turned[2 * k], errors[2 * k]),
        ]
    return lines


def configuration_block(fitted: CurveFit, field_angle_rad: float) -> str:
    """Return the map `magnetometer` of a configuration, with standard errors as comments."""
    ellipse = ellipse_of(fitted.coefficients)
    turned = about_phase(fitted, ellipse.phase)
    # Errors of the harmonics, as they are counted from the phase of the ellipse, which has an error of its own.
    errors = propagated(
        fitted, lambda c: about_phase(with_coefficients(fitted, c), phase_near(c, ellipse.phase)).ravel()
    ).reshape(turned.shape)
    field = f"{math.degrees(field_angle_rad):g}"
    lines = [
        Line("magnetometer:"),
        Line("    source: procedural"),
        Line("    angle_unit: degrees"),
        *([Line(f"    world_field: {{magnetic_north_angle: {field}}}")] if field_angle_rad else []),
        Line("    procedural:"),
        Line("        ellipse:"),
        *ellipse_lines(fitted, ellipse, turned, errors),
        *harmonic_lines(turned, errors),
        Line("    robot_variation:"),
        *noise_lines(fitted),
    ]
    return "\n".join(str(line).rstrip() for line in lines)


def phase_near(coefficients: Floats, phase: float) -> float:
    """Return the phase of the ellipse, or that plus pi, whichever is nearer to `phase`."""
    return phase + math.remainder(ellipse_of(coefficients).phase - phase, math.pi)


def with_coefficients(fitted: CurveFit, coefficients: Floats) -> CurveFit:
    """Return the fit with other coefficients."""
    return CurveFit(coefficients, fitted.covariance, fitted.noise, fitted.angle_rad, fitted.residual)


def noise_lines(fitted: CurveFit) -> list[Line]:
    """Return the lines of the noise, which is what the curve leaves."""
    error = fitted.noise / math.sqrt(2.0 * max(len(fitted.residual) - len(fitted.coefficients), 1))
    rms = ", ".join(f"{number:.3g}" for number in fitted.rms_error)
    return [
        axes("        noise_stddev:", fitted.noise, error),
        Line(f"        # root mean square of the residuals of x, y and z: {rms} counts"),
    ]
