"""Tables of `pogosim analyze network`."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

import pandas as pd

from pogosim.analysis.network import averaged_spectra, graph_over_time, instantaneous_spectra
from pogosim.analysis.trajectories import Trajectories
from pogosim.compat.table_function import Table, table_function
from pogosim.errors import AnalysisError
from pogosim.reports.command_lines import network
from pogosim.reports.network import windows_of
from pogosim.reports.options import labelled


def graphs(runs: Sequence[Trajectories], _: argparse.Namespace) -> pd.DataFrame:
    """Return components and degrees: a row for each time."""
    return pd.concat([labelled(graph_over_time(run), run) for run in runs])


def at_once(runs: Sequence[Trajectories], options: argparse.Namespace) -> pd.DataFrame:
    """Return the spectra of the graphs of each time."""
    own = [instantaneous_spectra(run, options.k_first, zero_tol=options.zero_tol) for run in runs]
    return pd.concat([labelled(table, run) for run, table in zip(runs, own, strict=True)])


def averaged(name: str) -> Table:
    """Return the function for spectra of graphs that are averaged over the windows of time of a table."""

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

    return table_function(f"compute_{name}", network, of_runs)


FUNCTIONS: dict[str, Table] = {
    "compute_network_graph": table_function("compute_network_graph", network, graphs),
    "compute_instantaneous_eigs": table_function("compute_instantaneous_eigs", network, at_once),
    "compute_timeavg_eigs": averaged("timeavg_eigs"),
    "compute_timeavg_eigs_tau_c": averaged("timeavg_eigs_tau_c"),
    "compute_timeavg_eigs_10dt": averaged("timeavg_eigs_10dt"),
}
