"""Tables of `pogosim analyze coverage`."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

import pandas as pd

from pogosim.analysis.coverage import coverage_over_time
from pogosim.analysis.trajectories import Trajectories
from pogosim.compat.table_function import Table, table_function
from pogosim.reports.command_lines import coverage
from pogosim.reports.coverage import named


def of_runs(runs: Sequence[Trajectories], _: argparse.Namespace) -> pd.DataFrame:
    """Return areas of cells and the covered share: a row for each time."""
    return pd.concat([named(coverage_over_time(run), run) for run in runs])


FUNCTIONS: dict[str, Table] = {
    "compute_voronoi_metrics_per_arena": table_function("compute_voronoi_metrics_per_arena", coverage, of_runs)
}
