"""Robots of many runs that this process drives: arrays of a category in all runs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.arguments import shown
from pogosim.simulation.brain import whole
from pogosim.simulation.errors import ConfigurationError
from pogosim.simulation.library import check, library
from pogosim.simulation.many_runs import ManyRuns

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
TAKEN_BACK = "send_length"  # which a run sets to -1


class VectorBrain:
    """The robots of a category with `brain: host` in all runs of a `VectorSimulation`: `runs.brain("robots")`.

    Arrays are those of `Brain` with the runs in front: `motors` has the shape (runs, robots, 3). But they are copies,
    and stay valid: `VectorSimulation.step` gives all runs what is in `motors`, `leds` and messages to send, then makes
    the steps, then takes the sensors, by one call each for all runs, and only for arrays that were asked for. So
    values that were written hold until others are, also over a reset. `runs[3].step()`, and what `each` calls, go by
    `runs[3].brain("robots")` alone. All runs need as many robots of the category.

    Messages that were received are asked for run by run: `runs[3].brain("robots").received`.

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
        self._seen: list[object] = []  # the runs that the arrays are of

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
        """Show what runs measure that have begun anew."""
        if self._seen != runs.states:
            for index, state in enumerate(runs.states):
                if not self._seen or self._seen[index] is not state:
                    self._take(runs, index)
            self._seen = list(runs.states)

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

    def _write(self, runs: ManyRuns) -> None:
        """Give the runs what was written."""
        if self._seen != runs.states:
            for index in range(len(runs.states)):
                self._check_size(runs, index)
        for name, array in self._arrays.items():
            if name in WRITTEN:
                runs.write(name, array, self._category)

    def _read(self, runs: ManyRuns) -> None:
        """Take what the runs have measured, and which messages wait still."""
        self._seen = list(runs.states)
        for name, array in self._arrays.items():
            if name in READ or name == TAKEN_BACK:
                runs.read(name, array, self._category)

    @property
    def motors(self) -> npt.NDArray[np.int32]:
        """Powers, -1023 to 1023, positive is forward. Shape (runs, robots, 3): right, left, back; to be written."""
        return self._array("motors")

    @motors.setter
    def motors(self, values: npt.ArrayLike) -> None:
        self.motors[...] = whole("motors", values, (-(2**31), 2**31 - 1), "from -1023 to 1023")

    @property
    def leds(self) -> npt.NDArray[np.uint8]:
        """Colours of the LEDs. Shape (runs, robots, 5, 3): head, front, right, back, left; to be written."""
        return self._array("leds")

    @leds.setter
    def leds(self, values: npt.ArrayLike) -> None:
        self.leds[...] = whole("leds", values, (0, 255), "from 0 to 255")

    @property
    def send_bytes(self) -> npt.NDArray[np.uint8]:
        """Messages to send, in the first `send_length` bytes. Shape (runs, robots, 382); to be written."""
        return self._array("send_bytes")

    @send_bytes.setter
    def send_bytes(self, values: npt.ArrayLike) -> None:
        self.send_bytes[...] = whole("send_bytes", values, (0, 255), "from 0 to 255")

    @property
    def send_length(self) -> npt.NDArray[np.int32]:
        """Bytes to send, 0 to 382, -1: none; set back to -1 when they are sent. Shape (runs, robots); to be written."""
        return self._array("send_length")

    @send_length.setter
    def send_length(self, values: npt.ArrayLike) -> None:
        self.send_length[...] = whole("send_length", values, (-(2**31), 2**31 - 1), "from -1 to 382")

    @property
    def send_face(self) -> npt.NDArray[np.int8]:
        """Where to: 0 front, 1 right, 2 back, 3 left, -1 in all directions. Shape (runs, robots); to be written."""
        return self._array("send_face")

    @send_face.setter
    def send_face(self, values: npt.ArrayLike) -> None:
        self.send_face[...] = whole("send_face", values, (-128, 127), "from -1 to 3")

    def clear_received(self) -> None:
        """Forget the messages that all runs have received, see `Brain.clear_received`."""
        runs = self._runs()
        for state in runs.states:
            check(library().pogosim_run_clear_received(state.pointer, self._category.encode()))
        for index in range(len(runs.states)):
            self._take(runs, index)

    @property
    def photosensors(self) -> npt.NDArray[np.int16]:
        """Sensor counts. Shape (runs, robots, 3): back, front left, front right; -1 without a body."""
        return self._array("photosensors")

    @property
    def acceleration(self) -> npt.NDArray[np.float32]:
        """What `pogobot_imu_read` gives, m/s2. Shape (runs, robots, 3): to the right, forward, up."""
        return self._array("acceleration")

    @property
    def angular_velocity(self) -> npt.NDArray[np.float32]:
        """What `pogobot_imu_read` gives, rad/s. Shape (runs, robots, 3); the last counter-clockwise from above."""
        return self._array("angular_velocity")

    @property
    def battery_mv(self) -> npt.NDArray[np.int16]:
        """Voltages of the batteries, mV. Shape (runs, robots)."""
        return self._array("battery_mv")

    @property
    def received_count(self) -> npt.NDArray[np.uint32]:
        """Messages received since `clear_received`. Shape (runs, robots)."""
        return self._array("received_count")
