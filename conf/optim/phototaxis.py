"""How bright it is where the robots of conf/optim/phototaxis.yaml are: what pogoptim maximises."""

from __future__ import annotations

import numpy as np
import pandas as pd

LAMP_MM = (450.0, 357.0)
RADIUS_MM = 400.0


def objective_fn(df: pd.DataFrame) -> float:
    """Return the mean brightness at the robots in the second half of the runs, 0 to 1 (all at the lamp's centre)."""
    late = df[(df["robot_category"] == "robots") & (df["time"] > df["time"].max() / 2)]
    distance_mm = np.hypot(late["x"] - LAMP_MM[0], late["y"] - LAMP_MM[1])
    return float(np.clip(1.0 - distance_mm / RADIUS_MM, 0.0, 1.0).mean())
