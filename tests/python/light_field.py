"""Light as the documentation says it is, computed from a configuration alone: what tests compare robots with."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import yaml
from running import ROOT

Array = npt.NDArray[np.float64]


def configuration(name: str) -> dict[str, Any]:
    """Read conf/<name>.yaml. PyYAML takes 1.0e6 for a text."""
    content: dict[str, Any] = yaml.safe_load((ROOT / "conf" / f"{name}.yaml").read_text())
    return content


def outline_mm(config: dict[str, Any]) -> Array:
    """Outer wall of an arena without holes, scaled to its surface, the top left of its bounding box at the origin."""
    lines = Path(ROOT / config["arena_file"]).read_text().split()
    corners = np.array([line.split(",") for line in lines], dtype=float)
    x, y = corners.T
    area = abs(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1))) / 2
    return np.asarray((corners - corners.min(axis=0)) * np.sqrt(float(config["arena_surface"]) / area))


def covers(lamp: dict[str, Any], dx: Array, dy: Array) -> npt.NDArray[np.bool_]:
    """Whether a lamp lights points at these offsets from its centre."""
    if lamp["geometry"] == "global":
        return np.full(dx.shape, True)
    if lamp["geometry"] == "disk":
        return np.asarray(np.hypot(dx, dy) <= lamp["radius"])
    assert lamp["geometry"] == "rectangle"
    return np.asarray((np.abs(dx) <= lamp["body_width"] / 2) & (np.abs(dy) <= lamp["body_height"] / 2))


def level_of(lamp: dict[str, Any], dx: Array, dy: Array) -> Array:
    """Level inside the lamp's shape, after any photo start."""
    if lamp["light_mode"] == "static":
        share = np.zeros_like(dx)
    elif lamp["light_mode"] == "gradient":
        share = np.hypot(dx, dy) / lamp["gradient_radius"]
    else:
        assert lamp["light_mode"] == "plane"
        along = dx * np.cos(lamp["plane_angle"]) + dy * np.sin(lamp["plane_angle"])
        share = 0.5 + 0.5 * along / lamp["plane_half_span"]
    value, edge = float(lamp["value"]), float(lamp.get("edge_value", 0))
    return value + (edge - value) * np.clip(share, 0, 1)


def light_at(config: dict[str, Any], x: npt.ArrayLike, y: npt.ArrayLike, cells: int = 100) -> Array:
    """Level of the light map's cell under each point (mm), sensor counts."""
    width, height = outline_mm(config).max(axis=0)
    # Levels are those of the middle of a cell.
    column = np.clip(np.floor(np.asarray(x, dtype=float) / width * cells), 0, cells - 1)
    row = np.clip(np.floor(np.asarray(y, dtype=float) / height * cells), 0, cells - 1)
    total = np.zeros(column.shape)
    for lamp in config["objects"].values():
        if lamp["type"] == "static_light":
            dx = (column + 0.5) * width / cells - lamp.get("x", 0.0)
            dy = (row + 0.5) * height / cells - lamp.get("y", 0.0)
            total += np.where(covers(lamp, dx, dy), level_of(lamp, dx, dy), 0.0)
    return np.minimum(total, 32767)


def light_on_sensors(config: dict[str, Any], x: Array, y: Array, angle: Array, radius_mm: float) -> Array:
    """Mean level on the three photosensors of robots: on the rim at 180, 320 and 40 degrees from the heading."""
    bearings = [angle + np.deg2rad(degrees) for degrees in (180, 320, 40)]
    levels = [light_at(config, x + radius_mm * np.cos(b), y + radius_mm * np.sin(b)) for b in bearings]
    return np.asarray(np.mean(levels, axis=0))
