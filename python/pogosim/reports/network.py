"""`pogosim analyze network`: connectedness and Laplacian spectra of the proximity graph, at once and time-averaged."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from pogosim.analysis.network import (
    averaged_spectra,
    contact_time_s,
    graph_over_time,
    instantaneous_spectra,
    ten_periods_s,
)
from pogosim.analysis.trajectories import Trajectories
from pogosim.command.parser import warn
from pogosim.reports.figures import save_over_time, save_violins
from pogosim.reports.groups import by_arena, by_combination, group_names, group_of
from pogosim.reports.options import labelled, output_folder, read_runs, write_table

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
    runs = read_runs(options, prog)
    graphs = [graph_over_time(run) for run in runs]
    count, tol = options.k_first, options.zero_tol
    spectra = {"instantaneous_eigs": [instantaneous_spectra(run, count, zero_tol=tol) for run in runs]}
    for name, windows in windows_of(runs, options.avg_window_s).items():
        spectra[name] = [
            averaged_spectra(run, window_s, count, zero_tol=tol) for run, window_s in zip(runs, windows, strict=True)
        ]
        whole = sum(math.isinf(window_s) for window_s in windows)
        if whole:
            warn(prog, f"in {whole} of {len(runs)} runs, robots do not move, or there is one save time: {name} has one "
                       "window there, the whole run")  # fmt: skip
    folder = output_folder(options)
    write_runs(runs, graphs, folder / "network_graph.csv", options.input)
    for name, tables in spectra.items():
        write_runs(runs, tables, folder / f"{name}.csv", options.input)
    for name, tables in {"network_graph": graphs, **spectra}.items():
        for arena, (own_runs, own_tables) in by_arena(runs, tables).items():
            panels = GRAPH_PANELS if name == "network_graph" else SPECTRUM_PANELS
            save_over_time(own_runs, own_tables, panels, folder / f"{name}_line__arena_{arena}")
            save_violins(own_runs, own_tables, panels, folder / f"{name}_violin__arena_{arena}")


def windows_of(runs: Sequence[Trajectories], window_s: float | None) -> dict[str, list[float]]:
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


def write_runs(runs: Sequence[Trajectories], tables: Sequence[pd.DataFrame], path: Path, inputs: Sequence[str]) -> None:
    """Write the tables of all runs as one."""
    write_table(pd.concat([labelled(table, run) for run, table in zip(runs, tables, strict=True)]), path, inputs)
