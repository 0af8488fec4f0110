"""One run: a simulator, its data file kept under the name of the run; again if it fails."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import shlex
import shutil
import signal
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import IO

from pogosim.batch.errors import BatchError, reason
from pogosim.batch.runs.identity import PYTHON, find_program
from pogosim.batch.runs.run import FRAMES, Outcome, Task
from pogosim.batch.runs.run_files import is_nested, place_of
from pogosim.batch.runs.run_log import CONFIGURATION, LOG, OWN, tail, warnings_in, with_last_line
from pogosim.batch.runs.run_server import ServerLostError
from pogosim.batch.runs.simulators import Saving, simulators
from pogosim.batch.runs.temporary import TemporaryFolder
from pogosim.batch.runs.unfinished_runs import FROM_OUTSIDE, UnfinishedRun, folder_of, held
from pogosim.firmware import is_firmware
from pogosim.installation import InstallationError, find_installation

REFUSED = 2  # exit code of a program that refuses its configuration, or cannot write its files
IN_A_FILE = re.compile(r"Error: [^\s,]+:\d+: ")  # of a robot model, a script, an arena
REFUSED_STATE = re.compile(r"Error: (--from-state: .*)")
DISK_FULL = tuple(os.strerror(number) for number in (errno.ENOSPC, errno.EDQUOT))


def ending(code: int) -> str:
    """Return how a program ended: "exit code 3", "killed by SIGSEGV"."""
    if code >= 0:
        return f"exit code {code}"
    try:
        return f"killed by {signal.Signals(-code).name}"
    except ValueError:
        return f"killed by signal {-code}"


def configuration_in(task: Task, folder: Path) -> str:
    """Return the configuration of a run, whose outputs go to a folder."""
    outputs = {key: folder / name for key, name in task.outputs}
    text = task.text
    for setting, output in outputs.items():
        if is_nested(setting):
            text = text.replace(place_of(setting), quoted(output))
        else:
            text += f"{setting}: {quoted(output)}\n"
    return text


def quoted(path: Path) -> str:
    """Return a path as a YAML string."""
    return "'" + str(path).replace("'", "''") + "'"


def attempt(task: Task, number: int) -> Outcome:
    """Do a run once, and keep its data file. If it fails, its folder stays.

    Raises:
        OSError: A file cannot be written, or the program not be started.
        StoppedError: The batch ends.
    """
    if task.settings.saves_states:
        return attempt_in_parts(task, number)
    # A run that has failed in a process of its own is repeated in one.
    is_first = number == 0 and task.settings.may_share_process
    outcome = attempt_in_server(task, number) if is_first else None
    return attempt_alone(task, number) if outcome is None else outcome


def attempt_in_server(task: Task, number: int) -> Outcome | None:
    """Do a run once, in a process that does many, and keep its data file.

    Returns:
        A run that is done; None: it did not end well, or the program serves no runs.

    Raises:
        OSError: A file cannot be written.
        StoppedError: The batch ends.
    """
    settings, replacement = task.settings, task.replacement_in(number)
    result = task.result_of(replacement)
    command = starting(str(settings.program))
    with contextlib.suppress(ServerLostError, FileNotFoundError), simulators.server(command, settings) as server:
        if server is None:
            return None
        server.configure(configuration_in(task, server.outputs))
        started_s = time.monotonic()
        with simulators.running(server.process, server.log):
            server.run(arguments_of(task, number, server.configuration))
        simulator_s = time.monotonic() - started_s
        (server.outputs / task.data).replace(result)
        said = warnings_in(server.folder) if server.log.stat().st_size else ""
        server.clear()
        if (file := task.read(result, replacement)) is not None:
            return Outcome(task.key, attempts=number + 1, file=file, log=said, simulator_s=simulator_s)
    return None


def attempt_alone(task: Task, number: int) -> Outcome:
    """Do a run once, in a new folder and a process of its own; the folder stays if it fails, or if folders are kept.

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
        outcome = with_moved_file(outcome, task)
        is_kept |= bool(outcome.problem)
        return replace(outcome, folder=str(folder) if is_kept else "")
    finally:
        if not is_kept:
            shutil.rmtree(folder, ignore_errors=True)


def attempt_in_parts(task: Task, number: int) -> Outcome:
    """Do a run once, from its state if there is one, and keep its data file; see `attempt_from_state`.

    Raises:
        OSError: A file cannot be written, or the program not be started.
        StoppedError: The batch ends; the state stays.
    """
    folder = folder_of(task, number)
    with held(folder) as its_lock:
        if its_lock is None:
            return attempt_alone(task, number)
        run = UnfinishedRun(folder, task, number)
        outcome = with_moved_file(attempt_from_state(run, its_lock), task)
        is_kept = task.settings.temporary.is_kept
        if outcome.file is not None:
            run.finish()
            if not is_kept:
                shutil.rmtree(folder, ignore_errors=True)
        return replace(outcome, folder=str(folder) if is_kept or outcome.problem else "")


def attempt_from_state(run: UnfinishedRun, its_lock: IO[bytes], configuration: str = CONFIGURATION) -> Outcome:
    """Do a run once, in its folder, from its state if there is one.

    A run that is ended from outside goes on; one that fails by itself begins anew the next time. So does, at once, one
    whose state does not fit, or whose earlier rows are missing.

    Raises:
        OSError: A file cannot be written, or the program not be started.
        StoppedError: The batch ends; the state stays.
    """
    said = ""
    simulator_s = 0.0
    while True:
        if not run.has_state:
            if run.others():
                said += "the state in its folder is of another run, so the run begins anew\n"
            run.begin()
        goes_on, before_ns = run.has_state, run.saved_at_ns
        outcome = attempt_in(
            run.folder, run.task, run.number, configuration, Saving(tuple(run.arguments()), its_lock, goes_on)
        )
        simulator_s += outcome.simulator_s
        if goes_on and (refused := REFUSED_STATE.search(outcome.log)):
            said += f"{refused[1]}; so the run begins anew\n"
        elif outcome.code in FROM_OUTSIDE and run.saved_at_ns != before_ns:
            continue
        elif outcome.problem:
            if outcome.code not in FROM_OUTSIDE and not outcome.is_fatal:
                run.state.unlink(missing_ok=True)
            break
        elif not goes_on:
            break
        else:
            try:
                run.join()
                file = run.task.read(run.data, run.task.replacement_in(run.number))
                outcome = replace(outcome, file=file, problem="" if file else "its data file is damaged")
                break
            except BatchError as error:
                said += f"{error}; so the run begins anew\n"
        run.state.unlink(missing_ok=True)
    log = outcome.log if outcome.problem else "\n".join(filter(None, (said.rstrip(), outcome.log)))
    return replace(outcome, log=log, simulator_s=simulator_s)


def attempt_in(
    folder: Path, task: Task, number: int, configuration: str = CONFIGURATION, saving: Saving | None = None
) -> Outcome:
    """Do a run once, in a folder, where its configuration, its log and its outputs stay.

    Args:
        folder: The folder, which is there.
        task: The run.
        number: Number of the attempt, from 0 on.
        configuration: Name of its configuration.
        saving: How its state is saved; None: it is not.

    Raises:
        OSError: A file cannot be written, or the program not be started.
        StoppedError: The batch ends.
    """
    (folder / FRAMES).mkdir(exist_ok=True)
    path = folder / configuration
    path.write_text(configuration_in(task, folder / FRAMES))
    settings = task.settings
    command = [*starting(str(settings.program)), *arguments_of(task, number, str(path))]
    more = saving.arguments if saving is not None else ()
    code, simulator_s = simulators.run([*command, *more], folder, settings, saving)
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
        code=code,
    )


def starting(program: str) -> list[str]:
    """Return the start of a command line that runs a program: the Python that runs now, for a file in Python.

    Raises:
        InstallationError: It is a firmware, and there is no simulator.
    """
    if is_firmware(Path(program)):
        return [str(find_installation().without_program), "--firmware", program]
    return [sys.executable, program] if program.endswith(PYTHON) else [program]


def command_of_users(program: str, configuration: Path) -> str:
    """Return the command line with which users run a configuration as a batch or a search has run it."""
    path = program if Path(program).exists() else str(find_program(program))
    try:
        is_none = Path(path) == find_installation().without_program
    except InstallationError:
        return shlex.join([*starting(path), "-c", str(configuration)])
    if path.endswith(PYTHON):
        return shlex.join(["python", path, "-c", str(configuration)])
    return shlex.join(["pogosim", "run", *([] if is_none else [path]), "-c", str(configuration)])


def arguments_of(task: Task, number: int, configuration: str) -> list[str]:
    """Return the command line of an attempt, after the program."""
    policy = task.settings.policy
    window = [] if policy.gui else ["-g"]
    return ["-c", configuration, *policy.says, "--seed", str(task.seed_of(number)), *window]


def disk_full(temporary: TemporaryFolder) -> str:
    """Return what is said when a run cannot write."""
    return f"the disk of {temporary.path} is full; free space, then give the same command again"


def with_moved_file(outcome: Outcome, task: Task) -> Outcome:
    """Put the data file of a run that is done where finished runs are, and return the run with that path.

    If folders are kept, the file stays in that of the run, until the batch has written down there what the run is.

    Raises:
        OSError: It cannot be put there.
    """
    if outcome.file is None or task.settings.temporary.is_kept:
        return outcome
    result = task.result_of(outcome.file.retry_attempt)
    outcome.file.path.replace(result)
    return replace(outcome, file=replace(outcome.file, path=result))


def do_run(task: Task) -> Outcome:
    """Do a run, again after each failure that may not come again.

    What remains of a failure is the folder of the last attempt.

    Raises:
        StoppedError: The batch ends.
    """
    temporary, outcome = task.settings.temporary, Outcome(task.key)
    simulator_s, first_problem = 0.0, ""
    for number in range(task.retries + 1):
        if outcome.folder and not (temporary.is_kept or task.settings.saves_states):
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
