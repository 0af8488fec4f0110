"""`pogosim analyze neighbors`: distances to neighbours, degrees, their Fano factor and clusters over time."""

from __future__ import annotations

import functools
import pickle
from argparse import Namespace
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.ticker import MaxNLocator

from pogosim.analysis.arena import Floats
from pogosim.analysis.listed_neighbours import listed_distance, listed_neighbours
from pogosim.analysis.neighbourhood import (
    Integers,
    cluster_sizes,
    clusters,
    degrees,
    fano_factor,
    nearest_distances,
)
from pogosim.analysis.trajectories import Trajectories
from pogosim.command.parser import warn
from pogosim.confidence import mean_over_runs
from pogosim.fonts import literal
from pogosim.outputs import OutputError, leads_to
from pogosim.reports.command_lines import NEIGHBOURS
from pogosim.reports.each_run import for_each_run
from pogosim.reports.figures import draw_bands, draw_each_run, draw_over_time, new_figure, save
from pogosim.reports.groups import by_combination
from pogosim.reports.options import labelled, output_folder, read_runs, write_table

STATISTICS = "neighbors_stats.pkl"


@dataclass(frozen=True)
class Found:
    """What was found out about one run."""

    time: pd.DataFrame  # a row per time
    histogram: pd.DataFrame  # a row per degree
    distance_mm: pd.DataFrame  # from each robot (columns) to its neighbours, in the mean; a row per time
    unknown: int  # listed ids that are no robot's


def analyze(options: Namespace, prog: str) -> None:
    """Compute everything, then write tables and figures."""
    runs = read_runs(options, prog)
    work = functools.partial(neighbours_of, column=options.neighborsCol, count=options.k)
    found = for_each_run(work, runs, options, "neighbours")
    unknown = sum(own.unknown for own in found)
    if unknown:
        warn(prog, f"{unknown} of the listed ids are of no robot in the data; they are left out")
    folder = output_folder(options)
    time = pd.concat([labelled(own.time, run) for run, own in zip(runs, found, strict=True)])
    histogram = pd.concat([labelled(own.histogram, run) for run, own in zip(runs, found, strict=True)])
    write_table(time, folder / "neighbors_time.csv", options.input)
    write_table(histogram, folder / "neighbors_degree_histogram.csv", options.input)
    distances = by_combination(runs, [own.distance_mm for own in found])
    bands = {"run": over_runs(distances), "robot": over_robots(distances)}
    bands = {basis: own for basis, own in bands.items() if options.statBasis in (basis, "both")}
    write_statistics(folder / STATISTICS, options.input, time, histogram, bands)
    listed = column_of(runs[0], options.neighborsCol)
    to_whom = "neighbours listed" if listed else "nearest neighbour" if options.k == 1 else f"{options.k} nearest"
    for basis, curves in bands.items():
        save_distances(curves, f"distance to {to_whom} (mm)", folder / f"knn_{basis}")
    save_degrees(runs, found, folder)


def column_of(run: Trajectories, wanted: str | None) -> str | None:
    """Return the column with lists of neighbours: the wanted one, the usual one if it is there, or none."""
    return wanted if wanted is not None else NEIGHBOURS if NEIGHBOURS in run.rows else None


def neighbours_of(run: Trajectories, column: str | None, count: int) -> Found:
    """Compute everything about a run, given the column that is wanted."""
    return find(run, column_of(run, column), count)


def find(run: Trajectories, column: str | None, count: int) -> Found:
    """Compute everything about a run."""
    degree = degrees(run)
    sizes = cluster_sizes(clusters(run))
    robots = run.is_there.sum(axis=1)
    if column is None:
        distance = mean_of_last(nearest_distances(run, count))
        unknown = 0
    else:
        listed = listed_neighbours(run, column)
        distance, unknown = listed_distance(run, listed), listed.unknown
    time = pd.DataFrame(
        {
            "time": run.time_s,
            "n_robots": robots,
            "neighbor_distance": mean_of_last(distance),
            "mean_degree": mean_of_last(degree),
            "fano_factor": fano_factor(degree),
            "n_clusters": (sizes > 0).sum(axis=1),
            "largest_cluster_fraction": np.divide(
                sizes.max(axis=1, initial=0), robots, out=np.full(len(robots), np.nan), where=robots > 0
            ),
        }
    )
    return Found(time, degree_histogram(degree), pd.DataFrame(distance, index=run.time_s), unknown)


def mean_of_last(values: Floats) -> Floats:
    """Return the mean along the last axis, without NaN; NaN where there is nothing else."""
    flat = pd.DataFrame(values.reshape(-1, values.shape[-1]))
    return flat.mean(axis=1).to_numpy(float).reshape(values.shape[:-1])


def degree_histogram(degree: Floats) -> pd.DataFrame:
    """Count robots by degree: at all times together, at the first, and at the last one. Shape (T, N)."""
    length = int(np.nanmax(degree)) + 1

    def counts(some: Floats) -> Integers:
        return np.bincount(some[np.isfinite(some)].astype(np.int64), minlength=length)

    columns = {"count": counts(degree), "count_first": counts(degree[0]), "count_last": counts(degree[-1])}
    return pd.DataFrame({"degree": np.arange(length), **columns})


def over_runs(distances: dict[str, list[pd.DataFrame]]) -> dict[str, pd.DataFrame]:
    """Average over the robots of each run: a column per run of each combination."""
    return {
        name: pd.DataFrame({number: own.mean(axis=1) for number, own in enumerate(runs)})
        for name, runs in distances.items()
    }


def over_robots(distances: dict[str, list[pd.DataFrame]]) -> dict[str, pd.DataFrame]:
    """Take the robots of all runs of a combination together: a column per robot."""
    return {name: pd.concat(runs, axis=1, ignore_index=True) for name, runs in distances.items()}


def write_statistics(
    path: Path,
    inputs: Sequence[str],
    time: pd.DataFrame,
    histogram: pd.DataFrame,
    bands: dict[str, dict[str, pd.DataFrame]],
) -> None:
    """Write all tables, and the curves of the figures, as a pickled dictionary of dataframes."""
    if any(leads_to(path, name) for name in inputs):
        raise OutputError(f"{path} is an input; choose another folder with -o")
    tables = {"time": time, "degree_histogram": histogram}
    for basis, curves in bands.items():
        parts = [
            mean_over_runs(own).rename_axis("time").reset_index().assign(combination=name)
            for name, own in curves.items()
        ]
        tables[f"knn_{basis}"] = pd.concat(parts, ignore_index=True).rename(columns={"runs": "n"})
    with path.open("wb") as file:
        pickle.dump({name: table.reset_index(drop=True) for name, table in tables.items()}, file, protocol=4)


def save_distances(curves: dict[str, pd.DataFrame], label: str, path: Path) -> None:
    """Save a figure of distances over time, with confidence bands over runs or robots."""
    figure, axes = new_figure()
    draw_bands(axes[0, 0], {name: [own[column] for column in own] for name, own in curves.items()})
    axes[0, 0].set_xlabel("time (s)")
    axes[0, 0].set_ylabel(label)
    save(figure, path)


def save_degrees(runs: Sequence[Trajectories], found: Sequence[Found], folder: Path) -> None:
    """Save the figures of degrees: Fano factor and histograms, over runs and run by run."""
    groups = by_combination(runs, [own.time for own in found])
    figure, axes = new_figure()
    draw_over_time(axes[0, 0], groups, "fano_factor", "Fano factor of the degrees")
    save(figure, folder / "fano_factor_over_time_corrected")
    figure, axes = new_figure()
    draw_each_run(
        axes[0, 0],
        {name: [own.set_index("time")["fano_factor"] for own in tables] for name, tables in groups.items()},
    )
    axes[0, 0].set(xlabel="time (s)", ylabel="Fano factor of the degrees")
    axes[0, 0].set_ylim(bottom=0.0)
    save(figure, folder / "fano_factor_over_time_all_runs")
    histograms = by_combination(runs, [own.histogram.set_index("degree") for own in found])
    shares = {name: shares_of(own, "count") for name, own in histograms.items()}
    for draw, name in ((draw_bands, ""), (draw_each_run, "_all_runs")):
        figure, axes = new_figure()
        draw(axes[0, 0], shares)
        axes[0, 0].set(xlabel="degree (neighbours of a robot)", ylabel="share of robots")
        axes[0, 0].set_ylim(bottom=0.0)
        axes[0, 0].xaxis.set_major_locator(MaxNLocator(integer=True))
        save(figure, folder / f"overall_neighbor_degree_histogram{name}")
    save_first_and_last(histograms, folder / "degree_histogram_first_last")


def shares_of(histograms: Sequence[pd.DataFrame], column: str) -> list[pd.Series[Any]]:
    """Return histograms as shares of all robots, all of the same length."""
    length = max(len(own) for own in histograms)
    filled = [own[column].reindex(range(length), fill_value=0) for own in histograms]
    return [own / max(own.sum(), 1) for own in filled]


def save_first_and_last(histograms: dict[str, list[pd.DataFrame]], path: Path) -> None:
    """Save a figure with a panel for each combination: degrees at the first and at the last time, over runs."""
    columns = min(len(histograms), 3)
    figure, axes = new_figure(columns, -(-len(histograms) // columns), width=5.0)
    for panel in axes.ravel()[len(histograms) :]:
        panel.set_axis_off()
    for panel, (name, own) in zip(axes.ravel(), histograms.items(), strict=False):
        for offset, column, colour, label in (
            (-0.2, "count_first", "tab:gray", "first time"),
            (0.2, "count_last", "tab:blue", "last time"),
        ):
            share = pd.DataFrame(dict(enumerate(shares_of(own, column)))).mean(axis=1)
            panel.bar(share.index + offset, share, width=0.4, color=colour, label=label)
        panel.set(xlabel="degree (neighbours of a robot)", ylabel="share of robots")
        panel.xaxis.set_major_locator(MaxNLocator(integer=True))
        if len(histograms) > 1:
            panel.set_title(literal(name), fontsize="medium")
        panel.legend(frameon=False, fontsize="small")
    save(figure, path)
