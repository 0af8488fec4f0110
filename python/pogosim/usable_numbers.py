"""Values of columns so large that sums and colours would overflow count as missing."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.deferred import pandas as pd

# The largest 32-bit number, as the window has them. Its square still fits into 64 bits.
LARGEST = float(np.finfo(np.float32).max)


def usable(values: pd.Series[Any]) -> npt.NDArray[np.float64]:
    """Return a column of numbers, NaN where there is none or one that is infinite or beyond 3.4e38. Shape (rows,)."""
    numbers = values.to_numpy(dtype=float, na_value=np.nan)
    return np.where(np.abs(numbers) <= LARGEST, numbers, np.nan)
