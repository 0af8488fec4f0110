"""Runs by arena and combination, and figures of a column of their tables: over time, and as distributions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes

from pogosim.analysis.trajectories import Trajectories
from pogosim.fonts import literal
from pogosim.reports.figures import draw_bands, group_names, group_of, new_figure, save

T = TypeVar("T")


def by_combination(runs: Sequence[Trajectories], values: Sequence[T]) -> dict[str, list[T]]:
    """Sort what belongs to each run by combination; see `groups_of`."""
    names = group_names(runs)
    groups: dict[str, list[T]] = {}
    for run, value in zip(runs, values, strict=True):
        groups.setdefault(group_of(run, names), []).append(value)
    return groups


def by_arena(runs: Sequence[Trajectories], values: Sequence[T]) -> dict[str, tuple[list[Trajectories], list[T]]]:
    """Sort runs, and what belongs to each, by the name of the arena."""
    arenas: dict[str, tuple[list[Trajectories], list[T]]] = {}
    for run, value in zip(runs, values, strict=True):
        own_runs, own_values = arenas.setdefault(run.arena.name, ([], []))
        own_runs.append(run)
        own_values.append(value)
    return arenas


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
