"""The frames of a film: the picture of a run at one time after another.

Floor, light, walls and writing that stays are drawn once, and again only if they change; robots, trails, links and the
clock are drawn over a copy of those.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from pogosim.errors import PictureError
from pogosim.film.brush import Brush
from pogosim.film.moving import Moving
from pogosim.film.timeline import timeline_of
from pogosim.fonts import any_characters, literal
from pogosim.picture import layers
from pogosim.picture.figure import draw_key, draw_notes, draw_scale_bar, notes, title, width_of_key
from pogosim.picture.palette import INK, PAPER
from pogosim.picture.swarm import OBJECT, Recording, Swarm
from pogosim.scene import bounds
from pogosim.shapes import Floats

DPI = 100.0
ABOVE, BELOW = 0.36, 0.42  # inches: heading and clock, scale bar
MAX_SIDE = 8192  # pixels
MIN_SIDE = 160


@dataclass(frozen=True)
class Look:
    """What frames show."""

    tail_s: float | None = None  # None: no trails
    links: bool = False


def size_for(recording: Recording, asked: tuple[int, int] | None, is_even: bool) -> tuple[int, int]:
    """Width and height of frames in pixels: as asked, or such that the arena's longer side has 720 pixels.

    Raises:
        PictureError: They are too small or too large.
    """
    swarm = recording.last
    extent = layers.extent_of(swarm)
    arena = 720.0 * extent / extent.max()
    beside = width_of_key(swarm.colouring) * DPI
    size = asked or (max(round(arena[0] + beside), MIN_SIDE), max(round(arena[1] + (ABOVE + BELOW) * DPI), MIN_SIDE))
    if not all(MIN_SIDE <= side <= MAX_SIDE for side in size):
        raise PictureError(f"frames of {size[0]} x {size[1]} pixels; {MIN_SIDE} to {MAX_SIDE} are possible (--size)")
    return (size[0] + size[0] % 2, size[1] + size[1] % 2) if is_even else size


class Stills:
    """Draws a run at any time."""

    def __init__(self, recording: Recording, size: tuple[int, int], look: Look) -> None:
        self.recording = recording
        self.moving = Moving(recording, look.tail_s, look.links)
        dots = recording.last.dots
        self.dots = timeline_of(recording, dots, [OBJECT, "subpart_id"]) if len(dots) else None
        self.has_membranes = self.dots is not None or bool(layers.is_membrane(recording.last).any())
        self.figure = Figure(figsize=(size[0] / DPI, size[1] / DPI), dpi=DPI, facecolor=PAPER)
        self.canvas: Any = FigureCanvasAgg(self.figure)
        self.size = size
        self.key: object = None  # of what the background depends on
        self.still: Any = None  # pixels of the background
        self.brush: Any = None

    def frame(self, time_s: float) -> bytes:
        """Return the picture at a time: RGBA, row by row from the top left; width * height * 4 bytes."""
        wall_colours = self.recording.wall_colours(time_s)
        key = self.background_key(time_s, wall_colours)
        if key != self.key:
            self.draw_background(replace(self.recording.last, wall_colours=wall_colours, end_s=time_s))
            self.key = key
        self.canvas.restore_region(self.still)
        self.clock.set_text(f"{time_s:.2f} s")
        self.clock.draw(self.canvas.get_renderer())
        membranes = (lambda: self.draw_membranes(time_s)) if self.has_membranes else None
        self.moving.draw(self.brush, self.axes, time_s, membranes)
        if self.border is not None:
            self.border.draw(self.canvas.get_renderer())
        return bytes(self.canvas.buffer_rgba())

    def background_key(self, time_s: float, wall_colours: dict[int, Floats]) -> object:
        """Return what differs whenever the background does."""
        lamps = tuple((tuple(lamp.centre_at(time_s)), lamp.photo_phase(time_s)) for lamp in self.recording.last.lamps)
        return lamps, tuple((wall, tuple(colour)) for wall, colour in sorted(wall_colours.items()))

    def draw_background(self, swarm: Swarm) -> None:
        """Draw all that stands still, and keep its pixels."""
        figure = self.figure
        figure.clear()
        width, height = figure.get_size_inches()
        beside = width_of_key(swarm.colouring)
        share = 1.0 - beside / width
        rect = (0.0, BELOW / height, share, 1.0 - (ABOVE + BELOW) / height)
        self.axes = figure.add_axes(rect)
        layers.show_arena(self.axes, swarm)
        self.floor = layers.draw_arena(self.axes, swarm.polygons)
        layers.draw_light(self.axes, swarm, self.floor)
        layers.draw_walls(self.axes, swarm, self.floor)
        low, high = bounds(swarm.polygons)
        draw_scale_bar(self.axes, low, high)
        draw_notes(self.axes, notes(swarm), low, high)
        y = 1.0 - 0.5 * ABOVE / height
        heading = title(self.recording.last, 1000.0).rsplit(" after ", 1)[0]
        room = int((width - beside) * 9.0) - 12  # characters
        heading = heading if len(heading) <= room else heading[: max(room - 1, 0)] + "\u2026"
        figure.text(0.15 / width, y, literal(heading), color=INK, fontsize=11, va="center")
        if swarm.colouring:
            draw_key(figure, swarm.colouring, share, beside)
        with any_characters():
            self.canvas.draw()
        self.still = self.canvas.copy_from_bbox(figure.bbox)
        self.border = layers.draw_border(self.axes, swarm)
        self.clock = figure.text(share - 0.15 / width, y, "", color=INK, fontsize=11, va="center", ha="right")

        if self.brush is None:
            self.brush = Brush(self.canvas, self.floor.get_transform().transform_path(self.floor.get_path()))

    def draw_membranes(self, time_s: float) -> None:
        """Draw membranes, of which there are few."""
        rows = self.moving.bodies.at(time_s)
        dots = self.recording.last.dots.iloc[:0] if self.dots is None else self.dots.at(time_s)
        below = len(self.axes.collections)
        layers.draw_membranes(self.axes, replace(self.recording.last, rows=rows, dots=dots, end_s=time_s), self.floor)
        renderer = self.canvas.get_renderer()
        for artist in sorted(list(self.axes.collections)[below:], key=lambda one: one.get_zorder()):
            artist.draw(renderer)
            artist.remove()
