"""Fluctuations: of the number of robots in boxes, and of their speeds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pogosim.analysis.arena import Floats
from pogosim.analysis.floor import box_of, floor_of_centres
from pogosim.analysis.trajectories import Trajectories

SIZES = 12
MIN_BOXES = 4


@dataclass(frozen=True)
class NumberFluctuations:
    """Robots in square boxes of several sizes. S sizes."""

    box_mm: Floats  # (S,), side of a box
    boxes: Floats  # (S,), number of boxes
    mean: Floats  # (S,), mean number of robots in a box
    deviation: Floats  # (S,), standard deviation of it

    @property
    def exponent(self) -> float:
        """Alpha of sigma ~ N^alpha, by least squares of the logarithms; NaN for fewer than two sizes."""
        good = (self.mean > 0.0) & (self.deviation > 0.0)
        if np.count_nonzero(good) < 2:
            return float("nan")
        x = np.log(self.mean[good])
        x -= x.mean()
        return float(x @ np.log(self.deviation[good]) / (x @ x)) if np.ptp(x) > 0.0 else float("nan")


def number_fluctuations(run: Trajectories) -> NumberFluctuations:
    """Return how much the number of robots in a box differs between boxes and times, by the size of the box.

    sigma ~ N^alpha: alpha is 1/2 for independent positions, more in swarms with giant number fluctuations (Narayan,
    Ramaswamy, Menon, "Long-lived giant number fluctuations in a swarming granular nematic", Science 317, 2007), and
    less in crystals. A box that takes the part p of the floor has sigma^2 = N (1 - p) for N of independent robots; it
    is divided by 1 - p, so that alpha is 1/2 for large boxes too. The floor is where centres can be
    (`floor_of_centres`).

    Boxes are squares side by side in the middle of the floor, and only those that are completely on it. Their sides are
    1/3 to 1/n of the shorter side of the floor, n such that they have one robot on average; sizes with less than four
    boxes are left out.

    Args:
        run: Its arena must be known.

    Returns:
        See `NumberFluctuations`; it may be empty if there are few robots.

    Raises:
        AnalysisError: The outline of the arena is not known.
    """
    import shapely

    floor = floor_of_centres(run)
    low, high = box_of(floor)
    size = high - low
    there = run.is_there
    robots = there.sum(axis=1)
    finest = int(size.min() * np.sqrt(robots.mean() / floor.area))
    # An array of no sizes if boxes of one robot are larger than a third of the floor.
    divisions = np.unique(np.geomspace(3, max(finest, 3), SIZES).astype(int))[: SIZES if finest >= 3 else 0]
    roomy = floor.buffer(1e-6 * float(size.min()))  # boxes may touch the walls
    rows = []
    for division in divisions:
        side = size.min() / division
        columns, lines = np.floor(size / side + 1e-9).astype(int)
        corner = (low + high - side * np.array([columns, lines])) / 2.0
        x, y = np.meshgrid(corner[0] + side * np.arange(columns), corner[1] + side * np.arange(lines))
        inside = shapely.covers(roomy, shapely.box(x, y, x + side, y + side)).ravel()
        if np.count_nonzero(inside) < MIN_BOXES:
            continue
        cell = np.floor((np.where(there[:, :, None], run.position_mm, low - side) - corner) / side).astype(int)
        column, line = cell[..., 0], cell[..., 1]
        at_time, robot = np.nonzero((column >= 0) & (column < columns) & (line >= 0) & (line < lines))
        index = (at_time * lines + line[at_time, robot]) * columns + column[at_time, robot]
        count = np.bincount(index, minlength=len(there) * lines * columns).reshape(len(there), -1)[:, inside]
        # If robots come and go, what is expected of a box comes and goes with them.
        expected = count.sum() / max(robots.sum() * count.shape[1], 1) * robots[:, None]
        variance = ((count - expected) ** 2).mean() / (1.0 - side**2 / floor.area)
        rows.append((side, count.shape[1], count.mean(), np.sqrt(variance)))
    return NumberFluctuations(*np.array(rows, dtype=float).reshape(-1, 4).T)


def mean_square_speed(velocity: Floats) -> Floats:
    """Return the mean of |v|^2 over the robots at each time.

    In two dimensions it is 2 k T / m of a gas, so its ratio to a reference is a ratio of effective temperatures.

    Args:
        velocity: Shape (T, N, 2), mm/s; NaN is left out.

    Returns:
        Shape (T,), mm^2/s^2; NaN at times without any velocity.
    """
    square = (velocity**2).sum(axis=2)
    with np.errstate(invalid="ignore"):
        return np.asarray(np.nansum(square, axis=1) / np.isfinite(square).sum(axis=1))
