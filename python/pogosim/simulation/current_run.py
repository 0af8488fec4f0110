"""The current run of a simulation, and its cleanup."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
import threading
from collections.abc import Callable
from pathlib import Path

from pogosim.lines import printable
from pogosim.outputs import OutputError, leads_to, partial_output, real_output, told
from pogosim.simulation.arrays import RunState
from pogosim.simulation.errors import ConfigurationError, given
from pogosim.simulation.library import OpenRun, Strict, interrupt_soon, library, open_run
from pogosim.table_formats import BESIDE, CSV, EXPECTED, format_of, is_our_metadata, metadata_path

WARNING = threading.Lock()
LONGEST_WAIT_S = 10.0  # at the end of Python, for a thread that still steps


def temporary_folder() -> str:
    """Return the folder for temporary files, as `tempfile` does, whose import takes longer than a short run.

    Raises:
        OSError: There is none.
    """
    if "tempfile" not in sys.modules:
        chosen = Path(next(filter(None, map(os.environ.get, ("TMPDIR", "TEMP", "TMP"))), "/tmp"))
        if chosen.is_absolute() and chosen.is_dir() and os.access(chosen, os.W_OK | os.X_OK):
            return str(chosen)
    import tempfile

    return tempfile.gettempdir()


class CurrentRun:
    """State that a `Simulation` shares with the finaliser that ends its run if it is not closed.

    Attributes:
        run: None: it is closed, or its last reset failed.
        opened: The newest run, also while it is being opened: Ctrl-C may come before it is `run`.
        lock: Lock of the thread that steps, resets, changes or closes it.
        is_shared: A view goes on with it in a thread of its own: other threads wait for each other.
        should_pause: Makes `step` return after the present slice.
        process: Id of the process that created it.
        when_ended: Called when a run has ended for another one by a reset; its files are complete.
        warned: Warnings that were passed on, of this run, of earlier ones, and of simulations that share them.
    """

    def __init__(self, warned: set[str]) -> None:
        self.run: RunState | None = None
        self.opened: OpenRun | None = None
        self.lock = threading.Lock()
        self.is_shared = False
        self.should_pause = False
        self.process = os.getpid()
        self.when_ended: Callable[[], object] = lambda: None
        self.warned = warned
        self._folder: Path | None = None

    def is_new(self, warning: str) -> bool:
        """Tell whether a warning was not passed on before; from now on it was."""
        with WARNING:
            is_new = warning not in self.warned
            self.warned.add(warning)
            return is_new

    def make_folder(self) -> Path:
        """Make a temporary folder for the rows of a run whose file has no other place.

        Raises:
            ConfigurationError: It cannot be made.
        """
        try:
            # Its name is kept before it is made: Ctrl-C between the two leaves nothing.
            self._folder = folder = Path(temporary_folder(), f"pogosim-{os.urandom(8).hex()}")
            folder.mkdir(mode=0o700)
        except OSError as error:
            self._folder = None
            raise ConfigurationError(
                f"no temporary folder for the rows can be made ({error}); give a data_file, or set TMPDIR"
            ) from None
        return folder

    def open(
        self, program: Path | None, configuration: Path, settings: list[str], seed: int | None, strict: Strict
    ) -> RunState:
        """Build a run and start its program."""
        self.opened = OpenRun()
        open_run(self.opened, program, configuration, settings, seed, strict)
        self.run = RunState(self.opened)
        return self.run

    def abandon(self) -> None:
        """End the run, if there is one, even if it has been opened only in part."""
        if self.opened is not None and self.opened.pointer:
            library().pogosim_run_end(self.opened.pointer)  # what goes wrong at its end is of no interest any more
        self.run = self.opened = None

    def finish(self) -> None:
        """End a run that was not closed, when its simulation is collected or Python ends: its file is complete then."""
        self.should_pause = True
        try:
            self.lock.acquire(timeout=LONGEST_WAIT_S)
            self.clean_up()
        except KeyboardInterrupt:
            interrupt_soon()

    def clean_up(self) -> None:
        """End the run, then remove the temporary folder, if it has one: without it, the rows would be rescued."""
        try:
            self._clean_up()
        except BaseException:  # Ctrl-C
            self._clean_up()
            raise

    def _clean_up(self) -> None:
        self.abandon()
        if self._folder is not None:
            shutil.rmtree(self._folder, ignore_errors=True)


def write_copy(data_file: Path, path: Path) -> None:
    """Write the rows and metadata of a data file to another file; bytes stay as they are if the format does.

    Raises:
        ConfigurationError: The name says no format, is that of the data file itself, or the copy cannot be written.
    """
    kind = format_of(path)
    if kind is None:
        raise given.refused("file", EXPECTED, str(path))
    if leads_to(path, data_file):
        raise ConfigurationError(f"file: {printable(path)} is the data file itself; choose another name")
    try:
        to_device = path.is_char_device()  # as /dev/null
        real = path if to_device else real_output(path)
        beside = metadata_path(path)
        if kind == CSV and beside.exists() and not is_our_metadata(beside):
            raise OutputError(f"{beside} is no file of the simulator and is not overwritten; choose another name")
        with contextlib.nullcontext(real) if to_device else partial_output(real) as partial:
            if kind != format_of(data_file):
                convert(data_file, kind, partial, real)
                return
            shutil.copyfile(data_file, partial)
            if kind == CSV:
                with partial_output(Path(f"{real}{BESIDE}")) as metadata:
                    shutil.copyfile(metadata_path(data_file), metadata)
    except (OutputError, OSError) as error:
        reason = told(error, path) if isinstance(error, OSError) else str(error)
        raise ConfigurationError(printable(f"file: the rows cannot be written: {reason}")) from None


def convert(data_file: Path, kind: str, partial: Path, real: Path) -> None:
    """Write a data file in another format to `partial`, which becomes `real`, and its metadata beside `real`."""
    # They import pyarrow and pandas, which takes most of a second.
    from pogosim.tables import table_writer, write_metadata_beside
    from pogosim.utils import read_table

    table = read_table(data_file)
    with partial.open("wb") as file, contextlib.closing(table_writer(file, kind, table.schema)) as writer:
        writer.write_table(table)
    write_metadata_beside(real, kind, table.schema)
