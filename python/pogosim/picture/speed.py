"""Speeds of objects, as one more column of a data file: to see in pictures and replays who is slow or stuck."""

from __future__ import annotations

import numpy as np
import pandas as pd

from pogosim.scene import Floats

SPEED = "speed"  # mm/s


def with_speed(rows: pd.DataFrame, size_mm: Floats | None) -> pd.DataFrame:
    """Add a column `speed`: the distance from an object's place in the record before, by the time since then, mm/s.

    Args:
        rows: With columns object, time, x and y; a column `speed` of the file's own stays as it is.
        size_mm: Width and height of a periodic arena, across whose borders the shorter way counts. None: walls.

    Returns:
        The rows; NaN in the first record of each object.
    """
    if SPEED in rows:
        return rows
    ordered = rows.sort_values(["object", "time"], kind="stable")
    steps = np.diff(ordered[["x", "y"]].to_numpy(dtype=float), axis=0, prepend=np.nan)
    if size_mm is not None:
        steps -= size_mm * np.round(steps / size_mm)
    duration = np.diff(ordered["time"].to_numpy(dtype=float), prepend=np.nan)
    is_first = np.diff(ordered["object"].to_numpy(), prepend=-1) != 0
    with np.errstate(invalid="ignore", divide="ignore"):
        speed = np.where(is_first | ~(duration > 0.0), np.nan, np.hypot(*steps.T) / duration)
    return rows.assign(**{SPEED: pd.Series(speed, index=ordered.index)})
