"""Runs that are stepped together, and read together, by one call of the library each."""

from __future__ import annotations

import os
import weakref
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from ctypes import byref, c_void_p
from threading import Lock
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.simulation.arrays import RunState
from pogosim.simulation.errors import SimulationError
from pogosim.simulation.library import OK, OVER, Exchange, Turn, check, error_of_step, library
from pogosim.simulation.run import SLICE_S

IN_USE = "a simulation is in use by another thread: give each thread one of its own"


def close_threads(handle: c_void_p, process: int) -> None:
    """End the threads of a handle, unless this is a forked child, which has none of them."""
    if os.getpid() == process:
        library().pogosim_threads_close(handle)


class RunThreads:
    """Threads of the library on which many runs go on.

    Args:
        count: How many runs go on at a time.
    """

    def __init__(self, count: int) -> None:
        self._handle = c_void_p()
        check(library().pogosim_threads_open(count, byref(self._handle)))
        self.close = weakref.finalize(self, close_threads, self._handle, os.getpid())

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


def bytes_each(array: npt.NDArray[Any]) -> int:
    """Return the size of the part of one run. Shape (runs, ...), without gaps."""
    return array.nbytes // len(array) if len(array) else 0


@contextmanager
def all_held(locks: Sequence[Lock]) -> Iterator[None]:
    """Hold the locks of simulations meanwhile.

    Raises:
        SimulationError: Another thread has one of them.
    """
    held: list[Lock] = []
    try:
        for lock in locks:
            held.append(lock)  # before it is: Ctrl-C may come in between
            if not lock.acquire(False):  # by name, the argument takes as long as the rest
                held.pop()
                raise SimulationError(IN_USE)
        yield
    finally:
        with suppress(RuntimeError):  # the last one was not held yet
            for lock in held:
                lock.release()
