"""Figures of `pogosim analyze collective`."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from itertools import compress
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

from pogosim.analysis.floor import grid_of
from pogosim.analysis.flow import flow_bounds
from pogosim.analysis.trajectories import Run
from pogosim.fonts import literal
from pogosim.reports.collective_metrics import Metric
from pogosim.reports.collective_swarm import Vortices
from pogosim.reports.figures import draw_bands, drawn_by_combination, new_figure, save

ARROWS = 24  # along the longer side
MAX_PANELS = 12


def draw_metric(metric: Metric, runs: Sequence[Run], tables: Sequence[pd.DataFrame], folder: Path) -> None:
    """Draw the curves of a metric, a panel for each, with bands over the runs of a combination."""
    is_known = [any(name in table and table[name].notna().any() for name in metric.curves) for table in tables]
    if not any(is_known):
        return

    def draw(axes: Axes, groups: dict[str, list[pd.DataFrame]], colours: Mapping[str, Any] | None, name: str) -> None:
        curves = {
            group: [pd.Series(table[name].to_numpy(dtype=float), index=table.iloc[:, 0].to_numpy()) for table in parts]
            for group, parts in groups.items()
        }
        draw_bands(axes, curves, colours)
        axes.set(xlabel=metric.x_label, ylabel=metric.curves[name])
        if metric.chance is not None:
            axes.axhline(metric.chance, color="grey", linewidth=0.8, linestyle=":")
        if metric.limits is not None:
            margin = 0.03 * (metric.limits[1] - metric.limits[0])
            axes.set_ylim(metric.limits[0] - margin, metric.limits[1] + margin)
        if metric.x_label.startswith(("time", "distance")):
            axes.set_xlim(left=0.0)
        if metric.logarithmic:
            draw_square_root(axes, colours is None)

    draws = [functools.partial(draw, name=name) for name in metric.curves]
    known_runs, known_tables = list(compress(runs, is_known)), list(compress(tables, is_known))
    rows = 1 if len(draws) < 3 else 2
    save(drawn_by_combination(known_runs, known_tables, draws, rows), folder / metric.figure)


def draw_square_root(axes: Axes, names_curves: bool) -> None:
    """Make both axes logarithmic, and draw what independent positions have: sigma = N^(1/2).

    The legend names all curves, or only this line.
    """
    if not np.isfinite(axes.dataLim.minpos).all():
        return  # no value above 0
    low, high = axes.dataLim.intervalx
    x = np.array([low, high])
    axes.set(xscale="log", yscale="log")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(NullFormatter())
    chance = "independent positions, $N^{1/2}$"
    line = axes.plot(x, np.sqrt(x), color="grey", linewidth=0.8, linestyle=":", label=chance)
    axes.legend(handles=None if names_curves else line, frameon=False, fontsize="small")


def draw_vorticity_fields(first: Mapping[str, Run], fields: Mapping[str, Vortices], folder: Path) -> None:
    """Draw the mean velocity field of the first run of each combination, up to twelve of them."""
    known = {name: own for name, own in fields.items() if np.isfinite(own.vorticity).any()}
    if not known:
        return
    names = list(known)[:MAX_PANELS]
    columns = min(len(names), 3)
    figure, axes = new_figure(columns, -(-len(names) // columns), width=5.5, height=4.5)
    for own in axes.flat[len(names) :]:
        own.set_axis_off()
    for own, name in zip(axes.flat, names, strict=False):
        draw_field(own, first[name], known[name])
        own.set_title(literal(name), fontsize="medium")
    save(figure, folder / "vortex_field")


def draw_field(axes: Axes, run: Run, field: Vortices) -> None:
    """Draw vorticity as colours and velocity as arrows, with y downwards."""
    low, high = flow_bounds(run)
    top = float(np.nanquantile(np.abs(field.vorticity), 0.99)) or 1.0
    image = axes.imshow(
        field.vorticity,
        extent=(low[0], high[0], high[1], low[1]),
        cmap="RdBu_r",
        vmin=-top,
        vmax=top,
        interpolation="nearest",
        rasterized=True,
    )
    for polygon in run.arena.polygons:
        axes.plot(*np.vstack([polygon, polygon[:1]]).T, color="black", linewidth=0.8)
    rows, columns = field.vorticity.shape
    step = max(max(rows, columns) // ARROWS, 1)
    at_row, at_column = (np.arange(step // 2, size, step) for size in (rows, columns))
    grid = np.ix_(at_row, at_column)
    place, arrow = grid_of((low, high), (columns, rows))[grid], field.velocity[grid]
    known = np.isfinite(arrow).all(axis=2)
    if known.any():
        axes.quiver(*place[known].T, *arrow[known].T, angles="xy", pivot="mid", color="black", width=0.003)
    axes.set(xlabel="x (mm)", ylabel="y (mm)", aspect="equal")
    axes.figure.colorbar(image, ax=axes, label="mean vorticity (1/s), clockwise positive", shrink=0.85)
