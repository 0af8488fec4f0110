"""`pogosim analyze network`: connectedness and Laplacian spectra of the proximity graph, at once and time-averaged."""

from __future__ import annotations

import argparse
import functools
import math
from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from pogosim.analysis.network import (
    AveragedSpectra,
    Connectedness,
    GraphTable,
    InstantaneousSpectra,
    contact_time_s,
    graph_tables,
    ten_periods_s,
)
from pogosim.analysis.trajectories import Run
from pogosim.command.parser import warn
from pogosim.reports.each_run import for_each_run
from pogosim.reports.figures import save_over_time, save_violins
from pogosim.reports.groups import by_arena, by_combination, group_names, group_of
from pogosim.reports.options import labelled, open_runs, output_folder, write_table

GRAPH_PANELS = {
    "n_components": "connected components",
    "largest_component_fraction": "largest component (share of robots)",
    "mean_degree": "mean degree",
}
SPECTRUM_PANELS = {
    "swarm_lambda_nz_1": "smallest non-zero eigenvalue",
    "lcc_lambda_nz_1": "algebraic connectivity\nof the largest component",
    "swarm_lambda_max": "largest eigenvalue",
}


def analyze(options: argparse.Namespace, prog: str) -> None:
    """Compute everything, then write tables and figures."""
    runs = open_runs(options, prog)
    windows = windows_of(runs, options.avg_window_s)
    for name, own in windows.items():
        whole = sum(math.isinf(window_s) for window_s in own)
        if whole:
            warn(prog, f"in {whole} of {len(runs)} runs, robots do not move, or there is one save time: {name} has one "
                       "window there, the whole run")  # fmt: skip
    work = functools.partial(tables_of, count=options.k_first, zero_tol=options.zero_tol)
    each = [(run, {name: own[number] for name, own in windows.items()}) for number, run in enumerate(runs)]
    found = for_each_run(work, each, options, "graphs")
    folder = output_folder(options)
    for name in found[0]:
        tables = [own[name] for own in found]
        write_runs(runs, tables, folder / f"{name}.csv", options.input)
        for arena, (own_runs, own_tables) in by_arena(runs, tables).items():
            panels = GRAPH_PANELS if name == "network_graph" else SPECTRUM_PANELS
            save_over_time(own_runs, own_tables, panels, folder / f"{name}_line__arena_{arena}")
            save_violins(own_runs, own_tables, panels, folder / f"{name}_violin__arena_{arena}")


def tables_of(run_and_windows: tuple[Run, dict[str, float]], count: int, zero_tol: float) -> dict[str, pd.DataFrame]:
    """Return all tables of a run by name, given the windows of those of averaged graphs."""
    run, windows = run_and_windows
    tables: dict[str, GraphTable] = {
        "network_graph": Connectedness(run),
        "instantaneous_eigs": InstantaneousSpectra(run, count, zero_tol),
        **{name: AveragedSpectra(run, window_s, count, zero_tol) for name, window_s in windows.items()},
    }
    return dict(zip(tables, graph_tables(run, list(tables.values())), strict=True))


def windows_of(runs: Sequence[Run], window_s: float | None) -> dict[str, list[float]]:
    """Return the windows of each run by the name of their table."""
    if window_s is not None:
        return {"timeavg_eigs": [window_s] * len(runs)}
    # Runs of one combination have the same windows, so that they can be averaged.
    names = group_names(runs)
    groups = by_combination(runs, runs)
    windows = {
        "timeavg_eigs_tau_c": {name: contact_time_s(own) for name, own in groups.items()},
        "timeavg_eigs_10dt": {name: ten_periods_s(own) for name, own in groups.items()},
    }
    return {name: [own[group_of(run, names)] for run in runs] for name, own in windows.items()}


def write_runs(runs: Sequence[Run], tables: Sequence[pd.DataFrame], path: Path, inputs: Sequence[str]) -> None:
    """Write the tables of all runs as one."""
    write_table(pd.concat([labelled(table, run) for run, table in zip(runs, tables, strict=True)]), path, inputs)
