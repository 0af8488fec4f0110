"""Keys of the configuration that are drawn anew for each episode."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import Any

import numpy as np

from pogosim.arguments import without_numpy
from pogosim.batch.configurations.option_words import DOMAIN, OptionsError
from pogosim.nearest_name import advice
from pogosim.optimize.domain import TYPES, Categorical, Domain, Real, domain_of
from pogosim.simulation.errors import ConfigurationError, given

Draw = Callable[[np.random.Generator], Any]

NORMAL = "normal"  # a type of domain that searches do not have
NORMAL_KEYS = ("mean", "stddev")
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


def is_interval(values: Any) -> bool:
    """Tell whether the values of a key are all numbers between two."""
    return isinstance(values, list | tuple) and len(values) == 2 and all(map(is_number, values))


def from_domain(domain: Domain) -> Draw:
    """Return the uniform distribution of the values of a domain."""
    return lambda generator: domain.value_at(float(generator.random()))


def interval(name: str, low: float, high: float) -> Draw:
    """Return a uniform distribution; of one number, if both ends are it."""
    if not low <= high:
        raise ConfigurationError(f"{name}: expected low <= high, found [{low:g}, {high:g}]")
    if not math.isfinite(high - low):
        raise ConfigurationError(f"{name}: the interval from {low:g} to {high:g} is too wide")
    return from_domain(Real(low, high, is_log=False, init=low) if low < high else Categorical((low,), 0))


def one_of(name: str, values: Any) -> Draw:
    """Return a choice, each value as likely."""
    if not values:
        raise given.refused(name, "at least one value to choose from", values)
    return from_domain(Categorical(tuple(given.value(name, value) for value in values), 0))


def normal(name: str, domain: Mapping[str, Any]) -> Draw:
    """Return the normal distribution that a map describes."""
    for key in domain:
        if key not in ("type", *NORMAL_KEYS):
            raise ConfigurationError(f"{name}: a domain of type normal has no key {key!r}{advice(key, NORMAL_KEYS)}")
    missing = [key for key in NORMAL_KEYS if key not in domain]
    if missing:
        raise ConfigurationError(f"{name}: a domain of type normal needs the key {missing[0]!r}")
    mean, stddev = (given.finite(f"{name}.{key}", domain[key]) for key in NORMAL_KEYS)
    if stddev < 0:
        raise given.refused(f"{name}.stddev", "a number of at least 0", stddev)
    return lambda generator: float(generator.normal(mean, stddev))


def of_map(name: str, domain: dict[str, Any]) -> Draw:
    """Return the distribution that a map describes."""
    kind = domain.get("type")
    if kind == NORMAL:
        return normal(name, domain)
    if "type" in domain and kind not in TYPES:
        raise given.refused(f"{name}.type", f"{', '.join(TYPES)} or {NORMAL}", kind)
    try:
        return from_domain(domain_of({DOMAIN: domain}))
    except OptionsError as error:
        raise ConfigurationError(f"{name}: {str(error).removeprefix(f'{DOMAIN}: ')}") from None


def draw_of(name: str, values: Any) -> Draw:
    """Return how the values of one key are drawn.

    Args:
        name: The key, as messages say it.
        values: A list of two numbers, an interval; another list, values of which each is as likely; a map as in
            `optimization_domain`, whose values are uniform, or {type: normal, mean: 0, stddev: 1}; or a function of a
            generator of random numbers.

    Raises:
        ConfigurationError: It is none of these, or an interval is empty.
    """
    plain = without_numpy(values)
    if isinstance(plain, Mapping):
        return of_map(name, given.value(name, plain))
    if isinstance(plain, list | tuple):
        if is_interval(plain):
            return interval(name, float(plain[0]), float(plain[1]))
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
        self._advice: dict[str, str] = {}  # what to write instead of an interval, for integers
        self._unchecked = {*(randomize or {})}  # of which no fraction has been drawn yet
        for key, values in (randomize or {}).items():
            name = given.text("randomize: a key", key)
            self._draws[name] = draw_of(f"randomize: {name}", values)
            if name in NOT_DRAWN:
                raise ConfigurationError(f"randomize: {name} cannot be drawn: {NOT_DRAWN[name]}")
            if is_interval(plain := without_numpy(values)):
                low, high = math.ceil(plain[0]), math.floor(plain[1])
                self._advice[name] = f": write {{'type': 'int', 'min': {low}, 'max': {high}}}"
        self.keys = tuple(self._draws)

    def drawn(self, generator: np.random.Generator) -> dict[str, Any]:
        """Draw values, one for each key."""
        return {key: draw(generator) for key, draw in self._draws.items()}

    def check_integers(self, drawn: Iterable[Mapping[str, Any]], warnings: Collection[str]) -> None:
        """Check that the simulator has used fractions as they were drawn.

        Args:
            drawn: What was drawn for some runs, which have begun with it.
            warnings: Those of the simulator: it uses another number where a key is one of integers.

        Raises:
            ConfigurationError: It has used another number.
        """
        if not self._unchecked:
            return
        for of_run in drawn:
            for key, value in of_run.items():
                if key not in self._unchecked or not is_number(value) or value == int(value):
                    continue
                if any(f": {key}: expected an integer, found" in warning for warning in tuple(warnings)):
                    advised = self._advice.get(key, "")
                    raise ConfigurationError(f"randomize: {key}: expected integers, found {value:g}{advised}")
                self._unchecked.discard(key)
