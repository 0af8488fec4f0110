"""Speeds of objects, as one more column of a data file, so that pictures and replays show which are slow or stuck."""

from __future__ import annotations

import numpy as np

from pogosim.deferred import pandas as pd
from pogosim.periodic import steps_of
from pogosim.shapes import Floats

SPEED = "speed"  # mm/s
OBJECT = "\0object"  # tells objects apart, see swarm.py


def object_steps(
    rows: pd.DataFrame, period_mm: Floats | None, top_speed_mm_s: float | None
) -> tuple[pd.DataFrame, Floats, Floats]:
    """Return the steps of all objects since their record before; see `steps_of` for the warning.

    Args:
        rows: With columns OBJECT, time, x and y.
        period_mm: Width and height of a periodic arena, across whose borders the shorter way counts. None: walls.
        top_speed_mm_s: Top speed mm of the objects. None: unknown.

    Returns:
        The rows by object and time, n of them; their steps, shape (n, 2), mm, and the time since the record before,
        shape (n,), s; NaN in the first record of each object.
    """
    ordered = rows.sort_values([OBJECT, "time"], kind="stable")
    offset = np.diff(ordered[["x", "y"]].to_numpy(dtype=float), axis=0, prepend=np.nan)
    duration = np.diff(ordered["time"].to_numpy(dtype=float), prepend=np.nan)
    is_first = np.diff(ordered[OBJECT].to_numpy(), prepend=-1) != 0
    offset[is_first], duration[is_first] = np.nan, np.nan
    return ordered, steps_of(offset, duration, period_mm, top_speed_mm_s), duration


def with_speed(rows: pd.DataFrame, period_mm: Floats | None, top_speed_mm_s: float | None) -> pd.DataFrame:
    """Add a column `speed`: the distance from an object's place in the record before, by the time since then, mm/s.

    Args:
        rows: With columns OBJECT, time, x and y; a column `speed` of the file's own stays as it is.
        period_mm: Width and height of a periodic arena, across whose borders the shorter way counts. None: walls.
        top_speed_mm_s: Top speed mm of the objects. None: unknown.

    Returns:
        The rows; NaN in the first record of each object.
    """
    if SPEED in rows:
        return rows
    ordered, steps, duration = object_steps(rows, period_mm, top_speed_mm_s)
    with np.errstate(invalid="ignore", divide="ignore"):
        speed = np.where(duration > 0.0, np.hypot(*steps.T) / duration, np.nan)
    return rows.assign(**{SPEED: pd.Series(speed, index=ordered.index)})
