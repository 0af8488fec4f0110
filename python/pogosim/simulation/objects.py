"""Objects and lamps of a run: where they are, moving them, switching them off and on."""

from __future__ import annotations

from collections.abc import Sequence
from ctypes import byref
from typing import TYPE_CHECKING, overload

from pogosim.arguments import shown
from pogosim.simulation.arrays import RunState
from pogosim.simulation.errors import ConfigurationError, given
from pogosim.simulation.library import LampState, ObjectState, check, library

if TYPE_CHECKING:
    from pogosim.simulation.run import Simulation

NONE = 2**32 - 1


def object_state(run: RunState, index: int) -> ObjectState:
    """Return what pogosim_run_object() says."""
    state = ObjectState()
    check(library().pogosim_run_object(run.pointer, index, byref(state)))
    return state


def lamp_state(run: RunState, index: int) -> LampState:
    """Return what pogosim_run_lamp() says. The name of its category is the run's."""
    state = LampState()
    check(library().pogosim_run_lamp(run.pointer, index, byref(state)))
    return state


def chosen_index(index: int, count: int, what: str) -> int:
    """Return the index from 0 that an index of a sequence means, which may count from the end.

    Raises:
        IndexError: There is none.
        ConfigurationError: It is no integer.
    """
    number = given.integer(f"index of a {what}", index)
    if not -count <= number < count:
        raise IndexError(f"there is no {what} {shown(number)}: the run has {count}")
    return number % count


class WorldObject:
    """An object of a run, as it is now: what has a body or runs the program.

    Attributes:
        index: In `Simulation.objects`.
    """

    __slots__ = ("_simulation", "index")  # a misspelt name is an error

    def __init__(self, simulation: Simulation, index: int) -> None:
        self._simulation = simulation
        self.index = index

    def _state(self) -> ObjectState:
        return object_state(self._simulation._run, self.index)

    @property
    def category(self) -> str:
        """Name of its category."""
        name: str = self._simulation.categories[self._state().category]
        return name

    @property
    def id(self) -> int:
        """What the data file shows as `robot_id`."""
        return int(self._state().id)

    @property
    def robot(self) -> int | None:
        """Its row in arrays of robots, such as `Simulation.leds`; None if it runs no program."""
        robot = int(self._state().robot)
        return None if robot == NONE else robot

    @property
    def position(self) -> tuple[float, float]:
        """Place, mm: of a membrane, its middle; of walls, the centre of their box."""
        state = self._state()
        return state.x_mm, state.y_mm

    @property
    def heading(self) -> float:
        """Heading, -pi to pi, clockwise on the screen; 0 for membranes and walls."""
        return float(self._state().heading_rad)

    @property
    def light(self) -> float:
        """Light level, sensor counts, without noise: mean of a robot's sensors; of others, in the middle."""
        return float(self._state().light)

    @property
    def magnetometer(self) -> tuple[int, int, int] | None:
        """What its program has read last of its magnetometer: x, y, z, counts; None before, or without a program."""
        robot, run = self.robot, self._simulation._run
        if robot is None or not run.array("robots.magnetometer_samples")[robot]:
            return None
        x, y, z = run.array("robots.magnetometer")[robot].tolist()
        return x, y, z

    @property
    def is_alive(self) -> bool:
        """Whether it is switched on; true for what runs no program."""
        return bool(self._state().is_alive)

    def move(self, x: float, y: float, heading: float | None = None) -> None:
        """Put it elsewhere, at rest.

        Args:
            x: mm.
            y: mm, downwards.
            heading: rad, clockwise on the screen; None: as before.

        Raises:
            ConfigurationError: It has no body, or the place is in a wall.
        """
        place = given.finite("x", x), given.finite("y", y)
        angle = self.heading if heading is None else given.finite("heading", heading)
        with self._simulation._busy():
            check(library().pogosim_run_set_object_pose(self._simulation._run.pointer, self.index, *place, angle))

    def kill(self) -> None:
        """Switch it off: no user code, no messages, motors stand still, LEDs are dark. Its body stays.

        Raises:
            ConfigurationError: It runs no program.
        """
        self._set_alive(False)

    def revive(self) -> None:
        """Switch it on again: it goes on where it was, with its memory.

        Raises:
            ConfigurationError: It runs no program.
        """
        self._set_alive(True)

    def _set_alive(self, alive: bool) -> None:
        with self._simulation._busy():
            check(library().pogosim_run_set_alive(self._simulation._run.pointer, self.index, alive))

    def __repr__(self) -> str:
        x, y = self.position
        return f"<object {self.index} of category {self.category!r} at ({x:.1f}, {y:.1f}) mm>"


class Objects(Sequence[WorldObject]):
    """All objects of a run, in the order of the configuration, which is that of the rows of the data file."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation

    def __len__(self) -> int:
        return int(self._simulation._run.number("object_count"))

    @overload
    def __getitem__(self, index: int) -> WorldObject: ...
    @overload
    def __getitem__(self, index: slice) -> list[WorldObject]: ...
    def __getitem__(self, index: int | slice) -> WorldObject | list[WorldObject]:
        if isinstance(index, slice):
            return [WorldObject(self._simulation, number) for number in range(len(self))[index]]
        return WorldObject(self._simulation, chosen_index(index, len(self), "object"))

    def of(self, category: str) -> list[WorldObject]:
        """Return the objects of a category.

        Raises:
            ConfigurationError: The configuration has no objects of this category.
        """
        known = self._simulation.categories
        if not isinstance(category, str) or category not in known:
            raise ConfigurationError(f"no objects have the category {shown(category)}; there are {', '.join(known)}")
        return [found for found in self if found.category == category]

    def __contains__(self, value: object) -> bool:
        return isinstance(value, WorldObject) and super().__contains__(value)


class Lamp:
    """A lamp of a run. Setting what it is like changes the light on the floor at once.

    Attributes:
        index: In `Simulation.lamps`.
    """

    __slots__ = ("_simulation", "index")  # a misspelt name is an error

    def __init__(self, simulation: Simulation, index: int) -> None:
        self._simulation = simulation
        self.index = index

    def _state(self) -> LampState:
        return lamp_state(self._simulation._run, self.index)

    def _set(self, state: LampState) -> None:
        with self._simulation._busy():
            check(library().pogosim_run_set_lamp(self._simulation._run.pointer, self.index, byref(state)))

    @property
    def category(self) -> str:
        """Name of its category."""
        run = self._simulation._run  # which has the name
        name: bytes = lamp_state(run, self.index).category
        return name.decode()

    @property
    def is_on(self) -> bool:
        """Whether it shines when the configuration says so."""
        return bool(self._state().is_on)

    @is_on.setter
    def is_on(self, on: bool) -> None:
        is_on = given.boolean("is_on", on)
        state = self._state()
        state.is_on = is_on
        self._set(state)

    @property
    def intensity(self) -> float:
        """Its levels are those of the configuration times this, at most 32767. At least 0; at first 1."""
        return float(self._state().intensity)

    @intensity.setter
    def intensity(self, intensity: float) -> None:
        number = given.number("intensity", intensity)
        state = self._state()
        state.intensity = number
        self._set(state)

    @property
    def position(self) -> tuple[float, float]:
        """Where it stands, mm; of one on an orbit, the centre of the orbit."""
        state = self._state()
        return state.x_mm, state.y_mm

    @position.setter
    def position(self, place: tuple[float, float]) -> None:
        x, y = given.numbers("position", place, 2)
        state = self._state()
        state.x_mm, state.y_mm = x, y
        self._set(state)

    def __repr__(self) -> str:
        x, y = self.position
        state = "on" if self.is_on else "off"
        return f"<lamp {self.index} of category {self.category!r} at ({x:.1f}, {y:.1f}) mm: {state}>"


class Lamps(Sequence[Lamp]):
    """All lamps of a run, in the order of the configuration."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation

    def __len__(self) -> int:
        return int(self._simulation._run.number("lamp_count"))

    @overload
    def __getitem__(self, index: int) -> Lamp: ...
    @overload
    def __getitem__(self, index: slice) -> list[Lamp]: ...
    def __getitem__(self, index: int | slice) -> Lamp | list[Lamp]:
        if isinstance(index, slice):
            return [Lamp(self._simulation, number) for number in range(len(self))[index]]
        return Lamp(self._simulation, chosen_index(index, len(self), "lamp"))

    def __contains__(self, value: object) -> bool:
        return isinstance(value, Lamp) and super().__contains__(value)
