"""Values of the robots of a category in many runs, by their names."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.arguments import shown
from pogosim.nearest_name import advice
from pogosim.simulation import ConfigurationError, Simulation, SimulationError, VectorSimulation
from pogosim.simulation.brain import MOST_BYTES
from pogosim.simulation.vector_brain import VectorBrain

Array = npt.NDArray[Any]

FACES = 4
BRIGHTEST = 32767  # sensor counts
QUEUE = 20  # messages, `message_queue_size` of robots
USER_DATA, COLUMN = "user_data.", "column."
PAYLOAD = re.compile(r"message\((\d{1,9})\)", re.ASCII)
ENTRY = re.compile(r"(.+)\[(\d{1,9})\]", re.ASCII)


@dataclass(frozen=True)
class KnownValue:
    """A value that robots have.

    Attributes:
        count: How many numbers it is for each robot.
        low: The least that is usual, in the unit of the value; None: not known.
        high: The greatest, likewise.
        entry: The number that an index chooses; None: all of them.
    """

    count: int
    low: float | None = None
    high: float | None = None
    entry: int | None = None


# What the world knows of any robot.
OF_WORLD = {
    "x": KnownValue(1),
    "y": KnownValue(1),
    "angle": KnownValue(1, -math.pi, math.pi),
    "speed": KnownValue(1),
    "light": KnownValue(1, 0, BRIGHTEST),
    "messages_sent": KnownValue(1),
    "messages_received": KnownValue(1),
}
# What robots that a host drives have measured, and heard since their last decision.
HOST_SENSORS = {
    "photosensors": KnownValue(3, 0, BRIGHTEST),
    "acceleration": KnownValue(3),
    "angular_velocity": KnownValue(3),
    "battery_mv": KnownValue(1),
    "messages": KnownValue(FACES, 0, QUEUE),
}


def number_fields(kind: np.dtype[Any], before: str = "") -> Iterator[tuple[str, np.dtype[Any]]]:
    """Return the members of a structure that hold numbers, those of inner structures as "pose.x"."""
    for name in kind.names or ():
        member = kind[name]
        base = member.subdtype[0] if member.subdtype else member
        if base.kind in "biuf":
            yield before + name, member
        elif member.names:
            yield from number_fields(member, f"{before}{name}.")


def field(array: Array, name: str) -> Array:
    """Return a member of a structured array, by a name such as "pose.x"."""
    for part in name.split("."):
        array = array[part]
    return array


def user_data_type(simulation: Simulation) -> np.dtype[Any] | None:
    """Return the type of the robots' user data; None: there is none, or it is not known."""
    try:
        found = simulation.user_data.dtype
    except SimulationError:
        return None
    return found if found.names else None


def is_hosted(simulation: Simulation, category: str) -> bool:
    """Tell whether this process drives the robots of a category."""
    try:
        simulation.brain(category)
    except ConfigurationError:
        return False
    return True


def rows_of(simulation: Simulation, category: str) -> npt.NDArray[np.int64]:
    """Return where the robots of a category stand in arrays of robots.

    Raises:
        ConfigurationError: There is no such category, or no robot in it.
    """
    names = simulation.categories
    if category not in names:
        raise ConfigurationError(f"there is no category {shown(category)}{advice(category, names)}")
    entries = [number for number, name in enumerate(names) if name == category]
    rows = np.flatnonzero(np.isin(simulation.robot_categories, entries))
    if not len(rows):
        raise ConfigurationError(f"category {shown(category)} has no robots")
    return rows


def robots_by_category(simulation: Simulation) -> dict[str, int]:
    """Return how many robots each category has."""
    names = simulation.categories
    counts = np.bincount(simulation.robot_categories, minlength=len(names))
    found: dict[str, int] = {}
    for name, count in zip(names, counts.tolist(), strict=True):
        found[name] = found.get(name, 0) + count
    return found


def as_slice(rows: npt.NDArray[np.int64]) -> slice | npt.NDArray[np.int64]:
    """Return rows that follow each other as a slice, which copies nothing."""
    first, last = int(rows[0]), int(rows[-1])
    return slice(first, last + 1) if last - first + 1 == len(rows) else rows


def known_values(simulation: Simulation, category: str) -> dict[str, KnownValue]:
    """Return all values that the robots of a category have, by name, except payloads and single entries."""
    known = dict(OF_WORLD)
    if is_hosted(simulation, category):
        known |= HOST_SENSORS
    elif (kind := user_data_type(simulation)) is not None:
        for name, member in number_fields(kind):
            is_truth = member.base.kind == "b"
            known[USER_DATA + name] = KnownValue(math.prod(member.shape), *((0, 1) if is_truth else ()))
    columns = simulation.columns
    for name in columns:
        if isinstance(columns[name], np.ma.MaskedArray):
            known[COLUMN + name] = KnownValue(1)
            known.setdefault(name, known[COLUMN + name])
    return known


def all_names(known: Mapping[str, KnownValue]) -> list[str]:
    """Return all names that expressions may use: values of one number, and the entries of others."""
    entries = [f"{name}[{entry}]" for name, value in known.items() if value.count > 1 for entry in range(value.count)]
    return [*(name for name, value in known.items() if value.count == 1), *entries]


def has_payloads(known: Mapping[str, KnownValue]) -> bool:
    """Tell whether messages that a host hears are among values; a column may have the name `messages`, too."""
    return known.get("messages") == HOST_SENSORS["messages"]


def payload_bytes(name: str, what: str) -> int | None:
    """Return the size of a message by its name, such as "message(4)"; None: it is the name of something else.

    Raises:
        ConfigurationError: A message cannot have this size.
    """
    found = PAYLOAD.fullmatch(name)
    if found is None:
        return None
    if not 1 <= int(found[1]) <= MOST_BYTES:
        raise ConfigurationError(f"{what}: {shown(name)}: a message has 1 to {MOST_BYTES} bytes")
    return int(found[1])


def find_whole(known: Mapping[str, KnownValue], name: str, what: str) -> KnownValue | None:
    """Return a value by its name without an index; None: there is none.

    Raises:
        ConfigurationError: It is a message of a wrong size.
    """
    if name in known or not has_payloads(known):
        return known.get(name)
    size = payload_bytes(name, what)
    return None if size is None else KnownValue(size, 0, 255)


def find_value(known: Mapping[str, KnownValue], name: str, what: str) -> KnownValue:
    """Return a value by its name, which may have an index.

    Args:
        known: As `known_values` returns them.
        name: Such as "light", "photosensors", "photosensors[1]", "message(4)".
        what: The argument that it is from, for messages.

    Raises:
        ConfigurationError: There is none; names the nearest.
    """
    if (found := find_whole(known, name, what)) is not None:
        return found
    entry = ENTRY.fullmatch(name)
    if entry and (whole := find_whole(known, entry[1], what)) is not None:
        if int(entry[2]) >= whole.count:
            raise ConfigurationError(f"{what}: {shown(name)}: {entry[1]} has {whole.count} entries, from 0")
        return KnownValue(1, whole.low, whole.high, int(entry[2]))
    sized = ["message(4)"] if has_payloads(known) else []
    raise ConfigurationError(f"{what}: the robots have no value {shown(name)}{advice(name, [*known, *sized])}")


def read_only(array: Array) -> Array:
    """Return a view that cannot be written."""
    view = array.view()
    view.flags.writeable = False
    return view


class SwarmArrays:
    """The robots of a category in all runs, as they are now: what rewards and ends are made of.

        reward=lambda swarm: swarm["light"] / 30000
        end=lambda swarm: (swarm.positions[..., 0] > 900).all(axis=1)

    `swarm["light"]` has the shape (runs, robots); a value of several numbers, such as `swarm["photosensors"]`, has
    (runs, robots, numbers). Arrays are those of now, and cannot be written.

    Attributes:
        runs: The simulations.
        category: That of the robots.
        robots: How many each run has.
        rows: Where they stand in arrays of all robots of a run.
        known: Values by name, without payloads and single entries.
    """

    def __init__(self, runs: VectorSimulation, category: str) -> None:
        """Look at the robots of runs.

        Raises:
            ConfigurationError: There is no such category, or runs have different robots.
        """
        self.runs = runs
        self.category = category
        first = runs[0]
        self.known = known_values(first, category)
        self._all_rows = rows_of(first, category)
        self._robots_by_category = robots_by_category(first)
        self.robots = len(self._all_rows)
        self.rows = as_slice(self._all_rows)
        self._brain: VectorBrain | None = runs.brain(category) if is_hosted(first, category) else None
        self._cache: dict[str, Array] = {}  # values, by name
        self._parts: dict[str, Array] = {}  # what they are made of: a value may have the name of one
        self._needs_messages = False

    @property
    def brain(self) -> VectorBrain:
        """The arrays that drive the robots.

        Raises:
            ConfigurationError: A program drives them.
        """
        if self._brain is None:
            raise ConfigurationError(f"a program drives the robots of category {shown(self.category)}, no host")
        return self._brain

    @property
    def is_hosted(self) -> bool:
        """Whether this process drives the robots."""
        return self._brain is not None

    @property
    def time_s(self) -> npt.NDArray[np.float64]:
        """Simulated time of each run, s. Shape (runs,)."""
        return np.array([simulation.time for simulation in self.runs])

    def when(self, run: int) -> str:
        """Return the time of a run as messages say it."""
        return f" at t = {self.runs[run].time:g} s"

    @property
    def positions(self) -> Array:
        """Positions, mm. Shape (runs, robots, 2)."""
        return self._part("positions", lambda: self._own(self.runs.positions))

    @property
    def headings(self) -> Array:
        """Headings, rad, clockwise on the screen, not wrapped. Shape (runs, robots)."""
        return self._part("headings", lambda: self._own(self.runs.headings))

    @property
    def velocities(self) -> Array:
        """Velocities in the last time step, mm/s. Shape (runs, robots, 2)."""
        return self._part("velocities", lambda: self._own(self.runs.velocities))

    @property
    def leds(self) -> Array:
        """Colours of the LEDs, 0 to 255. Shape (runs, robots, 5, 3): head, front, right, back, left."""
        return self._part("leds", lambda: self._own(self.runs.leds))

    def __getitem__(self, name: str) -> Array:
        """Return a value of all robots, see `find_value`. NaN where a robot has given none to a column."""
        if name in self._cache:
            return self._cache[name]
        value = find_value(self.known, name, "swarm")
        if value.entry is not None:
            return self[name.rpartition("[")[0]][..., value.entry]
        return self._kept(name, lambda: self._read(name))

    def _read(self, name: str) -> Array:
        if name in OF_WORLD:
            return self._of_world(name)
        if has_payloads(self.known):
            if name == "messages":
                return self._message_counts()
            if name not in self.known and (size := payload_bytes(name, "swarm")) is not None:
                return self._payloads(size)
        if self._brain is not None and name in HOST_SENSORS:
            found: Array = getattr(self._brain, name)
            return found
        if name.startswith(USER_DATA):
            whole = self._part("user data", lambda: self._own(self.runs.user_data))
            found = field(whole, name.removeprefix(USER_DATA))
            return found.reshape(*found.shape[:2], -1) if found.ndim > 3 else found
        column = self.runs.column(name.removeprefix(COLUMN))
        return self._own(np.ma.filled(column.astype(np.float64), np.nan))

    def _of_world(self, name: str) -> Array:
        if name in ("x", "y"):
            return self.positions[..., "xy".index(name)]
        if name == "angle":
            return np.arctan2(np.sin(self.headings), np.cos(self.headings))
        if name == "speed":
            return np.hypot(self.velocities[..., 0], self.velocities[..., 1])
        if name == "light":
            return self._own(self.runs.light_levels)
        return self._own(getattr(self.runs, name))

    def _received(self) -> tuple[Array, Array]:
        """Return the messages since the last decision, and the robot of each, counted through all runs."""
        self._needs_messages = True
        received = self._part("received", lambda: self.brain.received)
        place = self._part("place", lambda: received["run"].astype(np.int64) * self.robots + received["robot"])
        return received, place

    def _message_counts(self) -> Array:
        """Return how many messages robots have received since the last decision, by face."""
        received, place = self._received()
        shape = (len(self.runs), self.robots, FACES)
        return np.bincount(place * FACES + received["face"], minlength=math.prod(shape)).reshape(shape)

    def _payloads(self, size: int) -> Array:
        """Return means of the first bytes of the messages since the last decision.

        A byte is the mean over the messages that are long enough to have it, 0 if there is none.
        """
        received, place = self._received()
        shape = (len(self.runs), self.robots, size)
        places = len(self.runs) * self.robots
        payloads, begin, length = self.brain.received_bytes, received["offset"].astype(np.int64), received["length"]
        means = np.zeros((places, size))
        least = length.min(initial=MOST_BYTES)  # bytes that all of them have
        counts = np.maximum(np.bincount(place, minlength=places), 1)
        for byte in range(size):
            if byte >= least:
                has_it = length > byte
                place, begin, length = place[has_it], begin[has_it], length[has_it]
                counts = np.maximum(np.bincount(place, minlength=places), 1)
            means[:, byte] = np.bincount(place, payloads[begin + byte], minlength=places) / counts
        return means.reshape(shape)

    def _own(self, of_all: Array) -> Array:
        """Return the rows of the category."""
        return of_all[:, self.rows]

    def _kept(self, name: str, read: Callable[[], Array]) -> Array:
        """Return an array of now, read once."""
        if name not in self._cache:
            self._cache[name] = read_only(read())
        return self._cache[name]

    def _part(self, name: str, read: Callable[[], Array]) -> Array:
        """Return an array of now that values are made of, read once."""
        if name not in self._parts:
            self._parts[name] = read_only(read())
        return self._parts[name]

    def before_step(self) -> None:
        """Forget the messages that robots have received until now, if they are looked at."""
        if self._needs_messages:
            self.brain.clear_received()

    def after_step(self) -> None:
        """Look at the robots anew."""
        self._cache.clear()
        self._parts.clear()

    def check_robots(self, run: int) -> None:
        """Check that a run that has begun anew has the robots that it had.

        Raises:
            ConfigurationError: It has others.
        """
        simulation = self.runs[run]
        if len(simulation.robot_ids) != sum(self._robots_by_category.values()) or not np.array_equal(
            rows_of(simulation, self.category), self._all_rows
        ):
            found = robots_by_category(simulation)
            category = next(
                (name for name in found if found[name] != self._robots_by_category.get(name)), self.category
            )
            raise ConfigurationError(
                f"run {run} has {found[category]} robots in category {shown(category)} since its reset, and had "
                f"{self._robots_by_category.get(category, 0)}: arrays need the same robots in all episodes, so do not "
                "draw their number"
            )
