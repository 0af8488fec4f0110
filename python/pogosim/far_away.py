"""Rows with impossible positions: all tools ignore them, with one warning."""

from __future__ import annotations

import warnings

import numpy as np
import numpy.typing as npt

from pogosim.deferred import pandas as pd

# Ten times the largest coordinate that a configuration can have (kMaxLength in src/config/scenario.hpp): 10 km.
FARTHEST_MM = 1e7


def is_near(rows: pd.DataFrame) -> npt.NDArray[np.bool_]:
    """Tell which rows have a position that a run can have; NaN is one of a robot that is not there.

    Warns (RuntimeWarning) of those that do not.
    """
    far = is_far(rows)
    warn_of_far(int(np.count_nonzero(far)), len(rows))
    return ~far


def is_far(rows: pd.DataFrame) -> npt.NDArray[np.bool_]:
    """Tell which rows have a position that no run can have, without a warning."""
    distance = np.abs(rows[["x", "y"]].to_numpy(dtype=float)).max(axis=1, initial=0.0)
    return np.asarray(distance > FARTHEST_MM)


def warn_of_far(count: int, rows: int) -> None:
    """Warn (RuntimeWarning) if some of so many rows are too far away."""
    if count:
        warnings.warn(
            f"{count} of {rows} rows are left out: their positions are more than {FARTHEST_MM / 1e6:g} km away, which "
            "no run can have",
            RuntimeWarning,
            stacklevel=4,
        )
