"""Figures of the analyses: curves over time with bands over runs, saved as PNG and PDF."""

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


def group_names(runs: Sequence[Trajectories]) -> list[str]:
    """Return the labels whose values differ between runs, apart from the number of the run: those of combinations."""
    names = dict.fromkeys(name for run in runs for name in run.labels)
    return [name for name in names if name != "run" and len({str(run.labels.get(name)) for run in runs}) > 1]


def group_of(run: Trajectories, names: Sequence[str]) -> str:
    """Return what a curve of this run's combination is called: its values of these labels; the arena if none differ."""
    if not names:
        return run.arena.name
    return ", ".join(f"{short} {run.labels.get(name)}" for name, short in zip(names, endings(names), strict=True))


def endings(names: Sequence[str]) -> list[str]:
    """Return the shortest ends of dotted names that tell them apart: "speed", but "a.speed" beside "b.speed"."""
    return [next(end for end in ends_of(name) if is_alone(end, names) or end == name) for name in names]


def ends_of(name: str) -> list[str]:
    """Return "c", "b.c" and "a.b.c" of "a.b.c"."""
    parts = name.split(".")
    return [".".join(parts[-count:]) for count in range(1, len(parts) + 1)]


def is_alone(end: str, names: Sequence[str]) -> bool:
    """Tell whether only one of the names ends like that."""
    return sum(end in ends_of(name) for name in names) == 1


def groups_of(runs: Sequence[Trajectories]) -> dict[str, list[Trajectories]]:
    """Sort runs by combination, so that the runs of each are repetitions of the same."""
    names = group_names(runs)
    groups: dict[str, list[Trajectories]] = {}
    for run in runs:
        groups.setdefault(group_of(run, names), []).append(run)
    return groups


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
