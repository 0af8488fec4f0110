"""Neighbourhoods: pairs of neighbours, degrees, nearest neighbours and clusters.

Two robots are neighbours if their centres are not farther apart than the reach, `run.reach_mm` unless another one is
given. Distances are those of the shortest image in periodic arenas. Walls do not separate robots.

    from pogosim.analysis.neighbourhood import clusters, degrees, neighbours

    degrees(run).mean()  # mean number of neighbours
    for now in neighbours(run):
        print(now.time_s, now.adjacency().nnz)
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from pogosim.analysis.arena import Arena, Floats
from pogosim.analysis.snapshots import Integers as Integers
from pogosim.analysis.snapshots import nearest_of, pairs_at_times, pairs_of, snapshots_of
from pogosim.analysis.trajectories import Trajectories, given

if TYPE_CHECKING:
    from scipy import sparse


@dataclass(frozen=True)
class Neighbours:
    """The pairs of neighbours at one time. E pairs, each in both directions; robots by their number 0 to N - 1."""

    time_s: float
    is_there: npt.NDArray[np.bool_]  # (N,), which robots have a position
    robot: Integers  # (E,), increasing
    neighbour: Integers  # (E,), increasing for each robot
    distance_mm: Floats  # (E,)

    def degree(self) -> Integers:
        """Return the number of neighbours of each robot, shape (N,); 0 if it is not there."""
        return np.bincount(self.robot, minlength=len(self.is_there))

    def adjacency(self) -> sparse.csr_array:
        """Return the adjacency matrix, shape (N, N): 1 for neighbours, symmetric; without robots that are not there."""
        from scipy import sparse

        size = len(self.is_there)
        ones = np.ones(len(self.robot))
        return sparse.csr_array((ones, (self.robot, self.neighbour)), shape=(size, size))

    def cluster(self) -> Integers:
        """Return the cluster of each robot, shape (N,), see `clusters`."""
        from scipy.sparse import csgraph

        label = csgraph.connected_components(self.adjacency(), directed=False)[1]
        cluster = np.full(len(self.is_there), -1, dtype=np.int64)
        own = label[self.is_there].astype(np.int64)
        cluster[self.is_there] = ranks(own, np.zeros(len(own), dtype=np.int64))
        return cluster


def neighbour_pairs(position_mm: Floats, arena: Arena, reach_mm: float) -> tuple[Integers, Integers, Floats]:
    """Find all pairs of points that are not farther apart than the reach. O(n log n + pairs).

    Args:
        position_mm: Shape (n, 2), finite.
        arena: Its borders.
        reach_mm: Greatest distance, of the shortest image in periodic arenas.

    Returns:
        The numbers i and j of the points, and their distances in mm, shape (E,) each: every pair as (i, j) and (j, i),
        sorted by i, then j; no point is its own neighbour.
    """
    i, j, distance = pairs_within(position_mm, arena, reach_mm)
    first, second = np.concatenate([i, j]), np.concatenate([j, i])
    order = np.argsort(first * len(position_mm) + second)
    return first[order], second[order], np.concatenate([distance, distance])[order]


def pairs_within(position_mm: Floats, arena: Arena, reach_mm: float) -> tuple[Integers, Integers, Floats]:
    """Find all pairs of points as `neighbour_pairs` does, but each of them once, i < j, in no particular order."""
    return pairs_at_times(position_mm, np.zeros(len(position_mm), dtype=np.int64), arena, reach_mm)


def neighbours(run: Trajectories, reach_mm: float | None = None) -> Iterator[Neighbours]:
    """Yield the pairs of neighbours at each save time.

    Args:
        run: Robots without a position at a time have no neighbours, and are none.
        reach_mm: Greatest distance; None: that of the run.
    """
    reach = run.reach(reach_mm)
    for own in snapshots_of(run):
        i, j, distance = pairs_of(own, run.arena, reach)
        first, second = np.concatenate([i, j]), np.concatenate([j, i])
        order = np.argsort(first * len(own.robot) + second)
        first, second, distance = first[order], second[order], np.concatenate([distance, distance])[order]
        robot, neighbour = own.robot[first], own.robot[second]
        border = np.searchsorted(own.time[first], np.arange(own.length + 1))
        for step, time in enumerate(range(own.times.start, own.times.stop)):
            part = slice(border[step], border[step + 1])
            yield Neighbours(float(run.time_s[time]), run.is_there[time], robot[part], neighbour[part], distance[part])


def degrees(run: Trajectories, reach_mm: float | None = None) -> Floats:
    """Return the number of neighbours of each robot at each time.

    Args:
        run: See `neighbours`.
        reach_mm: See `neighbours`.

    Returns:
        Shape (T, N); NaN where a robot has no position.
    """
    reach = run.reach(reach_mm)
    degree = np.full(run.position_mm.shape[:2], np.nan)
    for own in snapshots_of(run):
        i, j, _ = pairs_of(own, run.arena, reach)
        own.put(degree, np.bincount(np.concatenate([i, j]), minlength=len(own.robot)))
    return degree


def nearest_distances(run: Trajectories, count: int = 3, reach_mm: float | None = None) -> Floats:
    """Return the distances from each robot to its nearest neighbours.

    Args:
        run: See `neighbours`.
        count: How many neighbours, at least 1.
        reach_mm: See `neighbours`; `numpy.inf` for the nearest ones however far.

    Returns:
        Shape (T, N, count), in mm, increasing; NaN where a robot has no position, or fewer neighbours.
    """
    reach = run.reach(reach_mm)
    count = given.integer("count", count, least=1)
    distance = np.full((*run.position_mm.shape[:2], count), np.nan)
    for own in snapshots_of(run):
        # The nearest is the robot itself, or one at the same place.
        found = nearest_of(own, run.arena, count + 1, reach)[0][:, 1:]
        own.put(distance, np.where(np.isfinite(found), found, np.nan))
    return distance


def clusters(run: Trajectories, reach_mm: float | None = None) -> Integers:
    """Return the cluster of each robot at each time: connected components of the graph of neighbours.

    Args:
        run: See `neighbours`.
        reach_mm: See `neighbours`.

    Returns:
        Shape (T, N): 0 in the largest cluster, 1 in the next one, ...; of equal ones, that of the first robot comes
        first. -1 where a robot has no position.
    """
    reach = run.reach(reach_mm)
    cluster = np.full(run.position_mm.shape[:2], -1, dtype=np.int64)
    for own in snapshots_of(run):
        i, j, _ = pairs_of(own, run.arena, reach)
        own.put(cluster, ranks(components(len(own.robot), i, j), own.time))
    return cluster


def components(count: int, i: Integers, j: Integers) -> Integers:
    """Return the number of the connected component of each of so many points, given the pairs that are connected."""
    from scipy import sparse
    from scipy.sparse import csgraph

    graph = sparse.csr_array((np.ones(len(i), dtype=np.int8), (i, j)), shape=(count, count))
    return np.asarray(csgraph.connected_components(graph, directed=False)[1], dtype=np.int64)


def ranks(label: Integers, time: Integers) -> Integers:
    """Number the clusters of each time from the largest to the smallest; of equal ones, the first comes first.

    Args:
        label: Label of the cluster of each point, different ones at different times, shape (n,).
        time: Number of the time of each point, increasing, shape (n,).

    Returns:
        Shape (n,).
    """
    own, first, inverse, count = np.unique(label, return_index=True, return_inverse=True, return_counts=True)
    order = np.lexsort((first, -count, time[first]))
    begin = np.searchsorted(time[first][order], time[first][order])  # place of the first cluster of the same time
    rank = np.empty(len(own), dtype=np.int64)
    rank[order] = np.arange(len(own)) - begin
    return np.asarray(rank[inverse.reshape(-1)])


def cluster_sizes(cluster: Integers) -> Integers:
    """Return the number of robots in each cluster at each time.

    Args:
        cluster: Cluster of `clusters`, shape (T, N).

    Returns:
        Shape (T, C), C clusters at most; decreasing, 0 where there are fewer. The largest cluster is column 0.
    """
    most = int(cluster.max(initial=-1)) + 1
    flat = cluster + (most + 1) * np.arange(len(cluster))[:, None] + 1
    counts = np.bincount(flat.ravel(), minlength=(most + 1) * len(cluster)).reshape(len(cluster), most + 1)
    return np.asarray(counts[:, 1:])


def fano_factor(degree: Floats) -> Floats:
    """Return the Fano factor of the degrees at each time: their variance over their mean.

    1 for robots at independent, uniform places of a large arena (Poisson), 0 for a lattice, more for clusters. The
    variance is that of these robots, with n in its denominator. U. Fano, Phys. Rev. 72, 26 (1947).

    Args:
        degree: Degree of `degrees`, shape (T, N).

    Returns:
        Shape (T,); NaN where no robot has a neighbour.
    """
    there = np.isfinite(degree)
    count = np.maximum(there.sum(axis=1), 1)
    mean = np.where(there, degree, 0.0).sum(axis=1) / count
    variance = np.where(there, (degree - mean[:, None]) ** 2, 0.0).sum(axis=1) / count
    return np.asarray(np.divide(variance, mean, out=np.full(len(mean), np.nan), where=mean > 0.0))
