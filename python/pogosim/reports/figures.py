"""Figures of the analyses: curves over time with bands over runs, and distributions; saved as PNG and PDF."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from pogosim.analysis.trajectories import Run
from pogosim.confidence import mean_over_runs
from pogosim.fonts import any_characters, literal
from pogosim.reports.groups import MOST_CURVES, by_panel

T = TypeVar("T")

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
    lay_out(figure)
    stem = path.stem if path.suffix in METADATA else path.name  # arenas may have dots in their names
    for suffix in FORMATS:
        with any_characters():
            figure.savefig(path.with_name(stem + suffix), dpi=DPI, metadata=METADATA[suffix])


def lay_out(figure: Figure) -> None:
    """Put the panels of a figure where they fit, once for all formats: that takes longer than drawing them."""
    if (engine := figure.get_layout_engine()) is None:
        return
    engine.execute(figure)
    # Without an engine, nothing is drawn on trial before each format. "none" would be an engine that does nothing.
    with mpl.rc_context({"figure.autolayout": False, "figure.constrained_layout.use": False}):
        figure.set_layout_engine(None)


def colours_of(names: Sequence[str]) -> dict[str, Any]:
    """Return a colour for each curve."""
    colours = colormaps["viridis"](np.linspace(0.0, 0.85, max(len(names), 1)))
    return dict(zip(names, colours, strict=False))


def draw_bands(
    axes: Axes, curves: Mapping[str, Iterable[pd.Series[Any]]], colours: Mapping[str, Any] | None = None
) -> None:
    """Draw the mean of several curves of each group, with a band: its 95 % confidence interval.

    Args:
        axes: Where to.
        curves: By group: a series per run, indexed by the abscissa. With one run there is no band.
        colours: Colours of the groups; None: their own, with a legend.
    """
    together: dict[str, dict[Hashable, pd.Series[Any]]] = {name: dict(enumerate(own)) for name, own in curves.items()}
    draw_means(axes, {name: mean_over_runs(pd.DataFrame(own)) for name, own in together.items()}, colours)


def draw_means(axes: Axes, bands: Mapping[str, pd.DataFrame], colours: Mapping[str, Any] | None = None) -> None:
    """Draw what `mean_over_runs` returns, by group, see `draw_bands`."""
    own_colours = colours_of(list(bands)) if colours is None else colours
    for name, band in bands.items():
        x = band.index.to_numpy(dtype=float)
        colour = own_colours[name]
        axes.plot(x, band["mean"], color=colour, label=literal(name), marker="o" if len(x) == 1 else "")
        axes.fill_between(x, band["low"], band["high"], color=colour, alpha=0.25, linewidth=0)
    if colours is None:
        name_curves(axes, len(bands))


Draw = Callable[[Axes, dict[str, list[T]], "Mapping[str, Any] | None"], None]


def drawn_by_combination(
    runs: Sequence[Run],
    values: Sequence[T],
    draws: Sequence[Draw[T]],
    rows: int = 1,
    palette: Callable[[Sequence[str]], dict[str, Any]] = colours_of,
) -> Figure:
    """Draw what belongs to each run, combination by combination.

    Up to six combinations are in one panel for each drawing, with a legend. With more of several parameters, the values
    of one of them have a row of panels each, with the same axes, and colours stand for the others. With more than six
    curves in a panel, the legend is below all panels.

    Args:
        runs: The runs.
        values: What belongs to each.
        draws: What to draw: functions of the axes, the values by the names of the curves, and the colours of these;
            without colours, there is a legend to make.
        rows: Rows of panels, if there is one for each drawing.
        palette: Gives the colours of many curves, by their names.
    """
    panels, names = by_panel(runs, values)
    if len(panels) == 1:
        figure, axes = new_figure(-(-len(draws) // rows), rows)
        colours = palette(names) if len(names) > MOST_CURVES else None
        for own, draw in zip(axes.flat, draws, strict=False):
            draw(own, next(iter(panels.values())), colours)
    else:
        figure, axes = new_figure(len(draws), len(panels), height=3.0)
        colours = palette(names)
        for line, (title, groups) in zip(axes, panels.items(), strict=True):
            for own, draw in zip(line, draws, strict=True):
                draw(own, groups, colours)
                own.set_title(literal(title), fontsize="medium")
        for column in axes.T:
            share_limits(column, "x")
            share_limits(column, "y")
    if colours is not None and len(names) > 1:
        legend_below(figure, [literal(name) for name in names], list(colours.values()))
    return figure


def share_limits(panels: Sequence[Axes], axis: str) -> None:
    """Give panels the same limits; one without data may be linear beside logarithmic ones, and is left alone."""
    scales = [getattr(own, f"get_{axis}scale")() for own in panels]
    for scale in set(scales):
        alike = list(itertools.compress(panels, [own == scale for own in scales]))
        ends = [getattr(own, f"get_{axis}lim")() for own in alike]
        for own in alike:
            getattr(own, f"set_{axis}lim")(min(low for low, _ in ends), max(high for _, high in ends))


def legend_below(figure: Figure, names: Sequence[str], colours: Sequence[Any]) -> None:
    """Name the curves below all panels, where the names cover nothing."""
    width = max(map(len, names)) * 0.085 + 0.6  # of an entry, in inches
    columns = max(int(figure.get_figwidth() / width), 1)
    rows = -(-len(names) // columns)
    figure.set_figheight(figure.get_figheight() + 0.2 * rows)
    lines = [Line2D([], [], color=colour) for colour in colours]
    figure.legend(lines, names, frameon=False, fontsize="small", ncols=columns, loc="outside lower center")


def draw_over_time(
    axes: Axes,
    groups: Mapping[str, Sequence[pd.DataFrame]],
    column: str,
    label: str,
    colours: Mapping[str, Any] | None = None,
) -> None:
    """Draw a column of the tables over time: the mean over the runs of each combination, with its confidence band.

    Values are not negative, and neither is what the axis shows of the bands.
    """
    draw_bands(
        axes, {name: [table.set_index("time")[column] for table in own] for name, own in groups.items()}, colours
    )
    axes.set_xlabel("time (s)")
    axes.set_ylabel(label)
    from_zero(axes)


def from_zero(axes: Axes) -> None:
    """Let the ordinate begin at 0, and end above all values: those of a constant curve are near the upper border."""
    top = axes.dataLim.y1
    axes.set_ylim(0.0, max(axes.get_ylim()[1], 1.05 * top if np.isfinite(top) else 0.0))


def draw_each_run(
    axes: Axes, groups: Mapping[str, Sequence[pd.Series[Any]]], colours: Mapping[str, Any] | None = None
) -> None:
    """Draw a line for each run, in the colour of its combination; without colours, in their own, with a legend."""
    own_colours = colours_of(list(groups)) if colours is None else colours
    for name, curves in groups.items():
        for number, curve in enumerate(curves):
            own = literal(name) if number == 0 else None
            x, marker = curve.index.to_numpy(dtype=float), "o" if len(curve) == 1 else ""
            axes.plot(x, curve, color=own_colours[name], linewidth=0.8, alpha=0.8, label=own, marker=marker)
    if colours is None:
        name_curves(axes, len(groups))


def name_curves(axes: Axes, count: int) -> None:
    """Name several curves in a legend."""
    if count > 1:
        axes.legend(frameon=False, fontsize="small")


def draw_violins(
    axes: Axes,
    groups: Mapping[str, Sequence[pd.DataFrame]],
    column: str,
    label: str,
    colours: Mapping[str, Any] | None = None,
) -> None:
    """Draw the distribution of a column over times and runs for each combination, with median and extremes.

    Without colours, the combinations are named along the axis.
    """
    own_colours = colours_of(list(groups)) if colours is None else colours
    samples = {name: np.concatenate([table[column].to_numpy(float) for table in own]) for name, own in groups.items()}
    samples = {name: values[np.isfinite(values)] for name, values in samples.items()}
    names = list(own_colours)
    good = [(names.index(name), values) for name, values in samples.items() if len(values)]
    if good:
        places, values = zip(*good, strict=True)
        drawn = axes.violinplot(values, positions=places, widths=0.8, showmedians=True)
        bodies: list[Any] = list(drawn["bodies"])  # type: ignore[call-overload]
        for place, body in zip(places, bodies, strict=True):
            body.set(facecolor=own_colours[names[place]], alpha=0.5)
        for part in ("cmedians", "cmins", "cmaxes", "cbars"):
            drawn[part].set(color="black", linewidth=1.0)
    axes.set_xticks(range(len(names)), ["" if colours else literal(name) for name in names])
    if len(names) > 2 and not colours:
        axes.tick_params(axis="x", rotation=30)
    axes.set_xlim(-0.7, len(names) - 0.3)
    axes.set_ylabel(label)
    from_zero(axes)


DrawColumn = Callable[[Axes, dict[str, list[pd.DataFrame]], str, str, "Mapping[str, Any] | None"], None]


def save_columns(
    draw_column: DrawColumn,
    runs: Sequence[Run],
    tables: Sequence[pd.DataFrame],
    panels: Mapping[str, str],
    path: Path,
) -> None:
    """Save a figure with a panel for each column; panels: column to label."""

    def draw(
        axes: Axes, groups: dict[str, list[pd.DataFrame]], colours: Mapping[str, Any] | None, column: str, label: str
    ) -> None:
        draw_column(axes, groups, column, label, colours)

    draws = [functools.partial(draw, column=column, label=label) for column, label in panels.items()]
    save(drawn_by_combination(runs, tables, draws), path)


save_over_time = functools.partial(save_columns, draw_over_time)
save_violins = functools.partial(save_columns, draw_violins)
