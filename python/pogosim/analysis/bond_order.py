"""Bond-orientational order: do the neighbours of robots stand in the directions of a lattice?"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from pogosim.analysis.snapshots import nearest_of, snapshots_of
from pogosim.analysis.trajectories import Trajectories

Complex = npt.NDArray[np.complex128]


def bond_order(run: Trajectories, k: int = 6) -> Complex:
    """Return the k-fold bond order of each robot, psi_k = mean of exp(i k phi) over its k nearest neighbours.

    phi is the direction of a neighbour. |psi_6| is 1 in a hexagonal lattice, |psi_4| in a square one; k neighbours in
    independent directions have sqrt(pi) / (2 sqrt(k)) on average. The nearest k count, however far they are. Source:
    Nelson, Halperin, "Dislocation-mediated melting in two dimensions", Physical Review B 19, 1979.

    Args:
        run: Positions of the robots.
        k: Symmetry and number of neighbours, at least 1.

    Returns:
        Shape (T, N), complex. NaN at times with less than k + 1 robots, and for robots that are not there.
    """
    psi = np.full(run.is_there.shape, np.nan, dtype=np.complex128)
    enough = run.is_there & (run.is_there.sum(axis=1) > k)[:, None]
    for own in snapshots_of(run, enough):
        _, nearest = nearest_of(own, run.arena, k + 1)
        # A robot is among its own nearest, first or, if others stand in the same place, later, or not at all.
        is_own = nearest == np.arange(len(nearest))[:, None]
        is_own[~is_own.any(axis=1), -1] = True
        neighbours = nearest[~is_own].reshape(len(nearest), k)
        offset = run.arena.minimum_image(own.position_mm[neighbours] - own.position_mm[:, None])
        own.put(psi, np.exp(1j * k * np.arctan2(offset[..., 1], offset[..., 0])).mean(axis=1))
    return psi
