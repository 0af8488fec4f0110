"""Where the robot of docs/tuning/dash.yaml has got to, and how soon."""

from __future__ import annotations

import numpy as np
import pandas as pd


def fd_fn(df: pd.DataFrame) -> dict[str, float]:
    """Return how far the robot has got in mm, and its heading in rad; it starts with the heading 0."""
    first, last = df.iloc[0], df.iloc[-1]
    displacement_mm = np.hypot(last["x"] - first["x"], last["y"] - first["y"])
    return {"displacement (mm)": float(displacement_mm), "heading (rad)": float(last["angle"])}


def objective_fn(df: pd.DataFrame) -> float:
    """Return minus the time that the robot has driven, in s."""
    return -float(df["driven_s"].iloc[-1])
