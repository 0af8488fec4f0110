"""What an episode is worth, and when it is over."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.learning.expression import Expression
from pogosim.learning.quantities import check_finite
from pogosim.learning.swarm_arrays import SwarmArrays, all_names
from pogosim.simulation import ConfigurationError
from pogosim.simulation.errors import given

OfSwarm = Callable[[SwarmArrays], Any]


def expression_of(what: str, text: str, swarm: SwarmArrays) -> Expression:
    """Return an expression of values of these robots."""
    return Expression(what, given.text(what, text), all_names(swarm.known))


def whether(condition: Expression) -> OfSwarm:
    """Return a function that tells in which runs a condition is true of a robot."""

    def is_true(swarm: SwarmArrays) -> npt.NDArray[np.bool_]:
        shape = (len(swarm.runs), swarm.robots)  # an expression without values has none
        found: npt.NDArray[np.bool_] = np.broadcast_to(condition.is_true(swarm.__getitem__), shape)
        reached: npt.NDArray[np.bool_] = np.any(found, axis=1)
        return reached

    return is_true


def array_of(found: Any) -> npt.NDArray[Any]:
    """Return what a function has returned as an array, of objects if its lists have different lengths."""
    try:
        return np.asarray(found)
    except (TypeError, ValueError):
        return np.empty(0, dtype=object)


def of_robots(found: Any, swarm: SwarmArrays) -> npt.NDArray[Any]:
    """Return the rewards of all robots. Shape (runs, robots).

    Args:
        found: One for each run, or for each robot of each run.
        swarm: The robots.

    Raises:
        ConfigurationError: They are others.
    """
    shape = (len(swarm.runs), swarm.robots)
    array = array_of(found)
    if array.dtype.kind not in "biuf" or array.shape not in (shape, shape[:1]):
        kind = f"an array of shape {array.shape}" if array.dtype.kind in "biuf" else f"{type(found).__name__}"
        raise ConfigurationError(
            f"reward: expected numbers of shape {shape}, for each robot of each run, or {shape[:1]}, for each run; "
            f"found {kind}"
        )
    return np.broadcast_to(array[:, None], shape) if array.ndim == 1 else array


def of_runs(found: Any, swarm: SwarmArrays) -> npt.NDArray[np.bool_]:
    """Return in which runs an end is reached. Shape (runs,).

    Raises:
        ConfigurationError: What a function has found is no array of booleans, one for each run.
    """
    array = array_of(found)
    if array.dtype.kind == "b" and array.shape == (len(swarm.runs),):
        return array
    if array.dtype.kind == "b":
        kind = f"an array of shape {array.shape}"
        if array.shape == (len(swarm.runs), swarm.robots):
            kind += ": say whether any or all robots count, with .any(axis=1) or .all(axis=1)"
    elif array.dtype.kind in "iuf":
        kind = f"numbers of shape {array.shape}: compare them with something"
    else:
        kind = type(found).__name__
    raise ConfigurationError(f"end: expected booleans of shape ({len(swarm.runs)},), one for each run; found {kind}")


class Reward:
    """What robots get for a step: a function of a `SwarmArrays`, or an expression of their values.

    Attributes:
        names: The values in the expression.
    """

    def __init__(self, reward: str | OfSwarm, swarm: SwarmArrays) -> None:
        """Read it.

        Raises:
            ConfigurationError: It is neither, or an expression that cannot be read.
        """
        self._swarm = swarm
        self.names: tuple[str, ...] = ()
        if isinstance(reward, str):
            expression = expression_of("reward", reward, swarm)
            self.names = expression.names
            self._of = self._of_expression(expression)
        elif callable(reward):
            self._of = reward
        else:
            raise given.refused("reward", 'a function, or an expression such as "light"', reward)

    def _of_expression(self, expression: Expression) -> OfSwarm:
        shape = (len(self._swarm.runs), self._swarm.robots)
        return lambda swarm: np.broadcast_to(expression.numbers(swarm.__getitem__), shape)

    def of_step(self, begins_anew: npt.NDArray[np.bool_]) -> npt.NDArray[np.float64]:
        """Return what all robots get now, 0 in runs that have just begun. Shape (runs, robots).

        Raises:
            ConfigurationError: Numbers are of another shape, or not finite.
        """
        found = np.array(of_robots(self._of(self._swarm), self._swarm), dtype=np.float64)
        found[begins_anew] = 0.0
        check_finite("reward", found, where=self._swarm.when)
        return found


class End:
    """Whether an episode is over before its time: conditions on robots, and functions of a `SwarmArrays`.

    Attributes:
        names: The values in the conditions.
    """

    def __init__(self, end: Any, swarm: SwarmArrays) -> None:
        """Read it; its times are those of `time_limit`.

        Raises:
            ConfigurationError: A condition cannot be read.
        """
        self._swarm = swarm
        self._conditions: list[OfSwarm] = []
        names: list[str] = []
        for part in parts_of(end):
            if isinstance(part, str):
                condition = expression_of("end", part, swarm)
                names += condition.names
                self._conditions.append(whether(condition))
            elif callable(part):
                self._conditions.append(part)
        self.names = tuple(names)

    def is_reached(self) -> npt.NDArray[np.bool_]:
        """Return in which runs a condition is true of a robot, or a function says so. Shape (runs,).

        Raises:
            ConfigurationError: A function has returned something else.
        """
        reached = np.zeros(len(self._swarm.runs), dtype=np.bool_)
        for condition in self._conditions:
            reached |= of_runs(condition(self._swarm), self._swarm)
        return reached


def parts_of(end: Any) -> list[Any]:
    """Return the times, conditions and functions of an end, each of which may stand alone."""
    if end is None:
        return []
    return list(end) if isinstance(end, list | tuple) else [end]


def time_limit(end: Any) -> float:
    """Return the time after which an episode is truncated, s; infinite: it has none.

    Raises:
        ConfigurationError: A part is neither a time above 0, nor a condition, nor a function.
    """
    limit_s = math.inf
    for part in parts_of(end):
        if not isinstance(part, str) and not callable(part):
            time_s = given.number("end", part, "a time (s), a condition or a function")
            if not 0 < time_s < math.inf:
                raise given.refused("end", "a time above 0 s", part)
            limit_s = min(limit_s, time_s)
    return limit_s
