"""Order of directions: do robots go the same way, all of them, or neighbours?

    from pogosim.analysis.directions import directions_of_motion
    from pogosim.analysis.order import local_alignment, polar_order

    order = polar_order(directions_of_motion(run))  # a number for each time

Directions are unit vectors of shape (T, N, 2), of velocities or headings, see `directions`. NaN: no direction; such
robots are left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from pogosim.analysis.arena import Floats
from pogosim.analysis.snapshots import Integers, pairs_of, snapshots_of
from pogosim.analysis.trajectories import Trajectories


def polar_order(direction: Floats) -> Floats:
    """Return the length of the mean direction at each time, P = |<u>|.

    1: all go the same way; 0: no common direction. N robots with independent directions have sqrt(pi) / (2 sqrt(N)) on
    average. Source: Vicsek, Czirok, Ben-Jacob, Cohen, Shochet, "Novel type of phase transition in a system of
    self-driven particles", Physical Review Letters 75, 1995.

    Args:
        direction: Unit vectors, shape (T, N, 2).

    Returns:
        Shape (T,), 0 to 1. NaN at times without any direction.
    """
    mean = mean_over_robots(direction)
    return np.asarray(np.minimum(np.hypot(mean[:, 0], mean[:, 1]), 1.0))


def nematic_order(direction: Floats) -> Floats:
    """Return the length of the mean of doubled angles at each time, S = |<exp(2 i theta)>|.

    1: all are parallel to one axis, whichever way they go; 0: no common axis. It is the greater eigenvalue of the
    tensor Q = <2 u u^T - 1>. Source: de Gennes, Prost, "The Physics of Liquid Crystals", 1993.

    Args:
        direction: Unit vectors, shape (T, N, 2).

    Returns:
        Shape (T,), 0 to 1. NaN at times without any direction.
    """
    x, y = direction[..., 0], direction[..., 1]
    return polar_order(np.stack([x * x - y * y, 2.0 * x * y], axis=2))


def mean_over_robots(vector: Floats) -> Floats:
    """Return the mean over the robots that have a vector. Shape (T, N, 2) to (T, 2), NaN at times without any."""
    has = np.asarray(np.isfinite(vector).all(axis=2))
    total = np.where(has[:, :, None], vector, 0.0).sum(axis=1)
    with np.errstate(invalid="ignore"):
        return np.asarray(total / has.sum(axis=1)[:, None])


@dataclass(frozen=True)
class LocalAlignment:
    """How each robot and its neighbours are aligned. Shapes (T, N), NaN for robots without a neighbour."""

    group_size: npt.NDArray[np.int64]  # m: the robot and its neighbours, those with a direction; 0 without a direction
    polar_order: Floats  # P, of the m directions
    corrected: Floats  # max(0, P - sqrt(pi) / (2 sqrt(m)))
    rayleigh_z: Floats  # Z = 2 m P^2
    pair_alignment: Floats  # mean of cos(theta_j - theta_i) over the m - 1 neighbours


def local_alignment(run: Trajectories, direction: Floats, radius_mm: float) -> LocalAlignment:
    """Return how well each robot is aligned with its neighbours.

    P is the polar order of the robot and its neighbours. Few directions have a common one by chance: the length of
    the mean of m independent unit vectors is distributed, for large m, as Rayleigh's with mean sqrt(pi) / (2
    sqrt(m)), which `corrected` subtracts (for m = 2, 3, 4 the mean is 0.637, 0.525, 0.450; the formula gives 0.627,
    0.512, 0.443). Under the same hypothesis Z = 2 m P^2 is distributed as chi^2 with two degrees of freedom, with
    mean 2: above 5.99, directions are not independent at the level of 5 %. Many texts call half of it, m P^2, the
    statistic of Rayleigh's test. Source: Mardia, Jupp, "Directional Statistics", 2000, sections 4.8 and 6.3.

    Args:
        run: Positions of the robots.
        direction: Unit vectors, shape (T, N, 2).
        radius_mm: Neighbours are at most so far apart.

    Returns:
        See `LocalAlignment`.
    """
    size = np.zeros(run.is_there.shape, dtype=np.int64)
    total = np.full(direction.shape, np.nan)
    counts = run.is_there & np.isfinite(direction).all(axis=2)
    for own in snapshots_of(run, counts):
        unit = own.of(direction)
        i, j, _ = pairs_of(own, run.arena, radius_mm)
        own.put(total, unit + sum_over_neighbours(unit, i, j))
        own.put(size, 1 + np.bincount(np.concatenate([i, j]), minlength=len(unit)))
    m = np.where(size > 1, size, np.nan)
    order = np.minimum(np.hypot(total[..., 0], total[..., 1]) / m, 1.0)
    return LocalAlignment(
        group_size=size,
        polar_order=order,
        corrected=np.maximum(order - np.sqrt(np.pi / m) / 2.0, 0.0),
        rayleigh_z=2.0 * m * order**2,
        pair_alignment=((total * direction).sum(axis=2) - 1.0) / (m - 1.0),
    )


def sum_over_neighbours(vector: Floats, i: Integers, j: Integers) -> Floats:
    """Return the sum of the vectors of each robot's neighbours; shape (n, 2), pairs i, j."""
    own, other = np.concatenate([i, j]), np.concatenate([j, i])
    parts = [np.bincount(own, vector[other, axis], minlength=len(vector)) for axis in (0, 1)]
    return np.stack(parts, axis=1)
