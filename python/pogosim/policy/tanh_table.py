"""tanh and sigmoid of whole numbers, by a table of tanh from 0 to 8 and straight lines between its entries.

Arguments have 12 fraction bits (tanh) or 11 (sigmoid, which is 1/2 + tanh(x / 2) / 2); results have 14.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Integers = npt.NDArray[np.int64]

VALUE_BITS = 14
INDEX_BITS = 7  # an argument's bits below the index of an entry
ENTRIES = 257
TABLE: Integers = np.rint((1 << VALUE_BITS) * np.tanh(np.arange(ENTRIES) * 2.0**INDEX_BITS / 4096)).astype(np.int64)


def tanh_of(argument: Integers) -> Integers:
    """Return tanh of arguments from -32767 to 32767."""
    size = np.abs(argument)
    index, rest = size >> INDEX_BITS, size & ((1 << INDEX_BITS) - 1)
    below = TABLE[index]
    found = below + (((TABLE[index + 1] - below) * rest + (1 << (INDEX_BITS - 1))) >> INDEX_BITS)
    return np.asarray(np.where(argument < 0, -found, found))


def sigmoid_of(argument: Integers) -> Integers:
    """Return the sigmoid of arguments from -32767 to 32767."""
    return ((1 << VALUE_BITS) + 1 + tanh_of(argument)) >> 1
