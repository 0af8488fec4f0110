"""Swarms with known answers, as rows of a data file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import pyarrow as pa
import yaml
from pogosim.analysis.trajectories import Trajectories
from pyarrow import feather

Floats = npt.NDArray[np.float64]


def square(side_mm: float) -> list[dict[str, float]]:
    """Corners of a square arena, as in a data file."""
    return [{"x": x * side_mm, "y": y * side_mm} for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]


def metadata_of(side_mm: float = 1000.0, periodic: bool = False, **robots: Any) -> dict[str, Any]:
    """Metadata of a run in a square arena."""
    return {
        "configuration": {
            "arena_file": "arenas/square.csv",
            "boundary_condition": "periodic" if periodic else "solid",
            "objects": {"robots": {"type": "pogobot", "radius": 26.5, "communication_radius": 80.0, **robots}},
        },
        "arena_polygons": [[[p["x"], p["y"]] for p in square(side_mm)]],
    }


def rows_of(
    position_mm: Floats, heading_rad: Floats | None = None, period_s: float = 1.0, **columns: Any
) -> pd.DataFrame:
    """Rows of robots at positions of shape (times, robots, 2)."""
    times, robots = position_mm.shape[:2]
    heading = np.zeros((times, robots)) if heading_rad is None else heading_rad
    frame = {
        "time": np.repeat(period_s * np.arange(times), robots),
        "robot_category": ["robots"] * (times * robots),
        "robot_id": np.tile(np.arange(robots), times),
        "x": position_mm[..., 0].ravel(),
        "y": position_mm[..., 1].ravel(),
        "angle": heading.ravel(),
    }
    return pd.DataFrame({**frame, **columns})


def write_rows(path: Path, rows: pd.DataFrame, metadata: dict[str, Any]) -> Path:
    """Write a data file as the simulator does."""
    polygons = [[{"x": x, "y": y} for x, y in polygon] for polygon in metadata.get("arena_polygons", [])]
    texts: dict[str | bytes, str | bytes] = {"arena_polygons": yaml.safe_dump(polygons)}
    texts |= {name: yaml.safe_dump(metadata[name]) for name in ("configuration", "combinations") if name in metadata}
    table = pa.Table.from_pandas(rows, preserve_index=False)
    table = table.replace_schema_metadata(texts)
    feather.write_feather(table, path)
    return path


def brownian_walk(times: int, robots: int, step_mm: float, seed: int = 1) -> Floats:
    """Positions of shape (times, robots, 2): each step is normal with this standard deviation in x and in y."""
    steps = np.random.default_rng(seed).normal(0.0, step_mm, (times - 1, robots, 2))
    return np.concatenate([np.zeros((1, robots, 2)), np.cumsum(steps, axis=0)])


def freud_system(run: Trajectories) -> tuple[Any, npt.NDArray[np.float32]]:
    """The first positions of a run in a periodic arena as freud takes them: its box, and points of shape (n, 3)."""
    import freud

    low, high = run.arena.bounds_mm
    box = freud.box.Box(Lx=high[0] - low[0], Ly=high[1] - low[1], is2D=True)
    points = np.zeros((run.position_mm.shape[1], 3), dtype=np.float32)
    points[:, :2] = run.position_mm[0] - (low + high) / 2.0
    return box, box.wrap(points)
