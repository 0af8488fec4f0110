"""A batch: from a configuration with options to files of results."""

from __future__ import annotations

import contextlib
import hashlib
import logging
import os
from collections.abc import Collection, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from pogosim.batch.configurations.combinations import combinations_of
from pogosim.batch.configurations.configuration import Configuration, dump_configuration
from pogosim.batch.configurations.names import COLUMNS, ambiguous, file_name, is_linked_out, new_columns
from pogosim.batch.configurations.seeds import listed_seeds, range_text
from pogosim.batch.configurations.selection import check_columns_exist, indistinguishable, with_output
from pogosim.batch.errors import BatchError, at_least, cannot, given, one_line, tell
from pogosim.batch.execution import Execution
from pogosim.batch.reports import Failure, Replaced, report_failures, report_replaced
from pogosim.batch.result_files.joining import join, remove_stale, removing_stale
from pogosim.batch.result_files.parts import OF_CAMPAIGNS, PLAIN
from pogosim.batch.result_files.results import check_output
from pogosim.batch.runs.identity import seed_of
from pogosim.batch.runs.open_batch import OpenBatch
from pogosim.batch.runs.run_policy import QUIET, RunPolicy
from pogosim.batch.runs.tasks import Combination
from pogosim.batch.runs.temporary import TemporaryFolder
from pogosim.batch.runs.unfinished_runs import tell_of_states
from pogosim.batch.workers.backends import Workers
from pogosim.batch.workers.jobqueue_options import QueuedJobs
from pogosim.batch.workers.slurm_options import SlurmJobs
from pogosim.run_columns import RETRY

MAX_RUNS = 10_000_000  # in memory, about 1 kB each

# What a simulator is asked to print, into the log of its run.
SIMULATOR_OUTPUTS = {"normal": QUIET, "quiet": QUIET, "verbose": ("-v",)}

log = logging.getLogger("pogobatch")


CONFIGURED = "configured"  # in place of seeds: see PogobotBatchRunner


class PogobotBatchRunner:
    """Runs a program with every combination of the options in a configuration, several times each.

    Made to be extended: `get_combinations` says which configurations there are, `compute_output_filename` where their
    results go, `compute_new_columns` and `compute_seed` what their columns and seeds are, and
    `run_launcher_for_combination` which runs are done for each. Override what should be different.

    Args:
        multi_config_file: YAML file with options (`batch_options` and others).
        runs: Runs per combination, at least 1; None where `seeds` says it.
        simulator_binary: Program compiled for Pogosim.
        temp_base: Folder for files of single runs. Finished runs of an unfinished batch are kept there.
        output_dir: Folder of the results.
        backend: "multiprocessing", "sequential" or "dask" ("ray" means dask).
        keep_temp: Keep the folders of single runs.
        verbose: Say more.
        retries: How many times a failed run is repeated.
        gui: Let each run open its window.
        only_output: Do only combinations whose results have this name, or path; empty: all.
        seed_from: "run": the seed of a run is its number (0, 1, ...). "config": it is derived from the configuration's
            `seed` and the number.
        workers: Runs at the same time; None: one per processor.
        scheduler: Address of a Dask scheduler (tcp://...) whose workers do the runs.
        jobs: Jobs of SLURM, or of another batch system, that do the runs.
        seeds: Seed of each run; None: as `seed_from` says; CONFIGURED: those of `_rundr` in the configuration, or else
            one run.
        retry_new_seed: Repeat a failed run with another seed, see `pogosim.batch.configurations.seeds`; otherwise, with
            the same one.
        with_seeds: Add the columns `seed` and `retry_attempt` to the results, and a manifest to their metadata.
        progress: Say how many runs are done also where there is no terminal.
        isolated: Each run is a process of its own; else, one process may do many, one after the other.
        simulator_output: "normal": warnings of simulators are shown; "quiet": they are not; "verbose": simulators and
            robots also print what they usually do into the logs of their runs, which stay with `keep_temp`.
        save_states: Save the state of each run after this wall-clock time each, in s, and when the batch is ended: the
            same batch goes on from there. None: runs that have not ended begin anew.

    Attributes:
        failures: Runs of the last `run_all()` that failed.
        replaced: Those that failed, and were done with other seeds.
        simulator_s: Wall-clock time, in s, that simulators of the last `run_all()` took, added up.
        generated: Files of results that the last `run_all()` wrote, each once.
        combination_count: Number of combinations of the last `run_all()`.

    Raises:
        BatchError: An argument is wrong, or the configuration cannot be read. Also raised by all methods: its message
            is one line.
    """

    def __init__(
        self,
        multi_config_file: str,
        runs: int | None,
        simulator_binary: str,
        temp_base: str,
        output_dir: str,
        backend: str = "multiprocessing",
        keep_temp: bool = False,
        verbose: bool = False,
        retries: int = 5,
        gui: bool = False,
        only_output: str = "",
        *,
        seed_from: str = "run",
        workers: int | None = None,
        scheduler: str | None = None,
        jobs: SlurmJobs | QueuedJobs | None = None,
        seeds: Iterable[int] | str | None = None,
        retry_new_seed: bool = False,
        with_seeds: bool = False,
        progress: bool = False,
        isolated: bool = False,
        simulator_output: str = "normal",
        save_states: float | None = None,
    ) -> None:
        self.multi_config_file = str(given.path("multi_config_file", multi_config_file))
        self.runs = 0
        self.seeds: Sequence[int] = ()  # of each combination, before `compute_seed` makes others of them
        if seeds is None:
            self.runs = at_least(1, runs, "--runs")
            self.seeds = range(self.runs)
        elif not (isinstance(seeds, str) and seeds == CONFIGURED):
            self.seeds = listed_seeds(seeds, "--seeds")
            self.runs = len(self.seeds)
            if runs is not None and runs != self.runs:
                raise BatchError(f"--runs: expected {self.runs}, as many as there are seeds; found {runs}")
            if seed_from == "config":
                raise BatchError("--seed-from config goes with --runs; the seeds are given already")
        self.simulator_binary = str(given.path("simulator_binary", simulator_binary))
        self.temp_base = str(given.path("temp_base", temp_base))
        self.output_dir = str(given.path("output_dir", output_dir))
        self.workers = Workers(backend, workers, scheduler, jobs)
        if simulator_output not in SIMULATOR_OUTPUTS:
            known = ", ".join(SIMULATOR_OUTPUTS)
            raise BatchError(f"simulator_output: expected one of {known}; found '{simulator_output}'")
        says = SIMULATOR_OUTPUTS[simulator_output]
        self.policy = RunPolicy(retries, retry_new_seed, gui, isolated, save_states, says)
        self.shows_warnings = simulator_output != "quiet"
        self.keep_temp = keep_temp
        self.verbose = verbose
        self.only_output = only_output
        self.seed_from = seed_from
        self.layout = OF_CAMPAIGNS if with_seeds else PLAIN
        self.progress = progress
        self.failures: list[Failure] = []
        self.replaced: list[Replaced] = []
        self.simulator_s = 0.0
        self.generated: list[str] = []
        self.combination_count = 0
        self.whole: frozenset[str] = frozenset()  # columns whose paths are not reduced to their stems
        self.queue: list[Combination] | None = None
        self.batch: OpenBatch | None = None  # within prepared()
        # Configurations of combinations that were written: their text and entries by path.
        self.written: dict[str, tuple[str, dict[str, Any]]] = {}
        if seed_from not in ("run", "config"):
            raise BatchError(f"--seed-from: expected run or config; found '{seed_from}'")
        self.configuration = Configuration(self.multi_config_file)
        if not self.runs:
            asked_for = self.configuration.seeds or range(1)
            self.runs = len(asked_for)
            self.seeds = asked_for if seed_from == "run" else range(self.runs)

    # ---- What can be overridden ----

    def get_combinations(self, config: dict[str, Any]) -> list[dict[str, Any]]:
        """Return the configuration of each combination of options, in order of appearance; the last varies fastest."""
        with self.configuration.placing_errors():
            return combinations_of(config)

    def compute_output_filename(self, comb_config: dict[str, Any]) -> str:
        """Return the path of the file with the results of a combination. Several combinations may share a file."""
        with self.configuration.placing_errors():
            output = str(Path(self.output_dir) / file_name(comb_config))
        try:
            is_out = is_linked_out(output, self.output_dir)
        except (OSError, RuntimeError) as error:  # links in a circle
            raise BatchError(f"{output} cannot be written: {one_line(error)}") from None
        if is_out:
            raise BatchError(
                f"{output} leads out of the folder of the results, to {Path(output).resolve()}; remove the symbolic "
                "link, or choose another folder with -o"
            )
        return output

    def compute_new_columns(self, comb_config: dict[str, Any]) -> dict[str, Any]:
        """Return names and values of the constant columns of a combination."""
        with self.configuration.placing_errors():
            return new_columns(comb_config, self.whole)

    def compute_seed(self, comb_config: dict[str, Any], run: int) -> int:
        """Return the seed of a run, 0 to 2^32-1. Runs are numbered 0, 1, ..."""
        if self.seed_from == "run":
            return self.seeds[run]
        seed = comb_config.get("seed")
        if isinstance(seed, bool) or not isinstance(seed, int) or not 0 <= seed < 2**32:
            where = self.configuration.where(("seed",))
            raise BatchError(f"{where}: --seed-from config needs a whole number from 0 to 4294967295, found {seed}")
        return seed_of(seed, run)

    def write_temp_yaml(self, comb_config: dict[str, Any]) -> str:
        """Write the configuration of a combination into the folder for temporary files; returns its path."""
        try:
            text = dump_configuration(comb_config)
        except UnicodeEncodeError:
            raise BatchError(f"{self.multi_config_file}: a value is no text in UTF-8 (such as \\ud800)") from None
        name = hashlib.sha256(text.encode()).hexdigest()[:8]
        path = self.temporary.path / f"combo_{name}.yaml"
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        except OSError as error:
            raise cannot("write", path, error) from None
        self.written[str(path)] = (text, comb_config)
        return str(path)

    def run_launcher_for_combination(self, temp_config_path: str, output_file: str) -> str:
        """Do all runs of a combination.

        Within `run_all()`, it queues them: the runs of all combinations are done together. Called alone, it does them
        and writes the results.

        Args:
            temp_config_path: Configuration of the combination.
            output_file: File of results.

        Returns:
            `output_file`.
        """
        if self.queue is not None:
            self.queue.append(self.combination_of(temp_config_path, output_file))
        else:
            with self.prepared():
                self.do_all([self.combination_of(temp_config_path, output_file)])
        return output_file

    # ---- The batch ----

    def list_outputs(self) -> list[str]:
        """Return the paths of all files of results, sorted, each once."""
        return sorted({output for _, output in self.selected()})

    def run_all(self) -> list[str]:
        """Do all runs and write all results.

        Returns:
            The file of results of each combination; one that several share is there several times. Runs that failed are
            missing in the results and listed in `failures`.
        """
        selected = self.checked_selection()
        self.combination_count = len(selected)
        with self.prepared():
            for output in dict.fromkeys(output for _, output in selected):
                check_output(output)
            tell(f"Found {len(selected)} combination(s) to run.")
            self.queue = []
            try:
                outputs = []
                for entries, output in selected:
                    path = self.write_temp_yaml(entries)
                    log.debug("Task: Config file %s -> Output: %s", path, output)
                    outputs.append(self.run_launcher_for_combination(path, output))
                queue = self.queue
            finally:
                self.queue = None
            self.do_all(queue)
        return outputs

    def run_part(self, number: int, parts: int) -> int:
        """Do one part of all runs, for one of several jobs, and join nothing: `pogobatch merge` does.

        The part has the runs `number`, `number` + `parts`, ... in the order of the combinations and their runs. With
        `keep_temp`, the folders of these runs stay, which are what is merged.

        Args:
            number: Which part, from 0 on.
            parts: How many there are.

        Returns:
            How many runs it has. Those that failed are listed in `failures`.
        """
        selected = self.checked_selection()
        self.combination_count = len(selected)
        with self.prepared():
            combinations = [self.combination_of(self.write_temp_yaml(entries), output) for entries, output in selected]
            count = 0
            for combination in combinations:
                all_tasks, before = combination.tasks, count
                combination.tasks = all_tasks[(number - before) % parts :: parts]
                count += len(all_tasks)
            self.do_runs(self.execution_of(combinations), ())
        return sum(len(combination.tasks) for combination in combinations)

    def do_all(self, combinations: Sequence[Combination]) -> None:
        """Do the runs that are not done yet, and write the results."""
        execution = self.execution_of(combinations)
        by_output: dict[str, list[Combination]] = {}
        for combination in combinations:
            by_output.setdefault(combination.output, []).append(combination)
        self.do_runs(execution, by_output)
        for output, of_output in by_output.items():
            if join(of_output, execution.finished, self.configuration.text, self.layout):
                self.generated.append(output)
        if not self.failures:
            self.open_batch.forget_runs()

    def execution_of(self, combinations: Sequence[Combination]) -> Execution:
        """Return the runs of combinations, of which none has ended yet."""
        execution = Execution(combinations, self.simulator_binary, self.configuration, self.layout, self.shows_warnings)
        self.failures, self.replaced, self.simulator_s, self.generated = execution.failures, [], 0.0, []
        return execution

    def do_runs(self, execution: Execution, outputs: Collection[str]) -> None:
        """Do the runs that are not done yet; the first of them removes results of an earlier batch."""
        waiting = execution.waiting()
        if done := len(execution.finished):
            tell(f"{done} of {len(execution.tasks)} runs are done already, in {self.temporary.done}")
        tell_of_states(waiting, self.open_batch.settings, self.simulator_binary)
        if waiting and (why := waiting[0].settings.why_alone):
            log.debug("each run is a process of its own: %s", why)
        with self.workers.opened() as do:
            outcomes = do(waiting)
            if not done:
                outcomes = removing_stale(outputs, outcomes)
            else:
                for output in outputs:
                    remove_stale(output)
            try:
                execution.take(outcomes, len(waiting), self.progress)
            finally:
                self.simulator_s = execution.simulator_s
        self.replaced = execution.replaced
        report_replaced(self.replaced, len(execution.tasks), RETRY if RETRY in self.layout.run_columns else None)
        report_failures(self.failures)
        if self.failures:
            log.error("%d run(s) failed; the same command does them again, and only them", len(self.failures))

    # ---- Its parts ----

    @property
    def temporary(self) -> TemporaryFolder:
        """The folder for temporary files."""
        return TemporaryFolder.of_batch(
            self.temp_base, self.multi_config_file, self.output_dir, self.simulator_binary, self.keep_temp
        )

    @property
    def open_batch(self) -> OpenBatch:
        """The batch, within `prepared()`."""
        assert self.batch is not None
        return self.batch

    @contextlib.contextmanager
    def prepared(self) -> Iterator[None]:
        """Look at the program, and keep the folder for temporary files for this batch meanwhile."""
        self.batch = OpenBatch(self.configuration, self.simulator_binary, self.temporary, self.policy)
        with self.batch.held(self.written):
            yield

    def checked_selection(self) -> list[tuple[dict[str, Any], str]]:
        """Return the combinations to do, each with its file of results, after all checks that need no program.

        Raises:
            BatchError: They are too many, or a column is wrong.
            NothingSelectedError: None has the output that was asked for.
        """
        selected = self.selected()
        if len(selected) * self.runs > MAX_RUNS:
            wanted = f"{self.runs} runs of {len(selected)} combination(s)"
            raise BatchError(f"--runs: {wanted} are more than {MAX_RUNS}; make several batches")
        with self.configuration.placing_errors():
            check_columns_exist([entries for entries, _ in selected])
        columns = [(entries, output, self.compute_new_columns(entries)) for entries, output in selected]
        for name in self.layout.run_columns:
            if any(name in own for _, _, own in columns):
                log.warning("%s: the column '%s' has that of each run", self.configuration.where((COLUMNS,)), name)
        for output, keys in indistinguishable(columns).items():
            listed = ", ".join(keys)
            log.warning("%s: no column tells its combinations apart; add to result_new_columns: %s", output, listed)
        return selected

    def selected(self) -> list[tuple[dict[str, Any], str]]:
        """Return the combinations to do, each with its file of results.

        Raises:
            NothingSelectedError: None has the output that was asked for.
        """
        combinations = self.get_combinations(self.configuration.entries)
        with self.configuration.placing_errors():
            self.whole = ambiguous(combinations)
        named = [(entries, self.compute_output_filename(entries)) for entries in combinations]
        return with_output(named, self.only_output)

    def combination_of(self, path: str, output: str) -> Combination:
        """Return the runs of a combination."""
        text, entries = self.written.get(path, ("", {}))
        try:
            if not text or Path(path).read_text() != text:
                entries = Configuration(path).entries
        except OSError as error:
            raise cannot("read", path, error) from None
        columns = self.compute_new_columns(entries)
        columns = {name: value for name, value in columns.items() if name not in self.layout.run_columns}
        seeds = [self.compute_seed(entries, run) for run in range(self.runs)]
        name = os.path.relpath(output, self.output_dir)
        tasks = self.open_batch.tasks_of(entries, seeds)
        return Combination(output, columns, entries, tasks, name, range_text(seeds))
