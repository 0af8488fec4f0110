"""Rows with impossible positions: all tools ignore them, with one warning."""

from __future__ import annotations

import warnings

import numpy as np
import numpy.typing as npt
import pandas as pd

# Ten times the largest coordinate that a configuration can have (kMaxLength in src/config/scenario.hpp): 10 km.
FARTHEST_MM = 1e7


def is_near(rows: pd.DataFrame) -> npt.NDArray[np.bool_]:
    """Tell which rows have a position that a run can have; NaN is one of a robot that is not there.

    Warns (RuntimeWarning) of those that do not.
    """
    distance = np.abs(rows[["x", "y"]].to_numpy(dtype=float)).max(axis=1, initial=0.0)
    is_far = distance > FARTHEST_MM
    if is_far.any():
        warnings.warn(
            f"{np.count_nonzero(is_far)} of {len(rows)} rows are left out: their positions are more than "
            f"{FARTHEST_MM / 1e6:g} km away, which no run can have",
            RuntimeWarning,
            stacklevel=3,
        )
    return np.asarray(~is_far)
