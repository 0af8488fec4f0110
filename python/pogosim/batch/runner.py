"""A batch: from a configuration with options to files of results."""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import logging
import os
import shutil
import sys
from collections.abc import Generator, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NoReturn

from tqdm import tqdm

from pogosim.batch.backends import BACKENDS, processors
from pogosim.batch.combinations import CombinationsError, combinations_of
from pogosim.batch.configuration import Configuration, dump_configuration
from pogosim.batch.errors import BatchError, NothingSelectedError, cannot, tell
from pogosim.batch.identity import find_program, program_digest, run_key, seed_of, world_digest
from pogosim.batch.names import COLUMNS, NamesError, file_name, has_key, new_columns
from pogosim.batch.results import Part, RunFile, check_columns, check_output, schema_of, write_results
from pogosim.batch.run import Outcome, Task, is_complete_data

log = logging.getLogger("pogobatch")

OUTPUTS = {"data_filename": "data.feather", "console_filename": "console.txt", "frames_name": "f{:010.4f}.png"}
FILES_BESIDE = ("arena_file", "formation_filename")
SHOWN_FAILURES = 5
SHOWN_WARNINGS = 10


@dataclass
class Combination:
    """What is done with one combination of options."""

    output: str
    columns: dict[str, Any]
    tasks: list[Task] = field(default_factory=list)


@dataclass(frozen=True)
class Failure:
    """A run that failed, again and again."""

    task: Task
    outcome: Outcome
    output: str


class PogobotBatchRunner:
    """Runs a program with every combination of the options in a configuration, several times each.

    Made to be extended: `get_combinations` says which configurations there are, `compute_output_filename` where their
    results go, `compute_new_columns` and `compute_seed` what their columns and seeds are, and
    `run_launcher_for_combination` which runs are done for each. Override what should be different.

    Args:
        multi_config_file: YAML file with options (`batch_options` and others).
        runs: Runs per combination, at least 1.
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

    Attributes:
        failures: Runs of the last `run_all()` that failed.
        simulator_s: Wall-clock time, in s, that simulators of the last `run_all()` took, added up.

    Raises:
        BatchError: An argument is wrong, or the configuration cannot be read. Also raised by all methods: its message
            is one line.
    """

    def __init__(
        self,
        multi_config_file: str,
        runs: int,
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
    ) -> None:
        self.multi_config_file = str(multi_config_file)
        self.runs = at_least(1, runs, "--runs")
        self.simulator_binary = str(simulator_binary)
        self.temp_base = str(temp_base)
        self.output_dir = str(output_dir)
        self.backend = "dask" if scheduler is not None and backend == "multiprocessing" else backend
        self.keep_temp = keep_temp
        self.verbose = verbose
        self.retries = at_least(0, retries, "--retries")
        self.gui = gui
        self.only_output = only_output
        self.seed_from = seed_from
        self.workers = at_least(1, processors() if workers is None else workers, "--workers")
        self.scheduler = scheduler
        self.failures: list[Failure] = []
        self.simulator_s = 0.0
        self.queue: list[Combination] | None = None
        self.program_digest = ""
        self.digests: dict[Path, str] = {}  # of files that configurations name
        self.program = Path(self.simulator_binary)
        # Configurations of combinations that were written: their text and entries by path.
        self.written: dict[str, tuple[str, dict[str, Any]]] = {}
        if self.backend not in BACKENDS:
            known = ", ".join(name for name in BACKENDS if name != "ray")
            raise BatchError(f"--backend: expected one of {known}; found '{self.backend}'")
        if self.scheduler is not None and BACKENDS[self.backend] is not BACKENDS["dask"]:
            raise BatchError(f"--scheduler goes with --backend dask, not with --backend {self.backend}")
        if seed_from not in ("run", "config"):
            raise BatchError(f"--seed-from: expected run or config; found '{seed_from}'")
        self.configuration = Configuration(self.multi_config_file)

    # ---- What can be overridden ----

    def get_combinations(self, config: dict[str, Any]) -> list[dict[str, Any]]:
        """Return the configuration of each combination of options, in order of appearance; the last varies fastest."""
        try:
            return combinations_of(config)
        except CombinationsError as error:
            raise BatchError(f"{self.configuration.where(error.path)}: {error.args[0]}") from None

    def compute_output_filename(self, comb_config: dict[str, Any]) -> str:
        """Return the path of the file with the results of a combination. Several combinations may share a file."""
        try:
            return str(Path(self.output_dir) / file_name(comb_config))
        except NamesError as error:
            raise self.names_error(error) from None

    def compute_new_columns(self, comb_config: dict[str, Any]) -> dict[str, Any]:
        """Return names and values of the constant columns of a combination."""
        try:
            return new_columns(comb_config)
        except NamesError as error:
            raise self.names_error(error) from None

    def compute_seed(self, comb_config: dict[str, Any], run: int) -> int:
        """Return the seed of a run, 0 to 2^32-1. Runs are numbered 0, 1, ..."""
        if self.seed_from == "run":
            return run
        seed = comb_config.get("seed")
        if isinstance(seed, bool) or not isinstance(seed, int) or not 0 <= seed < 2**32:
            where = self.configuration.where(("seed",))
            raise BatchError(f"{where}: --seed-from config needs a whole number from 0 to 4294967295, found {seed}")
        return seed_of(seed, run)

    def write_temp_yaml(self, comb_config: dict[str, Any]) -> str:
        """Write the configuration of a combination into the folder for temporary files; returns its path."""
        text = dump_configuration(comb_config)
        name = hashlib.sha256(text.encode(errors="surrogatepass")).hexdigest()[:8]
        path = Path(self.temp_base).absolute() / f"combo_{name}.yaml"
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
        selected = self.selected()
        self.check_columns_exist([config for config, _ in selected])
        with self.prepared():
            for output in dict.fromkeys(output for _, output in selected):
                check_output(output)
            tell(f"Found {len(selected)} combination(s) to run.")
            self.queue = []
            try:
                outputs = []
                for config, output in selected:
                    path = self.write_temp_yaml(config)
                    tell(f"Task: Config file {path} -> Output: {output}")
                    outputs.append(self.run_launcher_for_combination(path, output))
                queue = self.queue
            finally:
                self.queue = None
            self.do_all(queue)
        return outputs

    # ---- Its parts ----

    def names_error(self, error: NamesError) -> BatchError:
        """Return the error of a wrong name, with its place."""
        return BatchError(f"{self.configuration.where((error.key,))}{str(error).removeprefix(error.key)}")

    def selected(self) -> list[tuple[dict[str, Any], str]]:
        """Return the combinations to do, each with its file of results.

        Raises:
            NothingSelectedError: None has the output that was asked for.
        """
        combinations = self.get_combinations(self.configuration.entries)
        named = [(config, self.compute_output_filename(config)) for config in combinations]
        wanted = self.only_output
        if not wanted:
            return named
        kept = [
            (config, output)
            for config, output in named
            if wanted in (output, Path(output).name) or Path(output).absolute() == Path(wanted).absolute()
        ]
        if not kept:
            raise NothingSelectedError(
                f"--only-output: no combination has the output '{wanted}'; --list-outputs shows those that there are"
            )
        return kept

    def check_columns_exist(self, configs: Sequence[dict[str, Any]]) -> None:
        """Check that each of the new columns is a key in some combination."""
        try:
            names = new_columns(configs[0])
        except NamesError as error:
            raise self.names_error(error) from None
        for name in names:
            if not any(has_key(config, name) for config in configs):
                raise BatchError(
                    f"{self.configuration.where((COLUMNS,))}: there is no key '{name}' in the configuration; expected "
                    "the dotted paths of keys, such as objects.robots.nb"
                )

    @property
    def batch(self) -> str:
        """The name of this batch in names of temporary files: the same whenever the same command is given."""
        paths = [Path(path).absolute() for path in (self.multi_config_file, self.output_dir, self.simulator_binary)]
        return hashlib.sha256("\n".join(map(str, paths)).encode()).hexdigest()[:8]

    @property
    def temp(self) -> Path:
        """The folder for temporary files."""
        return Path(self.temp_base).absolute()

    @property
    def done(self) -> Path:
        """The folder of finished runs."""
        return self.temp / f"done_{self.batch}"

    @contextlib.contextmanager
    def prepared(self) -> Iterator[None]:
        """Look at the program, and keep other batches from using the same folder of finished runs meanwhile."""
        self.digests = {}
        self.program = find_program(self.simulator_binary)
        self.program_digest = program_digest(self.program)
        try:
            self.done.mkdir(parents=True, exist_ok=True)
            with (self.done / "lock").open("a") as file:
                try:
                    fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                except BlockingIOError:
                    raise BatchError(
                        f"the same batch is running already, with its files in {self.done}; wait for it, or choose "
                        "another folder with --temp-base"
                    ) from None
                except OSError:
                    pass  # no locks on this file system
                self.remove_leftovers()
                try:
                    yield
                finally:
                    self.tidy()
        except OSError as error:
            raise cannot("use", error.filename or self.temp, error) from None

    def remove_leftovers(self) -> None:
        """Remove what runs of an interrupted batch have left, unless folders are kept."""
        if not self.keep_temp:
            for folder in self.temp.glob(f"sim_*_try*_{self.batch}_*"):
                shutil.rmtree(folder, ignore_errors=True)

    def combination_of(self, path: str, output: str) -> Combination:
        """Return the runs of a combination."""
        text, entries = self.written.get(path, ("", {}))
        try:
            if not text or Path(path).read_text() != text:
                entries = Configuration(path).entries
        except OSError as error:
            raise cannot("read", path, error) from None
        if entries.get("enable_data_logging") is False:
            where = self.configuration.where(("enable_data_logging",))
            raise BatchError(f"{where}: is false, so runs write no data to join; set it to true")
        combination = Combination(output, self.compute_new_columns(entries))
        world = {key: value for key, value in entries.items() if key not in OUTPUTS}
        for key in FILES_BESIDE:
            if key in world:
                world[key] = self.found_beside(world[key])
        outputs = {key: basename(entries.get(key), default) for key, default in OUTPUTS.items()}
        text = dump_configuration(world) if world else ""
        folders = (Path.cwd(), Path(self.multi_config_file).absolute().parent)
        digest = world_digest(world, folders, self.digests)
        for run in range(self.runs):
            seed = self.compute_seed(entries, run)
            task = Task(
                key=run_key(digest, self.program_digest, seed),
                run=run,
                seed=seed,
                program=str(self.program),
                text=text,
                outputs=tuple(outputs.items()),
                data=outputs["data_filename"],
                working_folder=str(Path.cwd()),
                temp_folder=str(self.temp),
                done_folder=str(self.done),
                batch=self.batch,
                retries=self.retries,
                gui=self.gui,
                keep_temp=self.keep_temp,
            )
            combination.tasks.append(task)
        return combination

    def found_beside(self, name: Any) -> Any:
        """Return the path of a file that a single run would find beside the configuration; else the name as it is."""
        if not isinstance(name, str) or not name or Path(name).exists():
            return name
        beside = Path(self.multi_config_file).absolute().parent / name
        return str(beside) if beside.exists() else name

    def do_all(self, combinations: Sequence[Combination]) -> None:
        """Do the runs that are not done yet, and write the results."""
        self.failures = []
        self.simulator_s = 0.0
        first_of = {task.key: combination for combination in reversed(combinations) for task in combination.tasks}
        tasks = {task.key: task for combination in combinations for task in combination.tasks}
        outputs = list(dict.fromkeys(combination.output for combination in combinations))
        checked: set[Any] = set()
        waiting = [task for task in tasks.values() if not self.is_done(task)]
        for key in tasks.keys() - {task.key for task in waiting}:
            self.check_run(tasks[key], first_of[key], checked)
        if len(waiting) < len(tasks):
            tell(f"{len(tasks) - len(waiting)} of {len(tasks)} runs are done already, in {self.done}")
        outcomes = self.started(waiting)
        for output in outputs:
            remove_stale(output)
        self.do_runs(waiting, outcomes, first_of, checked)
        self.report_failures()
        for output in outputs:
            self.join([combination for combination in combinations if combination.output == output])
        self.clean()

    def is_done(self, task: Task) -> bool:
        """Tell whether a run is done already."""
        return task.result.is_file() and is_complete_data(task.result)

    def check_run(self, task: Task, combination: Combination, checked: set[Any]) -> None:
        """Check the columns of a finished run."""
        schema = schema_of(task.result)
        names = (*schema.names, None, *combination.columns)
        if names not in checked:
            checked.add(names)
            check_columns(schema, list(combination.columns), self.simulator_binary)

    def started(self, tasks: Sequence[Task]) -> Generator[Outcome, None, None]:
        """Make the backend ready for runs, which begin when their outcomes are asked for."""
        if self.backend == "ray":
            log.warning("--backend ray is replaced by --backend dask")
        return BACKENDS[self.backend](tasks, self.workers, self.scheduler)

    def do_runs(
        self,
        tasks: Sequence[Task],
        outcomes: Generator[Outcome, None, None],
        combination_of: dict[str, Combination],
        checked: set[Any],
    ) -> None:
        """Do runs, and show how many are done."""
        left = {task.key: task for task in tasks}
        warnings: dict[str, None] = {}
        bar = progress_bar(len(tasks))
        try:
            for outcome in outcomes:
                task = left.pop(outcome.key)
                self.simulator_s += outcome.simulator_s
                if not outcome.problem:
                    warnings.update(dict.fromkeys(outcome.log.splitlines()))
                    self.check_run(task, combination_of[task.key], checked)
                elif outcome.is_fatal:
                    raise BatchError(f"run {task.run} with seed {task.seed}: {outcome.problem}")
                else:
                    self.failures.append(Failure(task, outcome, combination_of[task.key].output))
                    log.debug("run %d failed: %s", task.run, outcome.problem)
                bar.update()
        finally:
            bar.close()
            outcomes.close()
            for line in list(warnings)[:SHOWN_WARNINGS]:
                log.warning("warning of a run: %s", line)

    def report_failures(self) -> None:
        """Say which runs failed, with what is needed to repeat them."""
        self.failures.sort(key=lambda failure: (failure.output, failure.task.run, failure.task.key))
        for failure in self.failures[:SHOWN_FAILURES]:
            task, outcome = failure.task, failure.outcome
            times = f"{task.retries + 1} time{'s' if task.retries else ''}"
            log.error(
                "run %d of %s, seed %d, failed %s: %s", task.run, failure.output, task.seed, times, outcome.problem
            )
            if outcome.command:
                log.error("  command: %s", outcome.command)
            for line in outcome.log.splitlines():
                log.error("  | %s", line)
        if len(self.failures) > SHOWN_FAILURES:
            seeds = ", ".join(str(failure.task.seed) for failure in self.failures[SHOWN_FAILURES:][:20])
            log.error("%d more runs failed, with the seeds %s", len(self.failures) - SHOWN_FAILURES, seeds)

    def join(self, combinations: Sequence[Combination]) -> None:
        """Write one file of results."""
        failed = {failure.task.key for failure in self.failures}
        parts = [
            Part(
                combination.columns,
                [RunFile(task.result, task.run, task.seed) for task in combination.tasks if task.key not in failed],
                [task.run for task in combination.tasks if task.key in failed],
            )
            for combination in combinations
        ]
        output = combinations[0].output
        if not any(part.runs for part in parts):
            log.error("%s is not written: none of its runs ended well", output)
            return
        written = write_results(output, parts, self.configuration.text)
        is_new = True
        for rows in written.rows:
            tell(f"Created {output} with {rows} rows" if is_new else f"Appended {rows} rows to {output}")
            is_new = False

    def clean(self) -> None:
        """Forget the finished runs, except after a failure, or if they are kept."""
        if self.failures:
            log.error("%d run(s) failed; the same command does them again, and only them", len(self.failures))
        elif not self.keep_temp:
            shutil.rmtree(self.done, ignore_errors=True)

    def tidy(self) -> None:
        """Remove what no later batch needs: configurations of combinations, and folders without a finished run."""
        if self.keep_temp:
            return
        for path in self.written:
            Path(path).unlink(missing_ok=True)
        if self.done.exists() and not any(self.done.glob("*.feather")):
            shutil.rmtree(self.done, ignore_errors=True)
        with contextlib.suppress(OSError):
            self.temp.rmdir()  # if nothing else is in it


def progress_bar(total: int) -> tqdm[NoReturn]:
    """Return a bar with the time left, on standard error if that is a terminal."""
    is_shown = total > 0 and sys.stderr.isatty()
    # Some terminals have no size; the bar would be empty.
    has_size = is_shown and os.get_terminal_size(sys.stderr.fileno()).columns > 0
    size = {"dynamic_ncols": True} if has_size else {"ncols": 80, "nrows": 24}
    return tqdm(total=total, unit="run", disable=not is_shown, file=sys.stderr, smoothing=0.05, **size)


def at_least(smallest: int, value: int, name: str) -> int:
    """Return a whole number.

    Raises:
        BatchError: It is none, or too small.
    """
    if isinstance(value, bool) or not isinstance(value, int) or value < smallest:
        raise BatchError(f"{name}: expected a whole number of at least {smallest}; found {value}")
    return value


def basename(name: Any, default: str) -> str:
    """Return the last part of a path."""
    return (Path(name).name or default) if isinstance(name, str) else default


def remove_stale(output: str) -> None:
    """Remove results of an earlier batch.

    Raises:
        BatchError: They cannot be removed.
    """
    real = check_output(output)
    try:
        if real.exists():
            real.unlink()
            tell(f"Removed stale result file: {output}")
    except OSError as error:
        raise cannot("remove", output, error) from None
