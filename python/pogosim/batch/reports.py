"""What a batch shows about its runs: how many are done, their warnings, and those that failed."""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NoReturn

from tqdm import tqdm

from pogosim.batch.run import Outcome, Task

log = logging.getLogger("pogobatch")

SHOWN_FAILURES = 5
SHOWN_WARNINGS = 10


@dataclass(frozen=True)
class Failure:
    """A run that failed, again and again."""

    task: Task
    outcome: Outcome
    output: str


def progress_bar(total: int) -> tqdm[NoReturn]:
    """Return a bar with the time left, on standard error if that is a terminal."""
    is_shown = total > 0 and sys.stderr is not None and sys.stderr.isatty()
    # Some terminals have no size; the bar would be empty.
    has_size = is_shown and os.get_terminal_size(sys.stderr.fileno()).columns > 0
    size = {"dynamic_ncols": True} if has_size else {"ncols": 80, "nrows": 24}
    return tqdm(total=total, unit="run", disable=not is_shown, file=sys.stderr, smoothing=0.05, **size)


def report_warnings(warnings: Iterable[str]) -> None:
    """Say what simulators have warned about; of many warnings the first ones, and how many there are."""
    lines = list(warnings)
    for line in lines[:SHOWN_WARNINGS]:
        log.warning("warning of a run: %s", line)
    if len(lines) > SHOWN_WARNINGS:
        log.warning("not shown: %d more warning(s) of runs; a single run prints its own", len(lines) - SHOWN_WARNINGS)


def report_failures(failures: Sequence[Failure]) -> None:
    """Say which runs failed, with what is needed to repeat them."""
    for failure in failures[:SHOWN_FAILURES]:
        task, outcome = failure.task, failure.outcome
        times = f"{task.retries + 1} time{'s' if task.retries else ''}"
        log.error("run %d of %s, seed %d, failed %s: %s", task.run, failure.output, task.seed, times, outcome.problem)
        if outcome.command:
            log.error("  command: %s", outcome.command)
        for line in outcome.log.splitlines():
            log.error("  | %s", line)
    if len(failures) > SHOWN_FAILURES:
        seeds = ", ".join(str(failure.task.seed) for failure in failures[SHOWN_FAILURES:][:20])
        log.error("%d more runs failed, with the seeds %s", len(failures) - SHOWN_FAILURES, seeds)
