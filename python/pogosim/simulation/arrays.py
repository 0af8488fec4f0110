"""Arrays and numbers of a run, where the simulator has them."""

from __future__ import annotations

import os
from ctypes import byref, c_double, c_void_p, string_at
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.simulation.errors import SimulationError
from pogosim.simulation.library import ArrayPlace, OpenRun, check, library

NO_BODY = 2**32 - 1
TEXT = b"text"


class Memory:
    """Memory of a run, for NumPy. Arrays made from it keep `owner` alive."""

    def __init__(self, place: ArrayPlace, owner: object) -> None:
        self.owner = owner
        shape = tuple(place.shape[: place.dimensions])
        self.__array_interface__: dict[str, Any] = {
            "version": 3,
            "shape": shape,
            "typestr": place.type.decode(),
            "data": (place.data or 0, True),  # read-only
            "strides": tuple(place.stride_bytes[: place.dimensions]),
        }


def check_process(process: int) -> None:
    """Raise SimulationError in a child of the process that has made a run: both would write the same files."""
    if os.getpid() != process:
        raise SimulationError(
            f"the simulation belongs to process {process}, which has forked this one: make one of its own here"
        )


class RunState:
    """The present state of a run. Any thread may read it at any time; reads are answered between two time steps.

    Each reset of a simulation creates a new one; code that keeps an old one sees the end of the old run.
    """

    def __init__(self, run: OpenRun) -> None:
        self._run = run
        self._process = os.getpid()
        self._arrays: dict[str, npt.NDArray[Any]] = {}
        self._rows_of_robots: slice | npt.NDArray[Any] | None = None

    @property
    def pointer(self) -> c_void_p:
        """The run for functions of the library. This object must live until they return."""
        check_process(self._process)
        return self._run.pointer

    def number(self, name: str) -> float:
        """Return a number of pogosim_run_number()."""
        value = c_double()
        check(library().pogosim_run_number(self.pointer, name.encode(), byref(value)))
        return value.value

    def names(self, function: str) -> list[str]:
        """Return what pogosim_run_categories() or pogosim_run_columns() gives."""
        text: bytes = getattr(library(), function)(self.pointer)
        return text.decode().split("\n") if text else []

    def array(self, name: str) -> npt.NDArray[Any]:
        """Return an array of pogosim_run_array() as a read-only view, which keeps the run."""
        pointer = self.pointer
        if name not in self._arrays:
            place = ArrayPlace()
            check(library().pogosim_run_array(pointer, name.encode(), byref(place)))
            shape = tuple(place.shape[: place.dimensions])
            has_memory = bool(place.data)
            self._arrays[name] = (
                np.asarray(Memory(place, self._run)) if has_memory else np.zeros(shape, dtype=place.type.decode())
            )
        return self._arrays[name]

    def texts(self, name: str) -> list[str] | None:
        """Return a column of strings; None if it is one of numbers."""
        place = ArrayPlace()
        check(library().pogosim_run_array(self.pointer, name.encode(), byref(place)))
        if place.type != TEXT:
            return None
        texts: list[str] = string_at(place.data, place.shape[0]).decode().split("\0")
        return texts[:-1]  # each is ended by a zero

    def of_robots(self, name: str) -> npt.NDArray[Any]:
        """Return rows of an array of bodies: a view if the bodies of the robots stand in a row, which is usual."""
        values = self.array(name)
        rows = self._rows_of_robots
        if rows is None:
            body = self.array("robots.body")
            first = int(body[0]) if len(body) else 0
            in_a_row = bool(np.array_equal(body, np.arange(first, first + len(body))))
            rows = self._rows_of_robots = slice(first, first + len(body)) if in_a_row else body
        if isinstance(rows, slice):
            return values[rows]
        copy = np.full((len(rows), *values.shape[1:]), np.nan, dtype=values.dtype)
        has_body = rows != NO_BODY
        copy[has_body] = values[rows[has_body]]
        return copy

    def light_levels(self) -> npt.NDArray[np.float64]:
        """Return what pogosim_run_light_levels() gives."""
        levels = np.empty(int(self.number("robot_count")))
        library().pogosim_run_light_levels(self.pointer, levels.ctypes.data)
        return levels
