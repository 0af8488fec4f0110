"""`pogosim analyze messages`: what became of the messages, and how many got through by distance and cluster size."""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from pogosim.analysis.reception import attempts, outcomes, reception_rates
from pogosim.analysis.trajectories import label_columns
from pogosim.command.parser import warn
from pogosim.errors import AnalysisError
from pogosim.fonts import literal
from pogosim.reports.figures import legend_below, new_figure, save
from pogosim.reports.groups import MOST_CURVES
from pogosim.reports.options import output_folder, write_table
from pogosim.row_batches import row_batches
from pogosim.utils import load_dataframe

SENDER = "sender_category"


def read_log(options: argparse.Namespace, prog: str) -> tuple[pd.DataFrame, list[str]]:
    """Read message logs. Returns the rows of the wanted senders, and the columns that tell combinations apart.

    Raises:
        AnalysisError: They are none, or have no row to analyse.
        OSError, ValueError: A file cannot be read.
    """
    files = options.input[0] if len(options.input) == 1 else options.input
    name = " ".join(options.input)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        rows, metadata = load_dataframe(files)
    for warning in caught:
        warn(prog, warning.message)
    if "outcome" not in rows or rows["outcome"].isna().any():
        check_are_logs(metadata.get("files", options.input))
    if options.category is not None:
        there = ", ".join(sorted(rows[SENDER].astype(str).unique())) or "none"
        rows = rows[rows[SENDER] == options.category]
        if rows.empty:
            raise AnalysisError(f"in {name}, no robot of the category '{options.category}' sends; senders: {there}")
    if rows.empty:
        raise AnalysisError(f"{name} has no message: no robot sent one")
    combination = [name for name in label_columns(rows, metadata) if name != "run" and rows[name].nunique() > 1]
    return rows, combination


def check_are_logs(files: Sequence[str]) -> None:
    """Raise AnalysisError for the first file that is none: rows of others could be joined with those of logs."""
    for file in files:
        if "outcome" not in row_batches(Path(file)).schema.names:
            raise AnalysisError(
                f"{file} is no message log (it has no column outcome): set message_log in the configuration"
            )


def with_bins(tried: pd.DataFrame, bin_mm: float) -> pd.DataFrame:
    """Add the borders of the bin that each distance is in; from one border up to and without the next."""
    number = np.floor(tried["distance"].astype(float) / bin_mm)
    return tried.assign(distance_from_mm=number * bin_mm, distance_to_mm=(number + 1.0) * bin_mm)


def senders(table: pd.DataFrame, by: Sequence[str]) -> pd.Series[str]:
    """Return the name of the group of senders that each row is of."""
    return table[list(by)].astype(str).agg(", ".join, axis=1)


def draw(axes: Axes, table: pd.DataFrame, x: pd.Series[float], by: Sequence[str], colours: dict[str, Any]) -> None:
    """Draw rates with their confidence intervals, and the law as a line, for each group of senders."""
    groups = senders(table, by) if len(table) else pd.Series(dtype=str)
    for name, colour in colours.items():
        rows = table[groups == name]
        place = x[rows.index].to_numpy(dtype=float)
        around = np.stack([rows["rate"] - rows["rate_low"], rows["rate_high"] - rows["rate"]])
        axes.plot(place, rows["law"], color=colour, alpha=0.5, linewidth=1.2, marker="_", markersize=9)
        axes.errorbar(
            place,
            rows["rate"],
            np.maximum(around, 0.0),
            color=colour,
            fmt="o",
            markersize=4,
            capsize=2,
            label=literal(name),
        )
    axes.set_ylabel("messages received (share)")
    axes.set_ylim(-0.03, 1.03)
    axes.grid(color="0.9")


def analyze(options: argparse.Namespace, prog: str) -> None:
    """Write the tables and the figure."""
    rows, combination = read_log(options, prog)
    by = [*combination, SENDER]
    runs = ["run"] if "run" in rows and "run" not in by else []
    tried = attempts(rows)
    folder = output_folder(options)
    write_table(outcomes(rows, [*runs, *by]), folder / "messages.csv", options.input)
    if tried.empty:
        warn(prog, "no message reached a robot, so there is no rate of reception")
        return
    near = tried[tried["distance"].notna()]
    if len(near) < len(tried):
        warn(prog, f"{len(tried) - len(near)} rows to or from walls and membranes have no distance")
    distance = reception_rates(with_bins(near, options.bin), [*by, "distance_from_mm", "distance_to_mm"])
    cluster = reception_rates(tried, [*by, "cluster_size"])
    write_table(distance, Path(folder, "reception_by_distance.csv"), options.input)
    write_table(cluster, Path(folder, "reception_by_cluster_size.csv"), options.input)
    save(drawn(distance, cluster, by), folder / "reception")


def drawn(distance: pd.DataFrame, cluster: pd.DataFrame, by: Sequence[str]) -> Figure:
    """Draw rates of reception by distance and by cluster size side by side."""
    figure, ((left, right),) = new_figure(columns=2, width=5.0)
    names = list(dict.fromkeys(senders(cluster, by)))
    colours = dict(zip(names, colormaps["viridis"](np.linspace(0.0, 0.85, len(names))), strict=True))
    draw(left, distance, (distance["distance_from_mm"] + distance["distance_to_mm"]) / 2.0, by, colours)
    draw(right, cluster, cluster["cluster_size"], by, colours)
    left.set_xlabel("distance from emitter to receiver's border (mm)")
    if len(distance):
        left.set_xlim(0.0, distance["distance_to_mm"].max())
    right.set_xlabel("cluster size (sender and robots in reach)")
    right.xaxis.set_major_locator(MaxNLocator(integer=True))
    right.plot([], [], color="0.3", marker="_", markersize=9, label="law")
    if len(names) > MOST_CURVES:
        right.legend(handles=right.lines[-1:], frameon=False, fontsize="small")
        legend_below(figure, [literal(name) for name in names], list(colours.values()))
    else:
        right.legend(frameon=False, fontsize="small")
    return figure
