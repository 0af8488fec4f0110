"""What the configuration says of the tracked robots, and where they start in its arena."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import shapely
import shapely.ops

from pogosim.arguments import number
from pogosim.batch.configuration import Configuration
from pogosim.calibration.reading import Warn
from pogosim.calibration.tracks import Floats, Tracks
from pogosim.errors import CalibrationError
from pogosim.geometry.arena_file import Outline
from pogosim.geometry.configured import arena_of
from pogosim.scene import POGOBOT_RADIUS_MM, read_periodic, type_of

CLOSE_MM = 10.0  # a start so far beyond where a robot can be is an error of the tracker
LEAST_CORRELATION, CLEARLY = 0.5, 1.25  # of turn rates over time
MARGIN_MM = 1.0  # between a robot and a wall at the start


@dataclass(frozen=True)
class Scene:
    """The configuration of the tracked robots.

    Attributes:
        configuration: The user's.
        entries: What a single run takes of it.
        category: Name of the robots' entry in `objects`.
        arena: Its walls, in mm.
    """

    configuration: Configuration
    entries: dict[str, Any]
    category: str
    arena: Outline

    @property
    def settings(self) -> dict[str, Any]:
        """Entry of the category."""
        own: dict[str, Any] = self.entries["objects"][self.category]
        return own

    @property
    def radius_mm(self) -> float:
        """Radius of a robot."""
        return number(self.settings.get("radius"), POGOBOT_RADIUS_MM)

    @property
    def size_mm(self) -> Floats:
        """Width and height of the arena. Shape (2,)."""
        low, high = self.arena.bounds
        return np.asarray(high - low)


def read_scene(path: Path, category: str | None) -> Scene:
    """Read a configuration.

    Raises:
        ToolError: It is none, or it has no such robots or no arena with walls.
    """
    configuration = Configuration(path)
    entries = configuration.resolved()
    objects = entries.get("objects")
    found = objects if isinstance(objects, dict) else {}
    robots = [str(name) for name, own in found.items() if isinstance(own, dict) and type_of(own) == "pogobot"]
    if category is None and len(robots) != 1:
        what = f"robots of {len(robots)} categories ({', '.join(robots)})" if robots else "no robots of type pogobot"
        raise CalibrationError(f"{path} has {what} in `objects`; name those that were tracked with --category NAME")
    if category is not None and category not in robots:
        raise CalibrationError(
            f"{path} has no robots '{category}' of type pogobot in `objects`; found {', '.join(robots) or 'none'}"
        )
    arena = walls_of(entries, path)
    if arena.periodic or read_periodic(entries):
        raise CalibrationError(f"{path} has a periodic arena; real robots are tracked in one with walls")
    return Scene(configuration, entries, category or robots[0], arena)


def walls_of(entries: dict[str, Any], path: Path) -> Outline:
    """Return the walls in mm, found as the simulator finds them.

    Raises:
        ToolError: They cannot be read.
    """
    if not isinstance(entries.get("arena_file"), str):
        raise CalibrationError(f"{path} has no arena_file; expected the arena in which the robots were tracked")
    _, outline = arena_of(entries, path)
    low, _ = outline.bounds
    return replace(outline, polygons=tuple(polygon - low for polygon in outline.polygons))


def in_arena(tracks: Tracks, scene: Scene, warn: Warn) -> Tracks:
    """Move tracks with another origin into the arena: the middle of what they cover to the middle of the arena."""
    low, high = np.nanmin(tracks.position_mm, axis=(0, 1)), np.nanmax(tracks.position_mm, axis=(0, 1))
    if (low >= -CLOSE_MM).all() and (high <= scene.size_mm + CLOSE_MM).all():
        return tracks
    shift = scene.size_mm / 2.0 - (low + high) / 2.0
    warn(
        "the tracks leave the arena, whose top left corner is (0, 0): they are moved by "
        f"({shift[0]:.0f}, {shift[1]:.0f}) mm, to its middle"
    )
    return replace(tracks, position_mm=tracks.position_mm + shift)


def start_poses(tracks: Tracks, scene: Scene, warn: Warn) -> Floats:
    """Return where robots are seen first, moved off walls. Shape (robots, 3): x, y in mm, angle in rad."""
    outer, *holes = scene.arena.polygons
    free = shapely.Polygon(outer, holes).buffer(-(scene.radius_mm + MARGIN_MM))
    if free.is_empty:
        raise CalibrationError(
            f"{scene.configuration.path}: the arena has no room for a robot of radius {scene.radius_mm:g} mm"
        )
    poses, moved = [], []
    for robot in range(tracks.robots):
        seen = np.isfinite(tracks.position_mm[:, robot, 0])
        x, y = tracks.position_mm[seen, robot][0]
        angles = tracks.angle_rad[np.isfinite(tracks.angle_rad[:, robot]), robot]
        nearest = shapely.ops.nearest_points(free, shapely.Point(x, y))[0]
        moved.append(float(np.hypot(nearest.x - x, nearest.y - y)))
        poses.append((nearest.x, nearest.y, float(angles[0]) if len(angles) else 0.0))
    if max(moved) > CLOSE_MM:
        warn(
            f"{sum(value > CLOSE_MM for value in moved)} robots start in a wall or outside of the arena; the simulated "
            f"ones start up to {max(moved):.0f} mm from there"
        )
    return np.array(poses)


def handedness(measured: Floats, simulated: Floats, frame_s: float) -> str:
    """Tell whether robots turn to the same side as in the simulation, whenever their program was started.

    Args:
        measured: Turn rate at each frame, averaged over robots.
        simulated: The same of the simulated robots.
        frame_s: Time between frames.

    Returns:
        "same", "mirrored", or "unknown" where turns do not follow a timetable.
    """
    every = max(1, round(0.2 / frame_s))
    a, b = (np.nan_to_num(values[::every]) for values in (measured, simulated))
    a, b = a - a.mean(), b - b.mean()
    scale = float(np.sqrt(np.sum(a**2) * np.sum(b**2)))
    if scale == 0.0:
        return "unknown"
    correlation = np.correlate(a, b, mode="full") / scale
    like, opposite = float(correlation.max()), float(-correlation.min())
    if max(like, opposite) < LEAST_CORRELATION or max(like, opposite) < CLEARLY * min(like, opposite):
        return "unknown"
    return "same" if like > opposite else "mirrored"
