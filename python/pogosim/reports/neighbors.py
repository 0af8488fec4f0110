"""`pogosim analyze neighbors`: distances to neighbours, degrees, their Fano factor and clusters over time."""

from __future__ import annotations

import functools
import pickle
import tempfile
from argparse import Namespace
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import IO, Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
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
from pogosim.analysis.snapshots import times_of
from pogosim.analysis.trajectories import Run, Trajectories
from pogosim.command.parser import warn
from pogosim.confidence import mean_over_runs
from pogosim.fonts import literal
from pogosim.outputs import OutputError, leads_to
from pogosim.reports.command_lines import NEIGHBOURS
from pogosim.reports.each_run import for_each_run
from pogosim.reports.figures import (
    draw_bands,
    draw_each_run,
    draw_means,
    drawn_by_combination,
    from_zero,
    new_figure,
    save,
)
from pogosim.reports.groups import by_combination
from pogosim.reports.options import labelled, open_runs, output_folder, write_table

STATISTICS = "neighbors_stats.pkl"
MAX_CELLS = 200_000  # distances of robots that are averaged at once


@dataclass(frozen=True)
class Distances:
    """The distance from each robot of a run to its neighbours at each time, in a file. T times, N robots."""

    path: Path  # (T, N), mm, doubles of the machine
    time_s: Floats  # (T,)
    robots: int

    def at(self, time_s: Floats) -> pd.DataFrame:
        """Return those at some of the times, a row per time that the run has."""
        place = np.searchsorted(self.time_s, time_s)
        is_there = self.time_s[np.minimum(place, len(self.time_s) - 1)] == time_s
        place = place[is_there]
        found = [np.empty((0, self.robots))]
        for part in np.split(place, np.flatnonzero(np.diff(place) != 1) + 1):
            begin = 8 * self.robots * int(part[0]) if len(part) else 0
            values = np.fromfile(self.path, dtype=float, count=len(part) * self.robots, offset=begin)
            found.append(values.reshape(-1, self.robots))
        return pd.DataFrame(np.concatenate(found), index=self.time_s[place])


@dataclass(frozen=True)
class Found:
    """What was found out about one run."""

    time: pd.DataFrame  # a row per time
    histogram: pd.DataFrame  # a row per degree
    distance_mm: pd.Series[float]  # from robots to their neighbours, in the mean over robots, by time
    unknown: int  # listed ids that are no robot's
    of_robots: Distances | None = None  # the distances of each robot


def analyze(options: Namespace, prog: str) -> None:
    """Compute everything, then write tables and figures."""
    runs = open_runs(options, prog)
    with tempfile.TemporaryDirectory(prefix="pogosim_neighbors_") as scratch:
        work = functools.partial(neighbours_of, column=options.neighborsCol, count=options.k)
        each = [(run, Path(scratch, str(number))) for number, run in enumerate(runs)]
        found = for_each_run(work, each, options, "neighbours")
        bands = {
            basis: {name: over(own) for name, own in by_combination(runs, found).items()}
            for basis, over in (("run", over_runs), ("robot", over_robots))
            if options.statBasis in (basis, "both")
        }
    unknown = sum(own.unknown for own in found)
    if unknown:
        warn(prog, f"{unknown} of the listed ids are of no robot in the data; they are left out")
    folder = output_folder(options)
    time = pd.concat([labelled(own.time, run) for run, own in zip(runs, found, strict=True)])
    histogram = pd.concat([labelled(own.histogram, run) for run, own in zip(runs, found, strict=True)])
    write_table(time, folder / "neighbors_time.csv", options.input)
    write_table(histogram, folder / "neighbors_degree_histogram.csv", options.input)
    write_statistics(folder / STATISTICS, options.input, time, histogram, bands)
    listed = column_of(runs[0], options.neighborsCol)
    to_whom = "neighbours listed" if listed else "nearest neighbour" if options.k == 1 else f"{options.k} nearest"
    for basis in bands:
        save_distances(runs, bands[basis], f"distance to {to_whom} (mm)", folder / f"knn_{basis}")
    save_degrees(runs, found, folder)


def column_of(run: Run, wanted: str | None) -> str | None:
    """Return the column with lists of neighbours: the wanted one, the usual one if it is there, or none."""
    return wanted if wanted is not None else NEIGHBOURS if NEIGHBOURS in run.column_names else None


def neighbours_of(run_and_path: tuple[Run, Path], column: str | None, count: int) -> Found:
    """Compute everything about a run, given the column that is wanted, and a file for the distances of robots."""
    run, path = run_and_path
    with path.open("wb") as file:
        found = find(run, column_of(run, column), count, file)
    return replace(found, of_robots=Distances(path, run.time_s, len(run.robot_id)))


def find(run: Run, column: str | None, count: int, file: IO[bytes] | None = None) -> Found:
    """Compute everything about a run. The distances of robots are written to a file, if there is one."""
    tables, means, histogram, unknown = [], [], Histogram(), 0
    for _, block in run.blocks(times_of(run.present), [] if column is None else [column]):
        degree = degrees(block)
        histogram.add(degree)
        if column is None:
            distance = mean_of_last(nearest_distances(block, count))
        else:
            listed = listed_neighbours(block, column)
            distance, unknown = listed_distance(block, listed), unknown + listed.unknown
        tables.append(over_time(block, degree, mean_of_last(distance)))
        means.append(pd.DataFrame(distance, index=block.time_s).mean(axis=1))
        if file is not None:
            file.write(distance.tobytes())
    return Found(pd.concat(tables, ignore_index=True), histogram.table(), pd.concat(means), unknown)


def over_time(run: Trajectories, degree: Floats, distance: Floats) -> pd.DataFrame:
    """Return a row for each time, given the degrees of robots, and the mean distance to neighbours."""
    sizes = cluster_sizes(clusters(run))
    robots = run.present
    return pd.DataFrame(
        {
            "time": run.time_s,
            "n_robots": robots,
            "neighbor_distance": distance,
            "mean_degree": mean_of_last(degree),
            "fano_factor": fano_factor(degree),
            "n_clusters": (sizes > 0).sum(axis=1),
            "largest_cluster_fraction": np.divide(
                sizes.max(axis=1, initial=0), robots, out=np.full(len(robots), np.nan), where=robots > 0
            ),
        }
    )


def mean_of_last(values: Floats) -> Floats:
    """Return the mean along the last axis, without NaN; NaN where there is nothing else."""
    flat = pd.DataFrame(values.reshape(-1, values.shape[-1]))
    return flat.mean(axis=1).to_numpy(float).reshape(values.shape[:-1])


class Histogram:
    """Counts of robots by degree: at all times together, at the first, and at the last one."""

    def __init__(self) -> None:
        self.every = self.first = self.last = np.zeros(0, dtype=np.int64)

    def add(self, degree: Floats) -> None:
        """Add the degrees at the next times, shape (T, N); NaN is left out."""

        def counts(some: Floats) -> Integers:
            return np.bincount(some[np.isfinite(some)].astype(np.int64))

        if len(self.every) == 0:
            self.first = counts(degree[0])
        self.every, self.last = added(self.every, counts(degree)), counts(degree[-1])

    def table(self) -> pd.DataFrame:
        """Return a row for each degree."""
        length = len(self.every)
        columns = {"count": self.every, "count_first": self.first, "count_last": self.last}
        padded = {name: np.pad(own, (0, length - len(own))) for name, own in columns.items()}
        return pd.DataFrame({"degree": np.arange(length), **padded})


def added(one: Integers, other: Integers) -> Integers:
    """Return the sum of two histograms, of which one may be shorter."""
    length = max(len(one), len(other))
    return np.pad(one, (0, length - len(one))) + np.pad(other, (0, length - len(other)))


def over_runs(found: Sequence[Found]) -> pd.DataFrame:
    """Average over the robots of each run, and then over the runs of a combination, see `mean_over_runs`."""
    return mean_over_runs(pd.DataFrame({number: own.distance_mm for number, own in enumerate(found)}))


def over_robots(found: Sequence[Found]) -> pd.DataFrame:
    """Average over the robots of all runs of a combination together, see `mean_over_runs`; some times at once."""
    distances = [own.of_robots for own in found if own.of_robots is not None]
    time = pd.concat([pd.DataFrame(index=own.time_s) for own in distances], axis=1, ignore_index=True).index
    length = max(MAX_CELLS // sum(own.robots for own in distances), 1)
    parts = []
    for begin in range(0, len(time), length):
        now = time[begin : begin + length]
        together = pd.concat([own.at(now.to_numpy(float)) for own in distances], axis=1, ignore_index=True)
        parts.append(mean_over_runs(together.reindex(now)))
    return pd.concat(parts)


DrawCurves = Callable[[Axes, "dict[str, list[pd.Series[Any]]]", "Mapping[str, Any] | None"], None]


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
        parts = [own.rename_axis("time").reset_index().assign(combination=name) for name, own in curves.items()]
        tables[f"knn_{basis}"] = pd.concat(parts, ignore_index=True).rename(columns={"runs": "n"})
    with path.open("wb") as file:
        pickle.dump({name: table.reset_index(drop=True) for name, table in tables.items()}, file, protocol=4)


def save_distances(runs: Sequence[Run], bands: Mapping[str, pd.DataFrame], label: str, path: Path) -> None:
    """Save a figure of distances over time, with confidence bands over runs or robots."""

    def draw(axes: Axes, groups: dict[str, list[str]], colours: Mapping[str, Any] | None) -> None:
        draw_means(axes, {name: bands[own[0]] for name, own in groups.items()}, colours)
        axes.set(xlabel="time (s)", ylabel=label)
        axes.set_ylim(bottom=max(axes.get_ylim()[0], 0.0))

    numbers = by_combination(runs, range(len(runs)))
    combinations = {number: name for name, own in numbers.items() for number in own}
    save(drawn_by_combination(runs, [combinations[number] for number in range(len(runs))], [draw]), path)


def save_degrees(runs: Sequence[Run], found: Sequence[Found], folder: Path) -> None:
    """Save the figures of degrees: Fano factor and histograms, over runs and run by run."""
    fano = [own.time.set_index("time")["fano_factor"] for own in found]
    histograms = [own.histogram.set_index("degree") for own in found]

    def draw_fano(
        axes: Axes, groups: dict[str, list[pd.Series[Any]]], colours: Mapping[str, Any] | None, draw: DrawCurves
    ) -> None:
        draw(axes, groups, colours)
        axes.set(xlabel="time (s)", ylabel="Fano factor of the degrees")
        from_zero(axes)

    def draw_shares(
        axes: Axes, groups: dict[str, list[pd.DataFrame]], colours: Mapping[str, Any] | None, draw: DrawCurves
    ) -> None:
        draw(axes, {name: shares_of(own, "count") for name, own in groups.items()}, colours)
        axes.set(xlabel="degree (neighbours of a robot)", ylabel="share of robots")
        from_zero(axes)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))

    for draw, ending, name in ((draw_bands, "corrected", ""), (draw_each_run, "all_runs", "_all_runs")):
        figure = drawn_by_combination(runs, fano, [functools.partial(draw_fano, draw=draw)])
        save(figure, folder / f"fano_factor_over_time_{ending}")
        figure = drawn_by_combination(runs, histograms, [functools.partial(draw_shares, draw=draw)])
        save(figure, folder / f"overall_neighbor_degree_histogram{name}")
    save_first_and_last(by_combination(runs, histograms), folder / "degree_histogram_first_last")


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
