"""Figures of `pogosim analyze locomotion`: speeds, displacements, autocorrelations and Peclet numbers."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from pogosim.analysis.arena import Floats
from pogosim.analysis.displacement import diffusion_exponent
from pogosim.analysis.trajectories import Run
from pogosim.fonts import literal
from pogosim.reports.figures import Draw, draw_bands, drawn_by_combination, from_zero, legend_below, new_figure, save
from pogosim.reports.groups import by_combination
from pogosim.reports.locomotion_tables import first_and_last_quarter

MAX_BOXES = 30
MAX_BINS = 40
COLOUR = colormaps["viridis"](0.3)


@dataclass(frozen=True)
class RunTables:
    """What is known of one run."""

    run: Run
    agents: pd.DataFrame
    over_time: pd.DataFrame
    peclet: pd.DataFrame
    msd: pd.DataFrame
    correlations: pd.DataFrame
    summary: pd.DataFrame
    msd_per_agent: pd.DataFrame
    positions: int  # of robots at all times
    outside: int  # of these, outside of the arena
    is_evenly_spaced: bool
    has_headings: bool


def groups(tables: Sequence[RunTables], names: Sequence[str]) -> dict[str, list[RunTables]]:
    """Sort runs by combination."""
    return by_combination([own.run for own in tables], tables, names)


def draw_curves(
    axes: Axes, groups: Mapping[str, Sequence[RunTables]], colours: Mapping[str, Any] | None, table: str, x: str, y: str
) -> None:
    """Draw a mean with a band over runs per combination; for one run the standard error over robots, if known.

    Curves without values are left out, but not their combinations.
    """
    found: dict[str, list[pd.Series[Any]]] = {}
    for name, own in groups.items():
        series = [getattr(one, table).set_index(x)[y].dropna() for one in own]
        found[name] = [one for one in series if len(one)] or series[:1]
    draw_bands(axes, found, colours)
    error = f"sem_{y.removeprefix('mean_')}"
    (one, *others) = [one for own in groups.values() for one in own]
    if not others and colours is None and error in getattr(one, table):
        own_table = getattr(one, table)
        low, high = own_table[y] - own_table[error], own_table[y] + own_table[error]
        axes.fill_between(own_table[x], low, high, color=axes.lines[-1].get_color(), alpha=0.25, linewidth=0)
    if legend := axes.get_legend():
        legend.remove()


def drawn(
    tables: Sequence[RunTables], draws: Sequence[Draw[RunTables]], rows: int = 1, is_named: bool = True
) -> Figure:
    """Draw combinations with their names below the figure, if there are several."""
    figure = drawn_by_combination([own.run for own in tables], tables, draws, rows)
    handles, labels = figure.axes[0].get_legend_handles_labels()
    if is_named and not figure.legends and len(handles) > 1:
        legend_below(figure, labels, [line.get_color() for line in figure.axes[0].lines[: len(labels)]])
    return figure


def band_words(tables: Sequence[RunTables], names: Sequence[str]) -> str:
    """Return what the bands are."""
    if len(tables) == 1:
        return "mean ± standard error over robots"
    most = max(map(len, groups(tables, names).values()))
    return f"mean and 95 % confidence interval over {most} runs" if most > 1 else "mean over robots"


def draw_speed_over_time(tables: Sequence[RunTables], names: Sequence[str], folder: Path) -> None:
    """Draw the mean speed and angular velocity over time."""

    def draw(
        axes: Axes, own: dict[str, list[RunTables]], colours: Mapping[str, Any] | None, column: str, label: str
    ) -> None:
        draw_curves(axes, own, colours, "over_time", "time", column)
        axes.set(xlabel="time (s)", ylabel=label)
        if column == "mean_speed_mm_s":
            from_zero(axes)

    labels = {"mean_speed_mm_s": "speed (mm/s)", "mean_angular_velocity_rad_s": "angular velocity (rad/s)"}
    figure = drawn(
        tables, [functools.partial(draw, column=name, label=label) for name, label in labels.items()], rows=2
    )
    figure.suptitle(band_words(tables, names), fontsize="medium")
    save(figure, folder / "speed_time")


def draw_speed_boxes(tables: Sequence[RunTables], names: Sequence[str], folder: Path) -> None:
    """Draw a box with the mean speeds of robots for each combination, or each run if there is but one combination."""
    boxes = {group: [own.agents for own in members] for group, members in groups(tables, names).items()}
    if len(boxes) == 1 and len(tables) > 1:
        boxes = {f"run {own.run.labels.get('run', n)}": [own.agents] for n, own in enumerate(tables[:MAX_BOXES])}
    values = {name: pd.concat(own)["mean_speed_mm_s"].to_numpy(dtype=float) for name, own in boxes.items()}
    longest = max(map(len, values))
    figure, panels = new_figure(width=7.0, height=1.0 + 0.32 * max(len(values), 3))
    axes = panels[0, 0]
    axes.boxplot(
        list(values.values()),
        orientation="horizontal",
        widths=0.6,
        patch_artist=True,
        boxprops={"facecolor": "0.85"},
        medianprops={"color": COLOUR, "linewidth": 2},
        flierprops={"markersize": 3, "markeredgecolor": "0.4"},
    )
    names_of_boxes = [literal(name) for name in values]
    axes.set_yticks(range(1, len(values) + 1), names_of_boxes, fontsize="small" if longest > 12 else "medium")
    axes.invert_yaxis()
    axes.set(xlabel="mean speed of a robot (mm/s)")
    axes.set_xlim(0.0, 1.05 * axes.get_xlim()[1])
    save(figure, folder / "speed_box")


def without_outliers(values: Floats) -> Floats:
    """Return the values within 1.5 interquartile ranges of the quartiles (Tukey's fences)."""
    low, high = np.percentile(values, [25, 75])
    fence = 1.5 * (high - low)
    return np.asarray(values[(values >= low - fence) & (values <= high + fence)])


def draw_peclet(tables: Sequence[RunTables], folder: Path) -> None:
    """Draw the histogram of the robots' Peclet numbers; outliers are not shown, but counted."""
    values = pd.concat([own.peclet["peclet"] for own in tables]).to_numpy(dtype=float)
    known = values[np.isfinite(values)]
    figure, panels = new_figure()
    axes = panels[0, 0]
    axes.set(xlabel="Péclet number", ylabel="robots")
    if len(known):
        shown = without_outliers(known)
        axes.hist(shown, bins=histogram_edges(shown), color=COLOUR, edgecolor="white", linewidth=0.5)
        median = float(np.median(known))
        axes.axvline(median, color="0.2", linestyle="--", label=f"median {median:.3g}")
        handle, label = axes.get_legend_handles_labels()
        axes.legend(handle, label, frameon=False, loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.2)
        notes = [f"{len(known)} robots"]
        if len(shown) < len(known):
            notes.append(f"{len(known) - len(shown)} beyond the axis")
        if len(known) < len(values):
            notes.append(f"{len(values) - len(known)} without D > 0")
        axes.set_title(", ".join(notes), loc="left", fontsize="small")
    else:
        say_nothing_there(axes, "no robot has a diffusion coefficient above 0")
    save(figure, folder / "peclet_hist")


def histogram_edges(values: Floats) -> Floats:
    """Return edges of bins by the rule of Freedman and Diaconis, at most 40 bins."""
    edges: Floats = np.histogram_bin_edges(values, bins="auto")
    return edges if len(edges) <= MAX_BINS + 1 else np.linspace(edges[0], edges[-1], MAX_BINS + 1)


def say_nothing_there(axes: Axes, text: str) -> None:
    """Write why axes are empty."""
    axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color="0.4", wrap=True)


MSD_KINDS = {"msd_mm2": "from the first position", "time_averaged_msd_mm2": "average over start times"}


def draw_msd(tables: Sequence[RunTables], folder: Path) -> None:
    """Draw mean squared displacements against the lag, on linear and on logarithmic axes."""

    def draw(
        axes: Axes, own: dict[str, list[RunTables]], colours: Mapping[str, Any] | None, column: str, scale: str
    ) -> None:
        draw_curves(axes, own, colours, "msd", "lag_s", column)
        axes.set(xlabel="lag (s)", ylabel=f"mean squared displacement (mm²)\n({MSD_KINDS[column]})")
        if not any(np.isfinite(line.get_ydata()).any() for line in axes.lines):
            say_nothing_there(axes, "needs save times that are evenly spaced, two or more")
        elif scale == "log":
            on_logarithmic_axes(axes, colours is None)

    for name, scale in (("msd_linear", "linear"), ("msd_loglog", "log")):
        draws = [functools.partial(draw, column=column, scale=scale) for column in MSD_KINDS]
        figure = drawn(positive_lags(tables) if scale == "log" else tables, draws, is_named=scale == "linear")
        save(figure, folder / name)


def positive_lags(tables: Sequence[RunTables]) -> list[RunTables]:
    """Return the tables without lag 0, which logarithmic axes do not have."""
    return [replace(own, msd=own.msd[own.msd["lag_s"] > 0.0]) for own in tables]


def on_logarithmic_axes(axes: Axes, names_curves: bool) -> None:
    """Make both axes logarithmic; a legend has the exponents of the first and the last quarter of the lags."""
    for line in axes.lines if names_curves else ():
        lag, mean = np.asarray(line.get_xdata(), dtype=float), np.asarray(line.get_ydata(), dtype=float)
        early, late = first_and_last_quarter(lag)
        first, last = diffusion_exponent(lag[early], mean[early]), diffusion_exponent(lag[late], mean[late])
        name = "" if len(axes.lines) == 1 else f"{line.get_label()}: "
        line.set_label(f"{name}{first:.2f}, {last:.2f}")
    values = np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in axes.lines])
    if not (values > 0.0).any():
        say_nothing_there(axes, "no robot moved")
        return
    axes.set(xscale="log", yscale="log")
    axes.set_ylim(0.5 * values[values > 0.0].min(), 2.0 * values[values > 0.0].max())
    if not names_curves:
        return
    handles, labels = axes.get_legend_handles_labels()
    title = "exponent $\\alpha$ of the first, last 25 % of lags"
    style: dict[str, Any] = {"frameon": False, "fontsize": "small", "title": title, "title_fontsize": "small"}
    axes.legend(handles, labels, loc="upper center", bbox_to_anchor=(0.5, -0.16), **style)


def draw_autocorrelations(tables: Sequence[RunTables], folder: Path) -> None:
    """Draw the autocorrelations of heading and velocity against the lag, up to half the longest one."""
    longest_s = max(float(own.correlations["lag_s"].max()) for own in tables)

    def draw(axes: Axes, own: dict[str, list[RunTables]], colours: Mapping[str, Any] | None, column: str) -> None:
        draw_curves(axes, own, colours, "correlations", "lag_s", column)
        axes.set(xlabel="lag (s)", ylabel=f"autocorrelation of the {column}")
        axes.axhline(0.0, color="0.7", linewidth=0.8, zorder=0)
        if not any(np.isfinite(line.get_ydata()).any() for line in axes.lines[:-1]):
            say_nothing_there(axes, "needs evenly spaced save times, and robots that turn or move")
            return
        axes.set_xlim(0.0, longest_s / 2.0 or None)
        axes.set_ylim(top=1.05)

    figure = drawn(tables, [functools.partial(draw, column=column) for column in ("heading", "velocity")])
    save(figure, folder / "autocorrelation")


def draw_all(tables: Sequence[RunTables], names: Sequence[str], folder: Path) -> None:
    """Draw all curves, boxes and histograms of these runs."""
    draw_speed_over_time(tables, names, folder)
    draw_speed_boxes(tables, names, folder)
    draw_peclet(tables, folder)
    draw_msd(tables, folder)
    draw_autocorrelations(tables, folder)
