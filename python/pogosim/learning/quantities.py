"""Numbers that a policy sees or gives, with their ranges, and how they are scaled from -1 to 1."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.learning.swarm_arrays import KnownValue
from pogosim.simulation.errors import ConfigurationError, given

Array = npt.NDArray[np.float32]


@dataclass(frozen=True)
class Quantity:
    """An entry of an observation or of actions.

    Attributes:
        name: Such as "photosensors", "column.heard" or "motors".
        low: What becomes -1; None: what is usual. Values beyond are cut to the range.
        high: What becomes 1.
        is_scaled: False: numbers are as they are, from `low` to `high`.
    """

    name: str
    low: float | None = None
    high: float | None = None
    is_scaled: bool = True


def quantity_of(what: str, entry: Any) -> Quantity:
    """Return an entry that is a name, a tuple of name, low and high, or a `Quantity`.

    Raises:
        ConfigurationError: It is none of these.
    """
    if isinstance(entry, str):
        return Quantity(given.text(what, entry))
    if isinstance(entry, tuple | list) and len(entry) == 3 and isinstance(entry[0], str):
        low, high = (given.finite(f"{what}: {entry[0]}", end) for end in entry[1:])
        return Quantity(given.text(what, entry[0]), low, high)
    if not isinstance(entry, Quantity):
        raise given.refused(what, "a name, (name, low, high) or a Quantity", entry)
    given.text(what, entry.name)
    given.boolean(f"{what}: {entry.name}: is_scaled", entry.is_scaled)
    return entry


def quantities_of(what: str, entries: Any) -> list[Quantity]:
    """Return the entries of an argument, each once.

    Raises:
        ConfigurationError: There are none, something of them is wrong, or a name is there twice.
    """
    if isinstance(entries, str) or not isinstance(entries, Sequence) or not entries:
        raise given.refused(what, 'a list of names, such as ["photosensors"]', entries)
    found = [quantity_of(what, entry) for entry in entries]
    names = [quantity.name for quantity in found]
    for name in names:
        if names.count(name) > 1:
            raise ConfigurationError(f"{what}: {name!r} is there twice")
    return found


@dataclass(frozen=True)
class ScaledQuantity:
    """A quantity of which all is known.

    Attributes:
        name: Such as "photosensors".
        count: How many numbers it is for each robot.
        low: In its own unit.
        high: In its own unit, above `low`.
        is_scaled: Whether a policy has it from -1 to 1.
    """

    name: str
    count: int
    low: float
    high: float
    is_scaled: bool

    @property
    def features(self) -> tuple[str, ...]:
        """The names of its numbers."""
        return (self.name,) if self.count == 1 else tuple(f"{self.name}[{entry}]" for entry in range(self.count))


def fits_float32(low: float, high: float) -> bool:
    """Tell whether a range, low < high, and its scaling from -1 to 1 can be represented in 32 bits."""
    half, middle = high / 2 - low / 2, low / 2 + high / 2
    with np.errstate(all="ignore"):
        numbers = np.array([low, high, half, 1 / half if half else math.inf, middle]).astype(np.float32)
        return bool(np.isfinite(numbers).all() and numbers[0] < numbers[1] and np.isfinite(numbers[4] * numbers[3]))


def scaled_quantity(what: str, quantity: Quantity, value: KnownValue) -> ScaledQuantity:
    """Return a quantity with its range, or else that of the value.

    Raises:
        ConfigurationError: It has no range, or one that is empty, not finite, or beyond 32 bits.
    """
    if (quantity.low is None or quantity.high is None) and (value.low is None or value.high is None):
        raise ConfigurationError(f"{what}: {quantity.name!r} needs a range: ({quantity.name!r}, low, high)")
    ends = (quantity.low if quantity.low is not None else value.low, quantity.high)
    low, high = ends[0], ends[1] if ends[1] is not None else value.high
    name = f"{what}: {quantity.name}"
    least, most = given.finite(name, low), given.finite(name, high)
    if not least < most:
        raise ConfigurationError(f"{name}: expected low < high, found {least:g} and {most:g}")
    if not fits_float32(least, most):
        raise ConfigurationError(
            f"{name}: the range from {least!r} to {most!r} is too wide or too narrow for numbers of 32 bits"
        )
    return ScaledQuantity(quantity.name, value.count, least, most, quantity.is_scaled)


def resolved(what: str, entries: Any, find: Callable[[str], KnownValue]) -> list[ScaledQuantity]:
    """Return quantities with their ranges.

    Args:
        what: The argument, for messages.
        entries: What was given for it.
        find: Returns what is known of a name, or raises ConfigurationError.
    """
    return [scaled_quantity(what, quantity, find(quantity.name)) for quantity in quantities_of(what, entries)]


class Scaling:
    """The numbers of some quantities side by side, and what they are in their own units.

    Attributes:
        quantities: The quantities, in order.
        features: Names of the numbers, such as "photosensors[0]".
        low: The least that a policy sees or gives. Shape (features,).
        high: The greatest. Shape (features,).
        own_low: The least in own units. Shape (features,).
        own_high: The greatest in own units. Shape (features,).
        half: What 1 of a policy is in own units. Shape (features,).
        middle: What 0 of a policy is in own units. Shape (features,).
    """

    def __init__(self, quantities: Sequence[ScaledQuantity]) -> None:
        self.quantities = tuple(quantities)
        self.features = tuple(feature for quantity in quantities for feature in quantity.features)
        counts = [quantity.count for quantity in quantities]
        own_low = np.repeat([quantity.low for quantity in quantities], counts)
        own_high = np.repeat([quantity.high for quantity in quantities], counts)
        is_scaled = np.repeat([quantity.is_scaled for quantity in quantities], counts)
        self.own_low: Array = own_low.astype(np.float32)
        self.own_high: Array = own_high.astype(np.float32)
        self.low: Array = np.where(is_scaled, -1.0, own_low).astype(np.float32)
        self.high: Array = np.where(is_scaled, 1.0, own_high).astype(np.float32)
        half = np.where(is_scaled, own_high / 2 - own_low / 2, 1.0)
        middle = np.where(is_scaled, own_low / 2 + own_high / 2, 0.0)
        self.half: Array = half.astype(np.float32)
        self.middle: Array = middle.astype(np.float32)
        self._gain: Array = (1 / half).astype(np.float32)
        self._offset: Array = (-middle / half).astype(np.float32)

    def __len__(self) -> int:
        return len(self.features)

    def parts(self) -> list[tuple[ScaledQuantity, slice]]:
        """Return the quantities with where their numbers stand."""
        ends = np.cumsum([quantity.count for quantity in self.quantities]).tolist()
        return [(one, slice(end - one.count, end)) for one, end in zip(self.quantities, ends, strict=True)]

    def to_policy(self, values: Array) -> None:
        """Scale values of own units in place, and cut them to their ranges. Shape (..., features)."""
        values *= self._gain
        values += self._offset
        np.clip(values, self.low, self.high, out=values)

    def from_policy(self, numbers: npt.NDArray[Any], into: Array) -> None:
        """Cut numbers of a policy to their ranges, and put what they are in own units. Shapes (..., features)."""
        np.clip(numbers, self.low, self.high, out=into)
        into *= self.half
        into += self.middle


def check_finite(
    what: str,
    values: npt.NDArray[Any],
    names: Sequence[str] = (),
    where: Callable[[int], str] = lambda _run: "",
    advice: str = "",
) -> None:
    """Check that all numbers of robots are finite.

    Args:
        what: "actions", "observation" or "reward".
        values: Shape (runs, robots) or (runs, robots, numbers).
        names: Those of the numbers.
        where: Returns what the message says of the time of a run.
        advice: What it says in the end.

    Raises:
        ConfigurationError: One is not; names the first.
    """
    is_finite = np.isfinite(values)
    if is_finite.all():
        return
    run, robot, *number = np.argwhere(~is_finite)[0].tolist()
    of = f", {names[number[0]]}" if number else ""
    found = f"{values[(run, robot, *number)]:g}"
    raise ConfigurationError(
        f"{what}: expected finite numbers, found {found} for run {run}, robot {robot}{of}{where(run)}{advice}"
    )
