"""What the configuration says of the tracked robots, and where they start in its arena."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import shapely
import shapely.ops

from pogosim.batch.rows import Runs
from pogosim.calibration.reading import Warn
from pogosim.calibration.simulation import rows_of, trial
from pogosim.calibration.tracks import Floats, Tracks
from pogosim.errors import CalibrationError
from pogosim.geometry.arena_file import Outline
from pogosim.object_facts import type_of
from pogosim.scene import read_periodic
from pogosim.several_files import configuration_of

CLOSE_MM = 10.0  # a start so far beyond where a robot can be is an error of the tracker
LEAST_CORRELATION, CLEARLY = 0.5, 1.25  # of turn rates over time
MARGIN_MM = 1.0  # between a robot and a wall at the start


@dataclass(frozen=True)
class Scene:
    """Where the tracked robots are simulated, and what they are, as the simulator says with all its defaults.

    Attributes:
        entries: The configuration, as a single run takes it.
        category: Name of the robots' entry in `objects`.
        settings: That entry, with the keys of its robot model and all defaults.
        time_step_s: Time step of the simulator.
        arena: Its walls, in mm.
    """

    entries: dict[str, Any]
    category: str
    settings: dict[str, Any]
    time_step_s: float
    arena: Outline

    @property
    def radius_mm(self) -> float:
        """Radius of a robot."""
        return float(self.settings["radius"])

    @property
    def size_mm(self) -> Floats:
        """Width and height of the arena. Shape (2,)."""
        low, high = self.arena.bounds
        return np.asarray(high - low)


def tracked_category(entries: dict[str, Any], path: Path, wanted: str | None) -> str:
    """Return the name of the robots' entry in `objects` of a configuration.

    Raises:
        CalibrationError: It has no such robots.
    """
    objects = entries.get("objects")
    found = objects if isinstance(objects, dict) else {}
    robots = [str(name) for name, own in found.items() if isinstance(own, dict) and type_of(own) == "pogobot"]
    if wanted is None and len(robots) != 1:
        what = f"robots of {len(robots)} categories ({', '.join(robots)})" if robots else "no robots of type pogobot"
        raise CalibrationError(f"{path} has {what} in `objects`; name those that were tracked with --category NAME")
    if wanted is not None and wanted not in robots:
        raise CalibrationError(
            f"{path} has no robots '{wanted}' of type pogobot in `objects`; found {', '.join(robots) or 'none'}"
        )
    return wanted or robots[0]


def read_scene(runs: Runs, entries: dict[str, Any], category: str) -> Scene:
    """Let the simulator say what a configuration is, in a run that ends as it begins.

    Raises:
        ToolError: It cannot be run, or has no arena with walls.
    """
    start = {**trial(entries, category, {"nb": 1}), "simulation_time": 0}
    (rows,) = rows_of(runs, [start], [0])
    resolved = configuration_of({str(name): value for name, value in rows.attrs.items()})
    path = runs.configuration.path
    if read_periodic(resolved):
        raise CalibrationError(f"{path} has a periodic arena; real robots are tracked in one with walls")
    polygons = tuple(np.asarray(polygon, dtype=float) for polygon in rows.attrs["arena_polygons"])
    arena = Outline(polygons, str(resolved["arena_file"]))
    return Scene(entries, category, resolved["objects"][category], float(resolved["time_step"]), arena)


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
            f"{scene.arena.source}: the arena has no room for a robot of radius {scene.radius_mm:g} mm"
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
