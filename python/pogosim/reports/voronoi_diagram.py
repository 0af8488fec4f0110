"""Pictures of Voronoi cells in their arena, coloured by area."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from pogosim.analysis.arena import Floats
from pogosim.analysis.trajectories import Run
from pogosim.analysis.voronoi import Cells, voronoi_areas, voronoi_cells


def draw_diagrams(run: Run) -> Figure:
    """Draw the cells at the first and the last time of a run, with one scale of colours."""
    times = sorted({0, len(run.time_s) - 1})
    width, height = run.arena.size_mm
    figure = Figure(figsize=(1.2 + 5.0 * len(times), min(max(5.0 * height / width, 2.0), 12.0)), layout="constrained")
    axes = figure.subplots(1, len(times), squeeze=False)[0]
    ends = [run.at(time) for time in times]
    positions = [own.position_mm[own.is_there] for own in ends]
    cells = [voronoi_cells(position, run.arena) for position in positions]
    areas = [voronoi_areas(own, position, run.arena) / 1e3 for own, position in zip(cells, positions, strict=True)]
    every = np.concatenate([*areas, [0.0]])
    colours = Normalize(0.0, max(float(every.max()), 1e-9))
    for panel, time, position, own, area in zip(axes, times, positions, cells, areas, strict=True):
        drawn = draw_diagram(panel, run, position, own, area, colours)
        panel.set_title(f"{run.time_s[time]:g} s", fontsize="medium")
    figure.colorbar(drawn, ax=list(axes), label="area of the cell (1000 mm²)", shrink=0.8)
    return figure


def draw_diagram(
    axes: Axes, run: Run, position_mm: Floats, cells: Cells, area: Floats, colours: Normalize
) -> PolyCollection:
    """Draw cells, robots at their size, and walls; y downwards."""
    arena = run.arena
    shifts = [np.zeros(2)]
    if arena.is_periodic:  # what sticks out on one side comes in on the other
        position_mm = arena.wrap(position_mm)
        shifts = [np.array([x, y]) * arena.size_mm for x in (-1, 0, 1) for y in (-1, 0, 1)]
    polygons, owner = outlines(cells)
    drawn = PolyCollection(
        [polygon + shift for shift in shifts for polygon in polygons],
        array=np.tile(area[owner], len(shifts)),
        norm=colours,
        cmap="viridis",
        edgecolors="white",
        linewidths=0.6,
    )
    axes.add_collection(drawn)
    size = np.full(len(position_mm) * len(shifts), 2.0 * run.radius_mm)
    places = np.concatenate([position_mm + shift for shift in shifts])
    axes.add_collection(
        EllipseCollection(
            size, size, np.zeros(len(size)), units="xy", offsets=places, transOffset=axes.transData, facecolors="black",
            alpha=0.7,
        )
    )  # fmt: skip
    walls = PolyCollection(arena.polygons, facecolors="none", edgecolors="black", linewidths=1.2)
    axes.add_collection(walls)
    low, high = arena.bounds_mm
    margin = 0.0 if arena.is_periodic else 0.01 * float((high - low).max())
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(high[1] + margin, low[1] - margin)
    axes.set_aspect("equal")
    axes.set(xlabel="x (mm)", ylabel="y (mm)")
    return drawn


def outlines(cells: Cells) -> tuple[list[Floats], Any]:
    """Return the outer walls of all parts of cells as arrays, and the number of the cell of each.

    Holes are drawn over by walls only: a cell with one is rare, and keeps its colour there.
    """
    import shapely

    parts, owner = shapely.get_parts(cells, return_index=True)
    is_area = shapely.area(parts) > 0.0
    return [shapely.get_coordinates(part.exterior) for part in parts[is_area]], owner[is_area]
