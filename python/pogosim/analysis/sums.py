"""Sums of values that are not in memory all at once, to the last bit those of the array that they would be."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from pogosim.analysis.arena import Floats

LEAF = 1 << 16  # values that are added by NumPy; at least 128, as it divides only longer arrays


def sum_of_parts(parts: Iterable[Floats], count: int) -> float:
    """Return what `np.sum` returns for the parts as one array.

    NumPy adds in pairs: it divides an array into halves, the first of a multiple of 8 values, and these again. See
    N. J. Higham, "The accuracy of floating point summation", SIAM J. Sci. Comput. 14, 783 (1993).

    Args:
        parts: Shape (n,) each; any number of them.
        count: How many values they have together.
    """
    source = iter(parts)
    waiting = np.empty(0)

    def taken(wanted: int) -> Floats:
        nonlocal waiting
        found = [waiting]
        length = len(waiting)
        while length < wanted:
            found.append(next(source))
            length += len(found[-1])
        values = np.concatenate(found)
        waiting = values[wanted:]
        return values[:wanted]

    def total(length: int) -> float:
        if length <= LEAF:
            return float(np.sum(taken(length)))
        half = length // 2
        half -= half % 8
        return total(half) + total(length - half)

    return total(count)
