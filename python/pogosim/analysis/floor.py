"""The part of an arena where robots can be, and what its borders do to statistics of pairs and counts."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from pogosim.analysis.arena import Floats
from pogosim.analysis.trajectories import Trajectories
from pogosim.errors import AnalysisError

if TYPE_CHECKING:
    import shapely

DIRECTIONS = 36  # over half a turn; more change the set covariance of a square by less than 0.1 %
RADII = 32
SAMPLES = 4  # per side of a cell


def floor_of_centres(run: Trajectories) -> shapely.Polygon | shapely.MultiPolygon:
    """Return where centres of robots can be: the floor, without what is closer to a wall than their radius.

    All of the box if the arena is periodic; all of the floor if it has no room for a robot. Objects in the arena are
    not walls.

    Raises:
        AnalysisError: The outline of the arena is not known.
    """
    if not run.arena.polygons:
        raise AnalysisError("it does not say what the arena is")
    floor = run.arena.shape()
    if run.arena.is_periodic:
        return floor
    inside = floor.buffer(-run.radius_mm)
    return floor if inside.is_empty else inside


def set_covariance(floor: shapely.Polygon | shapely.MultiPolygon, distance_mm: Floats) -> Floats:
    """Return the area that a floor has in common with itself shifted by a distance, averaged over all directions.

    It is the isotropised set covariance: two independent, uniform points on a floor of area A are at a distance r with
    the probability density 2 pi r covariance(r) / A^2. A at distance 0, and 0 beyond the diameter. Source: Ohser, "On
    estimators for the reduced second moment measure of point processes", Statistics 14, 1983; Chiu, Stoyan, Kendall,
    Mecke, "Stochastic Geometry and its Applications", 2013, section 4.7.

    Args:
        floor: With walls, not periodic; mm.
        distance_mm: Shape (n,), increasing from 0 or more. It is computed at 32 distances, and interpolated.

    Returns:
        Shape (n,), mm^2.
    """
    import shapely

    radius, common = covariance_at_radii(shapely.to_wkb(floor), float(distance_mm[-1]))
    return np.asarray(np.interp(distance_mm, radius, common))


@functools.lru_cache(maxsize=32)
def covariance_at_radii(floor_wkb: bytes, greatest_mm: float) -> tuple[Floats, Floats]:
    """Return 32 distances, and the `set_covariance` at these; remembered, as runs of a batch share their arenas."""
    import shapely

    floor = shapely.from_wkb(floor_wkb)
    radius = np.linspace(0.0, greatest_mm, RADII)
    angle = np.pi * (np.arange(DIRECTIONS) + 0.5) / DIRECTIONS
    shifts = (radius[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)).reshape(-1, 2)
    corners = shapely.get_coordinates(floor)
    shifted = shapely.set_coordinates(np.repeat(floor, len(shifts)), (shifts[:, None] + corners).reshape(-1, 2))
    common = shapely.area(shapely.intersection(shifted, floor)).reshape(RADII, DIRECTIONS)
    return radius, common.mean(axis=1)


def grid_of(bounds_mm: tuple[Floats, Floats], shape: tuple[int, int]) -> Floats:
    """Return the centres of the cells of a grid. Bounds (x, y) and shape (columns, rows) to (rows, columns, 2), mm."""
    low, high = bounds_mm
    x, y = (low[axis] + (high - low)[axis] * (np.arange(shape[axis]) + 0.5) / shape[axis] for axis in (0, 1))
    return np.stack(np.meshgrid(x, y), axis=2)


def covered_fraction(floor: shapely.Polygon | shapely.MultiPolygon, shape: tuple[int, int]) -> Floats:
    """Return which part of each cell of a grid over the bounding box of a floor belongs to it.

    Args:
        floor: In mm.
        shape: Columns and rows.

    Returns:
        Shape (rows, columns), 0 to 1, by 4 x 4 samples for each cell.
    """
    import shapely

    return fraction_of_cells(shapely.to_wkb(floor), shape)


@functools.lru_cache(maxsize=32)
def fraction_of_cells(floor_wkb: bytes, shape: tuple[int, int]) -> Floats:
    """Return the `covered_fraction`; remembered, as runs of a batch share their arenas."""
    import shapely

    floor = shapely.from_wkb(floor_wkb)
    columns, rows = shape
    samples = grid_of(box_of(floor), (columns * SAMPLES, rows * SAMPLES))
    shapely.prepare(floor)
    inside: npt.NDArray[np.bool_] = shapely.contains_xy(floor, samples[..., 0], samples[..., 1])
    return np.asarray(inside.reshape(rows, SAMPLES, columns, SAMPLES).mean(axis=(1, 3)))


def box_of(floor: shapely.Polygon | shapely.MultiPolygon) -> tuple[Floats, Floats]:
    """Return the corners (x, y) of the bounding box: least and greatest."""
    low_x, low_y, high_x, high_y = floor.bounds
    return np.array([low_x, low_y]), np.array([high_x, high_y])
