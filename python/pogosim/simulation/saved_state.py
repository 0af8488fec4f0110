"""A copy of the state of a run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from ctypes import byref, c_void_p
from typing import Any

from pogosim.simulation.arrays import RunState
from pogosim.simulation.library import check, library


class SavedState:
    """What `Simulation.save` returns, for `Simulation.restore` of the same run, before its next `reset`.

    It is in memory of this process: it cannot be pickled, nor used in another process.

    Attributes:
        pointer: The copy, for functions of the library.
        settings: The settings that the simulation was given, or had since.
        parameters: The values of its parameters.
    """

    def __init__(self, run: RunState, settings: Mapping[str, Any], parameters: Mapping[str, Any]) -> None:
        """Copy the state of a run.

        Raises:
            ConfigurationError: It cannot be copied.
        """
        self.pointer = c_void_p()
        self.settings = dict(settings)
        self.parameters = dict(parameters)
        self._free: Callable[[c_void_p], None] = library().pogosim_state_free
        check(library().pogosim_run_save_state(run.pointer, byref(self.pointer)))

    def __del__(self) -> None:
        if self.__dict__.get("_free") is not None:
            self._free(self.pointer)

    def __reduce__(self) -> str:
        raise TypeError("the state of a run is in memory of this process: it cannot be pickled or copied")
