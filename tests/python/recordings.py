"""Data files made up for tests of pictures, films and replays: every value in them is known."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import yaml
from pyarrow import feather

SIDE_MM = 1000.0
PERIOD_S = 0.5


def walkers(count: int = 3, records: int = 5) -> pd.DataFrame:
    """Robots side by side that go down at 100 mm/s; the LED of number i is red, green or blue, or off."""
    number = np.tile(np.arange(count), records)
    time = np.repeat(np.arange(records) * PERIOD_S, count)
    return pd.DataFrame(
        {
            "time": time.astype(np.float32),
            "robot_category": "robots",
            "robot_id": number.astype(np.int32),
            "x": (SIDE_MM * (number + 0.5) / count).astype(np.float32),
            "y": (100.0 + 100.0 * time).astype(np.float32),
            "angle": np.full(len(time), np.pi / 2, np.float32),
            "led_rgb": np.array([0x190000, 0x001900, 0x000019, 0])[number % 4].astype(np.int32),
            "heard": (10 * number + np.round(time / PERIOD_S)).astype(np.int32),
            "state": np.where(number % 2 == 0, "walks", "waits"),
            "fed": number % 3 == 0,
        }
    )


def write(path: Path, rows: pd.DataFrame, objects: dict[str, Any] | None = None, **settings: Any) -> Path:
    """Write a data file of a square arena."""
    robots = {"type": "pogobot", "geometry": "disk", "radius": 26.5, "communication_radius": 80}
    corners = [(0, 0), (SIDE_MM, 0), (SIDE_MM, SIDE_MM), (0, SIDE_MM)]
    metadata = {
        "arena_polygons": yaml.safe_dump([[{"x": x, "y": y} for x, y in corners]]),
        "configuration": yaml.safe_dump({"objects": {"robots": robots, **(objects or {})}, **settings}),
    }
    table = pa.Table.from_pandas(rows, preserve_index=False).replace_schema_metadata(metadata)
    feather.write_feather(table, path)
    return path
