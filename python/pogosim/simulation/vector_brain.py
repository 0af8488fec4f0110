"""Robots of many runs that this process drives: arrays of a category in all runs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.arguments import shown
from pogosim.simulation.arrays import RunState
from pogosim.simulation.brain import RECEIVED, BrainArrays
from pogosim.simulation.errors import ConfigurationError
from pogosim.simulation.library import Exchange
from pogosim.simulation.many_runs import ManyRuns, bytes_each

# Shape of a robot's row and type, by name, as of pogosim_run_brain_array().
WRITTEN: dict[str, tuple[tuple[int, ...], str]] = {
    "motors": ((3,), "<i4"),
    "leds": ((5, 3), "|u1"),
    "send_bytes": ((382,), "|u1"),
    "send_face": ((), "|i1"),
    "send_length": ((), "<i4"),
}
READ: dict[str, tuple[tuple[int, ...], str]] = {
    "photosensors": ((3,), "<i2"),
    "acceleration": ((3,), "<f4"),
    "angular_velocity": ((3,), "<f4"),
    "battery_mv": ((), "<i2"),
    "received_count": ((), "<u4"),
}
RECEIVED_IN_RUNS = np.dtype([("run", "<i4"), *RECEIVED.descr])
TAKEN_BACK = "send_length"  # which a run sets to -1


def moments_of(runs: ManyRuns) -> tuple[list[RunState], list[int]]:
    """Return what changes when a run begins anew, or goes on from a state: the runs, and how often each has done so."""
    return runs.states, [state.restored for state in runs.states]


class VectorBrain(BrainArrays):
    """The robots of a category with `brain: host` in all runs of a `VectorSimulation`: `runs.brain("robots")`.

    Arrays are those of `Brain` with the runs in front: `motors` has the shape (runs, robots, 3). But they are copies,
    and stay valid: `VectorSimulation.step` gives each run what is in `motors`, `leds` and messages to send, makes its
    steps, and takes its sensors, on the threads of the runs, and only for arrays that were asked for. So values that
    were written hold until others are, also over a reset. `runs[3].step()`, and what `each` calls, go by
    `runs[3].brain("robots")` alone. All runs need as many robots of the category.

        brain = runs.brain("robots")
        for _ in range(1000):
            brain.motors[..., :2] = policy(brain.photosensors)
            runs.step()
    """

    __slots__ = ("_arrays", "_category", "_robots", "_runs", "_seen")

    def __init__(self, runs: Callable[[], ManyRuns], category: str, robots: int) -> None:
        self._runs = runs
        self._category = category
        self._robots = robots
        self._arrays: dict[str, npt.NDArray[Any]] = {}
        self._seen: tuple[list[RunState], list[int]] = [], []  # see `moments_of`; what the arrays show

    def __repr__(self) -> str:
        return f"<pogosim.VectorBrain of category {self._category!r}: {len(self._runs().states)} runs>"

    def _array(self, name: str) -> npt.NDArray[Any]:
        runs = self._runs()
        self._follow(runs)
        if name not in self._arrays:
            row, kind = (WRITTEN | READ)[name]
            made = np.zeros((len(runs.states), self._robots, *row), dtype=kind)
            runs.read(name, made, self._category)
            self._arrays[name] = made
        return self._arrays[name]

    def _follow(self, runs: ManyRuns) -> None:
        """Show what runs measure that have begun anew, or gone on from a state."""
        if self._seen != (now := moments_of(runs)):
            before = list(zip(*self._seen, strict=True))
            for index, moment in enumerate(zip(*now, strict=True)):
                if not before or before[index] != moment:
                    self._take(runs, index)
            self._seen = now

    def _take(self, runs: ManyRuns, run: int) -> None:
        """Take what one run has measured.

        Raises:
            ConfigurationError: It has another number of robots than the others.
        """
        self._check_size(runs, run)
        for name, array in self._arrays.items():
            if name in READ:
                runs.read(name, array, self._category, run)

    def _check_size(self, runs: ManyRuns, run: int) -> None:
        """Check that a run has as many robots as the others.

        Raises:
            ConfigurationError: It has not.
        """
        if (found := len(runs.states[run].brain_array(self._category, "motors"))) != self._robots:
            raise ConfigurationError(
                f"run {run} has {found} robots in category {shown(self._category)} since its reset, and the others "
                f"{self._robots}: reset it with as many, or make another VectorSimulation"
            )

    def _check_sizes(self, runs: ManyRuns) -> None:
        """Check that all runs have as many robots, if one has begun anew since the arrays were made.

        Raises:
            ConfigurationError: One has not.
        """
        if self._seen != moments_of(runs):
            for index in range(len(runs.states)):
                self._check_size(runs, index)

    def _note_step(self, runs: ManyRuns) -> None:
        """Remember that the arrays show what the runs have measured."""
        self._seen = moments_of(runs)

    def _exchanges(self, runs: ManyRuns) -> list[Exchange]:
        """Return what a step gives the runs, and takes: what they have measured, and which messages wait still.

        Raises:
            ConfigurationError: A run has another number of robots than the others.
        """
        self._check_sizes(runs)
        category = self._category.encode()
        return [
            Exchange(
                category=category,
                name=name.encode(),
                place=array.ctypes.data,
                bytes_each=bytes_each(array),
                gives=name in WRITTEN,
                takes=name in READ or name == TAKEN_BACK,
            )
            for name, array in self._arrays.items()
        ]

    @property
    def received(self) -> npt.NDArray[Any]:
        """Messages that were received since `clear_received`, those of a run together, as a structured array.

        Its fields are run, robot (row), sender (id), face, and length and offset in `received_bytes`. Shape
        (messages,); a copy, as of the end of the last step of each run.
        """
        runs = self._present_runs()
        table, counts = runs.read_rows(self._category, "received", RECEIVED)
        messages = np.empty(len(table), RECEIVED_IN_RUNS)
        messages["run"] = np.repeat(np.arange(len(counts)), counts)
        for name in RECEIVED.names or ():
            messages[name] = table[name]
        # The payloads of a run stand behind those of the runs before it.
        bytes_until = np.concatenate(([0], np.cumsum(messages["length"], dtype=np.int64)))
        messages["offset"] += np.repeat(bytes_until[np.cumsum(counts) - counts], counts).astype(np.int32)
        return messages

    @property
    def received_bytes(self) -> npt.NDArray[np.uint8]:
        """The payloads of all these messages, one after the other. A copy: take it once for many messages."""
        return self._present_runs().read_rows(self._category, "received_bytes", np.dtype(np.uint8))[0]

    def _present_runs(self) -> ManyRuns:
        """Return the runs, all of which have as many robots.

        Raises:
            ConfigurationError: One has not.
        """
        runs = self._runs()
        self._check_sizes(runs)
        return runs

    def clear_received(self) -> None:
        """Forget the messages that all runs have received, see `Brain.clear_received`."""
        runs = self._runs()
        self._follow(runs)
        runs.clear_received(self._category)
        if "received_count" in self._arrays:
            self._arrays["received_count"][...] = 0
