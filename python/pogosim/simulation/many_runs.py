"""Runs that are stepped together, and read together, by one call of the library each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from ctypes import byref, c_void_p, string_at
from threading import Lock
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.simulation.arrays import RunState
from pogosim.simulation.errors import SimulationError
from pogosim.simulation.forked import finalize_here
from pogosim.simulation.library import OK, OVER, ArrayPlace, Exchange, Turn, check, error_of_step, library
from pogosim.simulation.run import SLICE_S

IN_USE = "a simulation is in use by another thread: give each thread one of its own"


class RunThreads:
    """Threads of the library on which many runs go on.

    Args:
        count: How many runs go on at a time.
    """

    def __init__(self, count: int) -> None:
        self._handle = c_void_p()
        check(library().pogosim_threads_open(count, byref(self._handle)))
        self.close = finalize_here(self, library().pogosim_threads_close, self._handle)

    def step(self, runs: ManyRuns, exchanges: Sequence[Exchange]) -> dict[int, SimulationError]:
        """Let runs make steps for a while, each at least one. Returns what went wrong, by the index of the run.

        Args:
            runs: They; their `turns` say what each is to do, and has done.
            exchanges: The arrays that each is given before its steps, and that are taken after them.
        """
        turns, count = runs.turns, len(exchanges)
        arrays = (Exchange * count)(*exchanges)
        where = turns.ctypes.data
        if library().pogosim_threads_step(self._handle, runs.pointers, where, len(turns), arrays, count, SLICE_S) == OK:
            return {}
        failed = np.flatnonzero((turns["status"] != OK) & (turns["status"] != OVER))
        found = {}
        for run in failed.tolist():
            if text := library().pogosim_threads_error(self._handle, run):
                found[run] = error_of_step(int(turns["status"][run]), text)
        return found


class ManyRuns:
    """The present runs of many simulations.

    Args:
        states: They, in order.
    """

    def __init__(self, states: Sequence[RunState]) -> None:
        self.states = list(states)
        self.pointers = (c_void_p * len(self.states))(*(state.pointer.value for state in self.states))
        self.turns = np.zeros(len(self.states), dtype=np.dtype(Turn))

    def read(self, name: str, into: npt.NDArray[Any], category: str | None = None, run: int | None = None) -> None:
        """Copy an array of each run, see pogosim_runs_read().

        Args:
            name: Its name in the library.
            into: Where to, without gaps. Shape (runs, ...).
            category: That of a brain; None: it is one of the run itself.
            run: Copy that of one run alone.

        Raises:
            ConfigurationError: The arrays of some runs have other shapes.
        """
        if not len(into):
            return
        of_category = None if category is None else category.encode()
        size = bytes_each(into)
        pointers, place, count = self.pointers, into.ctypes.data, len(into)
        if run is not None:
            pointers, place, count = (c_void_p * 1)(self.pointers[run]), place + run * size, 1
        check(library().pogosim_runs_read(pointers, count, of_category, name.encode(), place, size))

    def read_rows(self, category: str, name: str, kind: np.dtype[Any]) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
        """Copy an array of a brain that has more rows in some runs than in others.

        Args:
            category: That of the brain.
            name: Its name in the library.
            kind: The type of a row, which has no gaps.

        Returns:
            The rows of all runs, one after the other; and how many each run has. Shape (runs,).
        """
        find, place = library().pogosim_run_brain_array, ArrayPlace()
        of_category, of_name = category.encode(), name.encode()
        counts, parts = [], []
        for pointer in self.pointers:
            check(find(pointer, of_category, of_name, byref(place)))
            rows = place.shape[0]
            counts.append(rows)
            if rows:
                parts.append(string_at(place.data, rows * kind.itemsize))
        return np.frombuffer(b"".join(parts), kind), np.array(counts, dtype=np.int64)

    def clear_received(self, category: str) -> None:
        """Forget the messages that the robots of a category have received in all runs."""
        clear, of_category = library().pogosim_run_clear_received, category.encode()
        for pointer in self.pointers:
            check(clear(pointer, of_category))


def bytes_each(array: npt.NDArray[Any]) -> int:
    """Return the size of the part of one run. Shape (runs, ...), without gaps."""
    return array.nbytes // len(array) if len(array) else 0


@contextmanager
def all_held(locks: Sequence[tuple[Lock, bool]]) -> Iterator[None]:
    """Hold the locks of simulations meanwhile, each with whether to wait for it: a view goes on with the run.

    Raises:
        SimulationError: Another thread has one of them.
    """
    held: list[Lock] = []
    try:
        for lock, waits in locks:
            held.append(lock)  # before it is: Ctrl-C may come in between
            if not lock.acquire(waits):  # by name, the argument takes as long as the rest
                held.pop()
                raise SimulationError(IN_USE)
        yield
    finally:
        with suppress(RuntimeError):  # the last one was not held yet
            for lock in held:
                lock.release()
