"""Columns by which the tools tell runs apart. A program's own columns need other names where runs are joined."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd  # takes a while

RUN = "run"  # the number of the run in a batch, or of the file among several
SEED = "seed"
NUMBERS = "run_numbers"  # in an entry of the metadata `combinations`
RETRY = "retry_attempt"  # which replacement the seed of the run is, after failures; 0: its own seed
NAMES = (RUN, SEED, "arena_file")  # kColumnsOfRuns in src/tables/columns.cpp
KEYS = ("objects.", "parameters.")  # how dotted paths of configuration keys begin; kKeysOfRuns there

# What an object has in one row at each time.
OBJECT_AND_TIME = ("time", "robot_category", "robot_id", "subpart_id")


def tells_runs_apart(name: str) -> bool:
    """Tell whether a column of this name says which run a row is of."""
    return name in NAMES or name.startswith(KEYS)


def named_columns(metadata: Mapping[str, Any]) -> list[str] | None:
    """Return the columns that a batch was asked for: its `result_new_columns`, perhaps in its map `pogobatch`."""
    configuration = metadata.get("configuration")
    entries = configuration if isinstance(configuration, dict) else {}
    own = entries.get("pogobatch")
    named = {**entries, **(own if isinstance(own, dict) else {})}.get("result_new_columns")
    return [named] if isinstance(named, str) else named if isinstance(named, list) else None


def is_one_run(rows: pd.DataFrame, metadata: Mapping[str, Any]) -> bool:
    """Tell whether the rows are those that a single run wrote, so that all their columns are the program's or ours.

    The file of a single run says its version, has no combinations, and has each object once at each time.
    """
    return may_be_one_run(metadata) and not rows.duplicated([name for name in OBJECT_AND_TIME if name in rows]).any()


def may_be_one_run(metadata: Mapping[str, Any]) -> bool:
    """Tell whether metadata are those of the file of a single run, whatever its rows are."""
    is_batch = named_columns(metadata) is not None
    return not (is_batch or metadata.get("combinations") or "files" in metadata) and "program_version" in metadata


def run_numbers(combination: Mapping[str, Any]) -> list[int]:
    """Return what the column `run` has for the runs of a combination, by its entry in the metadata `combinations`.

    Raises:
        KeyError, TypeError, ValueError: The entry is not what a batch writes.
    """
    if NUMBERS in combination:
        return [int(run) for run in combination[NUMBERS]]
    failed = [int(run) for run in combination.get("failed_runs", [])]
    return [run for run in range(int(combination["runs"]) + len(failed)) if run not in failed]
