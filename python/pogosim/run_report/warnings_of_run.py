"""What to know of a run before its numbers are believed: warnings of its log, and of its data file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pogosim.batch.result_files.manifests import TASK
from pogosim.batch.runs.run_log import LOG, warnings_in_log
from pogosim.lines import counted

MOST_WARNINGS = 50  # that a page shows

NOTES = {
    "incomplete": "The run is still going on, or was killed: these are the rows that were saved.",
    "touched": "The run was touched from outside, {}. Configuration and seed alone do not repeat it.",
    "recovered": "{}",
    "continued_from_s": "The run went on from a saved state, at t = {} s; its earlier rows are in another file.",
}


def log_of(data: Path) -> Path | None:
    """Return the log that a batch has kept of the run of a data file; None if there is none.

    It is in the folder of the run, the data file in the folder below it.
    """
    folder = data.resolve().parent.parent
    return folder / LOG if (folder / TASK).is_file() and (folder / LOG).is_file() else None


def warnings_of(metadata: Mapping[str, Any], log: Path | None, others: list[str]) -> list[str]:
    """Return all warnings, each once: of the data file, of the tools that read it, and of the log.

    Args:
        metadata: As of load_dataframe().
        log: What the run printed; None: unknown.
        others: Warnings of reading and computing.

    Raises:
        OSError: The log cannot be read.
    """
    found = [text.format(metadata[name]) for name, text in NOTES.items() if name in metadata]
    found += failures(metadata)
    found += others
    if log is not None:
        found += warnings_in_log(log)
    different = list(dict.fromkeys(found))
    more = len(different) - MOST_WARNINGS
    return different if more <= 0 else [*different[:MOST_WARNINGS], f"... and {counted(more, 'more warning')}"]


def failures(metadata: Mapping[str, Any]) -> list[str]:
    """Tell of runs of a batch that failed."""
    combinations = metadata.get("combinations")
    entries = combinations if isinstance(combinations, list) else []
    lists = [entry.get("failed_runs") for entry in entries if isinstance(entry, dict)]
    failed = sum(len(own) for own in lists if isinstance(own, list))
    return [f"{counted(failed, 'run')} of the batch failed, and {'is' if failed == 1 else 'are'} not here."] * (
        failed > 0
    )
