"""Robots at many save times as one list of points, so that one search finds the pairs of all of them.

The save time is a third coordinate that keeps points of different times farther apart than any distance of interest:

    z ^   o  o     o      time 2
      |     o   o o       time 1     spacing > reach
      |   o  o     o      time 0

so searches in a tree of these points find the pairs of each time, and no others. Blocks of times keep what is in memory
small, however long the run is.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pogosim.analysis.arena import Arena, Floats
from pogosim.analysis.trajectories import Run

if TYPE_CHECKING:
    from scipy import spatial

Integers = npt.NDArray[np.int64]

# In a block of times, unless one time alone has more.
MAX_POINTS = 20_000
MAX_PAIRS = 2_000_000


@dataclass(frozen=True)
class Snapshots:
    """The robots at a block of save times. n points, sorted by time, then by robot."""

    times: slice  # of the run
    time: Integers  # (n,), number of the save time in the block
    robot: Integers  # (n,), number of the robot in the run
    position_mm: Floats  # (n, 2)

    @property
    def length(self) -> int:
        """Number of save times."""
        return int(self.times.stop - self.times.start)

    @property
    def counts(self) -> Integers:
        """Number of points at each time, shape (length,)."""
        return np.bincount(self.time, minlength=self.length)

    def of(self, values: Floats) -> Floats:
        """Return the values of the points. Shape (T, N, ...) to (n, ...)."""
        return np.asarray(values[self.times][self.time, self.robot])

    def put(self, values: npt.NDArray[Any], own: npt.ArrayLike) -> None:
        """Write values of the points, shape (n, ...), to an array of shape (T, N, ...)."""
        values[self.times][self.time, self.robot] = own


def blocks_of(cost: Floats) -> Iterator[slice]:
    """Divide times into blocks whose costs add up to 1 at most, or that are one time. Shape (T,)."""
    total = np.cumsum(cost)
    start = 0
    while start < len(cost):
        before = total[start - 1] if start else 0.0
        stop = max(int(np.searchsorted(total, before + 1.0, side="right")), start + 1)
        yield slice(start, stop)
        start = stop


def times_of(count: Integers, most_times: int = 100_000) -> Iterator[slice]:
    """Divide times into blocks, given how many robots are there at each, shape (T,)."""
    count = count.astype(float)
    yield from blocks_of(np.maximum(np.maximum(count / MAX_POINTS, count**2 / (2.0 * MAX_PAIRS)), 1.0 / most_times))


def snapshots_of(run: Run, use: npt.NDArray[np.bool_] | None = None, most_times: int = 100_000) -> Iterator[Snapshots]:
    """Yield the robots of a run, block by block.

    Args:
        run: Positions of the robots, in memory or in a file.
        use: Which robots at which times, shape (T, N), all with a position; None: all that have one.
        most_times: In a block.
    """
    count = run.present if use is None else np.count_nonzero(use, axis=1)
    for times, block in run.blocks(times_of(count, most_times)):
        time, robot = np.nonzero(block.is_there if use is None else use[times])
        yield Snapshots(times, time, robot, block.position_mm[time, robot])


def tree_of_times(
    position_mm: Floats, time: Integers, arena: Arena, spacing_mm: float
) -> tuple[spatial.cKDTree, Floats]:
    """Return a tree for searches of neighbours at the same time, and the points in it.

    scipy's trees keep all digits, and take distances beyond half a periodic box; freud's queries do neither.

    Args:
        position_mm: Shape (n, 2), finite.
        time: Number of the save time of each, shape (n,).
        arena: Its borders.
        spacing_mm: From one time to the next, more than any distance of interest.

    Returns:
        The tree, which knows the borders, and the points to ask it about, shape (n, 3): in periodic arenas, wrapped
        into the box.
    """
    from scipy import spatial

    points = np.column_stack([in_box(position_mm, arena), spacing_mm * time])
    if not arena.is_periodic:
        return spatial.cKDTree(points), points
    return spatial.cKDTree(points, boxsize=[*arena.size_mm, 0.0]), points


def in_box(position_mm: Floats, arena: Arena) -> Floats:
    """Return positions from the corner of a periodic arena, below its size; others stay. Shape (n, 2)."""
    if not arena.is_periodic:
        return position_mm
    points = np.mod(position_mm - arena.bounds_mm[0], arena.size_mm)
    return np.where(points < arena.size_mm, points, 0.0)  # of a tiny negative number, mod is the size itself


def farthest_mm(position_mm: Floats, arena: Arena) -> float:
    """Return a distance that no two of these points have. Shape (n, 2), n > 0."""
    extent = arena.size_mm if arena.is_periodic else np.ptp(position_mm, axis=0)
    return float(np.hypot(*extent)) + 1.0


def pairs_of(own: Snapshots, arena: Arena, reach_mm: float) -> tuple[Integers, Integers, Floats]:
    """Find all pairs of points at the same time that are not farther apart than the reach.

    Returns:
        The numbers i < j of the points, and their distances in mm (of the shortest image in periodic arenas), shape
        (E,) each; every pair once, in no particular order.
    """
    return pairs_at_times(own.position_mm, own.time, arena, reach_mm)


def pairs_at_times(
    position_mm: Floats, time: Integers, arena: Arena, reach_mm: float
) -> tuple[Integers, Integers, Floats]:
    """Do what `pairs_of` does, for points of shape (n, 2) and the number of the time of each, shape (n,)."""
    if len(position_mm) < 2:
        return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64), np.zeros(0)
    reach = min(reach_mm, farthest_mm(position_mm, arena))
    tree, points = tree_of_times(position_mm, time, arena, 2.0 * reach + 1.0)
    i, j = tree.query_pairs(reach, output_type="ndarray").astype(np.int64).T
    offset = arena.minimum_image(points[j, :2] - points[i, :2])
    return i, j, np.hypot(offset[:, 0], offset[:, 1])


def nearest_of(own: Snapshots, arena: Arena, count: int, reach_mm: float = np.inf) -> tuple[Floats, Integers]:
    """Find the nearest points of each point at the same time, itself among them.

    Returns:
        Distances in mm, increasing, and the numbers of the points, shape (n, count) each: infinite, and n, where there
        are fewer within the reach.
    """
    if len(own.position_mm) == 0:
        return np.zeros((0, count)), np.zeros((0, count), dtype=np.int64)
    farthest = farthest_mm(own.position_mm, arena)
    tree, points = tree_of_times(own.position_mm, own.time, arena, 2.0 * farthest)
    # The bound itself does not count, to scipy.
    bound = np.nextafter(min(reach_mm, farthest), np.inf)
    distance, nearest = tree.query(points, k=np.arange(1, count + 1), distance_upper_bound=bound)
    return distance, nearest.astype(np.int64)
