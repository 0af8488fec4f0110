"""Figures of the analyses: curves over time with bands over runs, and distributions; saved as PNG and PDF."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from pogosim.analysis.trajectories import Trajectories
from pogosim.confidence import mean_over_runs
from pogosim.fonts import any_characters, literal
from pogosim.reports.groups import by_combination

DPI = 150
FORMATS = (".pdf", ".png")
# The same bytes for the same data.
METADATA: Mapping[str, dict[str, Any]] = {".pdf": {"CreationDate": None}, ".png": {"Software": None}}


def new_figure(columns: int = 1, rows: int = 1, width: float = 6.0, height: float = 4.0) -> tuple[Figure, Any]:
    """Return a figure and its axes, an array of shape (rows, columns); width and height of one panel in inches."""
    figure = Figure(figsize=(columns * width, rows * height), layout="constrained")
    return figure, figure.subplots(rows, columns, squeeze=False)


def save(figure: Figure, path: Path) -> None:
    """Write a figure as PDF and PNG; parent folders are made. The path may have one of these suffixes or none."""
    path.parent.mkdir(parents=True, exist_ok=True)
    # Panels are laid out once, not for each format: that takes longer than drawing them.
    if (engine := figure.get_layout_engine()) is not None:
        engine.execute(figure)
        figure.set_layout_engine("none")
    stem = path.stem if path.suffix in METADATA else path.name  # arenas may have dots in their names
    for suffix in FORMATS:
        with any_characters():
            figure.savefig(path.with_name(stem + suffix), dpi=DPI, metadata=METADATA[suffix])


def draw_bands(axes: Axes, curves: Mapping[str, Iterable[pd.Series[Any]]]) -> None:
    """Draw the mean of several curves of each group, with a band: its 95 % confidence interval.

    Args:
        axes: Where to.
        curves: By group: a series per run, indexed by the abscissa. With one run there is no band.
    """
    colours = colormaps["viridis"](np.linspace(0.0, 0.85, max(len(curves), 1)))
    for colour, (name, series) in zip(colours, curves.items(), strict=False):
        together: dict[Hashable, pd.Series[Any]] = dict(enumerate(series))
        band = mean_over_runs(pd.DataFrame(together))
        x = band.index.to_numpy(dtype=float)
        axes.plot(x, band["mean"], color=colour, label=literal(name), marker="o" if len(x) == 1 else "")
        axes.fill_between(x, band["low"], band["high"], color=colour, alpha=0.25, linewidth=0)
    if len(curves) > 1:
        axes.legend(frameon=False, fontsize="small")


def draw_over_time(axes: Axes, groups: Mapping[str, Sequence[pd.DataFrame]], column: str, label: str) -> None:
    """Draw a column of the tables over time: the mean over the runs of each combination, with its confidence band.

    Values are not negative, and neither is what the axis shows of the bands.
    """
    draw_bands(axes, {name: [table.set_index("time")[column] for table in own] for name, own in groups.items()})
    axes.set_xlabel("time (s)")
    axes.set_ylabel(label)
    axes.set_ylim(bottom=0.0)


def draw_each_run(axes: Axes, groups: Mapping[str, Sequence[pd.Series[Any]]]) -> None:
    """Draw a line for each run, in the colour of its combination."""
    colours = colormaps["viridis"](np.linspace(0.0, 0.85, max(len(groups), 1)))
    for colour, (name, curves) in zip(colours, groups.items(), strict=True):
        for number, curve in enumerate(curves):
            own = literal(name) if number == 0 else None
            x = curve.index.to_numpy(dtype=float)
            axes.plot(x, curve, color=colour, linewidth=0.8, alpha=0.8, label=own, marker="o" if len(x) == 1 else "")
    if len(groups) > 1:
        axes.legend(frameon=False, fontsize="small")


def draw_violins(axes: Axes, groups: Mapping[str, Sequence[pd.DataFrame]], column: str, label: str) -> None:
    """Draw the distribution of a column over times and runs for each combination, with median and extremes."""
    samples = {name: np.concatenate([table[column].to_numpy(float) for table in own]) for name, own in groups.items()}
    samples = {name: values[np.isfinite(values)] for name, values in samples.items()}
    good = [(place, values) for place, values in enumerate(samples.values()) if len(values)]
    if good:
        places, values = zip(*good, strict=True)
        drawn = axes.violinplot(values, positions=places, widths=0.8, showmedians=True)
        colours = colormaps["viridis"](np.linspace(0.0, 0.85, len(samples)))
        bodies: list[Any] = list(drawn["bodies"])  # type: ignore[call-overload]
        for place, body in zip(places, bodies, strict=True):
            body.set(facecolor=colours[place], alpha=0.5)
        for part in ("cmedians", "cmins", "cmaxes", "cbars"):
            drawn[part].set(color="black", linewidth=1.0)
    names = list(samples)
    axes.set_xticks(range(len(names)), [literal(name) for name in names])
    if len(names) > 2:
        axes.tick_params(axis="x", rotation=30)
    axes.set_xlim(-0.7, len(names) - 0.3)
    axes.set_ylabel(label)
    axes.set_ylim(bottom=0.0)


def save_over_time(
    runs: Sequence[Trajectories], tables: Sequence[pd.DataFrame], panels: Mapping[str, str], path: Path
) -> None:
    """Save a figure with a panel for each column; panels: column to label."""
    figure, axes = new_figure(columns=len(panels))
    for panel, (column, label) in zip(axes[0], panels.items(), strict=True):
        draw_over_time(panel, by_combination(runs, tables), column, label)
    save(figure, path)


def save_violins(
    runs: Sequence[Trajectories], tables: Sequence[pd.DataFrame], panels: Mapping[str, str], path: Path
) -> None:
    """Save a figure with a panel for each column; panels: column to label."""
    groups = by_combination(runs, tables)
    figure, axes = new_figure(columns=len(panels), width=max(4.5, 1.5 + 0.7 * len(groups)))
    for panel, (column, label) in zip(axes[0], panels.items(), strict=True):
        draw_violins(panel, groups, column, label)
    save(figure, path)
