"""What a search leaves in its folder: tables, configurations, and a summary."""

from __future__ import annotations

import contextlib
import json
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pogosim.batch.configurations.combinations import overlay
from pogosim.batch.configurations.configuration import dump_configuration
from pogosim.batch.configurations.names import COLUMNS, FORMAT
from pogosim.batch.errors import cannot
from pogosim.batch.result_files.manifests import write_whole
from pogosim.batch.runs.run_files import with_files_beside
from pogosim.errors import OptimizeError
from pogosim.optimize.history import JOURNAL, Evaluation
from pogosim.optimize.settings import SECTION
from pogosim.optimize.variables import Space, Values, as_json
from pogosim.outputs import leads_to
from pogosim.yaml_1_2 import plain

HISTORY = "opt_history.csv"
HISTORY_TABLE = "opt_history.feather"
BEST = "best_config.yaml"
BEST_ROWS = "best_results.feather"
SUMMARY = "summary.json"
CONVERGENCE = "fitness_vs_eval.png"
ARCHIVE_TABLE = "archive.csv"
QD_ARCHIVE = "qd_archive.csv"  # the same elites, in the form that others' scripts read
ARCHIVE = "archive.png"
ELITES = "elites"
ELITE = re.compile(r"\d{2,}(_\d{2,})*\.yaml")  # what configurations of elites are called
# What a search writes; of pictures, another format, too.
PICTURES = tuple(Path(name).with_suffix(suffix).name for name in (CONVERGENCE, ARCHIVE) for suffix in (".pdf", ".png"))
OUTPUTS = (JOURNAL, HISTORY, HISTORY_TABLE, BEST, BEST_ROWS, SUMMARY, ARCHIVE_TABLE, QD_ARCHIVE, *PICTURES)
NOT_FOR_ONE_RUN = (SECTION, FORMAT, COLUMNS)


@dataclass(frozen=True)
class FreshRuns:
    """What a candidate does in runs that the search has not seen, or how much better it is than another there.

    Attributes:
        seeds: Seeds of the runs that could be judged.
        fitness: Fitness of each, alone; or the difference.
        mean: Their mean.
        low: Lower end of the 95 % confidence interval of the mean, NaN for fewer than two runs.
        high: Upper end.
    """

    seeds: Sequence[int]
    fitness: Sequence[float]
    mean: float
    low: float
    high: float


def check_outputs(folder: Path, inputs: Sequence[str]) -> None:
    """Check that results take the place of no input, under any name of it.

    Raises:
        OptimizeError: One would.
    """
    if folder.exists() and not folder.is_dir():
        raise OptimizeError(f"--output-dir: {folder} is not a folder; choose another one with -o")
    elites = sorted((folder / ELITES).glob("*")) if (folder / ELITES).is_dir() else []
    for path in [*(folder / name for name in OUTPUTS), *elites]:
        for name in inputs:
            if leads_to(path, name):
                raise OptimizeError(f"{name} is an input that {path} would replace; choose another folder with -o")


def remove_elites(folder: Path) -> None:
    """Remove the configurations of elites of an earlier search, and nothing else."""
    for path in (folder / ELITES).glob("*.yaml"):
        if ELITE.fullmatch(path.name) and path.is_file():
            path.unlink()
    with contextlib.suppress(OSError):
        (folder / ELITES).rmdir()  # if nothing else is in it


def remove_stale(folder: Path) -> None:
    """Remove what an earlier search has found.

    Raises:
        BatchError: It cannot be removed.
    """
    try:
        remove_elites(folder)
        for name in OUTPUTS:
            if name != JOURNAL:
                (folder / name).unlink(missing_ok=True)
    except OSError as error:
        raise cannot("remove", error.filename or folder, error) from None


def best_so_far(history: Sequence[Evaluation]) -> pd.Series[float]:
    """Return the greatest fitness up to each evaluation; NaN before the first one that has not failed."""
    fitness = pd.Series([np.nan if e.fitness is None else e.fitness for e in history], dtype=float)
    return fitness.cummax().ffill()


def history_table(history: Sequence[Evaluation]) -> pd.DataFrame:
    """Return all evaluations: number, generation, fitness (NaN: failed), values, features, problem and time of each."""
    columns: dict[str, Any] = {
        "eval": [e.number for e in history],
        "generation": [e.generation for e in history],
        "fitness": pd.Series([e.fitness for e in history], dtype=float),
        "best_so_far": best_so_far(history),
    }
    for attribute in ("values", "features"):
        maps: list[Mapping[str, Any]] = [getattr(e, attribute) for e in history]
        for name in dict.fromkeys(name for entries in maps for name in entries):
            columns[free_name(name, columns)] = plain_column([entries.get(name) for entries in maps])
    columns["problem"] = [e.problem for e in history]
    columns["timestamp"] = [e.timestamp for e in history]
    return pd.DataFrame(columns)


def free_name(name: str, taken: Collection[str]) -> str:
    """Return a name for a column of the user's that no other column has."""
    own = ("problem", "timestamp", "config", "values")
    return free_name(f"user.{name}", taken) if name in taken or name in own else name


def plain_column(values: Sequence[Any]) -> Sequence[Any]:
    """Return values that have one type as they are, and others as text."""
    values = [plain(value) for value in values]
    kinds = {type(value) for value in values if value is not None}
    if int in kinds and any(isinstance(value, int) and abs(value) >= 2**63 for value in values):
        kinds = {list}  # too large for a column of numbers
    if len(kinds) <= 1 and not kinds & {list, dict}:
        return values
    if kinds <= {int, float}:
        return [None if value is None else float(value) for value in values]
    return [None if value is None else str(value) for value in values]


def write_history(folder: Path, history: Sequence[Evaluation]) -> None:
    """Write all evaluations as CSV, with the columns that others' tools have, too, and as Feather.

    Raises:
        BatchError: A file cannot be written.
    """
    lines = pd.DataFrame(
        {
            "eval": [e.number for e in history],
            "fitness": pd.Series([e.fitness for e in history], dtype=float),
            "best_so_far": best_so_far(history),
            "u_internal": [json.dumps(e.point) for e in history],
            "values": [as_json(e.values) for e in history],
            "timestamp": [e.timestamp for e in history],
            "generation": [e.generation for e in history],
            "features": [as_json(dict(e.features)) for e in history],
            "problem": [e.problem for e in history],
            "status": ["failed" if e.fitness is None else "success" for e in history],
            "base_seeds": [json.dumps(list(e.base_seeds)) for e in history],
            "effective_seeds": [json.dumps(list(e.effective_seeds)) for e in history],
            "max_retry_attempt": [e.replacement for e in history],
            "error": [e.problem for e in history],
        }
    )
    write_whole(folder / HISTORY, lambda path: lines.to_csv(path, index=False))
    write_whole(folder / HISTORY_TABLE, lambda path: history_table(history).to_feather(path))


def configuration_text(space: Space, values: Values, folder: Path, notes: Sequence[str]) -> str:
    """Return a configuration with values in it, for the simulator.

    Args:
        space: What was searched.
        values: Values of the variables in use.
        folder: Folder of the configuration that was searched: files beside it are found from elsewhere, too.
        notes: Comments at its beginning.
    """
    entries = space.configuration(values, is_flat=True)
    own = {key: value for key, value in entries.items() if key not in NOT_FOR_ONE_RUN}
    own = with_files_beside(own, folder.absolute())
    kept = {key: entries[key] for key in (FORMAT, COLUMNS) if key in entries}
    comments = "".join(f"# {line}\n" for line in notes)
    return comments + dump_configuration(overlay(own, kept))


def write_text(path: Path, text: str) -> None:
    """Write a text.

    Raises:
        BatchError: It cannot be written.
    """
    write_whole(path, lambda partial: partial.write_text(text))


def write_summary(folder: Path, summary: Mapping[str, Any]) -> None:
    """Write `summary.json`."""
    write_text(folder / SUMMARY, json.dumps(summary, indent=2, default=str, ensure_ascii=False) + "\n")
