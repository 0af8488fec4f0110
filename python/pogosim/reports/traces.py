"""Figures and films of traces: the last steps of each robot's path, the older the fainter."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from PIL import Image

from pogosim.analysis.arena import Floats
from pogosim.analysis.motion import steps
from pogosim.analysis.trajectories import Run, Trajectories
from pogosim.fonts import literal
from pogosim.reports.figures import new_figure, save
from pogosim.reports.groups import group_of
from pogosim.reports.heat_maps import arenas_of, draw_arena, folder_name

FRAME_DPI = 80
FRAMES_PER_S = 12
COLOURS = colormaps["turbo"]


def traced_runs(runs: Sequence[Run], names: Sequence[str]) -> dict[str, Run]:
    """Return the first run of each combination, by what its files are called: arena, combination and run."""
    first: dict[str, Run] = {}
    for arena, own in arenas_of(runs).items():
        seen = set()
        for run in own:
            group = group_of(run, [name for name in names if name != "arena_file"]) if names else ""
            if group in seen:
                continue
            seen.add(group)
            parts = [arena, group if group != run.arena.name else "", f"run {run.labels.get('run', 0)}"]
            name = folder_name(" ".join(filter(None, parts)))
            first[name if name not in first else f"{name}_{len(first)}"] = run
    return first


def segments_until(
    run: Trajectories, displacement: Floats, index: int, length: int
) -> tuple[Floats, Floats, np.ndarray]:
    """Return the last steps up to a time as segments.

    Args:
        run: One run.
        displacement: Displacement of its `steps`, shape (T, N, 2).
        index: The last time.
        length: Number of save times to go back.

    Returns:
        Segments, shape (n, 2, 2), mm; their age, 0 (last) to 1, shape (n,); the index of their robots, shape (n,). A
        step across a periodic border is there twice, so that each side shows its part.
    """
    rows = slice(max(index - length + 1, 0), index + 1)
    step, end = displacement[rows], run.position_mm[rows]
    time, robot = np.nonzero(np.isfinite(step).all(axis=2))
    step, end = step[time, robot], end[time, robot]
    pieces = np.stack([end - step, end], axis=1)
    age = (index - rows.start - time) / length
    if run.arena.is_periodic:
        low, high = run.arena.bounds_mm
        left = ((pieces[:, 0] < low) | (pieces[:, 0] > high)).any(axis=1)
        size = run.arena.size_mm
        inside = low + np.mod(pieces[left, 0] - low, size)
        pieces = np.concatenate([pieces, np.stack([inside, inside + step[left]], axis=1)])
        age, robot = np.concatenate([age, age[left]]), np.concatenate([robot, robot[left]])
    return pieces, age, robot


def robot_colours(count: int) -> Floats:
    """Return colours, neighbours in the list far apart. Shape (count, 4)."""
    order = np.mod(0.05 + 0.6180339887 * np.arange(count), 1.0)  # golden ratio
    return np.asarray(COLOURS(0.05 + 0.9 * order))


class TraceFigure:
    """A figure of the traces of a run that can be set to another time."""

    def __init__(self, run: Trajectories, length: int) -> None:
        self.run, self.length = run, length
        self.displacement = steps(run)[0]
        self.colours = robot_colours(len(run.robot_id))
        self.figure, panels = new_figure(width=5.0, height=5.0)
        self.axes: Axes = panels[0, 0]
        self.floor = draw_arena(self.axes, run.arena)
        self.lines = LineCollection([], linewidths=1.2, capstyle="round", zorder=1)
        self.bodies = PolyCollection([], edgecolors="none", zorder=2)
        self.axes.add_collection(self.lines)
        self.axes.add_collection(self.bodies)
        if self.floor is None:
            low, high = np.nanmin(run.position_mm, axis=(0, 1)), np.nanmax(run.position_mm, axis=(0, 1))
            self.axes.set(xlim=(low[0] - 50.0, high[0] + 50.0), ylim=(high[1] + 50.0, low[1] - 50.0))
        else:
            self.lines.set_clip_path(self.floor)

    def show(self, index: int) -> None:
        """Show the traces up to a time."""
        pieces, age, robot = segments_until(self.run, self.displacement, index, self.length)
        oldest_first = np.argsort(-age, kind="stable")
        colours = self.colours[robot]
        colours[:, 3] = 1.0 - 0.95 * age
        self.lines.set_segments(list(pieces[oldest_first]))
        self.lines.set_color(list(map(tuple, colours[oldest_first])))
        there = self.run.is_there[index]
        angle = np.linspace(0.0, 2.0 * np.pi, 17)[:-1]
        circle = self.run.sizes.radius_mm[there, None, None] * np.column_stack([np.cos(angle), np.sin(angle)])
        self.bodies.set_verts(list(self.run.position_mm[index][there][:, None, :] + circle))
        self.bodies.set_facecolor(list(map(tuple, self.colours[there])))
        self.axes.set_title(f"{literal(self.run.arena.name)}, {self.run.time_s[index]:.1f} s")


def last_full_time(run: Trajectories) -> int:
    """Return the index of the last time at which any robot has a position."""
    return int(np.flatnonzero(run.is_there.any(axis=1))[-1])


def draw_traces(runs: Sequence[Run], names: Sequence[str], folder: Path, length: int) -> None:
    """Draw the last steps of the first run of each combination."""
    for name, run in traced_runs(runs, names).items():
        traces = TraceFigure(run.whole(), length)
        traces.show(last_full_time(traces.run))
        save(traces.figure, folder / "traces" / name)


def film_traces(runs: Sequence[Run], names: Sequence[str], folder: Path, length: int, frames: int) -> None:
    """Make an animated GIF of the traces of the first run of each combination, of at most so many frames."""
    for name, run in traced_runs(runs, names).items():
        traces = TraceFigure(run.whole(), length)
        shown = np.unique(np.linspace(0, len(run.time_s) - 1, frames).round().astype(int))
        images = []
        for index in shown:
            traces.show(int(index))
            picture = io.BytesIO()
            traces.figure.savefig(picture, format="png", dpi=FRAME_DPI)
            images.append(Image.open(picture).convert("RGB"))
        path = folder / "traces" / f"{name}.gif"
        path.parent.mkdir(parents=True, exist_ok=True)
        # One palette for all frames; bytes first, so that a file is complete or not there.
        palette = images[-1].quantize(colors=256)
        coloured = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
        buffer = io.BytesIO()
        coloured[0].save(
            buffer, "GIF", save_all=True, append_images=coloured[1:], duration=1000 // FRAMES_PER_S, loop=0
        )
        path.write_bytes(buffer.getvalue())
