"""Tables of `pogosim analyze locomotion`."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence

import pandas as pd

from pogosim.analysis.trajectories import Trajectories
from pogosim.compat.table_function import Table, table_function
from pogosim.reports.command_lines import locomotion
from pogosim.reports.locomotion_tables import (
    agent_table,
    autocorrelation_table,
    joined,
    msd_per_agent_table,
    msd_table,
    peclet_table,
    time_table,
)

OfRun = Callable[[Trajectories, argparse.Namespace], pd.DataFrame]


def function_of(name: str, of_run: OfRun) -> Table:
    """Return the function of a table."""

    def of_runs(runs: Sequence[Trajectories], options: argparse.Namespace) -> pd.DataFrame:
        return joined([of_run(run, options) for run in runs])

    return table_function(f"compute_{name}", locomotion, of_runs)


TABLES: dict[str, OfRun] = {
    "speed_agent_stats": lambda run, _: agent_table(run),
    "speed_time_stats": lambda run, options: time_table(run, options.window),
    "peclet": lambda run, options: peclet_table(run, options.characteristic_length),
    "msd_per_agent": lambda run, _: msd_per_agent_table(run),
    "msd_time_stats": lambda run, _: msd_table(run),
    "autocorrelation": lambda run, _: autocorrelation_table(run),
}
FUNCTIONS: dict[str, Table] = {f"compute_{name}": function_of(name, of_run) for name, of_run in TABLES.items()}
