"""Runs of configurations: those of many at once, and the rows of each as soon as its own are done."""

from __future__ import annotations

import contextlib
import logging
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from pogosim.batch.configurations.combinations import combinations_of
from pogosim.batch.configurations.configuration import Configuration
from pogosim.batch.configurations.names import ambiguous, new_columns, value_at
from pogosim.batch.execution import Execution
from pogosim.batch.reports import report_warnings
from pogosim.batch.result_files.joining import part_of
from pogosim.batch.result_files.parts import WITH_SEEDS
from pogosim.batch.result_files.results import write_results
from pogosim.batch.runs.identity import world_digest
from pogosim.batch.runs.open_batch import OpenBatch
from pogosim.batch.runs.run import Outcome
from pogosim.batch.runs.run_data import RunFile
from pogosim.batch.runs.run_log import with_last_line
from pogosim.batch.runs.run_policy import RunPolicy
from pogosim.batch.runs.tasks import Combination
from pogosim.batch.runs.temporary import TemporaryFolder
from pogosim.batch.workers.backends import Do, Workers
from pogosim.utils import load_dataframe

ARENA = "arena_file"
RUN_FAILED = "a run failed"  # how such problems begin
VALUES = re.compile(r"'[^']*'|[-+]?\d[\d.]*(e[-+]?\d+)?")  # in which messages of one kind differ

log = logging.getLogger("pogobatch")


def kind_of(message: str) -> str:
    """Return a message of a simulator without the values in it, in which candidates differ."""
    return VALUES.sub("...", message)


@dataclass(frozen=True)
class Finished:
    """What became of the runs of a configuration.

    Attributes:
        number: Which one it is of those that were asked for, from 0 on.
        rows: All its runs, as `load_dataframe` reads those of a batch; None: a run has failed.
        problem: Why, or empty.
        seeds: Seeds that its runs have had in the end, in the order of the runs of a combination; those of a
            combination differ from others only where a run had failed.
        replacement: The greatest number of a replacement of a seed among its runs; 0: all have their own.
    """

    number: int
    rows: pd.DataFrame | None
    problem: str
    seeds: tuple[int, ...] = ()
    replacement: int = 0


@dataclass
class Wanted:
    """A configuration whose runs are being done."""

    number: int
    combinations: list[Combination]
    waiting: set[str]  # keys of runs
    replacement: int = 0  # the greatest one of the seeds of its runs
    problem: str = ""


class Runs:
    """Runs configurations of one program, with all combinations of the options that they have.

    Args:
        configuration: The file in which they begin; files that it names are searched beside it, too.
        program: Program compiled for Pogosim.
        temp_base: Folder for files of single runs.
        output_dir: Folder of the results; with the others, it tells apart what shares a folder for temporary files.
        workers: The workers that do the runs.
        policy: How the runs are done.
        keep_temp: Keep the files of single runs.

    Attributes:
        simulator_s: Wall-clock time, in s, that simulators have taken, added up.
        digests: Digests of the configuration with the files that it names, and of the program.
    """

    def __init__(
        self,
        configuration: Configuration,
        program: str,
        temp_base: str,
        output_dir: str,
        workers: Workers,
        policy: RunPolicy,
        keep_temp: bool = False,
    ) -> None:
        self.configuration = configuration
        self.workers = workers
        self.program = program
        self.temporary = TemporaryFolder.of_batch(temp_base, str(configuration.path), output_dir, program, keep_temp)
        self.batch = OpenBatch(configuration, program, self.temporary, policy)
        settings = self.batch.settings
        world = world_digest(configuration.entries, settings.folders, self.batch.file_digests)
        self.digests = {"configuration": world, "program": settings.program_digest}
        self.simulator_s = 0.0
        self.warned: dict[str, str] = {}  # the first warning of each kind
        self.do: Do | None = None

    @contextlib.contextmanager
    def opened(self) -> Iterator[None]:
        """Keep workers, and the folder for temporary files, as long as there are runs to do.

        Raises:
            BatchError: They cannot be had.
        """
        with self.batch.held():
            try:
                with self.workers.opened(keep_idle=True) as self.do:
                    yield
                self.batch.forget_runs()
            finally:
                self.do = None
                self.temporary.remove_leftovers()  # of workers that were killed

    def rows_of(
        self,
        configurations: Sequence[dict[str, Any]],
        seeds: Sequence[Sequence[int]],
        save: Callable[[int], tuple[Path, str] | None] | None = None,
    ) -> Iterator[Finished]:
        """Yield the runs of several configurations, each when all its runs are done, in the order of that.

        Args:
            configurations: What to run.
            seeds: Seeds of the runs of each, 0 to 2^32-1.
            save: Says of each, by number, where its rows are to stay, and what the metadata entry "configuration" is;
                None: nowhere.

        Raises:
            BatchError: Runs cannot be done.
        """
        assert self.do is not None  # within opened()
        wanted = [self.wanted(number, entries, seeds[number]) for number, entries in enumerate(configurations)]
        combinations = [combination for one in wanted for combination in one.combinations]
        execution = Execution(combinations, self.program, self.configuration, WITH_SEEDS)
        uses = {key: [one for one in wanted if key in one.waiting] for key in execution.tasks}
        left = {key: len(ones) for key, ones in uses.items()}

        def take(key: str, replacement: int, problem: str = "") -> Iterator[Finished]:
            for one in uses[key]:
                one.waiting.discard(key)
                one.replacement = max(one.replacement, replacement)
                one.problem = one.problem or problem
                if not one.waiting:
                    yield self.finished(one, execution.finished, save(one.number) if save is not None else None)
                    for own in {task.key for combination in one.combinations for task in combination.tasks}:
                        left[own] -= 1
                        if left[own] == 0 and own in execution.finished and not self.temporary.is_kept:
                            execution.finished.pop(own).path.unlink(missing_ok=True)

        waiting = execution.waiting()
        for key, file in list(execution.finished.items()):
            yield from take(key, file.retry_attempt)
        try:
            with contextlib.closing(execution.ended(self.do(waiting))) as ended:
                for task, outcome in ended:
                    problem = self.problem_of(outcome)
                    if not problem:
                        execution.check_run(task)
                        execution.keep_copy(task)
                    yield from take(task.key, task.replacement_in(outcome.attempts - 1), problem)
        finally:
            self.simulator_s += execution.simulator_s

    def wanted(self, number: int, entries: dict[str, Any], seeds: Sequence[int]) -> Wanted:
        """Return the runs of a configuration."""
        with self.configuration.placing_errors():
            combined = combinations_of(entries)
        combinations, whole = [], ambiguous(combined)
        for own in combined:
            tasks = self.batch.tasks_of(own, seeds)
            columns = new_columns(own, whole)
            columns.setdefault(ARENA, value_at(own, ARENA) if ARENA in own else None)
            combinations.append(Combination("", columns, own, tasks))
        return Wanted(number, combinations, {task.key for combination in combinations for task in combination.tasks})

    def problem_of(self, outcome: Outcome) -> str:
        """Return why a run has failed, or nothing; warnings of simulators are passed on, each once."""
        if outcome.problem:
            return f"{RUN_FAILED}: {with_last_line(outcome.problem, outcome.log)}"
        new = {kind_of(line): line for line in outcome.log.splitlines() if kind_of(line) not in self.warned}
        self.warned.update(new)
        report_warnings(new.values())
        return ""

    def finished(self, one: Wanted, files: Mapping[str, RunFile], target: tuple[Path, str] | None) -> Finished:
        """Return the rows of a configuration whose runs are done."""
        if one.problem:
            return Finished(one.number, None, one.problem, replacement=one.replacement)
        parts = [part_of(combination, files, WITH_SEEDS) for combination in one.combinations]
        seeds = tuple(run.seed for run in parts[0].runs)
        scratch = self.temporary.done / f"joined_{one.number}.feather"
        path, text = (scratch, self.configuration.text) if target is None else target
        write_results(str(path), parts, text, WITH_SEEDS)
        rows, _ = load_dataframe(path)
        scratch.unlink(missing_ok=True)
        return Finished(one.number, rows, "", seeds, one.replacement)
