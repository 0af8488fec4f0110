"""The tables of `pogosim analyze` as functions of rows, see `pogosim.compat`."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import pandas as pd

from pogosim.analysis.coverage import coverage_over_time
from pogosim.analysis.network import averaged_spectra, graph_over_time, instantaneous_spectra
from pogosim.analysis.trajectories import Trajectories, trajectories_of
from pogosim.command.parser import Parser
from pogosim.errors import AnalysisError
from pogosim.reports import command_lines, locomotion_tables
from pogosim.reports.collective import joined_table, settings_of
from pogosim.reports.collective_metrics import METRICS, Metric
from pogosim.reports.collective_swarm import Swarm
from pogosim.reports.coverage import named
from pogosim.reports.neighbors import Found, column_of, find
from pogosim.reports.network import windows_of
from pogosim.reports.options import labelled

Table = Callable[..., pd.DataFrame]
OfRuns = Callable[[Sequence[Trajectories], argparse.Namespace], pd.DataFrame]
OfRun = Callable[[Trajectories, argparse.Namespace], pd.DataFrame]

INPUT_AND_OUTPUT = ("arenas_dir", "config", "input", "no_csv", "no_extended_infos", "output_dir", "run")


def options_of(parser: Callable[[str], Parser], function: str, given: Mapping[str, Any]) -> argparse.Namespace:
    """Return the options of an analysis, with the values that are given for some of them.

    Raises:
        TypeError: The analysis has no such option.
    """
    options = parser(function).parse_args([])
    known = [name for name in vars(options) if name not in INPUT_AND_OUTPUT]
    for name, value in given.items():
        if name not in known:
            raise TypeError(f"{function}() has no option '{name}'; it has {', '.join(known)}")
        setattr(options, name, value)
    return options


def table_function(name: str, parser: Callable[[str], Parser], of_runs: OfRuns) -> Table:
    """Return the function `name` of rows, for the table that `of_runs` makes of their runs."""

    def compute(rows: pd.DataFrame, metadata: Mapping[str, Any] | None = None, **options: Any) -> pd.DataFrame:
        own = options_of(parser, name, options)
        runs = trajectories_of(rows, metadata, own.category)
        if own.rc is not None:
            runs = [replace(run, sizes=run.sizes.with_reach(own.rc)) for run in runs]
        return of_runs(runs, own).reset_index(drop=True)

    compute.__name__ = compute.__qualname__ = name
    compute.__doc__ = f"""Return the table {name.removeprefix("compute_")}.csv of all runs, see `pogosim.compat`.

        Args:
            rows: As `pogosim.utils.load_dataframe` returns them.
            metadata: See `trajectories_of`.
            options: Those that the command line has, by their names there.

        Raises:
            AnalysisError: The rows do not allow it.
            TypeError: There is no such option.
        """
    return compute


# ---- Tables of all runs, made of a table for each ----


def of_each(of_run: OfRun) -> OfRuns:
    """Return what joins the tables of runs, each with the labels of its run."""
    return lambda runs, options: pd.concat([labelled(of_run(run, options), run) for run in runs])


def of_metric(metric: Metric) -> OfRuns:
    """Return what makes the table of a metric of `pogosim analyze collective`."""

    def of_runs(runs: Sequence[Trajectories], options: argparse.Namespace) -> pd.DataFrame:
        settings = settings_of(options, runs)
        return joined_table(runs, [metric.compute(Swarm(run, settings)) for run in runs])

    return of_runs


def of_locomotion(of_run: OfRun) -> OfRuns:
    """Return what joins the tables of `pogosim analyze locomotion`, which have the labels of their runs."""
    return lambda runs, options: locomotion_tables.joined([of_run(run, options) for run in runs])


def neighbours_in(run: Trajectories, options: argparse.Namespace) -> Found:
    """Compute what `pogosim analyze neighbors` does of a run."""
    return find(run, column_of(run, options.neighborsCol), options.k)


def averaged(name: str) -> OfRuns:
    """Return what makes the spectra of graphs that are averaged over the windows of time of a table."""

    def of_runs(runs: Sequence[Trajectories], options: argparse.Namespace) -> pd.DataFrame:
        windows = windows_of(runs, options.avg_window_s)
        own = windows.get(name)
        if own is None:
            which = "without" if name in windows_of(runs, None) else "with"
            raise AnalysisError(
                f"compute_{name}: the table is that {which} the option avg_window_s; with this call, there is "
                + " and ".join(f"compute_{other}" for other in windows)
            )
        return pd.concat(
            [
                labelled(averaged_spectra(run, window_s, options.k_first, zero_tol=options.zero_tol), run)
                for run, window_s in zip(runs, own, strict=True)
            ]
        )

    return of_runs


# By the name of the module: the options of its analysis, and its tables.
TABLES: dict[str, tuple[Callable[[str], Parser], dict[str, OfRuns]]] = {
    "am": (command_lines.collective, {metric.key: of_metric(metric) for metric in METRICS}),
    "coverage": (
        command_lines.coverage,
        {
            "voronoi_metrics_per_arena": lambda runs, _: pd.concat(
                [named(coverage_over_time(run), run) for run in runs]
            ),
        },
    ),
    "locomotion": (
        command_lines.locomotion,
        {
            "speed_agent_stats": of_locomotion(lambda run, _: locomotion_tables.agent_table(run)),
            "speed_time_stats": of_locomotion(lambda run, own: locomotion_tables.time_table(run, own.window)),
            "peclet": of_locomotion(lambda run, own: locomotion_tables.peclet_table(run, own.characteristic_length)),
            "msd_per_agent": of_locomotion(lambda run, _: locomotion_tables.msd_per_agent_table(run)),
            "msd_time_stats": of_locomotion(lambda run, _: locomotion_tables.msd_table(run)),
            "autocorrelation": of_locomotion(lambda run, _: locomotion_tables.autocorrelation_table(run)),
        },
    ),
    "neighbors": (
        command_lines.neighbors,
        {
            "neighbors_time": of_each(lambda run, own: neighbours_in(run, own).time),
            "neighbors_degree_histogram": of_each(lambda run, own: neighbours_in(run, own).histogram),
        },
    ),
    "network": (
        command_lines.network,
        {
            "network_graph": of_each(lambda run, _: graph_over_time(run)),
            "instantaneous_eigs": of_each(
                lambda run, own: instantaneous_spectra(run, own.k_first, zero_tol=own.zero_tol)
            ),
            **{name: averaged(name) for name in ("timeavg_eigs", "timeavg_eigs_tau_c", "timeavg_eigs_10dt")},
        },
    ),
}
FUNCTIONS: dict[str, dict[str, Table]] = {
    module: {f"compute_{name}": table_function(f"compute_{name}", parser, of_runs) for name, of_runs in tables.items()}
    for module, (parser, tables) in TABLES.items()
}
