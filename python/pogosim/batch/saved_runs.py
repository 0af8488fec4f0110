"""Runs whose states are saved on the way: what is kept of one that was ended, and its rows, joined from its parts."""

from __future__ import annotations

import contextlib
import os
import re
import signal
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import pyarrow as pa

from pogosim.batch.errors import BatchError, one_line
from pogosim.batch.run import FRAMES, Task
from pogosim.batch.run_log import LOG
from pogosim.outputs import lock
from pogosim.recover import DAMAGED, INCOMPLETE, RecoverError, open_rows, reraise_system_error
from pogosim.table_formats import FEATHER
from pogosim.tables import table_writer

STATE = ".state"
LOCK = "lock"
MOST_SECONDS = 1e6  # between states
PATIENCE_S = 10.0  # for the simulator of a batch that was killed

# How a run ends that was asked to: it has saved its state; or was killed, and has an earlier one.
INTERRUPTED = 130
FROM_OUTSIDE = (INTERRUPTED, *(-number for number in (signal.SIGTERM, signal.SIGKILL, signal.SIGINT, signal.SIGHUP)))

# In the metadata of a part that goes on: the time from which it does, and the number of rows before.
CONTINUED = (b"continued_from_s", b"continued_after_rows")
NOT_OF_THE_WHOLE = (*CONTINUED, INCOMPLETE)


def check_period(save_every_s: float) -> None:
    """Check how often states are saved.

    Raises:
        BatchError: It is no time.
    """
    if not 0.0 <= save_every_s <= MOST_SECONDS:
        raise BatchError(f"--save-states: expected a time from 0 to {MOST_SECONDS:.0f} s; found {save_every_s:g}")


@dataclass(frozen=True)
class SavedRun:
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
        found = states_in(self.folder)
        return [path for path in found if path != self.state and re.fullmatch(r"[0-9a-f]{32}_\d+", path.stem)]

    def arguments(self) -> list[str]:
        """Return what the simulator is told in addition."""
        every = ["--save-state", str(self.state), "--save-state-every", f"{self.task.settings.save_every_s:g}"]
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


def states_in(folder: Path, below: str = "") -> list[Path]:
    """Return the states in a folder, or in those `below` it ("*/"); a run that was killed early left an empty file."""
    return [path for path in folder.glob(f"{below}*{STATE}") if path.stat().st_size > 0]


def folder_of(task: Task, number: int) -> Path:
    """Return the folder of a run in the folder for temporary files."""
    temporary = task.settings.temporary
    return temporary.saved / f"{task.key}_{task.seed_of(number)}"


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


def parts_of(data: Path) -> list[Path]:
    """Return the data files of a run and of its earlier parts that are there, in order."""
    name = re.compile(rf"{re.escape(data.stem)}\.(\d+){re.escape(data.suffix)}")
    try:
        numbered = [(int(found[1]), path) for path in data.parent.iterdir() if (found := name.fullmatch(path.name))]
    except FileNotFoundError:
        return []
    return [path for _, path in sorted(numbered)] + ([data] if data.exists() else [])


def first_row(schema: pa.Schema) -> int:
    """Return the number of rows before a part."""
    return int((schema.metadata or {}).get(CONTINUED[1], b"0"))


@contextlib.contextmanager
def opened_part(path: Path) -> Iterator[pa.ipc.RecordBatchStreamReader]:
    """Open the rows of a part, which may be unfinished.

    Raises:
        BatchError: It ends before its first row could.
        OSError: It cannot be read.
    """
    with path.open("rb") as file:
        try:
            reader = open_rows(path, file)
        except RecoverError as error:
            raise BatchError(str(error)) from None
        yield reader


def counted_parts(parts: list[Path]) -> list[tuple[Path, int | None]]:
    """Return which parts have rows of the run, in order, and how many count of each; None: all.

    Rows after the state from which the run went on are in the next part again; a part that was killed before it saved
    a state has none that count.

    Raises:
        BatchError: A part is missing.
    """
    with opened_part(parts[-1]) as last:
        missing = first_row(last.schema)
    counted: list[tuple[Path, int | None]] = [(parts[-1], None)]
    for path in reversed(parts[:-1]):
        if missing == 0:
            break
        try:
            with opened_part(path) as part:
                first = first_row(part.schema)
        except BatchError:
            continue  # killed while it began
        if first < missing:
            counted.append((path, missing - first))
            missing = first
    if missing:
        raise BatchError(f"the first {missing} rows of the run are missing in {parts[-1].parent}")
    return counted[::-1]


def join_parts(data: Path) -> None:
    """Put the rows of all parts of a run into its data file; memory does not grow with their number.

    Raises:
        BatchError: Rows are missing.
        OSError: It cannot be written.
    """
    counted = counted_parts(parts_of(data))
    with opened_part(data) as last:
        metadata = last.schema.metadata or {}
        if not any(key in metadata for key in CONTINUED):
            return  # it has all rows
        schema = last.schema.with_metadata({key: metadata[key] for key in metadata if key not in NOT_OF_THE_WHOLE})
    scratch = data.with_name(f"{data.name}.joined")
    try:
        with scratch.open("wb") as file:
            with contextlib.closing(table_writer(file, FEATHER, schema)) as writer:
                for path, count in counted:
                    for batch in rows_of(path, count):
                        if not batch.schema.equals(schema, check_metadata=False):
                            raise BatchError(f"{path} has other columns than the part behind it")
                        writer.write_table(pa.table(batch.columns, schema=schema))
            file.flush()
            os.fsync(file.fileno())
        scratch.replace(data)
    finally:
        scratch.unlink(missing_ok=True)


def rows_of(path: Path, count: int | None) -> Iterator[pa.RecordBatch]:
    """Yield the first rows of a part, or all.

    Raises:
        BatchError: It has less.
    """
    left = count
    with opened_part(path) as reader:
        while left is None or left > 0:
            try:
                batch = reader.read_next_batch()
                batch.validate(full=True)
            except StopIteration:
                break
            except DAMAGED as error:
                reraise_system_error(error)
                if left is None:
                    raise
                break
            batch = batch if left is None else batch.slice(0, left)
            left = None if left is None else left - batch.num_rows
            if batch.num_rows:
                yield batch
    if left:
        raise BatchError(f"{path} lacks {left} rows before the state")
