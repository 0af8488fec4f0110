"""Tables of `pogosim analyze collective`."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

import pandas as pd

from pogosim.analysis.trajectories import Trajectories
from pogosim.compat.table_function import Table, table_function
from pogosim.reports.collective import joined_table, settings_of
from pogosim.reports.collective_metrics import METRICS, Metric
from pogosim.reports.collective_swarm import Swarm
from pogosim.reports.command_lines import collective


def function_of(metric: Metric) -> Table:
    """Return the function of a metric."""

    def of_runs(runs: Sequence[Trajectories], options: argparse.Namespace) -> pd.DataFrame:
        settings = settings_of(options, runs)
        return joined_table(runs, [metric.compute(Swarm(run, settings)) for run in runs])

    return table_function(f"compute_{metric.key}", collective, of_runs)


FUNCTIONS: dict[str, Table] = {f"compute_{metric.key}": function_of(metric) for metric in METRICS}
