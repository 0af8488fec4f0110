"""Columns that a program has added to the data file, as they were at the last save."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from ctypes import byref, c_double, c_void_p, string_at
from typing import Any

import numpy as np

from pogosim.simulation.arrays import array_of
from pogosim.simulation.library import ArrayPlace, check, library

TEXT = b"text"


class Columns(Mapping[str, Any]):
    """What robots gave with `data_set_value_*` at the last save of rows, by name of the column.

        heard = sim.columns["heard"]
        print(sim.columns.time, heard.mean(), heard[sim.positions[:, 0] < 500])

    A column of numbers or booleans is a masked array of shape (robots,), in the type of the data file: a read-only
    view, which goes with the run from save to save. Masked are robots that gave no value, or whose row is not in the
    data file; below the mask is NaN, 0 or False. A column of strings is a list of str, with None for these robots; it
    is new each time. All columns that the program has added are there, those that `data_logger_fields` leaves out, too.
    """

    def __init__(self, run: c_void_p, owner: object) -> None:
        """Look at the columns of a run.

        Args:
            run: The run.
            owner: Keeps the run as long as an array of it exists.
        """
        self._run = run
        self._owner = owner
        names: bytes = library().pogosim_run_columns(run)
        self._names = names.decode().split("\n") if names else []

    @property
    def time(self) -> float:
        """Simulated time of the last save, s; NaN: there was none (`enable_data_logging: false`)."""
        value = c_double()
        check(library().pogosim_run_number(self._run, b"save_time", byref(value)))
        return value.value

    def __getitem__(self, name: str) -> Any:
        if name not in self._names:
            raise KeyError(f"the program has added no column '{name}' to the data file; {self._what_there_is()}")
        absent = array_of(self._run, f"columns_absent.{name}", self._owner)
        place = ArrayPlace()
        check(library().pogosim_run_array(self._run, f"columns.{name}".encode(), byref(place)))
        if place.type == TEXT:
            texts = string_at(place.data, place.shape[0]).decode().split("\0")
            return [None if is_absent else text for text, is_absent in zip(texts, absent.tolist(), strict=False)]
        return np.ma.MaskedArray(array_of(self._run, f"columns.{name}", self._owner), absent)

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
