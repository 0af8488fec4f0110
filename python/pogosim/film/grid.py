"""Frames of several runs side by side, each with its label, at one time."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.colors import to_rgb

from pogosim.errors import PictureError
from pogosim.film.frames import ARENA_PX, MAX_SIDE, MIN_SIDE, Frames, size_for
from pogosim.film.painter import Picture
from pogosim.picture.palette import PAPER
from pogosim.picture.swarm import Recording

MAX_IN_A_ROW = 3  # of runs that stand in one row
ALL_ARENAS_PX = 1440.0  # arenas beside each other together, unless each has ARENA_PX
MAX_VARIED = 2  # keys that a label tells
FILES = ("filename", "frames_name", "message_log")  # ends of keys that differ between all runs


class Grid:
    """Draws frames of one run or more."""

    def __init__(
        self,
        recordings: Sequence[Recording],
        size: tuple[int, int] | None,
        options: Mapping[str, Any],
        tail_s: float | None = None,
        labels: Sequence[str] | None = None,
        is_even: bool = False,
    ) -> None:
        """Prepare.

        Args:
            recordings: The runs, from left to right, then from top to bottom.
            size: Width and height of a frame, pixels. None: as the arenas need.
            options: As of Moments.
            tail_s: As of Moments.
            labels: What stands above each run. None: how many objects there are.
            is_even: Whether width and height have to be even numbers.

        Raises:
            PictureError: The frame would be too small or too large, or cannot be drawn.
        """
        count = len(recordings)
        self.columns = count if count <= MAX_IN_A_ROW else math.ceil(math.sqrt(count))
        self.rows = math.ceil(count / self.columns)
        self.cell = self.cell_size(recordings, size)
        width, height = size or (self.columns * self.cell[0], self.rows * self.cell[1])
        if not all(MIN_SIDE <= side <= MAX_SIDE for side in (width, height)):
            raise PictureError(f"frames of {width} x {height} pixels; {MIN_SIDE} to {MAX_SIDE} are possible (--size)")
        self.size = (width + width % 2, height + height % 2) if is_even else (width, height)
        paper = np.round(255.0 * np.array(to_rgb(PAPER))).astype(np.uint8)
        self.paper: Picture = np.broadcast_to(paper, (self.size[1], self.size[0], 3))
        self.runs = [
            Frames(
                recording,
                self.size if count == 1 else self.cell,
                # One clock, at the top right.
                options if i == self.columns - 1 else {**options, "time": False},
                tail_s,
                None if labels is None else labels[i],
            )
            for i, recording in enumerate(recordings)
        ]

    def cell_size(self, recordings: Sequence[Recording], size: tuple[int, int] | None) -> tuple[int, int]:
        """Width and height of the place of each run, pixels."""
        if size is not None:
            return size[0] // self.columns, size[1] // self.rows
        arena_px = min(ARENA_PX, ALL_ARENAS_PX / max(self.columns, self.rows))
        sizes = [size_for(recording, arena_px) for recording in recordings]
        return max(width for width, _ in sizes), max(height for _, height in sizes)

    def frame(self, time_s: float) -> Picture:
        """Return the frame of a time, s. Shape (height, width, 3)."""
        frame = self.paper.copy()
        for i, run in enumerate(self.runs):
            left, top = (i % self.columns) * self.cell[0], (i // self.columns) * self.cell[1]
            run.draw(time_s, frame[top : top + run.size[1], left : left + run.size[0]])
        return frame


def labels_of(paths: Sequence[str], recordings: Sequence[Recording]) -> list[str]:
    """Return what tells runs apart: one or two keys of their configurations, or else the names of their files."""
    settings = [flat(recording.configuration) for recording in recordings]
    names = dict.fromkeys(name for own in settings for name in own if not name.endswith(FILES))
    varied = [name for name in names if len({str(own.get(name)) for own in settings}) > 1]
    if all(settings) and 1 <= len(varied) <= MAX_VARIED:
        return [", ".join(f"{name.rsplit('.', 1)[-1]} = {own.get(name)}" for name in varied) for own in settings]
    files = [Path(path).name for path in paths]
    return files if len(set(files)) == len(files) else list(paths)


def flat(settings: Mapping[str, Any], before: str = "") -> dict[str, Any]:
    """Return the keys of nested maps, joined by dots, and their values."""
    found: dict[str, Any] = {}
    for key, value in settings.items():
        found.update(flat(value, f"{before}{key}.") if isinstance(value, dict) else {f"{before}{key}": value})
    return found
