"""What a batch writes down of itself in JSON: `pogobatch_task.json` of a run, and `pogobatch_run.json` of all."""

from __future__ import annotations

import hashlib
import json
import math
import uuid
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pogosim
from pogosim.arguments import is_text
from pogosim.batch.configurations.option_words import shown
from pogosim.batch.configurations.seeds import LARGEST, seeds_between
from pogosim.batch.errors import BatchError, cannot, check_is_file, given, is_whole, one_line
from pogosim.batch.runs.run import FRAMES, Task
from pogosim.batch.runs.tasks import Combination
from pogosim.outputs import OutputError, partial_output, real_output
from pogosim.yaml_1_2 import plain

TASK = "pogobatch_task.json"
TASK_VERSION = 2
TASK_VERSIONS = (1, 2)  # that can be read
CAMPAIGN = "pogobatch_run.json"
CAMPAIGN_VERSION = 1
NAMESPACE = uuid.UUID("6f6a0f0e-2a43-5d1e-9d0b-7b6f676f7369")

# What manifests of runs have that is read, with the largest number, or None for a text; every one has the first four.
MOST = 2**63 - 1
KNOWN = {
    **{"seed": LARGEST, "logical_run": MOST, "result_filename": None, "data_file": None},
    **{"retry_attempt": MOST, "combination_ordinal": MOST, "config_hash": None, "program_hash": None},
    **{"batch_combinations": MOST, "batch_seeds": None},
}
NEEDED = list(KNOWN)[:4]


def for_json(value: Any) -> Any:
    """Return a value of a configuration with the types that JSON has; infinity and NaN as text."""
    if isinstance(value, Mapping):
        return {str(key): for_json(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [for_json(item) for item in value]
    value = plain(value)
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def task_entries(
    combination: Combination, task: Task, replacement: int, ordinal: int, choices: Mapping[str, Any]
) -> dict[str, Any]:
    """Return what `pogobatch_task.json` says of a run.

    Args:
        combination: The combination of options that it belongs to.
        task: The run.
        replacement: Which replacement its seed is; 0: its own.
        ordinal: Number of the combination, from 0 on.
        choices: What tells the combination from others: keys and values.
    """
    digest, seed = combination.config_hash, task.seed_of(replacement)
    return {
        "schema_version": TASK_VERSION,
        # The same run always has the same one.
        "task_uuid": str(uuid.uuid5(NAMESPACE, f"{digest} {task.run} {seed} {replacement}")),
        "seed": seed,
        "logical_run": task.run,
        "retry_attempt": replacement,
        "combination_ordinal": ordinal,
        "config_hash": digest,
        "result_filename": combination.name,
        "extra_columns": for_json(combination.columns),
        "batch_choices": for_json(choices),
        "data_file": f"{FRAMES}/{task.data}",
        "program_hash": hashlib.sha256(task.settings.program_digest.encode()).hexdigest()[:16],
        "pogosim_version": pogosim.__version__,
    }


def batch_entries(combination: Combination, combinations: int) -> dict[str, Any]:
    """Return what `pogobatch_task.json` also says of the batch that a run is of, so that a merge knows what is missing.

    Args:
        combination: The combination of options that the run belongs to.
        combinations: How many the batch has.
    """
    seeds = {"batch_seeds": combination.seeds} if combination.seeds else {}
    return {"batch_combinations": combinations, **seeds}


def write_json(path: Path, entries: Mapping[str, Any]) -> Path:
    """Write a file in JSON, which appears as a whole; returns its path.

    Raises:
        BatchError: It cannot be written.
    """
    text = json.dumps(entries, indent=2, ensure_ascii=False) + "\n"
    return write_whole(path, lambda partial: partial.write_text(text, encoding="utf-8"))


def write_whole(path: Path, writer: Callable[[Path], object]) -> Path:
    """Write a file, which appears when it is complete, and the folders that it is in; returns its path.

    Raises:
        BatchError: It cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with partial_output(real_output(path)) as partial:
            writer(partial)
    except OSError as error:
        raise cannot("write", path, error) from None
    except OutputError as error:
        raise BatchError(str(error)) from None
    return path


def read_manifest(path: Path) -> dict[str, Any]:
    """Read `pogobatch_task.json`.

    Raises:
        BatchError: It cannot be read, or is not what a batch writes.
    """
    try:
        check_is_file(path)
        entries = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise cannot("read", path, error) from None
    except (ValueError, RecursionError) as error:
        raise BatchError(f"{path} is no manifest of a run: {one_line(error)}") from None
    version = entries.get("schema_version") if isinstance(entries, dict) else None
    if version not in TASK_VERSIONS or isinstance(version, bool):
        raise BatchError(f"{path}: schema_version: expected 1 or {TASK_VERSION}, found {shown(version)}")
    for name, most in KNOWN.items():
        if (value := entries.get(name)) is None and name not in NEEDED:
            continue
        if most is None and not is_text(value):
            raise BatchError(f"{path}: {name}: expected a text, found {shown(value)}")
        if most is not None and not (is_whole(value) and 0 <= value <= most):
            raise BatchError(f"{path}: {name}: expected a whole number from 0 to {most}, found {shown(value)}")
    if (seeds := entries.get("batch_seeds")) is not None:
        seeds_between(seeds, f"{path}: batch_seeds")
    columns = entries.get("extra_columns", {})
    if not isinstance(columns, dict):
        raise BatchError(f"{path}: extra_columns: expected a map, found {shown(columns)}")
    try:
        given.value("extra_columns", columns)
    except BatchError as error:
        raise BatchError(f"{path}: {error}") from None
    return dict(entries)


def check_campaign(path: Path) -> None:
    """Check that a manifest of all runs may take the place of what is there.

    Raises:
        BatchError: Something else is there.
    """
    if not path.exists() and not path.is_symlink():
        return
    try:
        entries = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        entries = None
    if not isinstance(entries, dict) or "schema_version" not in entries:
        raise BatchError(f"{path} is there and was not written by pogobatch; it will not be overwritten: remove it")
