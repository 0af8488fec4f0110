"""tanh and sigmoid of whole numbers, by a table of tanh from 0 to 8 and straight lines between its entries.

Arguments of tanh have ARGUMENT_BITS fraction bits, those of sigmoid, which is 1/2 + tanh(x / 2) / 2, one less; results
have VALUE_BITS.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Integers = npt.NDArray[np.int64]

VALUE_BITS = 14  # of a fraction: 1 is 16384
ONE = 1 << VALUE_BITS
ARGUMENT_BITS = 12
INDEX_BITS = 7  # an argument's bits below the index of an entry
ENTRIES = 257
LARGEST = ((ENTRIES - 1) << INDEX_BITS) >> ARGUMENT_BITS  # that the table goes to
TABLE: Integers = np.rint(ONE * np.tanh(np.ldexp(np.arange(ENTRIES) * 1.0, INDEX_BITS - ARGUMENT_BITS))).astype(
    np.int64
)


def tanh_of(argument: Integers) -> Integers:
    """Return tanh of arguments from -32767 to 32767."""
    size = np.abs(argument)
    index, rest = size >> INDEX_BITS, size & ((1 << INDEX_BITS) - 1)
    below = TABLE[index]
    found: Integers = below + (((TABLE[index + 1] - below) * rest + (1 << (INDEX_BITS - 1))) >> INDEX_BITS)
    return np.where(argument < 0, -found, found)


def sigmoid_of(argument: Integers) -> Integers:
    """Return the sigmoid of arguments from -32767 to 32767."""
    return (ONE + 1 + tanh_of(argument)) >> 1
