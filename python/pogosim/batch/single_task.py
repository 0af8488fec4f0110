"""One run of a batch in a folder of its own, for schedulers that start every run themselves; see also `merging`."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from pogosim.batch.configurations.configuration import Configuration
from pogosim.batch.configurations.names import file_name, new_columns
from pogosim.batch.configurations.option_words import CHOICES, shown
from pogosim.batch.configurations.seeds import listed_seeds, seeds_between
from pogosim.batch.errors import BatchError, at_least, cannot, given
from pogosim.batch.result_files.manifests import MOST, TASK, read_manifest, task_entries, write_json
from pogosim.batch.result_files.parts import OF_CAMPAIGNS, WITH_SEEDS
from pogosim.batch.result_files.result_metadata import columns_as_text
from pogosim.batch.result_files.results import check_columns
from pogosim.batch.runs.attempts import attempt_from_state, attempt_in
from pogosim.batch.runs.open_batch import OpenBatch
from pogosim.batch.runs.places import in_the_users_file
from pogosim.batch.runs.run import FRAMES, Outcome, Task
from pogosim.batch.runs.run_data import RunFile, read_run, shared
from pogosim.batch.runs.run_log import EFFECTIVE, with_last_line
from pogosim.batch.runs.run_policy import RunPolicy
from pogosim.batch.runs.simulators import simulators
from pogosim.batch.runs.tasks import Combination
from pogosim.batch.runs.temporary import TemporaryFolder, batch_name
from pogosim.batch.runs.unfinished_runs import UnfinishedRun, held
from pogosim.outputs import PathLike
from pogosim.run_columns import RETRY, RUN, SEED
from pogosim.table_metadata import parse_configuration

log = logging.getLogger("pogobatch")

WHICH_RUN = ("seed", "result_filename", "extra_columns")  # entries of a manifest that tell runs in a folder apart


@dataclass(frozen=True)
class TaskArtifact:
    """The folder of a run that is done.

    Attributes:
        folder: The folder.
        manifest: What its `pogobatch_task.json` says.
    """

    folder: Path
    manifest: dict[str, Any]

    @property
    def data(self) -> Path:
        """The data file."""
        return self.folder / str(self.manifest["data_file"])

    @property
    def columns(self) -> dict[str, Any]:
        """The constant columns of the run, without those that say which run it is."""
        extra = self.manifest.get("extra_columns", {})
        return {name: value for name, value in extra.items() if name not in OF_CAMPAIGNS.run_columns}

    @property
    def batch_choices(self) -> dict[str, Any]:
        """What tells its combination from others of its batch; its constant columns if its manifest does not say it."""
        choices = self.manifest.get("batch_choices")
        return choices if isinstance(choices, dict) else self.columns

    @property
    def lost_columns(self) -> list[str]:
        """Its constant columns that contradict those columns of results which say which run a row is of."""
        extra, own = self.manifest.get("extra_columns", {}), self.manifest
        there = {RUN: own["logical_run"], SEED: own[SEED], RETRY: own.get(RETRY) or 0}
        return [name for name, value in there.items() if name in extra and extra[name] != value]

    @cached_property
    def columns_text(self) -> str:
        """The constant columns as a text, which is the same for the same columns."""
        return columns_as_text(self.columns)

    @cached_property
    def batch_seeds(self) -> range:
        """The seeds of all runs of its combination in its batch; empty: its manifest does not say it."""
        text = self.manifest.get("batch_seeds")
        return seeds_between(text, "batch_seeds") if text else range(0)

    @property
    def first_seed(self) -> int:
        """The seed of its first attempt."""
        run = self.manifest["logical_run"]
        return self.batch_seeds[run] if run < len(self.batch_seeds) else int(self.manifest[SEED])

    @cached_property
    def combination(self) -> tuple[str, ...]:
        """What tells the combination of the run from others: its configuration, columns and file of results."""
        return (str(self.manifest.get("config_hash", "")), self.columns_text, str(self.manifest["result_filename"]))

    @cached_property
    def file(self) -> RunFile:
        """The data file, and what it has beside its rows.

        Raises:
            BatchError: It cannot be read.
        """
        manifest = self.manifest
        try:
            return shared(read_run(self.data, manifest["logical_run"], manifest[SEED], manifest.get(RETRY) or 0))
        except OSError as error:
            raise cannot("read", self.data, error) from None

    @property
    def configuration_text(self) -> str:
        """The configuration in the data file."""
        return self.file.metadata.get(b"configuration", b"").decode(errors="replace")

    @property
    def configuration(self) -> dict[str, Any]:
        """Its entries; empty: they cannot be read."""
        return parse_configuration(self.configuration_text)


class TaskError(BatchError):
    """The run failed. The message is one line.

    Attributes:
        outcome: What became of it.
    """

    def __init__(self, message: str, outcome: Outcome) -> None:
        super().__init__(message)
        self.outcome = outcome


def execute_task(
    config_path: PathLike,
    simulator_binary: PathLike,
    *,
    seed: int,
    output_dir: PathLike,
    run_index: int = 0,
    retry_attempt: int = 0,
    gui: bool = False,
    force: bool = False,
    save_states: float | None = None,
) -> TaskArtifact:
    """Do one run in a folder: `pogobatch_effective.yaml`, `log.txt`, `frames/`, and at the end `pogobatch_task.json`.

    Args:
        config_path: YAML file. A run takes the `default_option` of each of its options.
        simulator_binary: Program compiled for Pogosim, or a Python file that behaves like one.
        seed: Seed, 0 to 2^32-1.
        output_dir: The folder, which is made. What the same run has left there, or one that failed, is replaced; the
            same are runs with the same seed whose results have the same name and columns.
        run_index: Number of the run, 0 to 2^63-1, for the column `run`.
        retry_attempt: Which attempt this is, 0 to 2^63-1, for the column `retry_attempt`.
        gui: Let the run open its window.
        force: Replace another run, too.
        save_states: Save the state of the run in the folder after this wall-clock time each, in s, and when it is
            ended: the same call goes on from there. None: never.

    Raises:
        BatchError: It cannot be done, or another run is in the folder.
        TaskError: The run failed.
    """
    (seed,) = listed_seeds([seed], "--seed")
    at_least(0, run_index, "--run-index", MOST)
    at_least(0, retry_attempt, "--retry-attempt", MOST)
    program = str(given.path("simulator_binary", simulator_binary))
    configuration = Configuration(given.path("config_path", config_path))
    entries = configuration.resolved()
    with configuration.placing_errors():
        name, columns = file_name(entries), new_columns(entries)
    folder = given.path("output_dir", output_dir)
    task = task_in(folder, configuration, entries, program, seed, run_index, gui, save_states)
    combination = Combination("", columns, entries, [task], name)
    manifest = task_entries(combination, task, 0, 0, entries.get(CHOICES, {})) | {"retry_attempt": retry_attempt}
    if not force:
        refuse_another_run(folder, manifest)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / TASK).unlink(missing_ok=True)
        simulators.begin(1)
        if task.settings.saves_states:
            outcome = saving_states(folder.absolute(), task, retry_attempt)
        else:
            (folder / FRAMES / task.data).unlink(missing_ok=True)
            outcome = attempt_in(folder.absolute(), task, retry_attempt, EFFECTIVE)
    except OSError as error:
        raise cannot("use", error.filename or folder, error) from None
    if outcome.file is None:
        said = in_the_users_file(outcome.log, task, entries, configuration)
        raise TaskError(f"the run with seed {seed} failed: {with_last_line(outcome.problem, said)}", outcome)
    check_columns(outcome.file.schema, list(columns), program, WITH_SEEDS)
    write_json(folder / TASK, manifest)
    return TaskArtifact(folder, manifest)


def saving_states(folder: Path, task: Task, number: int) -> Outcome:
    """Do the run, from its state if there is one.

    Raises:
        BatchError: Another process does it.
        OSError: A file cannot be written, or the program not be started.
    """
    with held(folder) as its_lock:
        if its_lock is None:
            raise BatchError(f"another process does a run in {folder}; wait for it, or choose another folder with -o")
        run = UnfinishedRun(folder, task, number)
        outcome = attempt_from_state(run, its_lock, EFFECTIVE)
        if outcome.file is not None:
            run.finish()
        for line in outcome.log.splitlines() if outcome.file is not None else ():
            log.warning("%s", line)
        return outcome


def refuse_another_run(folder: Path, manifest: Mapping[str, Any]) -> None:
    """Raise BatchError if a folder has a run that is done and is another one than a manifest says."""
    try:
        there = read_manifest(folder / TASK)
    except BatchError:
        return  # none is done there
    for name in WHICH_RUN:
        if there.get(name) != manifest[name]:
            raise BatchError(
                f"{folder} has another run already, with the {name.replace('_', ' ')} {shown(there.get(name))}, not "
                f"{shown(manifest[name])}; choose another folder with -o, or replace that run with --force"
            )


def task_in(
    folder: Path,
    configuration: Configuration,
    entries: dict[str, Any],
    program: str,
    seed: int,
    run_index: int,
    gui: bool,
    save_states: float | None = None,
) -> Task:
    """Return a run whose files are in a folder."""
    temporary = TemporaryFolder(folder.absolute(), batch_name([str(folder)]), is_kept=True)
    policy = RunPolicy(retries=0, gui=gui, save_every_s=save_states)
    (task,) = OpenBatch(configuration, program, temporary, policy).tasks_of(entries, [seed])
    return replace(task, run=run_index)
