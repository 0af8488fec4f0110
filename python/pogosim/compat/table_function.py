"""What all functions of `pogosim.compat` have in common."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import pandas as pd

from pogosim.analysis.trajectories import Trajectories, trajectories_of
from pogosim.command.parser import Parser

Table = Callable[..., pd.DataFrame]
OfRuns = Callable[[Sequence[Trajectories], argparse.Namespace], pd.DataFrame]

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
