"""Columns that a program has added to the data file, as they were at the last save."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from pogosim.arguments import shown
from pogosim.simulation.arrays import RunState


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
