"""The runs of a batch: which there are, which are done already, and what became of the others."""

from __future__ import annotations

import logging
from collections.abc import Generator, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

from pogosim.batch.configuration import Configuration
from pogosim.batch.errors import BatchError, tell
from pogosim.batch.manifests import TASK, task_entries, write_json
from pogosim.batch.option_words import chosen_in
from pogosim.batch.parts import PLAIN, Format
from pogosim.batch.places import in_the_users_file
from pogosim.batch.reports import Failure, Progress, Replaced, report_warnings
from pogosim.batch.results import check_columns, schema_of
from pogosim.batch.run import Outcome, Task
from pogosim.batch.tasks import Combination
from pogosim.batch.temporary import TemporaryFolder
from pogosim.varied import varied_parameters

log = logging.getLogger("pogobatch")


class Execution:
    """The runs of several combinations; one that they share is done once.

    Attributes:
        failures: Runs that failed.
        finished: With which replacement of its seed a run is done (0: its own seed), by key.
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
        self.first_of = {task.key: combination for combination in reversed(combinations) for task in combination.tasks}
        self.numbers = {id(combination): number for number, combination in enumerate(combinations)}
        self.program = program  # its name in messages
        self.layout = layout
        self.shows_warnings = shows_warnings
        self.finished: dict[str, int] = {}
        self.checked: set[tuple[str | None, ...]] = set()  # names of columns
        self.failures: list[Failure] = []
        self.problems: dict[str, str] = {}  # of first attempts of runs that are done, by key
        self.simulator_s = 0.0

    def waiting(self, temporary: TemporaryFolder) -> list[Task]:
        """Return the runs that are not done yet, in order.

        Raises:
            BatchError: The columns of one that is done are wrong.
        """
        for task in self.tasks.values():
            if (replacement := temporary.finished(task)) is not None:
                self.finished[task.key] = replacement
                self.check_run(task)
        waiting = [task for task in self.tasks.values() if task.key not in self.finished]
        if len(waiting) < len(self.tasks):
            tell(f"{len(self.tasks) - len(waiting)} of {len(self.tasks)} runs are done already, in {temporary.done}")
        return waiting

    def take(self, outcomes: Generator[Outcome, None, None], total: int, with_progress: bool = False) -> None:
        """Let a backend do runs, and show how many are done; on a terminal always, elsewhere as asked for.

        Raises:
            BatchError: The others would fail in the same way as one that did; or its columns are wrong.
        """
        warnings: dict[str, None] = {}
        bar = Progress(total, is_asked_for=with_progress)
        try:
            for outcome in outcomes:
                task = self.tasks[outcome.key]
                self.simulator_s += outcome.simulator_s
                if not outcome.problem:
                    warnings.update(dict.fromkeys(self.messages(outcome.log, task).splitlines()))
                    self.finished[task.key] = outcome.replacement
                    if outcome.first_problem:
                        self.problems[task.key] = self.messages(outcome.first_problem, task)
                        log.debug("run %d failed at first: %s", task.run, self.problems[task.key])
                    self.check_run(task)
                    self.keep_manifest(task, outcome)
                elif outcome.is_fatal:
                    raise BatchError(f"run {task.run} with seed {task.seed}: {outcome.problem}")
                else:
                    self.failures.append(self.failure(outcome, task))
                    log.debug("run %d failed: %s", task.run, outcome.problem)
                bar.update()
        finally:
            bar.close()
            outcomes.close()
            if self.shows_warnings:
                report_warnings(warnings)
        self.failures.sort(key=lambda failure: (failure.output, failure.task.run, failure.task.key))

    def messages(self, said: str, task: Task) -> str:
        """Return what a run has said, with places in the file of the user."""
        return in_the_users_file(said, task, self.first_of[task.key].entries, self.configuration)

    def failure(self, outcome: Outcome, task: Task) -> Failure:
        """Return what is said of a run that has failed."""
        combination = self.first_of[task.key]
        number = self.number_of(combination)
        options = self.options_of(number)
        outcome = replace(outcome, log=self.messages(outcome.log, task))
        return Failure(task, outcome, combination.output, options, number)

    @property
    def replaced(self) -> list[Replaced]:
        """Runs that failed, and were done with other seeds; in order."""
        return [
            Replaced(task, self.finished[key], self.problems.get(key, ""), first.output, self.number_of(first))
            for key, task in self.tasks.items()
            if self.finished.get(key) and (first := self.first_of[key])
        ]

    def number_of(self, combination: Combination) -> int:
        """Return which one a combination is, from 0 on."""
        return self.numbers[id(combination)]

    def options_of(self, number: int) -> dict[str, Any]:
        """Return what tells a combination from the others: keys and their values."""
        return chosen_in(self.varied, number)

    @cached_property
    def varied(self) -> dict[str, list[Any]]:
        """What differs between the combinations: keys, with a value for each."""
        return varied_parameters([combination.entries for combination in self.combinations])

    def check_run(self, task: Task) -> None:
        """Check the columns of a finished run; those that many runs have are checked once."""
        combination = self.first_of[task.key]
        schema = schema_of(task.result_of(self.finished[task.key]))
        names = (*schema.names, None, *combination.columns)
        if names not in self.checked:
            self.checked.add(names)
            check_columns(schema, list(combination.columns), self.program, self.layout)

    def keep_manifest(self, task: Task, outcome: Outcome) -> None:
        """Write down what a run is whose folder stays."""
        if not outcome.folder:
            return
        combination = self.first_of[task.key]
        number = self.number_of(combination)
        entries = task_entries(combination, task, outcome.replacement, number, self.options_of(number))
        write_json(Path(outcome.folder) / TASK, entries)
