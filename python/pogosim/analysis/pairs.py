"""Pairs of robots that are near each other, across periodic borders too."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree

from pogosim.analysis.arena import Arena, Floats

Indices = npt.NDArray[np.int64]


def tree_of(arena: Arena, position_mm: Floats) -> KDTree:
    """Return a search tree of positions, shape (n, 2), finite; in a periodic arena it looks across the borders."""
    if not arena.is_periodic:
        return KDTree(position_mm)
    return KDTree(in_box(arena, position_mm), boxsize=arena.size_mm)


def in_box(arena: Arena, position_mm: Floats) -> Floats:
    """Return positions in a periodic arena counted from its corner; 0 <= x < width, 0 <= y < height."""
    size = arena.size_mm
    inside = np.mod(position_mm - arena.bounds_mm[0], size)
    return np.where(inside < size, inside, 0.0)  # the remainder of -1e-20 is rounded to the width


def pairs_within(arena: Arena, position_mm: Floats, distance_mm: float) -> tuple[Indices, Indices]:
    """Find all pairs of positions that are at most so far from each other.

    Args:
        arena: If it is periodic, the nearest images count.
        position_mm: Shape (n, 2), finite.
        distance_mm: Greatest distance.

    Returns:
        The indices i < j of each pair, once, sorted.
    """
    if len(position_mm) < 2:
        return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
    pairs = tree_of(arena, position_mm).query_pairs(distance_mm, output_type="ndarray")
    # The order of the pairs is not specified, and sums depend on it in their last digits.
    order = np.argsort(pairs[:, 0] * len(position_mm) + pairs[:, 1])
    return pairs[order, 0].astype(np.int64), pairs[order, 1].astype(np.int64)
