"""What a policy makes robots do: motors, LEDs and messages of a host's brain, user data and parameters of a program."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from pogosim.arguments import shown
from pogosim.firmware import is_firmware
from pogosim.learning.quantities import ScaledQuantity, Scaling, check_finite, resolved
from pogosim.learning.swarm_arrays import USER_DATA, KnownValue, SwarmArrays, field, payload_bytes
from pogosim.nearest_name import advice
from pogosim.simulation import ConfigurationError

Array = npt.NDArray[np.float32]
Write = Callable[[Array], None]  # values in their own units, shape (runs, robots, numbers)

logger = logging.getLogger("pogosim")

PARAMETER = "parameters."
FULL = 1023  # power of a motor
# What a host writes: the array of its brain, and which of its numbers.
HOST_OUTPUTS: Mapping[str, tuple[str, Any, KnownValue]] = {
    "motors": ("motors", np.s_[..., :2], KnownValue(2, -FULL, FULL)),
    "back_motor": ("motors", np.s_[..., 2:], KnownValue(1, -FULL, FULL)),
    "led": ("leds", np.s_[..., 0, :], KnownValue(3, 0, 255)),
    "leds": ("leds", np.s_[..., :], KnownValue(15, 0, 255)),
}


def known_actions(swarm: SwarmArrays) -> dict[str, KnownValue]:
    """Return what robots can be made to do, by name, except messages and parameters."""
    if swarm.is_hosted:
        return {name: value for name, (_, _, value) in HOST_OUTPUTS.items()}
    program = swarm.runs[0].program
    if program is not None and is_firmware(program):
        return {}  # its memory is read only
    return {name: value for name, value in swarm.known.items() if name.startswith(USER_DATA)}


def find_action(swarm: SwarmArrays, name: str) -> KnownValue:
    """Return what is known of an action.

    Raises:
        ConfigurationError: There is none of this name, or it is one of a host and a program drives the robots.
    """
    known = known_actions(swarm)
    if name in known:
        return known[name]
    if name.startswith(PARAMETER) and name != PARAMETER:
        return KnownValue(1)
    size = payload_bytes(name, "actions")
    if not swarm.is_hosted and (name in HOST_OUTPUTS or size is not None):
        raise ConfigurationError(
            f"actions: {shown(name)} is written by a host, and a program drives the robots of category "
            f"{shown(swarm.category)}: pass None in place of the program, or name a member of its user data"
            f"{advice(name, known) if known else ''}"
        )
    if size is not None:
        return KnownValue(size, 0, 255)
    others = ["message(4)"] if swarm.is_hosted else []
    raise ConfigurationError(f"actions: there is no action {shown(name)}{advice(name, [*known, *others])}")


def limits_of(swarm: SwarmArrays, name: str) -> tuple[float, float]:
    """Return the least and the greatest number that the place of an action can hold."""
    if name.startswith(USER_DATA):
        kind = field_type(swarm, name).base
        if kind.kind == "b":
            return 0, 1
        limits = np.iinfo(kind) if kind.kind in "iu" else np.finfo(kind)
        return limits.min, limits.max
    if name.startswith(PARAMETER):
        return -math.inf, math.inf
    usual = find_action(swarm, name)  # of a host: the whole of it
    return cast("tuple[float, float]", (usual.low, usual.high))


def field_type(swarm: SwarmArrays, name: str) -> np.dtype[Any]:
    """Return the type of a member of user data."""
    kind: np.dtype[Any] = swarm.runs[0].user_data.dtype
    for part in name.removeprefix(USER_DATA).split("."):
        kind = kind[part]
    return kind


def check_holds(quantity: ScaledQuantity, limits: tuple[float, float]) -> None:
    """Check that the place of an action can hold all numbers of its range.

    Raises:
        ConfigurationError: It cannot; another number would be written.
    """
    if quantity.low < limits[0] or quantity.high > limits[1]:
        raise ConfigurationError(
            f"actions: {quantity.name}: expected a range within {limits[0]:.10g} to {limits[1]:.10g}, found "
            f"{quantity.low:.10g} to {quantity.high:.10g}"
        )


def check_apart(quantities: Sequence[ScaledQuantity]) -> None:
    """Check that no two actions are written to the same place.

    Raises:
        ConfigurationError: Two are.
    """
    taken: dict[str, str] = {}
    for name in (quantity.name for quantity in quantities):
        place = {"led": "leds"}.get(name, name if payload_bytes(name, "actions") is None else "message")
        if place in taken:
            raise ConfigurationError(f"actions: {taken[place]!r} and {name!r} are written to the same place: keep one")
        taken[place] = name


def as_integers(values: Array, kind: np.dtype[Any]) -> Array:
    """Return rounded numbers that a type of integers can hold: its greatest may be none of 32 bits."""
    if kind.kind == "b":
        return np.rint(values)
    limits = np.iinfo(kind)
    most = np.float32(limits.max)
    if int(most) > limits.max:
        most = np.nextafter(most, np.float32(0))
    return np.clip(np.rint(values), np.float32(limits.min), most)


def as_stored(values: Array, view: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return numbers of robots in the type and shape of a member of user data. Shape (robots, ...)."""
    numbers = values if view.dtype.kind == "f" else as_integers(values, view.dtype)
    return numbers.astype(view.dtype, copy=False).reshape(-1, *view.shape[1:])


class Actions:
    """Writes what a policy gives where robots find it.

    Attributes:
        scaling: Its numbers, and their ranges.
    """

    def __init__(self, swarm: SwarmArrays, actions: Any) -> None:
        """Look up where it goes.

        Raises:
            ConfigurationError: A name or a range is wrong.
        """
        self._swarm = swarm
        self.scaling = Scaling(resolved("actions", actions, lambda name: find_action(swarm, name)))
        check_apart(self.scaling.quantities)
        for quantity in self.scaling.quantities:
            check_holds(quantity, limits_of(swarm, quantity.name))
        self._own = np.zeros((len(swarm.runs), swarm.robots, len(self.scaling)), np.float32)
        self._views: dict[str, list[npt.NDArray[Any]]] = {}  # of user data, by member
        self._has_looked = False  # for what the program overwrites
        self._writes: list[tuple[Write, slice]] = [
            (self._write_of(quantity.name), part) for quantity, part in self.scaling.parts()
        ]

    @property
    def shape(self) -> tuple[int, int, int]:
        """Runs, robots, numbers."""
        runs, robots, numbers = self._own.shape
        return runs, robots, numbers

    def checked(self, actions: npt.ArrayLike) -> npt.NDArray[Any]:
        """Return actions as an array.

        Raises:
            ConfigurationError: They are not finite numbers of the shape (runs, robots, numbers).
        """
        try:
            found = np.asarray(actions)
        except (TypeError, ValueError):  # lists of different lengths
            found = np.empty(0, dtype=object)
        if found.dtype.kind not in "biuf":
            raise ConfigurationError(f"actions: expected numbers of shape {self.shape}, found {shown(actions)}")
        if found.shape != self.shape:
            names = ", ".join(self.scaling.features)
            raise ConfigurationError(
                f"actions: expected the shape {self.shape}: runs, robots, numbers ({names}); found {found.shape}"
            )
        check_finite("actions", found, self.scaling.features)
        return found

    def write(self, actions: npt.NDArray[Any]) -> None:
        """Let robots do what `checked` has returned, from their next tick on."""
        self.scaling.from_policy(actions, self._own)
        for write, part in self._writes:
            write(self._own[..., part])

    def tell_of_overwritten(self) -> None:
        """Warn of user data that hold other numbers in all robots after the first step: the program decides itself."""
        if self._has_looked:
            return
        self._has_looked = True
        for quantity, part in self.scaling.parts():
            if not quantity.name.startswith(USER_DATA):
                continue
            views = self._views[quantity.name.removeprefix(USER_DATA)]
            if all(
                (view[self._swarm.rows] != as_stored(of_run, view)).reshape(self._swarm.robots, -1).any(axis=1).all()
                for view, of_run in zip(views, self._own[..., part], strict=True)
            ):
                logger.warning(
                    "actions: %s: the program has written other numbers there than the policy, so robots may do "
                    "something else; let it leave them alone while Python decides, as examples/learning does with "
                    "set={'parameters.is_commanded': True}",
                    quantity.name,
                )

    def forget(self) -> None:
        """Ask for the memory of robots anew: some runs have begun again."""
        self._views.clear()

    def _write_of(self, name: str) -> Write:
        if name.startswith(PARAMETER):
            return lambda values: self._set_parameter(name.removeprefix(PARAMETER), values)
        if name.startswith(USER_DATA):
            return lambda values: self._write_user_data(name.removeprefix(USER_DATA), values)
        if name in HOST_OUTPUTS:
            array, part, _ = HOST_OUTPUTS[name]
            return lambda values: self._write_brain(array, part, values)
        return self._send

    def _write_brain(self, name: str, part: Any, values: Array) -> None:
        array = getattr(self._swarm.brain, name)[part]
        array[...] = np.rint(values).reshape(array.shape)

    def _send(self, values: Array) -> None:
        brain = self._swarm.brain
        brain.send_bytes[..., : values.shape[-1]] = np.rint(values)
        brain.send_face[...] = -1
        brain.send_length[...] = values.shape[-1]

    def _write_user_data(self, member: str, values: Array) -> None:
        if member not in self._views:
            self._views[member] = [field(simulation.user_data, member) for simulation in self._swarm.runs]
        for view, of_run in zip(self._views[member], values, strict=True):
            view[self._swarm.rows] = as_stored(of_run, view)

    def _set_parameter(self, name: str, values: Array) -> None:
        """All robots of a run share a parameter: it gets the mean of what they ask for."""
        for simulation, of_run in zip(self._swarm.runs, values, strict=True):
            try:
                simulation.parameters[name] = float(math.fsum(of_run.flat) / of_run.size)
            except ConfigurationError as error:
                raise ConfigurationError(f"actions: {error}") from None
