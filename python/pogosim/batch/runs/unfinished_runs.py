"""Runs whose states are saved on the way: what is kept of one that was ended."""

from __future__ import annotations

import contextlib
import logging
import os
import re
import signal
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from pogosim.batch.errors import BatchError, one_line, tell
from pogosim.batch.runs.run import FRAMES, RunSettings, Task
from pogosim.batch.runs.run_log import LOG
from pogosim.batch.runs.temporary import STATE
from pogosim.continued import ContinuedError, join_parts, parts_of
from pogosim.outputs import lock
from pogosim.recover import DAMAGED, reraise_system_error

LOCK = "lock"
PATIENCE_S = 10.0  # for the simulator of a batch that was killed

# How a run ends that was asked to: it has saved its state; or was killed, and has an earlier one.
INTERRUPTED = 130
FROM_OUTSIDE = (INTERRUPTED, *(-number for number in (signal.SIGTERM, signal.SIGKILL, signal.SIGINT, signal.SIGHUP)))

log = logging.getLogger("pogobatch")


@dataclass(frozen=True)
class UnfinishedRun:
    """What is kept of a run until it is done, in a folder that is the same whenever it is begun.

    The folder has the state, whose name says which run it is of, and the files of the run, in parts. The simulator
    renames those of the part before, to data.1.feather and so on.
    """

    folder: Path
    task: Task
    number: int  # of the attempt

    @property
    def state(self) -> Path:
        """The file of the state."""
        return self.folder / f"{self.task.key}_{self.task.seed_of(self.number)}{STATE}"

    @property
    def data(self) -> Path:
        """The data file, at first of the last part."""
        return self.folder / FRAMES / self.task.data

    @property
    def has_state(self) -> bool:
        """Whether there is something to go on from; a run that was killed early leaves an empty file."""
        try:
            return self.state.stat().st_size > 0
        except OSError:
            return False

    @property
    def saved_at_ns(self) -> int:
        """When the state was saved; 0: never."""
        return self.state.stat().st_mtime_ns if self.has_state else 0

    def others(self) -> list[Path]:
        """Return the states of other runs in the folder."""
        found = [path for path in self.folder.glob(f"*{STATE}") if path.stat().st_size > 0]
        return [path for path in found if path != self.state and re.fullmatch(r"[0-9a-f]{32}_\d+", path.stem)]

    def arguments(self) -> list[str]:
        """Return what the simulator is told in addition."""
        every = ["--save-state", str(self.state), "--save-state-every", f"{self.task.settings.policy.save_every_s:g}"]
        return [*every, "--from-state", str(self.state)] if self.has_state else every

    def begin(self) -> None:
        """Remove what no state goes on from.

        Raises:
            OSError: It cannot be removed.
        """
        for path in (self.folder / LOG, self.state, *self.others(), *parts_of(self.data)):
            path.unlink(missing_ok=True)

    def join(self) -> None:
        """Make one data file of the parts, with the same rows and metadata as that of a run that was never ended.

        Raises:
            BatchError: Rows are missing.
            OSError: It cannot be written.
        """
        try:
            join_parts(self.data)
        except ContinuedError as error:
            raise BatchError(error) from None
        except DAMAGED as error:
            reraise_system_error(error)
            raise BatchError(f"the rows beside {self.data} are damaged: {one_line(error)}") from None

    def finish(self) -> None:
        """Remove the state, when the run is done and its data file is where it stays.

        Raises:
            OSError: It cannot be removed.
        """
        for path in (self.state, *self.others(), *parts_of(self.data)[:-1], self.folder / LOCK):
            path.unlink(missing_ok=True)


def tell_of_states(waiting: Sequence[Task], settings: RunSettings, program: str) -> None:
    """Say which runs of a batch go on from their states, which cannot, and which would if they were asked to.

    Args:
        waiting: Runs that are not done yet.
        settings: What all runs of the batch have in common.
        program: Its name in messages.
    """
    temporary, keys = settings.temporary, {task.key for task in waiting}
    found = [state.parent.name for state in temporary.states()]
    going_on = sum(name.partition("_")[0] in keys for name in found)
    if settings.policy.save_every_s is None:
        if going_on == 1:
            log.warning("1 unfinished run has a saved state: give --save-states to continue it")
        elif going_on:
            log.warning("%d unfinished runs have saved states: give --save-states to continue them", going_on)
        return
    if not settings.saves_states:
        log.warning("--save-states: %s is a Python file, whose runs cannot be saved", program)
        return
    if going_on:
        tell(f"{going_on} of {len(waiting)} runs go on from their states, in {temporary.unfinished}")
    if others := len(found) - going_on:
        log.warning(
            "%d states in %s are of runs with another configuration, program or seed: nothing goes on from them",
            others,
            temporary.unfinished,
        )


def folder_of(task: Task, number: int) -> Path:
    """Return the folder of a run in the folder for temporary files."""
    temporary = task.settings.temporary
    return temporary.unfinished / f"{task.key}_{task.seed_of(number)}"


@contextlib.contextmanager
def held(folder: Path) -> Iterator[IO[bytes] | None]:
    """Keep others from doing the same run meanwhile; yields the lock, for the simulator, too. None: another one does.

    A worker that was given up may still be at it.

    Raises:
        OSError: The folder cannot be used.
    """
    while True:
        (folder / FRAMES).mkdir(parents=True, exist_ok=True)
        try:
            file = (folder / LOCK).open("ab")
        except FileNotFoundError:  # the other one has just ended, and removed the folder
            continue
        with file:
            if not lock(file, PATIENCE_S):
                yield None
                return
            if is_there(folder / LOCK, file):
                yield file
                return


def is_there(path: Path, file: IO[bytes]) -> bool:
    """Tell whether an open file is still the one at a path."""
    try:
        return os.path.samestat(path.stat(), os.fstat(file.fileno()))
    except OSError:
        return False
