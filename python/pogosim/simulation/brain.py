"""Robots that this process drives: arrays of a whole category, where the simulator has them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.arguments import shown
from pogosim.simulation.arrays import RunState, writable
from pogosim.simulation.errors import ConfigurationError, given
from pogosim.simulation.library import check, library

RECEIVED = np.dtype([(name, "<i4") for name in ("robot", "sender", "face", "length", "offset")])
MOST_BYTES = 382


def whole(name: str, values: npt.ArrayLike, limits: tuple[int, int], meaning: str, scale: str = "") -> npt.NDArray[Any]:
    """Return values that an array of whole numbers can take as they are.

    Args:
        name: That of the array.
        values: To be assigned.
        limits: The least and the greatest number that the array can hold.
        meaning: Those that make sense, as words.
        scale: What values from 0 to 1 may be multiplied by; empty: they are no shares of anything.

    Raises:
        ConfigurationError: Some are no whole numbers (as True is), or beyond the limits.
    """
    found = np.asarray(values)
    is_fine = np.zeros(found.shape, dtype=bool)
    if found.dtype.kind in "iu":
        is_fine = np.asarray((found >= limits[0]) & (found <= limits[1]))
    elif found.dtype.kind == "f":
        is_fine = np.asarray((found == np.rint(found)) & (found >= limits[0]) & (found <= limits[1]))
    if not is_fine.all():
        wrong = found[~is_fine].flat[0]
        text = f"{wrong:g}" if found.dtype.kind in "iuf" else shown(wrong.item() if found.dtype.kind == "b" else wrong)
        advice = f"; scale and round what is from 0 to 1, such as np.rint({scale} * values)" if scale else ""
        raise ConfigurationError(f"brain.{name} takes whole numbers {meaning}, found {text}{advice}")
    return found


class BrainArrays:
    """Arrays that drive the robots of a category, and what these measure, whatever has them.

    Shapes are those of a `Brain`, in which what is measured is read-only; a `VectorBrain` has the runs in front: (runs,
    robots, 3) in place of (robots, 3).
    """

    __slots__ = ()

    def _array(self, name: str) -> npt.NDArray[Any]:
        """Return an array by its name in the library."""
        raise NotImplementedError

    def _writable(self, name: str) -> npt.NDArray[Any]:
        """Return one that is to be written."""
        return self._array(name)

    @property
    def motors(self) -> npt.NDArray[np.int32]:
        """Powers, -1023 to 1023, positive is forward. Shape (robots, 3): right, left, back; to be written."""
        return self._writable("motors")

    @motors.setter
    def motors(self, values: npt.ArrayLike) -> None:
        self.motors[...] = whole("motors", values, (-(2**31), 2**31 - 1), "from -1023 to 1023", scale="1023")

    @property
    def leds(self) -> npt.NDArray[np.uint8]:
        """Colours of the LEDs, to be written. Shape (robots, 5, 3): head, front, right, back, left; channels."""
        return self._writable("leds")

    @leds.setter
    def leds(self, values: npt.ArrayLike) -> None:
        self.leds[...] = whole("leds", values, (0, 255), "from 0 to 255", scale="255")

    @property
    def send_bytes(self) -> npt.NDArray[np.uint8]:
        """Messages to send, in the first `send_length` bytes. Shape (robots, 382); to be written."""
        return self._writable("send_bytes")

    @send_bytes.setter
    def send_bytes(self, values: npt.ArrayLike) -> None:
        self.send_bytes[...] = whole("send_bytes", values, (0, 255), "from 0 to 255")

    @property
    def send_length(self) -> npt.NDArray[np.int32]:
        """Bytes to send, 0 to 382, -1: none; set back to -1 when they are sent. Shape (robots,); to be written."""
        return self._writable("send_length")

    @send_length.setter
    def send_length(self, values: npt.ArrayLike) -> None:
        self.send_length[...] = whole("send_length", values, (-(2**31), 2**31 - 1), "from -1 to 382")

    @property
    def send_face(self) -> npt.NDArray[np.int8]:
        """Where to: 0 front, 1 right, 2 back, 3 left, -1 in all directions. Shape (robots,); to be written."""
        return self._writable("send_face")

    @send_face.setter
    def send_face(self, values: npt.ArrayLike) -> None:
        self.send_face[...] = whole("send_face", values, (-128, 127), "from -1 to 3")

    @property
    def photosensors(self) -> npt.NDArray[np.int16]:
        """Sensor counts. Shape (robots, 3): back, front left, front right; -1 without a body."""
        return self._array("photosensors")

    @property
    def acceleration(self) -> npt.NDArray[np.float32]:
        """What `pogobot_imu_read` gives, m/s2. Shape (robots, 3): to the right, forward, up."""
        return self._array("acceleration")

    @property
    def angular_velocity(self) -> npt.NDArray[np.float32]:
        """What `pogobot_imu_read` gives, rad/s. Shape (robots, 3); [:, 2] counter-clockwise from above."""
        return self._array("angular_velocity")

    @property
    def battery_mv(self) -> npt.NDArray[np.int16]:
        """Voltages of the batteries, mV. Shape (robots,)."""
        return self._array("battery_mv")

    @property
    def received_count(self) -> npt.NDArray[np.uint32]:
        """Messages received since `clear_received`. Shape (robots,)."""
        return self._array("received_count")


class Brain(BrainArrays):
    """The robots of a category whose configuration says `brain: host`: `sim.brain("robots")`.

    Rows are the robots of the category, in the order of the arrays of the simulation. Between two steps, write
    `motors`, `leds` and messages, and read the rest: nothing is copied. Each robot takes what is written at its next
    tick, every 16 ms of its own clock, and its sensors are those of its last tick.

    Arrays may be assigned, which copies values into them: `brain.motors = powers`, `brain.leds //= 2`.

    Powers are integers from -1023 to 1023, to which greater ones are cut, with a warning for the first. NumPy cuts off
    fractions without a word, so a power of 0.8 becomes 0: scale what is from -1 to 1, as in
    `brain.motors[:, :2] = np.rint(1023 * policy)`.

    Arrays belong to a run: ask for them again after `Simulation.reset`. Writing to one of the run before raises
    ValueError (of NumPy: read-only); but not to a part of it, such as `brain.motors[:, 0]`, that was kept.

        brain = sim.brain("robots")
        while sim.step():
            brain.motors[:, :2] = policy(brain.photosensors)
    """

    __slots__ = ("_category", "_run")  # a misspelt array is an error

    def __init__(self, run: Callable[[], RunState], category: str) -> None:
        self._run = run
        self._category = given.text("category", category)
        self._array("motors")  # raises if there is none

    def _array(self, name: str) -> npt.NDArray[Any]:
        return self._run().brain_array(self._category, name)

    def _writable(self, name: str) -> npt.NDArray[Any]:
        run = self._run()
        array = run.brain_array(self._category, name)
        return run.kept_writable(f"{self._category}\0{name}", lambda: writable(array))

    def __len__(self) -> int:
        return len(self._array("motors"))

    def __repr__(self) -> str:
        return f"<pogosim.Brain of category {self._category!r}>"

    @property
    def received(self) -> npt.NDArray[Any]:
        """Those messages, as a structured array: robot (row), sender (id), face, length and offset in `received_bytes`.

        Shape (messages,); read-only, and as long as it is now: ask again after a step.
        """
        table = self._run().brain_array(self._category, "received", stays=False)
        return np.ascontiguousarray(table).view(RECEIVED)[:, 0] if len(table) else np.zeros(0, RECEIVED)

    @property
    def received_bytes(self) -> npt.NDArray[np.uint8]:
        """The payloads of all received messages, one after the other. Read-only, as long as it is now."""
        return self._run().brain_array(self._category, "received_bytes", stays=False)

    def payload(self, message: Any) -> bytes:
        """Return the payload of one entry of `received`."""
        begin = int(message["offset"])
        return self.received_bytes[begin : begin + int(message["length"])].tobytes()

    def send(self, robot: int, message: bytes, face: int = -1) -> None:
        """Let a robot (row) send a message of up to 382 bytes at its next tick.

        Raises:
            ConfigurationError: It is too long or not of bytes, or there is no such robot or face.
        """
        row = given.integer("robot", robot, least=0, most=len(self) - 1)
        to = given.integer("face", face, least=-1, most=3)
        if not isinstance(message, (bytes, bytearray)):
            raise given.refused("message", 'bytes, such as b"x"', message)
        if len(message) > MOST_BYTES:
            raise given.refused("message", f"up to {MOST_BYTES} bytes", len(message))
        self.send_bytes[row, : len(message)] = np.frombuffer(message, dtype=np.uint8)
        self.send_face[row] = to
        self.send_length[row] = len(message)

    def clear_received(self) -> None:
        """Forget the received messages. Without it, further ones are lost once there is no more room for them."""
        check(library().pogosim_run_clear_received(self._run().pointer, self._category.encode()))
