"""What a batch shows about its runs: how many are done, their warnings, and those that failed."""

from __future__ import annotations

import contextlib
import logging
import os
import sys
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NoReturn

from tqdm import tqdm
from tqdm.contrib.logging import logging_redirect_tqdm

from pogosim.batch.configurations.option_words import shown
from pogosim.batch.runs.run import Outcome, Task
from pogosim.lines import counted, printable

log = logging.getLogger("pogobatch")

SHOWN_FAILURES = 5
SHOWN_WARNINGS = 10
LINE_EVERY_S = 60.0
LINES = 20  # of a batch whose progress is asked for


@dataclass(frozen=True)
class Failure:
    """A run that failed, again and again; `options` are what tells its combination from others."""

    task: Task
    outcome: Outcome
    output: str
    options: dict[str, Any]
    combination: int  # its number, from 0 on


@dataclass(frozen=True)
class Replaced:
    """A run that failed, and was done with another seed."""

    task: Task
    replacement: int  # of its seed, from 1 on
    problem: str  # of its first attempt; empty: another call of the same batch has done it
    output: str
    combination: int  # its number, from 0 on


class Progress:
    """How many runs are done: a bar with the time left on a terminal; elsewhere, as in a log file, a line a minute.

    Args:
        total: How many there are.
        unit: What they are: runs, or something else.
        is_asked_for: Say more than a line a minute: twenty lines, or one for each if they are fewer.
    """

    def __init__(self, total: int, unit: str = "run", is_asked_for: bool = False) -> None:
        self.total = total
        self.unit = unit
        self.done = 0
        self.is_asked_for = is_asked_for
        self.started_s = self.said_s = time.monotonic()
        is_terminal = total > 0 and sys.stderr is not None and sys.stderr.isatty()
        # Some terminals have no size; the bar would be empty.
        has_size = is_terminal and os.get_terminal_size(sys.stderr.fileno()).columns > 0
        size = {"dynamic_ncols": True} if has_size else {"ncols": 80, "nrows": 24}
        self.bar: tqdm[NoReturn] = tqdm(
            total=total, unit=unit, disable=not is_terminal, file=sys.stderr, smoothing=0.05, **size
        )

    def update(self) -> None:
        """Count one more run."""
        self.done += 1
        self.bar.update()
        now_s = time.monotonic()
        is_due = now_s - self.said_s >= LINE_EVERY_S and self.done < self.total
        is_part = self.done * LINES // self.total > (self.done - 1) * LINES // self.total
        if self.bar.disable and (is_due or (self.is_asked_for and is_part)):
            self.said_s = now_s
            left_s = (now_s - self.started_s) / self.done * (self.total - self.done)
            left = tqdm.format_interval(left_s)
            log.info("%d of %d %ss are done; %s left", self.done, self.total, self.unit, left)

    def beside(self, *loggers: logging.Logger) -> contextlib.AbstractContextManager[None]:
        """Let the lines of loggers stand above the bar meanwhile."""
        return contextlib.nullcontext() if self.bar.disable else logging_redirect_tqdm(list(loggers))

    def close(self) -> None:
        """Leave the bar as it is."""
        self.bar.close()


def report_warnings(warnings: Iterable[str]) -> None:
    """Say what simulators have warned about; of many warnings the first ones, and how many there are."""
    lines = list(warnings)
    for line in lines[:SHOWN_WARNINGS]:
        log.warning("warning of a run: %s", line)
    if len(lines) > SHOWN_WARNINGS:
        log.warning("not shown: %d more warning(s) of runs; a single run prints its own", len(lines) - SHOWN_WARNINGS)


def report_replaced(replaced: Sequence[Replaced], count: int, column: str | None) -> None:
    """Say how many runs of how many failed and have other seeds, since that biases a sample.

    Args:
        replaced: These runs.
        count: Number of all runs.
        column: Column of the results that tells them from others; None: there is none.
    """
    if not replaced:
        return
    first = replaced[0]
    log.warning(
        "%d of %s failed and %s%s; the first: run %d of %s, seed %d, is now that of seed %d%s",
        len(replaced),
        counted(count, "run"),
        "was done with another seed" if len(replaced) == 1 else "were done with other seeds",
        f" ({column} > 0)" if column else "",
        first.task.run,
        first.output,
        first.task.seed,
        first.task.seed_of(first.replacement),
        f": {first.problem}" if first.problem else "",
    )


def report_failures(failures: Sequence[Failure]) -> None:
    """Say which runs failed, with what is needed to repeat them."""
    for failure in failures[:SHOWN_FAILURES]:
        task, outcome = failure.task, failure.outcome
        times = f"{outcome.attempts} time{'s' if outcome.attempts > 1 else ''}"
        log.error("run %d of %s, seed %d, failed %s: %s", task.run, failure.output, task.seed, times, outcome.problem)
        if failure.options:
            options = ", ".join(f"{key}: {shown(value)}" for key, value in failure.options.items())
            log.error("  options: %s", printable(options))
        if outcome.command:
            log.error("  command: %s", outcome.command)
        for line in outcome.log.splitlines():
            log.error("  | %s", line)
    if len(failures) > SHOWN_FAILURES:
        seeds = ", ".join(str(failure.task.seed) for failure in failures[SHOWN_FAILURES:][:20])
        log.error("%d more runs failed, with the seeds %s", len(failures) - SHOWN_FAILURES, seeds)
