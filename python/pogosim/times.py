"""Times of data files: 64 bits; 32 in files of versions up to 0.10."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import pandas as pd  # takes a while


def as_float64(times_s: npt.NDArray[np.float32]) -> npt.NDArray[np.float64]:
    """Convert times of 32 bits to the decimals that were meant: 0.1, not 0.10000000149011612. Any shape."""
    known, place = np.unique(times_s, return_inverse=True)
    return np.array([float(str(time)) for time in known], dtype=np.float64)[place].reshape(times_s.shape)


def with_exact_times(rows: pd.DataFrame) -> pd.DataFrame:
    """Return rows whose times have 64 bits, see as_float64(); others, and rows without times, stay as they are."""
    if list(rows.columns).count("time") != 1 or rows["time"].dtype != np.float32:
        return rows
    return rows.assign(time=as_float64(rows["time"].to_numpy()))


def slack_s(time_s: float) -> float:
    """Return by how much a time may differ from one of the file, s, and still mean it: both are rounded."""
    return 1e-9 * max(1.0, abs(time_s))
