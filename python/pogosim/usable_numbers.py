"""Values of columns so large that sums and colours would overflow count as missing."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

# The largest 32-bit number, as the window has them. Its square still fits into 64 bits.
LARGEST = float(np.finfo(np.float32).max)


def usable(values: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
    """Return numbers with NaN in place of those that are infinite or beyond 3.4e38; same shape."""
    numbers = np.asarray(values, dtype=float)
    return np.where(np.abs(numbers) <= LARGEST, numbers, np.nan)
