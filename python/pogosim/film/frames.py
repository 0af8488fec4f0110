"""The frames of a film: the simulator's picture of a run, with writing around it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from pogosim.errors import PictureError
from pogosim.film.moments import Moments
from pogosim.film.painter import Picture
from pogosim.fonts import any_characters, literal
from pogosim.picture import layers
from pogosim.picture.figure import draw_key, notes, title, width_of_key
from pogosim.picture.palette import INK, PAPER
from pogosim.picture.swarm import Recording
from pogosim.times import slack_s

DPI = 100.0
ABOVE_PX, BELOW_PX, MARGIN_PX = 36, 26, 15  # heading, notes
FILLED = 0.95  # share of a picture that the arena has along its longer side
ARENA_PX = 720.0
MAX_SIDE = 8192  # pixels
MIN_SIDE = 160
LEAST_PICTURE = 16


def size_for(recording: Recording, arena_px: float = ARENA_PX) -> tuple[int, int]:
    """Width and height of frames in pixels, such that the arena's longer side has `arena_px`."""
    extent = layers.extent_of(recording.last)
    picture = np.round(arena_px / FILLED * extent / extent.max()).astype(int)
    key_px, below_px = beside(recording)
    return max(int(picture[0]) + key_px, MIN_SIDE), max(int(picture[1]) + ABOVE_PX + below_px, MIN_SIDE)


def beside(recording: Recording) -> tuple[int, int]:
    """Pixels at the right side of the picture, for what colours mean, and below it, for notes."""
    key_px = round(width_of_key(recording.last.colouring) * DPI)
    return key_px, BELOW_PX if notes(recording.last) else 0


def heading_of(recording: Recording) -> str:
    """Objects by category."""
    return title(recording.last, 1000.0).rsplit(" after ", 1)[0]


def new_figure(size: tuple[int, int]) -> Figure:
    """Return an empty figure of so many pixels."""
    return Figure(figsize=(size[0] / DPI, size[1] / DPI), dpi=DPI, facecolor=PAPER)


def pixels_of(figure: Figure) -> Picture:
    """Draw a figure of matplotlib. Shape (height, width, 3)."""
    canvas: Any = FigureCanvasAgg(figure)
    with any_characters():
        canvas.draw()
    return np.ascontiguousarray(np.asarray(canvas.buffer_rgba())[..., :3])


class Frames:
    """Draws frames of one run."""

    def __init__(
        self,
        recording: Recording,
        size: tuple[int, int],
        options: Mapping[str, Any],
        tail_s: float | None = None,
        heading: str | None = None,
    ) -> None:
        """Prepare.

        Args:
            recording: The run.
            size: Width and height of a frame, pixels.
            options: As of Moments.
            tail_s: As of Moments.
            heading: What stands above the picture. None: how many objects there are.

        Raises:
            PictureError: There is no room for the picture, or it cannot be drawn.
        """
        key_px, below_px = beside(recording)
        self.size = size
        self.picture_size = (size[0] - key_px, size[1] - ABOVE_PX - below_px)
        if min(self.picture_size) < LEAST_PICTURE:
            raise PictureError(f"frames of {size[0]} x {size[1]} pixels have no room beside the writing (--size)")
        self.recording = recording
        self.heading = heading_of(recording) if heading is None else heading
        self.moments = Moments(recording, options, tail_s)
        self.end_s = float(recording.times_s[-1])
        self.still = cache(self.draw_still)

    def draw(self, time_s: float, frame: Picture) -> None:
        """Draw a time, s.

        Args:
            time_s: The time; after the end of the run, the heading says that it is over.
            frame: Red, green and blue, shape (height, width, 3), to be filled; may be a part of a larger one.
        """
        frame[:] = self.still(time_s > self.end_s + slack_s(time_s))
        width, height = self.picture_size
        moment = self.moments.at(min(time_s, self.end_s), time_s)
        self.moments.painter.draw(moment, frame[ABOVE_PX : ABOVE_PX + height, :width])

    def draw_still(self, is_over: bool) -> Picture:
        """Draw all but the picture. Shape (height, width, 3)."""
        figure = new_figure(self.size)
        width, height = self.size
        picture_width = self.picture_size[0]
        y = 1.0 - 0.5 * ABOVE_PX / height
        style: dict[str, Any] = {"color": INK, "va": "center"}
        room = max(int(0.1 * picture_width) - (12 if is_over else 2), 1)  # characters
        heading = self.heading if len(self.heading) <= room else self.heading[: room - 1] + "\u2026"
        figure.text(MARGIN_PX / width, y, literal(heading), fontsize=11, **style)
        if is_over:
            figure.text((picture_width - MARGIN_PX) / width, y, "over", fontsize=11, ha="right", **style)
        if below := notes(self.recording.last):
            x = (picture_width - MARGIN_PX) / width
            figure.text(x, 0.5 * BELOW_PX / height, literal(below), fontsize=9, ha="right", **style)
        if self.recording.last.colouring:
            left = picture_width / width
            draw_key(figure, self.recording.last.colouring, left, (width - picture_width) / DPI)
        return pixels_of(figure)
