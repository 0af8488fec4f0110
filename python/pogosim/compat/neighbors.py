"""Tables of `pogosim analyze neighbors`."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

import pandas as pd

from pogosim.analysis.trajectories import Trajectories
from pogosim.compat.table_function import Table, table_function
from pogosim.reports.command_lines import neighbors
from pogosim.reports.neighbors import Found, column_of, find
from pogosim.reports.options import labelled


def found_in(run: Trajectories, options: argparse.Namespace) -> Found:
    """Compute everything about a run."""
    return find(run, column_of(run, options.neighborsCol), options.k)


def over_time(runs: Sequence[Trajectories], options: argparse.Namespace) -> pd.DataFrame:
    """Return distances, degrees and clusters: a row for each time."""
    return pd.concat([labelled(found_in(run, options).time, run) for run in runs])


def by_degree(runs: Sequence[Trajectories], options: argparse.Namespace) -> pd.DataFrame:
    """Return the number of robots by degree."""
    return pd.concat([labelled(found_in(run, options).histogram, run) for run in runs])


FUNCTIONS: dict[str, Table] = {
    "compute_neighbors_time": table_function("compute_neighbors_time", neighbors, over_time),
    "compute_neighbors_degree_histogram": table_function("compute_neighbors_degree_histogram", neighbors, by_degree),
}
