"""Arrays and numbers of a run, where the simulator has them."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from ctypes import byref, c_double, c_void_p, string_at
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.arguments import shown
from pogosim.simulation.errors import ConfigurationError, given
from pogosim.simulation.forked import check_process
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


def writable(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return a view of the same memory that can be written."""
    interface = dict(array.__array_interface__)
    address, _ = interface["data"]
    interface["data"] = (address, False)
    holder = type("UserData", (), {"__array_interface__": interface, "owner": array})()
    return np.asarray(holder)


def chosen_rows(name: str, chosen: Any, count: int, what: str, where: str) -> npt.NDArray[np.int64]:
    """Return the indices that an argument chooses.

    Args:
        name: That of the argument, as messages say it.
        chosen: An index, an array of indices, or an array of booleans, one for each.
        count: How many there are.
        what: What is chosen: "link".
        where: What has so many: "the run has".

    Raises:
        ConfigurationError: It is none of these, or there is nothing of an index.
    """
    rows = np.asarray(chosen)
    if rows.dtype != np.bool_ and isinstance(chosen, list | tuple) and any(isinstance(one, bool) for one in chosen):
        raise given.refused(name, "indices, or True or False for each, but not both", chosen)
    if rows.dtype == np.bool_ and rows.ndim == 1:
        if len(rows) != count:
            raise ConfigurationError(
                f"{name}: expected {count} values of True or False, one for each, found {len(rows)}"
            )
        rows = np.flatnonzero(rows)
    if rows.ndim > 1 or (rows.size and not np.issubdtype(rows.dtype, np.integer)):
        raise given.refused(name, f"an index, an array of indices, or True or False for each {what}", chosen)
    rows = np.atleast_1d(rows).astype(np.int64)
    outside = rows[(rows < 0) | (rows >= count)]
    if len(outside):
        raise ConfigurationError(f"{name}: there is no {what} {outside[0]}: {where} {count}")
    return rows


class RunState:
    """The present state of a run. Any thread may read it at any time; reads are answered between two time steps.

    Each reset of a simulation creates a new one; code that keeps an old one sees the end of the old run.

    Attributes:
        known_pointer: `pointer` for code that has checked the process.
        restored: How many times it has gone on from a saved state.
    """

    def __init__(self, run: OpenRun) -> None:
        self._run = run
        self.known_pointer = run.pointer
        self.restored = 0
        self._process = os.getpid()
        self._arrays: dict[str, npt.NDArray[Any]] = {}
        self._writable: dict[str, npt.NDArray[Any]] = {}
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

    def brain_array(self, category: str, name: str, *, stays: bool = True) -> npt.NDArray[Any]:
        """Return an array of pogosim_run_brain_array() as a view, which keeps the run. `stays`: its shape is fixed."""
        pointer = self.pointer
        key = f"{category}\0{name}"
        if key not in self._arrays:
            place = ArrayPlace()
            check(library().pogosim_run_brain_array(pointer, category.encode(), name.encode(), byref(place)))
            shape = tuple(place.shape[: place.dimensions])
            has_memory = bool(place.data) and 0 not in shape
            found = np.asarray(Memory(place, self._run)) if has_memory else np.zeros(shape, dtype=place.type.decode())
            if not stays:
                return found
            self._arrays[key] = found
        return self._arrays[key]

    def firmware_bytes(
        self, file: Path, robots: int, address: int, size: int
    ) -> tuple[npt.NDArray[np.uint8], npt.NDArray[np.bool_]]:
        """Return a copy of bytes in the memory of the robots that run a firmware, and which do.

        Args:
            file: Its ELF file.
            robots: How many the run has (n).
            address: Where these bytes begin.
            size: How many bytes.

        Returns:
            Bytes (n, size), 0 for robots that do not run it; whether they do (n).
        """
        found = np.zeros((robots, size), dtype=np.uint8)
        runs_it = np.zeros(robots, dtype=np.bool_)
        places = (array.ctypes.data_as(c_void_p) for array in (found, runs_it))
        check(library().pogosim_run_firmware_bytes(self.pointer, os.fsencode(file), address, size, *places))
        return found, runs_it

    def kept_writable(self, name: str, make: Callable[[], npt.NDArray[Any]]) -> npt.NDArray[Any]:
        """Return the writable array that `make` gave at first. `retire` finds it by this."""
        if name not in self._writable:
            self._writable[name] = make()
        return self._writable[name]

    def retire(self) -> None:
        """Let writing raise, since nothing reads these arrays any more: another run begins."""
        for array in self._writable.values():
            array.flags.writeable = False

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


class Columns(Mapping[str, Any]):
    """What robots gave with `data_set_value_*` at the last save of rows, by name of the column.

        heard = sim.columns["heard"]
        print(sim.columns.time, heard.mean(), heard[sim.positions[:, 0] < 500])

    A column of numbers or booleans is a masked array of shape (robots,), in the type of the data file: a read-only
    view, which goes with the run from save to save. Masked are robots that gave no value, or whose row is not in the
    data file; below the mask is NaN, 0 or False. A column of strings is a list of str, with None for these robots; it
    is new each time. All columns that the program has added are there, those that `data_logger_fields` leaves out, too.
    """

    def __init__(self, run: RunState) -> None:
        """Look at the columns of a run."""
        self._run = run
        self._names = run.names("pogosim_run_columns")

    @property
    def time(self) -> float:
        """Simulated time of the last save, s; NaN: there was none (`enable_data_logging: false`)."""
        return self._run.number("save_time")

    def __getitem__(self, name: str) -> Any:
        if name not in self:
            raise KeyError(f"the program has added no column {shown(name)} to the data file; {self._what_there_is()}")
        absent = self._run.array(f"columns_absent.{name}")
        if (texts := self._run.texts(f"columns.{name}")) is not None:
            return [None if is_absent else text for text, is_absent in zip(texts, absent.tolist(), strict=True)]
        return np.ma.MaskedArray(self._run.array(f"columns.{name}"), absent)

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and name in self._names

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"<columns at t = {self.time:g} s: {', '.join(self._names)}>"

    def _what_there_is(self) -> str:
        if self._names:
            return f"there are {', '.join(self._names)}"
        return "it has added none, or the run records no rows (enable_data_logging: false)"
