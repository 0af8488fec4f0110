"""Times of data files: 64 bits; 32 in files of versions up to 0.10."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def as_float64(times_s: npt.NDArray[np.float32]) -> npt.NDArray[np.float64]:
    """Convert times of 32 bits to the decimals that were meant: 0.1, not 0.10000000149011612. Any shape."""
    known, place = np.unique(times_s, return_inverse=True)
    return np.array([float(str(time)) for time in known], dtype=np.float64)[place].reshape(times_s.shape)


def slack_s(time_s: float) -> float:
    """Return by how much a time may differ from one of the file, s, and still mean it: both are rounded."""
    return 1e-9 * max(1.0, abs(time_s))
