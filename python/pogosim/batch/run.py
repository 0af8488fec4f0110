"""One run: a folder of its own, a simulator in it, its data file kept under the name of the run."""

from __future__ import annotations

import contextlib
import errno
import logging
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from pogosim.batch.errors import BatchError, reason
from pogosim.batch.identity import PYTHON
from pogosim.batch.run_data import RunFile, read_run
from pogosim.batch.run_files import is_nested, place_of
from pogosim.batch.running import Watch
from pogosim.batch.temporary import TemporaryFolder
from pogosim.extensions import MODELS_VARIABLE, models_path
from pogosim.firmware import is_firmware
from pogosim.installation import find_installation
from pogosim.lines import printable

LOG = "log.txt"
CONFIGURATION = "test.yaml"
EFFECTIVE = "pogobatch_effective.yaml"  # its name in the folder of a single task
FRAMES = "frames"  # folder of the outputs of a run, in its own
OWN = "<configuration>"  # in messages of a run: its own configuration, a temporary file
REFUSED = 2  # exit code of a program that refuses its configuration, or cannot write its files
QUIET = ("-nr", "-q")  # a simulator prints warnings and errors only
LOG_LINES = 10
WHEN = re.compile(r"^\[[^\]]*\] (?=\[)")  # the date of a line in the log
MAX_WARNINGS = 1000  # of one run
LONGEST_LINE = 10_000  # bytes of a line that are read at once
IN_A_FILE = re.compile(r"Error: [^\s,]+:\d+: ")  # of a robot model, a script, an arena
DISK_FULL = tuple(os.strerror(number) for number in (errno.ENOSPC, errno.EDQUOT))

log = logging.getLogger("pogobatch")

# Dies with the thread that starts it, whatever ends that one; and starts nothing if that has happened already.
WATCHED = ("setpriv", "--pdeathsig", "KILL", "sh", "-c", '[ "$PPID" = "$0" ] && exec "$@"')


class StoppedError(Exception):
    """The batch ends; the run was not done."""


@dataclass(frozen=True)
class RunSettings:
    """What all runs of a batch have in common. All paths are absolute."""

    program: Path
    program_digest: str
    configuration_folder: Path  # where files that configurations name are searched, too
    temporary: TemporaryFolder
    retries: int
    gui: bool
    retry_new_seed: bool = False  # a run that failed is repeated with another seed
    says: tuple[str, ...] = QUIET
    working_folder: Path = field(default_factory=Path.cwd)
    models_path: str = field(default_factory=lambda: models_path(log.warning))  # folders, as in POGOSIM_PATH

    @property
    def folders(self) -> tuple[Path, ...]:
        """Folders in which files that a configuration names are searched, in this order."""
        models = map(Path, filter(None, self.models_path.split(os.pathsep)))
        return (self.working_folder, self.configuration_folder, *models)

    @property
    def search_path(self) -> str:
        """POGOSIM_PATH of the simulator: where it finds what single runs find beside the configuration, and models."""
        beside = str(self.configuration_folder)
        return os.pathsep.join(filter(None, ["" if os.pathsep in beside else beside, self.models_path]))


@dataclass(frozen=True)
class Task:
    """A run to do."""

    key: str
    run: int
    seed: int
    text: str  # configuration, without the names of its outputs, or with `place_of` them
    outputs: tuple[tuple[str, str], ...]  # keys of the configuration, and the basenames of the files
    settings: RunSettings
    replacements: tuple[int, ...] = ()  # seeds of its second, third, ... attempt; empty: its own seed

    @property
    def retries(self) -> int:
        """How many times the run is repeated if it fails: there may be too few seeds for as many as are asked for."""
        return len(self.replacements) if self.settings.retry_new_seed else self.settings.retries

    @property
    def data(self) -> str:
        """Basename of the data file."""
        return dict(self.outputs)["data_filename"]

    def seed_of(self, attempt: int) -> int:
        """Return the seed of an attempt, from 0 on."""
        return self.replacements[attempt - 1] if attempt and self.replacements else self.seed

    def result_of(self, replacement: int) -> Path:
        """Return where the data file is when the run is done, with its own seed (0) or a replacement (1, ...)."""
        suffix = f"_{replacement}_{self.seed_of(replacement)}" if replacement else ""
        return self.settings.temporary.done / f"{self.key}{suffix}.feather"

    def replacement_in(self, attempt: int) -> int:
        """Return which replacement of its seed an attempt has: 0 if it is its own seed again."""
        return attempt if self.replacements else 0

    def read(self, data: Path, replacement: int) -> RunFile | None:
        """Return a data file of the run, with its own seed (0) or a replacement; None: it is damaged."""
        with contextlib.suppress(BatchError, OSError):
            return read_run(data, self.run, self.seed_of(replacement), replacement)
        return None

    def finished(self) -> RunFile | None:
        """Return the data file of the run if it is done already, with its own seed or a replacement."""
        for replacement in range(len(self.replacements) + 1):
            result = self.result_of(replacement)
            if result.is_file() and (file := self.read(result, replacement)) is not None:
                return file
        return None


@dataclass(frozen=True)
class Outcome:
    """What became of a run."""

    key: str
    problem: str = ""  # empty: it is done
    is_fatal: bool = False  # other runs would end in the same way
    is_certain: bool = False  # the same run would end in the same way: its configuration is refused
    attempts: int = 1
    file: RunFile | None = None  # None: it has failed
    first_problem: str = ""  # of an attempt before, with the last line of its log; empty: there was none
    command: str = ""
    log: str = ""  # its last lines; of a run that is done, its warnings
    folder: str = ""  # what a failure leaves
    simulator_s: float = 0.0  # wall-clock time of its simulators


class Simulators:
    """The simulators of this process, so that they can be ended."""

    def __init__(self) -> None:
        self.watch = Watch()
        self.is_stopping = False
        self.slots: contextlib.AbstractContextManager[object] = contextlib.nullcontext()

    def begin(self, at_once: int) -> None:
        """Let this number of simulators run at the same time; others wait for their turn."""
        self.is_stopping = False
        self.watch.begin()
        self.slots = threading.BoundedSemaphore(at_once)

    def run(self, command: Sequence[str], folder: Path, log: Path, search_path: str) -> tuple[int, float]:
        """Run a program to its end.

        Returns:
            Its exit code, or minus the signal that ended it; and its wall-clock time in s.

        Raises:
            OSError: It cannot be started.
            StoppedError: The batch ends.
        """
        with self.slots:
            started_s = time.monotonic()
            code = self.run_now(command, folder, log, search_path)
            return code, time.monotonic() - started_s

    def run_now(self, command: Sequence[str], folder: Path, log: Path, search_path: str) -> int:
        """Do what `run` does, at once; returns the exit code."""
        if self.is_stopping:
            raise StoppedError
        with log.open("wb") as output:
            process = subprocess.Popen(
                [*watch(), *command],
                cwd=folder,
                env=os.environ | {MODELS_VARIABLE: search_path} if search_path else None,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,  # Ctrl-C reaches the batch alone
            )
        running = self.watch.add(process, log)
        if self.is_stopping:
            kill(process)
        try:
            code = process.wait()
        except BaseException:
            kill(process)
            process.wait()
            raise
        finally:
            self.watch.remove(running)
        if self.is_stopping:
            raise StoppedError
        return code

    def stop(self) -> None:
        """End all simulators, and let none begin."""
        self.is_stopping = True
        with self.watch.lock:
            for running in self.watch.running:
                kill(running.process)


simulators = Simulators()


def kill(process: subprocess.Popen[bytes]) -> None:
    """End a program and what it has started."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, signal.SIGKILL)


def watch() -> list[str]:
    """Return the start of a command line with which a program ends when this process does; empty where it cannot."""
    if sys.platform != "linux" or shutil.which(WATCHED[0]) is None:
        return []
    return [*WATCHED, str(os.getpid())]


def tail(path: Path) -> str:
    """Return the last lines of a log."""
    try:
        with path.open("rb") as file:
            file.seek(0, os.SEEK_END)
            file.seek(max(0, file.tell() - 20_000))
            lines = file.read().decode(errors="replace").splitlines()
    except OSError:
        return ""
    return "\n".join(without_folder(line, path.parent) for line in lines[-LOG_LINES:])


def with_last_line(problem: str, log: str) -> str:
    """Return why a run failed, with the last line of its log, without the date."""
    last = next((line for line in reversed(log.splitlines()) if line.strip()), "")
    return f"{problem}: {WHEN.sub('', last)}" if last else problem


def without_folder(line: str, folder: Path) -> str:
    """Return a line of a log with its control characters shown, and the run's own configuration as OWN."""
    for name in (CONFIGURATION, EFFECTIVE):
        line = line.replace(str(folder / name), OWN)
    return printable(line)


def warnings_in(folder: Path) -> str:
    """Return the warnings in the log of a run, each once, without dates."""
    found: dict[str, None] = {}
    with contextlib.suppress(OSError), (folder / LOG).open("rb") as file:
        while len(found) < MAX_WARNINGS and (line := file.readline(LONGEST_LINE)):
            _, mark, text = line.decode(errors="replace").rstrip("\r\n").partition("[warning] ")
            if mark:
                found[without_folder(text, folder)] = None
    return "\n".join(found)


def ending(code: int) -> str:
    """Return how a program ended: "exit code 3", "killed by SIGSEGV"."""
    if code >= 0:
        return f"exit code {code}"
    try:
        return f"killed by {signal.Signals(-code).name}"
    except ValueError:
        return f"killed by signal {-code}"


def write_configuration(task: Task, folder: Path, configuration: str) -> Path:
    """Write the configuration of a run, whose outputs go to `frames` in its folder."""
    outputs = {key: folder / FRAMES / name for key, name in task.outputs}
    text = task.text
    for setting, output in outputs.items():
        if is_nested(setting):
            text = text.replace(place_of(setting), quoted(output))
        else:
            text += f"{setting}: {quoted(output)}\n"
    path = folder / configuration
    path.write_text(text)
    return path


def quoted(path: Path) -> str:
    """Return a path as a YAML string."""
    return "'" + str(path).replace("'", "''") + "'"


def attempt(task: Task, number: int) -> Outcome:
    """Do a run once, in a new folder, and keep its data file. The folder stays if it fails, or if folders are kept.

    Raises:
        OSError: A file cannot be written, or the program not be started.
        StoppedError: The batch ends.
    """
    temporary = task.settings.temporary
    prefix = f"sim_{task.run}_try{number}_{temporary.batch}_"
    folder = Path(tempfile.mkdtemp(prefix=prefix, dir=temporary.path))
    is_kept = temporary.is_kept
    try:
        outcome = attempt_in(folder, task, number)
        if outcome.file is not None:
            result = task.result_of(outcome.file.retry_attempt)
            keep(outcome.file.path, result, as_copy=temporary.is_kept)
            outcome = replace(outcome, file=replace(outcome.file, path=result))
        is_kept |= bool(outcome.problem)
        return replace(outcome, folder=str(folder) if is_kept else "")
    finally:
        if not is_kept:
            shutil.rmtree(folder, ignore_errors=True)


def attempt_in(folder: Path, task: Task, number: int, configuration: str = CONFIGURATION) -> Outcome:
    """Do a run once, in a folder, where its configuration, its log and its outputs stay.

    Args:
        folder: The folder, which is there.
        task: The run.
        number: Number of the attempt, from 0 on.
        configuration: Name of its configuration.

    Raises:
        OSError: A file cannot be written, or the program not be started.
        StoppedError: The batch ends.
    """
    (folder / FRAMES).mkdir(exist_ok=True)
    path = write_configuration(task, folder, configuration)
    settings = task.settings
    arguments = ["-c", str(path), *settings.says, "--seed", str(task.seed_of(number))]
    command = [*starting(str(settings.program)), *arguments, *([] if settings.gui else ["-g"])]
    code, simulator_s = simulators.run(command, settings.working_folder, folder / LOG, settings.search_path)
    data = folder / FRAMES / task.data
    problem, is_fatal, is_certain = "", False, False
    file, log = None, ""
    if code != 0:
        log = tail(folder / LOG)
        problem = ending(code)
        is_certain = code == REFUSED and (f"Error: {OWN}:" in log or IN_A_FILE.search(log) is not None)
        is_fatal = any(words in log for words in DISK_FULL)
        if is_fatal:
            problem = disk_full(settings.temporary)
    elif not data.is_file():
        problem = f"it ended without writing its data file: is {settings.program} a program compiled for Pogosim?"
        is_fatal = True
    elif (file := task.read(data, task.replacement_in(number))) is None:
        problem = "its data file is damaged"
    else:
        log = warnings_in(folder)
    return Outcome(
        task.key,
        problem,
        is_fatal,
        is_certain,
        attempts=number + 1,
        file=file,
        command=shlex.join(command),
        log=log,
        simulator_s=simulator_s,
    )


def starting(program: str) -> list[str]:
    """Return the start of a command line that runs a program: the Python that runs now, for a file in Python.

    Raises:
        InstallationError: It is a firmware, and there is no simulator.
    """
    if is_firmware(Path(program)):
        return [str(find_installation().without_program), "--firmware", program]
    return [sys.executable, program] if program.endswith(PYTHON) else [program]


def disk_full(temporary: TemporaryFolder) -> str:
    """Return what is said when a run cannot write."""
    return f"the disk of {temporary.path} is full; free space, then give the same command again"


def keep(data: Path, result: Path, as_copy: bool) -> None:
    """Put a data file where finished runs are; it appears there as a whole."""
    if as_copy:
        scratch = result.with_suffix(".copy")
        scratch.unlink(missing_ok=True)
        try:
            os.link(data, scratch)
        except OSError:
            shutil.copyfile(data, scratch)
        data = scratch
    data.replace(result)


def do_run(task: Task) -> Outcome:
    """Do a run, again after each failure that may not come again.

    What remains of a failure is the folder of the last attempt.

    Raises:
        StoppedError: The batch ends.
    """
    temporary, outcome = task.settings.temporary, Outcome(task.key)
    simulator_s, first_problem = 0.0, ""
    for number in range(task.retries + 1):
        if outcome.folder and not temporary.is_kept:
            shutil.rmtree(outcome.folder, ignore_errors=True)
        try:
            outcome = attempt(task, number)
        except OSError as error:
            is_full = error.errno in (errno.ENOSPC, errno.EDQUOT)
            # What starts the program names it; what cannot be written has no name, and is in the temporary folder.
            problem = disk_full(temporary) if is_full else f"{error.filename or temporary.path}: {reason(error)}"
            is_fatal = is_full or error.errno == errno.ENOEXEC
            outcome = Outcome(task.key, problem, is_fatal=is_fatal, attempts=number + 1)
        simulator_s += outcome.simulator_s
        # What is certain for one seed, such as that robots find no place, may be otherwise for another.
        if not outcome.problem or outcome.is_fatal or (outcome.is_certain and not task.replacements):
            break
        first_problem = first_problem or with_last_line(outcome.problem, outcome.log)
    return replace(outcome, simulator_s=simulator_s, first_problem=first_problem)
