"""Pictures of arenas."""

from __future__ import annotations

import numpy as np
import shapely
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Curve

from pogosim.fonts import literal, without_tex
from pogosim.geometry.arena_file import Outline
from pogosim.geometry.validity import Room

FLOOR, WALL, HOLE, UNREACHABLE = "#eef2f5", "#29343d", "#a8321b", "#f0c9a8"


@without_tex()
def draw(outline: Outline, room: Room | None, title: str, figure: Figure | None = None) -> Figure:
    """Draw an arena: its floor, walls and holes, and what robots cannot reach.

    Args:
        outline: The arena, in mm; it may be invalid.
        room: How much room it has for robots. None: that is not known.
        title: Heading.
        figure: An empty figure to draw into, that of a window for instance. None: a new one.
    """
    low, high = outline.bounds
    size = high - low
    width, height = 6.5 * size / max(float(size.max()), 1e-12)
    figure = figure or Figure()
    figure.set_size_inches(max(float(width), 2.5) + 1.0, max(float(height), 1.5) + 1.2)
    figure.set_layout_engine("constrained")
    axes = figure.subplots()
    closed = [Curve(np.vstack([polygon, polygon[:1]]), closed=True) for polygon in outline.polygons]
    axes.add_patch(PathPatch(closed[0], facecolor=FLOOR, edgecolor="none"))
    if room is not None:
        left = room.floor.difference(shapely.union_all(room.parts)) if room.parts else room.floor
        label: str | None = "out of reach of robots"
        for part in shapely.get_parts(left):
            # The rounding at corners is not worth a colour.
            if part.geom_type == "Polygon" and part.area > 1e-5 * room.floor.area:
                rings = [np.asarray(ring.coords) for ring in (part.exterior, *part.interiors)]
                path = Curve.make_compound_path(*(Curve(ring, closed=True) for ring in rings))
                axes.add_patch(PathPatch(path, facecolor=UNREACHABLE, edgecolor="none", label=label))
                label = None
    for number, curve in enumerate(closed):
        if number:
            axes.add_patch(PathPatch(curve, facecolor="white", edgecolor="none"))
        axes.add_patch(PathPatch(curve, facecolor="none", edgecolor=HOLE if number else WALL, linewidth=1.5))
    margin = 0.03 * float(size.max())
    axes.set(xlim=(low[0] - margin, high[0] + margin), ylim=(high[1] + margin, low[1] - margin))  # y runs downwards
    axes.set(xlabel="x (mm)", ylabel="y (mm)", aspect="equal")
    axes.set_title(literal(title), fontsize=10)
    if axes.get_legend_handles_labels()[0]:
        figure.legend(loc="outside lower right", fontsize=8, frameon=False)
    return figure
