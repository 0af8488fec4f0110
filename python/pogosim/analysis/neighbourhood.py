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
from pogosim.analysis.trajectories import Trajectories, given

if TYPE_CHECKING:
    from scipy import sparse, spatial

Integers = npt.NDArray[np.int64]


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
        return by_size(label, self.is_there)


def tree_of(position_mm: Floats, arena: Arena) -> tuple[spatial.cKDTree, Floats]:
    """Return a tree for searches of neighbours, and the points in it: in periodic arenas, wrapped into the box.

    scipy's trees keep all digits, and take distances beyond half a periodic box; freud's queries do neither.

    Args:
        position_mm: Shape (n, 2), finite.
        arena: Its borders.

    Returns:
        The tree, which knows the borders, and the points to ask it about, shape (n, 2), in mm.
    """
    from scipy import spatial

    if not arena.is_periodic:
        return spatial.cKDTree(position_mm), position_mm
    points = np.mod(position_mm - arena.bounds_mm[0], arena.size_mm)
    points = np.where(points < arena.size_mm, points, 0.0)  # of a tiny negative number, mod is the size itself
    return spatial.cKDTree(points, boxsize=arena.size_mm), points


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
    if len(position_mm) < 2:
        return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64), np.zeros(0)
    tree, points = tree_of(position_mm, arena)
    pairs = tree.query_pairs(reach_mm, output_type="ndarray").astype(np.int64)
    offset = arena.minimum_image(points[pairs[:, 1]] - points[pairs[:, 0]])
    return pairs[:, 0], pairs[:, 1], np.hypot(offset[:, 0], offset[:, 1])


def neighbours(run: Trajectories, reach_mm: float | None = None) -> Iterator[Neighbours]:
    """Yield the pairs of neighbours at each save time.

    Args:
        run: Robots without a position at a time have no neighbours, and are none.
        reach_mm: Greatest distance; None: that of the run.
    """
    reach = run.reach(reach_mm)
    for time, positions, is_there in run.snapshots():
        first, second, distance = neighbour_pairs(positions, run.arena, reach)
        robots = np.flatnonzero(is_there)
        yield Neighbours(time, is_there, robots[first], robots[second], distance)


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
    for step, (_, positions, is_there) in enumerate(run.snapshots()):
        if len(positions):
            pairs = tree_of(positions, run.arena)[0].query_pairs(reach, output_type="ndarray")
            degree[step, is_there] = np.bincount(pairs.ravel(), minlength=len(positions))
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
    for step, (_, positions, is_there) in enumerate(run.snapshots()):
        if len(positions):
            tree, points = tree_of(positions, run.arena)
            # The nearest is the robot itself, or one at the same place. The bound itself does not count, to scipy.
            found = tree.query(points, k=count + 1, distance_upper_bound=np.nextafter(reach, np.inf))[0][:, 1:]
            distance[step, is_there] = np.where(np.isfinite(found), found, np.nan)
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
    return np.stack([now.cluster() for now in neighbours(run, reach_mm)])


def by_size(label: npt.NDArray[np.integer], is_there: npt.NDArray[np.bool_]) -> Integers:
    """Number clusters from the largest to the smallest, -1 for robots that are not there. Shapes (N,)."""
    own, first, inverse, count = np.unique(label[is_there], return_index=True, return_inverse=True, return_counts=True)
    rank = np.empty(len(own), dtype=np.int64)
    rank[np.lexsort((first, -count))] = np.arange(len(own))
    ranked = np.full(len(label), -1, dtype=np.int64)
    ranked[is_there] = rank[inverse]
    return ranked


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
