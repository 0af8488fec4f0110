"""Figures of where robots spend their time: a panel per arena."""

from __future__ import annotations

import functools
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch

from pogosim.analysis.arena import Arena, Floats
from pogosim.analysis.density import DensityGrid, count_density, kernel_density
from pogosim.analysis.snapshots import snapshots_of
from pogosim.analysis.trajectories import Run
from pogosim.fonts import literal
from pogosim.reports.figures import new_figure, save
from pogosim.scene import floor_outline

WALL_COLOUR = "0.25"
MAX_COLUMNS = 3


def arenas_of(runs: Sequence[Run]) -> dict[str, list[Run]]:
    """Sort runs by arena.

    Returns:
        By a name that can be that of a folder, in the order of their first runs.
    """
    arenas: dict[str, list[Run]] = {}
    for run in runs:
        arenas.setdefault(folder_name(run.arena.name), []).append(run)
    return arenas


def folder_name(text: str) -> str:
    """Return a text as the name of a file or folder: letters, digits, - . and _ only."""
    return re.sub(r"[^\w.-]+", "_", text).strip("._") or "arena"


def draw_arena(axes: Axes, arena: Arena) -> PathPatch | None:
    """Draw the outline of an arena, y downwards, in mm; returns its floor, None if the file does not have it."""
    axes.set(xlabel="x (mm)", ylabel="y (mm)", aspect="equal")
    if not arena.polygons:
        axes.invert_yaxis()
        return None
    low, high = arena.bounds_mm
    corners = np.array([low, (high[0], low[1]), high, (low[0], high[1])])
    polygons = [corners] if arena.is_periodic else arena.polygons
    style = "--" if arena.is_periodic else "-"
    floor = PathPatch(
        floor_outline(polygons), facecolor="none", edgecolor=WALL_COLOUR, linewidth=1.2, linestyle=style, zorder=3
    )
    axes.add_patch(floor)
    margin = 0.03 * float((high - low).max())
    axes.set(xlim=(low[0] - margin, high[0] + margin), ylim=(high[1] + margin, low[1] - margin))
    return floor


def draw_density(axes: Axes, arena: Arena, grid: DensityGrid, title: str) -> None:
    """Draw a density with the outline of the arena and a colour bar."""
    floor = draw_arena(axes, arena)
    image = axes.pcolormesh(
        grid.x_mm, grid.y_mm, grid.probability_per_m2, cmap="viridis", vmin=0.0, rasterized=True, shading="flat"
    )
    if floor is not None:
        image.set_clip_path(floor)
    axes.set_title(literal(title))
    axes.figure.colorbar(image, ax=axes, label="probability density (1/m²)", shrink=0.8)


def positions_of(runs: Sequence[Run]) -> Iterator[Floats]:
    """Yield the positions of robots in all runs, shape (n, 2), those at some times after the other."""
    for run in runs:
        for own in snapshots_of(run):
            yield own.position_mm


def draw_heat_maps(runs: Sequence[Run], folder: Path, bins: int) -> None:
    """Draw the heat maps of all arenas together, and of each one alone in its folder."""
    positions = {name: functools.partial(positions_of, own) for name, own in arenas_of(runs).items()}
    arenas = {name: own[0].arena for name, own in arenas_of(runs).items()}
    counts = {name: count_density(arenas[name], points, bins) for name, points in positions.items()}
    kernels = {name: kernel_density(arenas[name], points) for name, points in positions.items()}
    for grids, suffix in ((counts, ""), (kernels, "_kde")):
        draw_panels(arenas, grids, folder / f"arena_heatmaps{suffix}")
        for name, grid in grids.items():
            draw_panels({name: arenas[name]}, {name: grid}, folder / "arenas" / name / f"heatmap{suffix}")


def draw_panels(arenas: Mapping[str, Arena], grids: Mapping[str, DensityGrid], path: Path) -> None:
    """Draw densities in panels, up to three in a row."""
    columns = min(len(arenas), MAX_COLUMNS)
    rows = -(-len(arenas) // columns)
    figure, panels = new_figure(columns, rows, width=4.8, height=4.0)
    for axes, (name, arena) in zip(panels.flat, arenas.items(), strict=False):
        draw_density(axes, arena, grids[name], name)
    for axes in panels.flat[len(arenas) :]:
        axes.set_axis_off()
    save(figure, path)
