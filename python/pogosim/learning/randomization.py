"""Keys of the configuration that are drawn anew for each episode."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from pogosim.arguments import without_numpy
from pogosim.nearest_name import advice
from pogosim.simulation.errors import ConfigurationError, given

Draw = Callable[[np.random.Generator], Any]

# What may stand in a domain, by its type; as in `optimization_domain`, with normal distributions besides.
DOMAIN_KEYS = {
    "float": ("min", "max", "log"),
    "int": ("min", "max", "log"),
    "categorical": ("choices",),
    "normal": ("mean", "stddev"),
}
# Keys that no draw can change, and why.
NOT_DRAWN = {
    "time_step": "a decision has the same number of time steps in all episodes",
    "simulation_time": "episodes end after the same time; use a function as `end`",
    "seed": "episodes draw it, from the seed of `reset`",
}
FORMS = "an interval [low, high], a list of values, a map such as {type: int, min: 1, max: 9}, or a function"


def is_number(value: Any) -> bool:
    """Tell whether a value is a finite number."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def interval(name: str, low: float, high: float, is_log: bool) -> Draw:
    """Return a uniform distribution, of the number or of its logarithm."""
    if not low <= high:
        raise ConfigurationError(f"{name}: expected low <= high, found [{low:g}, {high:g}]")
    if not math.isfinite(high - low):
        raise ConfigurationError(f"{name}: the interval from {low:g} to {high:g} is too wide")
    if not is_log:
        return lambda generator: float(generator.uniform(low, high))
    if low <= 0:
        raise ConfigurationError(f"{name}: with log, min must be above 0, found {low:g}")
    return lambda generator: float(min(max(math.exp(generator.uniform(math.log(low), math.log(high))), low), high))


def whole_numbers(name: str, low: int, high: int, is_log: bool) -> Draw:
    """Return a uniform distribution of whole numbers, both ends included."""
    if not is_log:
        interval(name, low, high, is_log=False)
        return lambda generator: int(generator.integers(low, high, endpoint=True))
    real = interval(name, low, high, is_log=True)
    return lambda generator: round(real(generator))


def one_of(name: str, values: Any) -> Draw:
    """Return a choice, each value as likely."""
    if not isinstance(values, list | tuple) or not values:
        raise given.refused(name, "at least one value to choose from", values)
    choices = [given.value(name, value) for value in values]
    return lambda generator: choices[int(generator.integers(len(choices)))]


def of_domain(name: str, domain: Mapping[str, Any]) -> Draw:
    """Return the distribution that a map describes."""
    kind = domain.get("type")
    if not isinstance(kind, str) or kind not in DOMAIN_KEYS:
        raise given.refused(f"{name}.type", f"one of {', '.join(DOMAIN_KEYS)}", kind)
    keys = DOMAIN_KEYS[kind]
    for key in domain:
        if key != "type" and key not in keys:
            raise ConfigurationError(f"{name}: a domain of type {kind} has no key {key!r}{advice(str(key), keys)}")
    missing = [key for key in keys if key not in domain and key != "log"]
    if missing:
        raise ConfigurationError(f"{name}: a domain of type {kind} needs the key {missing[0]!r}")
    if kind == "categorical":
        return one_of(f"{name}.choices", without_numpy(domain["choices"]))
    if kind == "normal":
        mean, stddev = (given.finite(f"{name}.{key}", domain[key]) for key in keys)
        if stddev < 0:
            raise given.refused(f"{name}.stddev", "a number of at least 0", stddev)
        return lambda generator: float(generator.normal(mean, stddev))
    is_log = given.boolean(f"{name}.log", domain.get("log", False))
    if kind == "int":
        least, most = (given.integer(f"{name}.{key}", domain[key], -(2**63), 2**63 - 1) for key in ("min", "max"))
        return whole_numbers(name, least, most, is_log)
    low, high = (given.finite(f"{name}.{key}", domain[key]) for key in ("min", "max"))
    return interval(name, low, high, is_log)


def draw_of(name: str, values: Any) -> Draw:
    """Return how the values of one key are drawn.

    Args:
        name: The key, as messages say it.
        values: A list of two numbers, an interval; another list, values of which each is as likely; a map of a domain,
            as in `optimization_domain`, or {type: normal, mean: 0, stddev: 1}; or a function of a generator of random
            numbers.

    Raises:
        ConfigurationError: It is none of these, or an interval is empty.
    """
    plain = without_numpy(values)
    if isinstance(plain, Mapping):
        return of_domain(name, plain)
    if isinstance(plain, list | tuple):
        if len(plain) == 2 and all(map(is_number, plain)):
            return interval(name, float(plain[0]), float(plain[1]), is_log=False)
        return one_of(name, plain)
    if callable(values):
        return lambda generator: given.value(name, values(generator))
    raise given.refused(name, FORMS, values)


class Randomization:
    """Values for keys of the configuration, a new draw for each episode.

    Attributes:
        keys: Which are drawn, in order.
    """

    def __init__(self, randomize: Mapping[str, Any] | None) -> None:
        """Describe it, see `draw_of`.

        Raises:
            ConfigurationError: Something of it is wrong.
        """
        if randomize is not None and not isinstance(randomize, Mapping):
            raise given.refused("randomize", "a map from keys of the configuration to what is drawn", randomize)
        self._draws: dict[str, Draw] = {}
        for key, values in (randomize or {}).items():
            name = given.text("randomize: a key", key)
            self._draws[name] = draw_of(f"randomize: {name}", values)
            if name in NOT_DRAWN:
                raise ConfigurationError(f"randomize: {name} cannot be drawn: {NOT_DRAWN[name]}")
        self.keys = tuple(self._draws)

    def drawn(self, generator: np.random.Generator) -> dict[str, Any]:
        """Draw values, one for each key."""
        return {key: draw(generator) for key, draw in self._draws.items()}
