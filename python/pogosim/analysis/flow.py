"""The swarm as a flow: its velocity field on a grid, and how it rotates and deforms."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from pogosim.analysis.arena import Arena, Floats
from pogosim.analysis.snapshots import Integers, blocks_of, snapshots_of
from pogosim.analysis.trajectories import Run, Trajectories

MIN_ROBOTS = 4
MAX_PAIRS = 200_000  # of robots and cells, in a block of times: what fits into the processor's cache


@dataclass(frozen=True)
class VelocityField:
    """Velocity and its gradient at the centres of cells. Rows from the top, as y downwards. NaN where it is not known.

    Rotation is positive from the x axis towards the y axis: clockwise as seen, as the column `angle` counts.
    """

    velocity: Floats  # (rows, columns, 2), or (M, 2) of M cells; mm/s
    gradient: Floats  # (rows, columns, 2, 2) or (M, 2, 2), 1/s; [..., a, b] is the derivative of v_a by b

    @property
    def vorticity(self) -> Floats:
        """Vorticity d v_y / dx - d v_x / dy, 1/s: twice the angular velocity of a rigid rotation."""
        return np.asarray(self.gradient[..., 1, 0] - self.gradient[..., 0, 1])

    @property
    def divergence(self) -> Floats:
        """Divergence d v_x / dx + d v_y / dy, 1/s: positive where robots go apart."""
        return np.asarray(self.gradient[..., 0, 0] + self.gradient[..., 1, 1])

    @property
    def enstrophy(self) -> Floats:
        """Enstrophy density, half the square of the vorticity, 1/s^2."""
        return np.asarray(self.vorticity**2 / 2.0)

    @property
    def swirling_strength(self) -> Floats:
        """Imaginary part of the eigenvalues of the gradient, rad/s; 0 where they are real.

        The angular velocity at which paths go round; a shear has vorticity but no swirling strength. Source: Zhou,
        Adrian, Balachandar, Kendall, "Mechanisms for generating coherent packets of hairpin vortices in channel flow",
        Journal of Fluid Mechanics 387, 1999.
        """
        g = self.gradient
        determinant = g[..., 0, 0] * g[..., 1, 1] - g[..., 0, 1] * g[..., 1, 0]
        return np.asarray(np.sqrt(np.maximum(determinant - self.divergence**2 / 4.0, 0.0)))

    @property
    def okubo_weiss(self) -> Floats:
        """Okubo-Weiss parameter, normal strain^2 + shear strain^2 - vorticity^2, 1/s^2: negative in a vortex.

        Source: Okubo, Deep-Sea Research 17, 1970; Weiss, Physica D 48, 1991.
        """
        g = self.gradient
        normal, shear = g[..., 0, 0] - g[..., 1, 1], g[..., 1, 0] + g[..., 0, 1]
        return np.asarray(normal**2 + shear**2 - self.vorticity**2)


@dataclass(frozen=True)
class KnownCells:
    """The velocity fields at a block of times, where they are known: M cells of all times."""

    times: slice  # of the run
    time: Integers  # (M,), number of the time in the block, increasing
    cell: Integers  # (M,), row * columns + column
    field: VelocityField  # of M cells

    @property
    def length(self) -> int:
        """Number of times."""
        return int(self.times.stop - self.times.start)


def flow_bounds(run: Run) -> tuple[Floats, Floats]:
    """Return the corners of the grid: those of the arena, or of all positions if the arena is not known."""
    if run.arena.polygons:
        return run.arena.bounds_mm
    ends = np.array([(own.position_mm.min(axis=0), own.position_mm.max(axis=0)) for own in snapshots_of(run)])
    return ends[:, 0].min(axis=0), ends[:, 1].max(axis=0)


def velocity_fields(
    run: Trajectories, velocity: Floats, radius_mm: float, shape: tuple[int, int] = (64, 64)
) -> Iterator[tuple[float, VelocityField]]:
    """Yield the velocity field at each time.

    At the centre of each cell, a plane is fitted to the velocities of the robots around it by least squares, with the
    weights (1 - (d / radius)^2)^2. So a flow that is linear in x and y, such as a rotation, comes out exactly, however
    robots are spread (local linear regression; Fan, Gijbels, "Local Polynomial Modelling and Its Applications", 1996).
    There are values only where at least four robots are within the radius, on all sides of the cell: their mean place
    is less than one standard deviation from it.

    Args:
        run: Positions of the robots.
        velocity: Shape (T, N, 2), mm/s; NaN: the robot is left out.
        radius_mm: How far robots count; the resolution of the field, however fine the grid is.
        shape: Columns and rows of the grid, over `flow_bounds`.

    Yields:
        Time in s, and the field.
    """
    columns, rows = shape
    for known in blocks_of_fields(run, velocity, radius_mm, shape):
        value = np.full((known.length, rows * columns, 2), np.nan)
        gradient = np.full((known.length, rows * columns, 2, 2), np.nan)
        value[known.time, known.cell] = known.field.velocity
        gradient[known.time, known.cell] = known.field.gradient
        for number, time in enumerate(run.time_s[known.times]):
            yield (
                float(time),
                VelocityField(value[number].reshape(rows, columns, 2), gradient[number].reshape(rows, columns, 2, 2)),
            )


def blocks_of_fields(
    run: Trajectories, velocity: Floats, radius_mm: float, shape: tuple[int, int] = (64, 64)
) -> Iterator[KnownCells]:
    """Yield the fields of `velocity_fields` at blocks of times, without the cells where they are not known."""
    grid = Grid(flow_bounds(run), shape)
    use = run.is_there & np.isfinite(velocity).all(axis=2)
    use &= (use.sum(axis=1) >= MIN_ROBOTS)[:, None]
    around = grid.most_near(radius_mm)
    for times in blocks_of(np.maximum(use.sum(axis=1) * around, grid.cells) / MAX_PAIRS):
        time, robot = np.nonzero(use[times])
        position, own = run.position_mm[times][time, robot], velocity[times][time, robot]
        images = images_near(run.arena, position, radius_mm)
        time, position, own = time[images.robot], position[images.robot] + images.shift_mm, own[images.robot]
        yield fitted(grid, times, time, position, own, run.arena.period_mm, radius_mm)


@dataclass(frozen=True)
class Grid:
    """Cells side by side over a box, as of `grid_of`."""

    bounds_mm: tuple[Floats, Floats]
    shape: tuple[int, int]  # columns, rows

    @property
    def cells(self) -> int:
        """Number of cells."""
        return self.shape[0] * self.shape[1]

    def centres_mm(self, axis: int) -> Floats:
        """Return x (axis 0) of the columns, or y (axis 1) of the rows."""
        low, high = self.bounds_mm
        count = self.shape[axis]
        return np.asarray(low[axis] + (high - low)[axis] * (np.arange(count) + 0.5) / count)

    def centres_of(self, cell: Integers) -> Floats:
        """Return x and y of the centres of cells, given row * columns + column, modulo their number. Shape (2, n)."""
        row, column = np.divmod(cell % self.cells, self.shape[0])
        return np.stack([self.centres_mm(0)[column], self.centres_mm(1)[row]])

    def window(self, axis: int, place_mm: Floats, radius_mm: float) -> tuple[Integers, Floats]:
        """Return the columns (axis 0) or rows (axis 1) that may be within the radius, and the way from them to a place.

        Args:
            axis: 0 or 1.
            place_mm: x or y, shape (n,).
            radius_mm: The radius.

        Returns:
            Numbers and offsets in mm, shape (n, w) each. Where there is no such column, the offset is infinite.
        """
        centres = self.centres_mm(axis)
        count = min(self.width(axis, radius_mm), len(centres))
        first = np.searchsorted(centres, place_mm - radius_mm * (1.0 + 1e-9))
        number = first[:, None] + np.arange(count)
        inside = number < len(centres)
        number = np.where(inside, number, 0)
        return number, np.where(inside, place_mm[:, None] - centres[number], np.inf)

    def width(self, axis: int, radius_mm: float) -> int:
        """Return how many columns (axis 0) or rows (axis 1) can be within the radius of a place."""
        side = float((self.bounds_mm[1] - self.bounds_mm[0])[axis]) / self.shape[axis]
        return self.shape[axis] if 2.0 * radius_mm >= side * self.shape[axis] else int(2.0 * radius_mm / side) + 2

    def most_near(self, radius_mm: float) -> int:
        """Return how many cells can be within the radius of a place, at most."""
        wide, high = (min(self.width(axis, radius_mm), self.shape[axis]) for axis in (0, 1))
        return wide * high


@dataclass(frozen=True)
class Images:
    """Robots, and those of their images across periodic borders that are near the arena. M of them."""

    robot: Integers  # (M,), number of the robot
    shift_mm: Floats  # (M, 2)


def images_near(arena: Arena, position_mm: Floats, radius_mm: float) -> Images:
    """Return the images of robots that are within the radius of the arena's box; themselves, if it has walls."""
    robots = np.arange(len(position_mm))
    if not arena.is_periodic:
        return Images(robots, np.zeros_like(position_mm))
    low, high = arena.bounds_mm
    home = arena.wrap(position_mm) - position_mm
    numbers, shifts = [], []
    for x in (-1, 0, 1):
        for y in (-1, 0, 1):
            shift = home + np.array([x, y]) * arena.size_mm
            place = position_mm + shift
            near = ((place >= low - radius_mm) & (place <= high + radius_mm)).all(axis=1)
            numbers.append(robots[near])
            shifts.append(shift[near])
    number = np.concatenate(numbers)
    order = np.argsort(number, kind="stable")  # in the order of times
    return Images(number[order], np.concatenate(shifts)[order])


def fitted(
    grid: Grid,
    times: slice,
    time: Integers,
    position_mm: Floats,
    velocity: Floats,
    period_mm: Floats | None,
    radius: float,
) -> KnownCells:
    """Fit the velocity fields of several times; see `velocity_fields`.

    Args:
        grid: Where to.
        times: Which.
        time: Number of the time of each robot among these, shape (n,).
        position_mm: Shape (n, 2), finite; images across periodic borders are robots too.
        velocity: Shape (n, 2), mm/s, finite.
        period_mm: Size of a periodic arena, where the nearest image counts.
        radius: How far robots count, mm.
    """
    columns, rows = grid.shape
    # Around the middle of the grid, squares stay small, and so do rounding errors.
    middle = (grid.bounds_mm[0] + grid.bounds_mm[1]) / 2.0
    (column, x), (row, y) = (grid.window(axis, position_mm[:, axis], radius) for axis in (0, 1))
    if period_mm is not None:
        x, y = (np.where((own >= -size / 2.0) & (own < size / 2.0), own, np.inf)
                for own, size in zip((x, y), period_mm, strict=True))  # fmt: skip
    square = (y**2)[:, :, None] + (x**2)[:, None, :]
    near = square <= radius**2
    first = ((time[:, None] * rows + row) * columns).astype(np.int32)  # sizes of blocks keep them small
    number = (first[:, :, None] + column.astype(np.int32)[:, None, :])[near]
    weight = square[near]
    weight *= -1.0 / radius**2
    weight += 1.0
    weight *= weight
    # Sums over the robots around each cell are the product of a sparse matrix of weights and what robots have.
    p, v = position_mm - middle, velocity
    of_places = [np.ones(len(p)), p, p[:, 0] ** 2, p[:, 0] * p[:, 1], p[:, 1] ** 2]
    of_velocities = [v, *(v[:, a] * p[:, b] for a in (0, 1) for b in (0, 1))]
    starts = np.concatenate([[0], np.cumsum(np.count_nonzero(near, axis=(1, 2)))])
    size = (times.stop - times.start) * rows * columns
    matrix = sparse.csc_array((weight, number, starts), shape=(size, len(p)))
    sums = matrix @ np.column_stack(of_places + of_velocities)
    there = np.flatnonzero(np.bincount(number, minlength=size) >= MIN_ROBOTS)
    with np.errstate(invalid="ignore", divide="ignore"):
        # Where are the robots around each cell, and are they on all sides of it?
        means = contiguous(sums[there, :6] / sums[there, :1])
        place = means[1:3]
        xx, xy, yy = means[3] - place[0] ** 2, means[4] - place[0] * place[1], means[5] - place[1] ** 2
        determinant = xx * yy - xy**2
        off = place - (grid.centres_of(there) - middle[:, None])
        off_centre = (off[0] ** 2 * yy - 2.0 * off[0] * off[1] * xy + off[1] ** 2 * xx) / determinant
        good = (determinant > 1e-3 * (xx + yy) ** 2) & (off_centre < 1.0)
    there, place, off = there[good], place[:, good], off[:, good]
    xx, xy, yy, determinant = xx[good], xy[good], yy[good], determinant[good]
    means = contiguous(sums[there, 6:] / sums[there, :1])
    mean = means[:2]
    slopes = np.empty((2, 2, len(there)))
    for a in (0, 1):
        along_x, along_y = (means[2 + 2 * a + b] - mean[a] * place[b] for b in (0, 1))
        slopes[a, 0] = (along_x * yy - along_y * xy) / determinant
        slopes[a, 1] = (along_y * xx - along_x * xy) / determinant
    value = mean - slopes[:, 0] * off[0] - slopes[:, 1] * off[1]
    number_of_time, cell = np.divmod(there, rows * columns)
    return KnownCells(times, number_of_time, cell, VelocityField(value.T, np.moveaxis(slopes, 2, 0)))


def contiguous(rows: Floats) -> Floats:
    """Return the columns of a table as rows, each in one piece of memory. Shape (n, k) to (k, n)."""
    return np.ascontiguousarray(rows.T)
