"""The runs of a batch: which there are, which are done already, and what became of the others."""

from __future__ import annotations

import contextlib
import logging
import os
import shutil
from collections.abc import Generator, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

from pogosim.batch.configurations.configuration import Configuration
from pogosim.batch.configurations.option_words import chosen_in
from pogosim.batch.errors import BatchError, cannot
from pogosim.batch.reports import Failure, Progress, Replaced, report_warnings
from pogosim.batch.result_files.manifests import TASK, batch_entries, task_entries, write_json
from pogosim.batch.result_files.parts import PLAIN, Format
from pogosim.batch.result_files.results import check_columns
from pogosim.batch.runs.places import in_the_users_file
from pogosim.batch.runs.run import Outcome, Task
from pogosim.batch.runs.run_data import RunFile, shared
from pogosim.batch.runs.tasks import Combination
from pogosim.varied import varied_parameters

log = logging.getLogger("pogobatch")


class Execution:
    """The runs of several combinations; one that they share is done once.

    Attributes:
        failures: Runs that failed.
        finished: Data files of runs that are done, by key.
        simulator_s: Wall-clock time of simulators, in s, added up.
    """

    def __init__(
        self,
        combinations: Sequence[Combination],
        program: str,
        configuration: Configuration,
        layout: Format = PLAIN,
        shows_warnings: bool = True,
    ) -> None:
        self.combinations = combinations
        self.configuration = configuration
        self.tasks = {task.key: task for combination in combinations for task in combination.tasks}
        self.uses: dict[str, list[tuple[int, Task]]] = {}  # by key: numbers of combinations, and their own tasks
        for number, combination in enumerate(combinations):
            for task in combination.tasks:
                self.uses.setdefault(task.key, []).append((number, task))
        self.program = program  # its name in messages
        self.layout = layout
        self.shows_warnings = shows_warnings
        self.finished: dict[str, RunFile] = {}
        self.checked: set[tuple[str | None, ...]] = set()  # names of columns
        self.failures: list[Failure] = []
        self.problems: dict[str, str] = {}  # of first attempts of runs that are done, by key
        self.simulator_s = 0.0

    def waiting(self) -> list[Task]:
        """Return the runs that are not done yet, in order.

        Raises:
            BatchError: The columns of one that is done are wrong.
        """
        for task in self.tasks.values():
            if (file := task.finished()) is not None:
                self.finished[task.key] = shared(file)
                self.check_run(task)
        return [task for task in self.tasks.values() if task.key not in self.finished]

    def ended(self, outcomes: Generator[Outcome, None, None]) -> Generator[tuple[Task, Outcome], None, None]:
        """Let a backend do runs; yields each that has ended, with what became of it.

        Raises:
            BatchError: The others would fail in the same way as one that did.
        """
        with contextlib.closing(outcomes):
            for outcome in outcomes:
                task = self.tasks[outcome.key]
                self.simulator_s += outcome.simulator_s
                if outcome.is_fatal:
                    raise BatchError(f"run {task.run} with seed {task.seed}: {outcome.problem}")
                if outcome.problem:
                    log.debug("run %d failed: %s", task.run, outcome.problem)
                if outcome.file is not None:
                    self.finished[task.key] = shared(outcome.file)
                said, first = self.messages(outcome.log, task), self.messages(outcome.first_problem, task)
                yield task, replace(outcome, log=said, first_problem=first)

    def take(self, outcomes: Generator[Outcome, None, None], total: int, with_progress: bool = False) -> None:
        """Let a backend do runs, and show how many are done; on a terminal always, elsewhere as asked for.

        Raises:
            BatchError: The others would fail in the same way as one that did; or its columns are wrong.
        """
        warnings: dict[str, None] = {}
        bar = Progress(total, is_asked_for=with_progress)
        try:
            with contextlib.closing(self.ended(outcomes)) as ended:
                for task, outcome in ended:
                    if outcome.problem:
                        self.failures.append(self.failure(outcome, task))
                    else:
                        warnings.update(dict.fromkeys(outcome.log.splitlines()))
                        if outcome.first_problem:
                            self.problems[task.key] = outcome.first_problem
                            log.debug("run %d failed at first: %s", task.run, outcome.first_problem)
                        self.check_run(task)
                        self.keep_manifest(task, outcome.folder)
                        self.keep_copy(task)
                    bar.update()
        finally:
            bar.close()
            if self.shows_warnings:
                report_warnings(warnings)
        self.failures.sort(key=lambda failure: (failure.output, failure.task.run, failure.task.key))

    def messages(self, said: str, task: Task) -> str:
        """Return what a run has said, with places in the file of the user."""
        return in_the_users_file(said, task, self.combination_of(task).entries, self.configuration)

    def combination_of(self, task: Task) -> Combination:
        """Return the first combination that has a run."""
        return self.combinations[self.first_of(task.key)]

    def first_of(self, key: str) -> int:
        """Return the number of the first combination that has a run."""
        return self.uses[key][0][0]

    def failure(self, outcome: Outcome, task: Task) -> Failure:
        """Return what is said of a run that has failed."""
        number = self.first_of(task.key)
        return Failure(task, outcome, self.combinations[number].output, chosen_in(self.varied, number), number)

    @property
    def replaced(self) -> list[Replaced]:
        """Runs that failed, and were done with other seeds; in order."""
        return [
            Replaced(task, file.retry_attempt, self.problems.get(key, ""), self.combinations[number].output, number)
            for key, task in self.tasks.items()
            if (file := self.finished.get(key)) and file.retry_attempt
            for number in [self.first_of(key)]
        ]

    @cached_property
    def varied(self) -> dict[str, list[Any]]:
        """What differs between the combinations: keys, with a value for each."""
        return varied_parameters([combination.entries for combination in self.combinations])

    def check_run(self, task: Task) -> None:
        """Check the columns of a finished run; those that many runs have are checked once."""
        combination = self.combination_of(task)
        schema = self.finished[task.key].schema
        names = (*schema.names, None, *combination.columns)
        if names not in self.checked:
            self.checked.add(names)
            check_columns(schema, list(combination.columns), self.program, self.layout)

    def keep_copy(self, task: Task) -> None:
        """Put the data file of a run where finished runs are, if it stays in a folder of its own, too.

        The run counts as finished from then on, so what is written about it has to be there before.

        Raises:
            BatchError: It cannot be put there.
        """
        if not task.settings.temporary.is_kept:
            return
        file = self.finished[task.key]
        result = task.result_of(file.retry_attempt)
        try:
            copy_whole(file.path, result)
        except OSError as error:
            raise cannot("write", result, error) from None
        self.finished[task.key] = replace(file, path=result)

    def keep_manifest(self, task: Task, folder: str) -> None:
        """Write down in the folder of a finished run, if it stays, what the run is.

        Further combinations that share the run have folders of their own, which name its data file.
        """
        if not folder:
            return
        first, replacement = Path(folder), self.finished[task.key].retry_attempt
        for number, own in self.uses[task.key]:
            done = replace(task, run=own.run)  # whose outputs may have other names than those of `own`
            choices = chosen_in(self.varied, number)
            entries = task_entries(self.combinations[number], done, replacement, number, choices)
            entries |= batch_entries(self.combinations[number], len(self.combinations))
            place = first
            if number != self.first_of(task.key):
                place = first.with_name(f"{first.name}_as_{number}")
                entries["data_file"] = f"../{first.name}/{entries['data_file']}"
            write_json(place / TASK, entries)


def copy_whole(data: Path, result: Path) -> None:
    """Copy a data file, or link it where that is possible; it appears as a whole.

    Raises:
        OSError: It cannot be written.
    """
    scratch = result.with_suffix(".copy")
    scratch.unlink(missing_ok=True)
    try:
        os.link(data, scratch)
    except OSError:
        shutil.copyfile(data, scratch)
    scratch.replace(result)
