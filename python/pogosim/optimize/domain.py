"""The values that a variable may take, and where they are in the interval from 0 to 1 that optimisers search."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from pogosim.batch.configurations.option_words import (
    DEFAULT,
    DOMAIN,
    DOMAIN_WORDS,
    LIST,
    OptionsError,
    refuse_unknown,
    shown,
)
from pogosim.yaml_1_2 import plain

TYPES = ("int", "float", "categorical")
LARGEST = 1e300
LARGEST_WHOLE = 2**52  # so that positions from 0 to 1 tell whole numbers apart


@dataclass(frozen=True)
class Real:
    """A real number between two others, which may both be reached.

    Attributes:
        low: The least value.
        high: The greatest value, above `low`.
        is_log: Orders of magnitude are equally likely, not numbers; `low` is above 0 then.
        init: Where a search starts.
    """

    low: float
    high: float
    is_log: bool
    init: float

    def value_at(self, position: float) -> float:
        """Return the value at a position from 0 to 1; at the start exactly `init`, without rounding."""
        if position == self.start:
            return self.init
        if self.is_log:
            value = math.pow(self.low, 1.0 - position) * math.pow(self.high, position)
        else:
            value = self.low + position * (self.high - self.low)
        return min(max(value, self.low), self.high)

    def position_of(self, value: float) -> float:
        """Return the position of a value, 0 to 1."""
        if self.is_log:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    @property
    def start(self) -> float:
        """Where a search starts in the interval from 0 to 1."""
        return self.position_of(self.init)

    @property
    def step(self) -> float:
        """How far apart neighbouring values are in the interval from 0 to 1."""
        return 0.0


@dataclass(frozen=True)
class Whole:
    """A whole number between two others, which may both be reached.

    Each value has a part of the interval from 0 to 1, so that random positions give all values the same chance, or, if
    `is_log`, all orders of magnitude.

    Attributes:
        low: The least value.
        high: The greatest value, above `low`.
        is_log: See above; `low` is above 0 then.
        init: Where a search starts.
    """

    low: int
    high: int
    is_log: bool
    init: int

    def value_at(self, position: float) -> int:
        """Return the value at a position from 0 to 1."""
        count = self.high - self.low + 1
        if self.is_log:
            value = math.floor(self.low * math.exp(position * math.log((self.high + 1) / self.low)))
        else:
            value = self.low + math.floor(position * count)
        return min(max(value, self.low), self.high)

    def position_of(self, value: int) -> float:
        """Return a position of a value, 0 to 1: the middle of its part."""
        if self.is_log:
            return math.log((value + 0.5) / self.low) / math.log((self.high + 1) / self.low)
        return (value - self.low + 0.5) / (self.high - self.low + 1)

    @property
    def start(self) -> float:
        """Where a search starts in the interval from 0 to 1."""
        return self.position_of(self.init)

    @property
    def step(self) -> float:
        """How far apart neighbouring values are in the interval from 0 to 1, on average."""
        return 1.0 / (self.high - self.low + 1)


@dataclass(frozen=True)
class Categorical:
    """One of several values without an order.

    Attributes:
        choices: The values, at least one.
        init: Where a search starts: the number of a choice, from 0 on.
    """

    choices: tuple[Any, ...]
    init: int

    def value_at(self, position: float) -> Any:
        """Return the value at a position from 0 to 1; all values have parts of the same size."""
        return self.choices[self.number_at(position)]

    def number_at(self, position: float) -> int:
        """Return the number of the choice at a position, from 0 on."""
        return min(max(math.floor(position * len(self.choices)), 0), len(self.choices) - 1)

    def position_of(self, number: int) -> float:
        """Return a position of a choice, 0 to 1: the middle of its part."""
        return (number + 0.5) / len(self.choices)

    @property
    def start(self) -> float:
        """Where a search starts in the interval from 0 to 1."""
        return self.position_of(self.init)

    @property
    def step(self) -> float:
        """How far apart neighbouring choices are in the interval from 0 to 1."""
        return 1.0 / len(self.choices)


Domain = Real | Whole | Categorical


def has_init(node: dict[str, Any], domain: Domain) -> bool:
    """Tell whether a node says where a search starts in its domain, with `init` or `default_option`."""
    start = domain.choices[domain.init] if isinstance(domain, Categorical) else domain.init
    return same(node[DOMAIN].get("init", node.get(DEFAULT)), start)


def domain_of(node: dict[str, Any]) -> Domain:
    """Return what the `optimization_domain` of a node of the configuration says.

    Args:
        node: A map with `optimization_domain`, and perhaps `default_option` (where the search starts, unless `init`
            says it) and `batch_options` (the choices, unless `choices` says them).

    Raises:
        OptionsError: It is wrong.
    """
    entries = node[DOMAIN]
    if not isinstance(entries, dict):
        raise OptionsError(
            f"{DOMAIN}: expected a map such as {{type: int, min: 10, max: 1000}}, found {shown(entries)}"
        )
    refuse_unknown(entries, DOMAIN_WORDS, (DOMAIN,))
    choices = entries.get("choices", node.get(LIST))
    kind = entries.get("type", "categorical" if choices is not None else None)
    if kind not in TYPES:
        found = "nothing" if kind is None else shown(kind)
        raise OptionsError(f"{DOMAIN}: type: expected int, float or categorical, found {found}")
    if kind == "categorical":
        return categorical(entries, choices, node.get(DEFAULT))
    if "choices" in entries:
        raise OptionsError(f"{DOMAIN}: choices go with type: categorical, not with {kind}")
    return number(entries, kind, node.get(DEFAULT))


def categorical(entries: dict[str, Any], choices: Any, default: Any) -> Categorical:
    """Return the domain of a categorical variable."""
    for key in ("min", "max", "log"):
        if key in entries:
            raise OptionsError(f"{DOMAIN}: {key} does not go with type: categorical, which has choices")
    if not isinstance(choices, list) or not choices:
        raise OptionsError(f"{DOMAIN}: choices: expected a list of values, found {shown(choices)}")
    for i in range(len(choices)):
        if is_in(choices[i], choices[:i]):
            raise OptionsError(f"{DOMAIN}: choices: {shown(choices[i])} is there twice")
    if "init" in entries and not is_in(entries["init"], choices):
        raise OptionsError(f"{DOMAIN}: init: {shown(entries['init'])} is none of the choices")
    start = entries.get("init", default)
    return Categorical(tuple(choices), next((i for i, choice in enumerate(choices) if same(choice, start)), 0))


def is_in(value: Any, choices: Sequence[Any]) -> bool:
    """Tell whether a value is one of several."""
    return any(same(value, choice) for choice in choices)


def same(value: Any, other: Any) -> bool:
    """Tell whether two values of a configuration are the same; true is not 1."""
    value, other = plain(value), plain(other)
    return isinstance(value, bool) == isinstance(other, bool) and bool(value == other)


def number(entries: dict[str, Any], kind: str, default: Any) -> Real | Whole:
    """Return the domain of a number."""
    low, high = (bound(entries, key, kind) for key in ("min", "max"))
    if low >= high:
        raise OptionsError(f"{DOMAIN}: expected min below max, found {shown(low)} and {shown(high)}")
    if not math.isfinite(high - low):
        raise OptionsError(f"{DOMAIN}: min and max are too far apart")
    is_log = plain(entries.get("log", False))
    if not isinstance(is_log, bool):
        raise OptionsError(f"{DOMAIN}: log: expected true or false, found {shown(is_log)}")
    if is_log and low <= 0:
        raise OptionsError(f"{DOMAIN}: log: true needs a min above 0, found {shown(low)}")
    if kind == "int":
        middle: float = Whole(int(low), int(high), is_log, 0).value_at(0.5)
    else:
        middle = Real(low, high, is_log, low).value_at(0.5)
    init = entries.get("init")
    if init is None:
        init = default if is_number(default, kind) and low <= default <= high else middle
    if not is_number(init, kind) or not low <= init <= high:
        what = "a whole number" if kind == "int" else "a number"
        raise OptionsError(f"{DOMAIN}: init: expected {what} from {shown(low)} to {shown(high)}, found {shown(init)}")
    if kind == "int":
        return Whole(int(low), int(high), is_log, int(init))
    return Real(float(low), float(high), is_log, float(init))


def is_number(value: Any, kind: str) -> bool:
    """Tell whether a value is a finite number of a kind, "int" or "float"."""
    largest = LARGEST_WHOLE if kind == "int" else LARGEST
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not -largest <= value <= largest:
        return False
    return kind == "float" or value == int(value)


def bound(entries: dict[str, Any], key: str, kind: str) -> float:
    """Return the least or the greatest value."""
    value = entries.get(key)
    if not is_number(value, kind):
        what = "a whole number" if kind == "int" else "a number"
        raise OptionsError(f"{DOMAIN}: {key}: expected {what}, found {shown(value)}")
    assert isinstance(value, (int, float))
    return value
