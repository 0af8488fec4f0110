"""What viewers ask for, as messages in JSON, checked before anything is done."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

MOST_CHARACTERS = 2000  # of a message
MOST_STEPS = 10_000
MOST_SEED = 2**32 - 1


class RefusedError(Exception):
    """A message asks for nothing that can be done; says why."""


@dataclass(frozen=True)
class Command:
    """A message that was understood."""

    name: str
    values: dict[str, Any]
    steers: bool  # it changes the run, for all viewers


Check = Callable[[Any], bool]


def is_whole(least: int, most: int) -> Check:
    """Return the check for whole numbers in a range."""
    return lambda value: type(value) is int and least <= value <= most


def is_finite(value: Any) -> bool:
    """Tell whether a value is a finite number."""
    return type(value) in (int, float) and abs(value) <= 1e9 and math.isfinite(value)


def is_name(value: Any) -> bool:
    """Tell whether a value is a text that could be a name."""
    return isinstance(value, str) and 0 < len(value) <= 200


def or_none(check: Check) -> Check:
    """Return the check for values that may be null."""
    return lambda value: value is None or check(value)


def is_object(value: Any) -> bool:
    """Tell whether a value could be the index of an object; -1: of none."""
    return type(value) is int and -1 <= value < 2**31


# By name: what each value has to be, and whether it steers the run.
COMMANDS: dict[str, tuple[dict[str, Check], bool]] = {
    "shown": ({"frame": is_whole(0, 2**32 - 1)}, False),
    "select": ({"object": is_object}, False),
    "columns": ({"color_by": or_none(is_name), "heat_map": or_none(is_name)}, False),
    "steer": ({}, False),
    "play": ({}, True),
    "pause": ({}, True),
    "step": ({"steps": is_whole(1, MOST_STEPS)}, True),
    "speed": ({"value": or_none(lambda value: is_finite(value) and 0 < value <= 1e6)}, True),
    "drag": ({"object": is_object, "x": is_finite, "y": is_finite}, True),
    "set": ({"name": is_name, "value": lambda value: type(value) is bool or is_finite(value)}, True),
    "lamp": ({"lamp": is_whole(0, 10**6), "on": lambda value: type(value) is bool, "intensity": is_finite}, True),
    "reset": ({"seed": or_none(is_whole(0, MOST_SEED))}, True),
}
OPTIONAL = {"seed": None}


def read_command(message: Any) -> Command:
    """Understand a message.

    Args:
        message: JSON text, or what it stands for.

    Raises:
        RefusedError: It is none of the commands.
    """
    if isinstance(message, str):
        if len(message) > MOST_CHARACTERS:
            raise RefusedError(f"a message has at most {MOST_CHARACTERS} characters, this one {len(message)}")
        try:
            message = json.loads(message)
        except (ValueError, RecursionError):
            raise RefusedError("a message is not JSON") from None
    if not isinstance(message, Mapping):
        raise RefusedError("a message is not a map")
    name = message.get("do")
    if not isinstance(name, str) or name not in COMMANDS:
        raise RefusedError(f"unknown command; there are {', '.join(COMMANDS)}")
    checks, steers = COMMANDS[name]
    unknown = set(map(str, message)) - {"do", *checks}
    if unknown:
        raise RefusedError(f"{name} takes {', '.join(checks) or 'nothing'}")
    values = {**{key: value for key, value in OPTIONAL.items() if key in checks}, **message}
    values.pop("do")
    for key, check in checks.items():
        if key not in values or not check(values[key]):
            raise RefusedError(f"{name}: {key} is missing or out of range")
    return Command(name, values, steers)
