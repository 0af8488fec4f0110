"""Data files made up for tests of pictures, films and replays: every value in them is known."""

from __future__ import annotations

import json
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


def link_table(**columns: Any) -> dict[str, Any]:
    """Metadata of two links: robots 0 and 1 by a spring from its front, robot 2 and a place by a rod."""
    return {
        "objects": [["robots", 0], ["robots", 1], ["robots", 2]],
        "categories": [{"name": "skin", "drawn": True}],
        "category": [0, 0],
        "kind": ["spring", "rod"],
        "a": [0, 2],
        "b": [1, -1],
        "end_a_mm": [[20, 0], [0, 0]],
        "end_b_mm": [[0, 0], [500, 900]],
        "rest_mm": [100, 500],
        "stiffness_n_m": [2, 0],
        "damping_n_s_m": [0, 0],
        "breaking_n": [None, None],
        **columns,
    }


def linked(
    path: Path,
    links: dict[str, Any] | None = None,
    changes: dict[str, Any] | None = None,
    rows: pd.DataFrame | None = None,
    **settings: Any,
) -> Path:
    """A data file of three robots (recordings.walkers) with links."""
    write(path, walkers() if rows is None else rows, **settings)
    found = feather.read_table(path)
    metadata = dict(found.schema.metadata)
    if links is not None:
        metadata[b"links"] = json.dumps(links).encode()
    if changes is not None:
        metadata[b"link_changes"] = json.dumps(changes).encode()
    feather.write_feather(pa.Table.from_batches(found.to_batches()).replace_schema_metadata(metadata), path)
    return path
