"""Where robots spend their time: densities of positions on a grid over the arena, counted or smoothed.

from pogosim.analysis.density import count_density, kernel_density

grid = count_density(run.arena, run.position_mm.reshape(-1, 2))
grid.density_per_m2  # (rows, columns)
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from pogosim.analysis.arena import Arena, Floats
from pogosim.analysis.walls import has_walls

Parts = Callable[[], Iterable[Floats]]  # yields points, shape (n, 2) each

# Bins with a smaller share of floor are not drawn: their density would rest on hardly any positions.
MIN_FLOOR_SHARE = 0.05
KERNEL_GRID = 200  # bins along the longer side


@dataclass(frozen=True)
class DensityGrid:
    """A density on a grid."""

    x_mm: Floats  # (columns + 1,), edges of the bins
    y_mm: Floats  # (rows + 1,)
    probability_per_m2: Floats  # (rows, columns), of the position of a robot; integrates to 1; NaN where no floor is


def finite_parts(position_mm: Floats | Parts) -> Parts:
    """Return a function that yields the points that are known, in parts, given an array or such a function."""
    parts: Parts = position_mm if callable(position_mm) else lambda: [position_mm]
    return lambda: map(finite_points, parts())


def finite_points(position_mm: Floats) -> Floats:
    """Return the points of shape (n, 2) that are known, of shape (m, 2)."""
    return np.asarray(position_mm[np.isfinite(position_mm).all(axis=1)])


def edges(arena: Arena, parts: Parts, bins: int) -> tuple[Floats, Floats]:
    """Return edges of about square bins over the arena (or the points), so many on the longer side."""
    if arena.polygons:
        low, high = arena.bounds_mm
    else:
        ends = np.array([(part.min(axis=0), part.max(axis=0)) for part in parts() if len(part)])
        low, high = ends[:, 0].min(axis=0), ends[:, 1].max(axis=0)
        high = np.maximum(high, low + 1.0)
    side = float((high - low).max()) / bins
    count = np.maximum(np.round((high - low) / side).astype(int), 1)
    return np.linspace(low[0], high[0], count[0] + 1), np.linspace(low[1], high[1], count[1] + 1)


def floor_share(arena: Arena, x_mm: Floats, y_mm: Floats) -> Floats:
    """Return the share of each bin that is floor. Shape (rows, columns), 0 to 1; 1 without walls."""
    shape = (len(y_mm) - 1, len(x_mm) - 1)
    if not has_walls(arena):
        return np.ones(shape)
    import shapely

    floor = arena.shape()
    shapely.prepare(floor)
    left, top = np.meshgrid(x_mm[:-1], y_mm[:-1])
    right, bottom = np.meshgrid(x_mm[1:], y_mm[1:])
    bins = shapely.box(left, top, right, bottom)
    share = shapely.contains(floor, bins).astype(float)
    partly = (share == 0.0) & shapely.intersects(floor, bins)
    share[partly] = shapely.area(shapely.intersection(floor, bins[partly])) / shapely.area(bins[partly])
    return np.asarray(share)


def counted(parts: Parts, x_mm: Floats, y_mm: Floats) -> Floats:
    """Return the number of points in each bin. Shape (rows, columns); points beyond the edges are left out."""
    count = np.zeros((len(y_mm) - 1, len(x_mm) - 1))
    for points in parts():
        count += np.histogram2d(points[:, 1], points[:, 0], bins=(y_mm, x_mm))[0]
    return count


def sum_of(parts: Iterable[Floats]) -> Floats:
    """Return the sum of points, shape (2,)."""
    total = np.zeros((1, 2))
    for points in parts:
        total = np.concatenate([total, points]).sum(axis=0, keepdims=True)
    return np.asarray(total[0])


def variance_of(parts: Parts, count: int) -> Floats:
    """Return the variance of x and of y of so many points, shape (2,)."""
    mean = sum_of(parts()) / count
    return sum_of((points - mean) ** 2 for points in parts()) / count


def count_density(arena: Arena, position_mm: Floats | Parts, bins: int = 30) -> DensityGrid:
    """Count positions in bins: the share of all positions in a bin, by the floor that the bin has.

    Bins of which less than 5 % is floor are NaN.

    Args:
        arena: Its bounding box is divided into bins.
        position_mm: Shape (n, 2); of periodic arenas, within the bounding box. NaN is left out. Or a function that
            yields the positions in parts, each time that it is called.
        bins: Number of bins along the longer side; they are about square.

    Returns:
        The density: NaN everywhere without positions.
    """
    points = finite_parts(position_mm)
    total = sum(map(len, points()))
    if total == 0:
        return DensityGrid(np.zeros(2), np.zeros(2), np.full((1, 1), np.nan))
    x, y = edges(arena, points, bins)
    area_m2 = floor_share(arena, x, y) * np.outer(np.diff(y), np.diff(x)) * 1e-6
    few = area_m2 < MIN_FLOOR_SHARE * area_m2.max()
    count = counted(points, x, y)
    with np.errstate(invalid="ignore", divide="ignore"):
        return DensityGrid(x, y, np.where(few, np.nan, count / (total * area_m2)))


def is_within(points: Floats, x_mm: Floats, y_mm: Floats) -> npt.NDArray[np.bool_]:
    """Tell which points are on a grid. Shape (n, 2) to (n,)."""
    return np.asarray(((points >= [x_mm[0], y_mm[0]]) & (points <= [x_mm[-1], y_mm[-1]])).all(axis=1))


def count_outside(arena: Arena, position_mm: Floats) -> int:
    """Return how many points are outside of the bounding box of the arena, and thus in no bin; 0 if it is not known."""
    if not arena.polygons:
        return 0
    low, high = arena.bounds_mm
    points = finite_points(position_mm)
    return int(np.count_nonzero(~is_within(points, *np.stack([low, high]).T)))


def smoothed(values: Floats, sigma: Floats, arena: Arena) -> Floats:
    """Smooth values of bins by a Gaussian with these standard deviations, in bins.

    What a kernel that is wider than the grid has beyond it is not computed; in a periodic arena, one that is as wide
    as the grid is uniform, and so is a wider one. So the time does not depend on the width.
    """
    if arena.is_periodic:
        return np.asarray(ndimage.gaussian_filter(values, np.minimum(sigma, values.shape), mode="wrap"))
    radius = np.minimum(np.floor(4.0 * sigma + 0.5), values.shape).astype(int)  # scipy's own, if the grid has it
    sigma = np.minimum(sigma, 100.0 * np.array(values.shape))  # flat, as far as the grid goes
    return np.asarray(ndimage.gaussian_filter(values, sigma, mode="constant", radius=tuple(radius)))


def kernel_density(arena: Arena, position_mm: Floats | Parts, bandwidth_mm: float | None = None) -> DensityGrid:
    """Estimate the density by Gaussian kernels: each position is spread over its surroundings.

    Positions are counted in fine bins, and these smoothed (Silverman, "Kernel density estimation using the fast
    Fourier transform", Appl. Stat. 31, 1982), so a million positions take a moment. Near walls, where a part of each
    kernel lies outside, the density is divided by the part inside (Diggle, Appl. Stat. 34, 1985). Kernels go on across
    periodic borders.

    Args:
        arena: The grid covers its bounding box.
        position_mm: As for `count_density`; those beyond the box are left out.
        bandwidth_mm: Standard deviation of the kernel. None: Scott's rule in two dimensions, s n^(-1/6), where s is
            the standard deviation of the positions in the arena (root mean square of both axes).

    Returns:
        The density: NaN off the floor.
    """
    every = finite_parts(position_mm)
    if not any(map(len, every())):
        return DensityGrid(np.zeros(2), np.zeros(2), np.full((1, 1), np.nan))
    x, y = edges(arena, every, KERNEL_GRID)

    def points() -> Iterator[Floats]:
        return (part[is_within(part, x, y)] for part in every())

    total = sum(map(len, points()))
    if total == 0:
        return DensityGrid(x, y, np.full((len(y) - 1, len(x) - 1), np.nan))
    if bandwidth_mm is None:
        bandwidth_mm = float(np.sqrt(variance_of(points, total).mean())) * total ** (-1.0 / 6.0)
    size = np.array([y[1] - y[0], x[1] - x[0]])
    sigma = np.maximum(bandwidth_mm / size, 0.5)  # in bins
    share = floor_share(arena, x, y)
    count = smoothed(counted(points, x, y), sigma, arena)
    inside = smoothed(share, sigma, arena) if has_walls(arena) else share
    with np.errstate(invalid="ignore", divide="ignore"):
        density = np.where(share > MIN_FLOOR_SHARE, count / inside, np.nan)
    whole = np.nansum(density * share) * size.prod() * 1e-6
    return DensityGrid(x, y, density / whole if whole > 0.0 else np.full_like(density, np.nan))
