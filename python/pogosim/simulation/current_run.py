"""The current run of a simulation, and its cleanup."""

from __future__ import annotations

import os
import shutil
import tempfile
import threading
from contextlib import suppress
from pathlib import Path

from pogosim.simulation.arrays import RunState
from pogosim.simulation.errors import ConfigurationError, SimulationError
from pogosim.simulation.library import check, library

LONGEST_WAIT_S = 10.0  # at the end of Python, for a thread that still steps


def own_folder() -> Path:
    """Make a folder for the rows of a run whose file has no other place.

    Raises:
        ConfigurationError: It cannot be made.
    """
    try:
        return Path(tempfile.mkdtemp(prefix="pogosim-"))
    except OSError as error:
        raise ConfigurationError(
            f"no temporary folder for the rows can be made ({error}); give a data_file, or set TMPDIR"
        ) from None


class CurrentRun:
    """State that a `Simulation` shares with the finaliser that ends its run if it is not closed.

    Attributes:
        run: None: it is closed, or its last reset failed.
        lock: Lock of the thread that steps, resets, changes or closes it.
        should_pause: Makes `step` return after the present slice.
        process: Id of the process that created it.
    """

    def __init__(self, folder: Path | None) -> None:
        self.run: RunState | None = None
        self.lock = threading.Lock()
        self.should_pause = False
        self.process = os.getpid()
        self._folder = folder

    def finish(self) -> None:
        """End a run that was not closed, when its simulation is collected or Python ends: its file is complete then."""
        self.should_pause = True
        self.lock.acquire(timeout=LONGEST_WAIT_S)
        run, self.run = self.run, None
        with suppress(SimulationError):
            if run is not None:
                check(library().pogosim_run_end(run.pointer))
        self.remove_folder()

    def remove_folder(self) -> None:
        """Remove the temporary folder, if it has one."""
        if self._folder is not None:
            shutil.rmtree(self._folder, ignore_errors=True)
