"""Many alike things drawn at once onto a picture of matplotlib's Agg: lines, outlines and disks.

One call draws all lines of a colour, and disks are stamped, with Pillow (it comes with matplotlib): a disk of each size
has been drawn once for each of 64 places within a pixel. Both are several times as fast as collections of matplotlib.
Places are in pixels, x from the left and y from the bottom, as in matplotlib.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.backends import backend_agg
from matplotlib.path import Path as Outline
from matplotlib.transforms import IdentityTransform, TransformedPath
from PIL import Image, ImageChops, ImageDraw
from scipy.ndimage import distance_transform_edt

from pogosim.shapes import Floats

PARTS = 8  # of a pixel, along either side: places of stamps
MAX_STAMP_BYTES = 64_000_000

# Shares of the radius and opacities of the disks that make up a glow.
Rings = tuple[tuple[float, float], ...]
DISK: Rings = ((1.0, 1.0),)


def outline_of(vertices: Floats, is_closed: bool, starts: npt.NDArray[np.bool_] | None = None) -> Outline:
    """Join m lines of k corners each, shape (m, k, 2), to one path.

    Args:
        vertices: Corners, in pixels.
        is_closed: Whether the last corner of each leads back to its first.
        starts: Shape (m, k): corners to which no line leads. None: only the first ones.
    """
    if is_closed:
        vertices = np.concatenate([vertices, vertices[:, :1]], axis=1)
    codes = np.full(vertices.shape[:2], Outline.LINETO, dtype=Outline.code_type)
    if starts is not None:
        codes[starts] = Outline.MOVETO
    codes[:, 0] = Outline.MOVETO
    if is_closed:
        codes[:, -1] = Outline.CLOSEPOLY
    path = Outline(vertices.reshape(-1, 2), codes.ravel())
    path.should_simplify = False
    return path


class Brush:
    """Draws onto a canvas, and only there."""

    def __init__(self, canvas: Any, floor: Outline) -> None:
        """Prepare.

        Args:
            canvas: Canvas of Agg, which has been drawn.
            floor: What drawing can be confined to, in pixels.
        """
        self.renderer: Any = canvas.get_renderer()
        self.pixels = np.asarray(self.renderer.buffer_rgba())  # shape (height, width, 4), row 0 at the top
        self.floor = TransformedPath(floor, IdentityTransform())
        self.stamps: dict[tuple[Rings, float, int, int], Image.Image] = {}
        self.stamp_bytes = 0
        self.copy: Image.Image | None = None  # of the picture, while disks are drawn
        self.draw_floor_mask(floor)

    def draw_floor_mask(self, floor: Outline) -> None:
        """Keep which pixels are floor, and how far each is from the nearest that is not."""
        height, width = self.pixels.shape[:2]
        agg: Any = backend_agg
        renderer = agg.RendererAgg(width, height, self.renderer.dpi)
        graphics = renderer.new_gc()
        graphics.set_linewidth(0.0)
        renderer.draw_path(graphics, floor, IdentityTransform(), (1.0, 1.0, 1.0, 1.0))
        mask = np.asarray(renderer.buffer_rgba())[..., 3].copy()
        self.floor_mask = Image.fromarray(mask)
        around = np.pad(mask == 255, 1)  # what is beyond the picture is no floor
        self.floor_depth = distance_transform_edt(around)[1:-1, 1:-1]

    def draw(
        self,
        path: Outline,
        line: Sequence[float] | None = None,
        width_pt: float = 1.0,
        fill: Sequence[float] | None = None,
        cap: str = "butt",
        on_floor: bool = False,
    ) -> None:
        """Draw a path. What crosses itself is not drawn twice there.

        Args:
            path: In pixels.
            line: Colour and opacity of its line. None: it has none.
            width_pt: Width of the line, in points.
            fill: Colour and opacity of what it encloses. None: nothing is filled.
            cap: Ends of lines: butt or round.
            on_floor: Whether to leave out what is not above the floor.
        """
        self.finish()
        graphics = self.renderer.new_gc()
        graphics.set_linewidth(0.0 if line is None else width_pt)
        if line is not None:
            graphics.set_foreground(tuple(line), isRGBA=True)
        graphics.set_capstyle(cap)
        graphics.set_joinstyle("round" if cap == "round" else "miter")
        graphics.set_snap(False)
        if on_floor:
            graphics.set_clip_path(self.floor)
        self.renderer.draw_path(graphics, path, IdentityTransform(), None if fill is None else tuple(fill))
        graphics.restore()

    def stamp(self, rings: Rings, radius: float, column: int, row: int) -> Image.Image:
        """Return the opacity of disks around a place in the middle pixel of a small picture.

        Args:
            rings: Disks on top of each other.
            radius: Radius of a disk of share 1, in pixels.
            column: Eighths of a pixel from the left.
            row: Eighths of a pixel from the top.
        """
        key = (rings, radius, column, row)
        found = self.stamps.get(key)
        if found is None:
            half = half_width(rings, radius)
            place = np.arange(-half, half + 1) + 0.5
            distance = np.hypot(place - (column + 0.5) / PARTS, (place - (row + 0.5) / PARTS)[:, None])
            through = np.ones(distance.shape)
            for share, opacity in rings:
                through *= 1.0 - opacity * np.clip(share * radius + 0.5 - distance, 0.0, 1.0)
            if self.stamp_bytes > MAX_STAMP_BYTES:
                self.stamps.clear()
                self.stamp_bytes = 0
            found = Image.fromarray(np.round(255.0 * (1.0 - through)).astype(np.uint8))
            self.stamps[key] = found
            self.stamp_bytes += through.size
        return found

    def stamp_disks(self, disks: Disks) -> None:
        """Draw disks, later ones above earlier ones; each with all its layers, first to last."""
        height, width = self.pixels.shape[:2]
        places = np.column_stack([disks.places[:, 0], height - disks.places[:, 1]])
        eighths = np.floor(places * PARTS).astype(int)
        pixels = eighths // PARTS
        half = max(half_width(*layer) for layer in disks.layers)
        near = np.clip(pixels, 0, [width - 1, height - 1])
        is_seen = np.all((pixels + half >= 0) & (pixels - half < [width, height]), axis=1)
        is_cut = (disks.on_floor & (self.floor_depth[near[:, 1], near[:, 0]] <= half + 1)).tolist()
        parts = (eighths - pixels * PARTS).tolist()
        pixels = pixels.tolist()
        layers = [(own, half_width(*own), colours) for own, colours in zip(disks.layers, disks.colours, strict=True)]
        pen = self.pen()
        for i in np.flatnonzero(is_seen).tolist():
            (x, y), part = pixels[i], parts[i]
            for layer, half, colours in layers:
                mask = self.stamp(*layer, *part)
                corner = (x - half, y - half)
                if is_cut[i]:
                    box = (*corner, x - half + mask.width, y - half + mask.height)
                    mask = ImageChops.multiply(mask, self.floor_mask.crop(box))
                pen.bitmap(corner, mask, colours[i])

    def pen(self) -> ImageDraw.ImageDraw:
        """Return what draws onto a copy of the picture, which draw() and finish() put back."""
        if self.copy is None:
            height, width = self.pixels.shape[:2]
            self.copy = Image.frombuffer("RGBA", (width, height), self.pixels, "raw", "RGBA", 0, 1).copy()
        return ImageDraw.Draw(self.copy)

    def finish(self) -> None:
        """Complete the picture."""
        if self.copy is not None:
            self.pixels[:] = np.frombuffer(self.copy.tobytes(), np.uint8).reshape(self.pixels.shape)
            self.copy = None


class Disks:
    """Disks of one size that look alike but for their colours; in pixels."""

    def __init__(self, places: Floats, on_floor: bool = False) -> None:
        """Begin without layers.

        Args:
            places: Centres, shape (n, 2).
            on_floor: Whether to leave out what is not above the floor.
        """
        self.places = places
        self.on_floor = on_floor
        self.layers: list[tuple[Rings, float]] = []
        self.colours: list[list[tuple[int, ...]]] = []

    def add(self, radius: float, colours: Floats, rings: Rings = DISK) -> Disks:
        """Put a layer above those that there are.

        Args:
            radius: Radius of a ring of share 1.
            colours: Shape (n, 3) or (3,), 0 to 1.
            rings: What each disk consists of.
        """
        channels = np.full((len(self.places), 4), 255)
        channels[:, :3] = np.round(255.0 * colours)
        self.layers.append((rings, radius))
        self.colours.append(list(map(tuple, channels.tolist())))
        return self


def half_width(rings: Rings, radius: float) -> int:
    """Pixels of a stamp on either side of its middle."""
    return math.ceil(radius * max(share for share, _ in rings) + 0.5) + 1
