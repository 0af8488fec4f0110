"""The values that a node of a configuration offers: `batch_options` and `batch_options_range`."""

from __future__ import annotations

import itertools
import math
from decimal import Decimal
from typing import Any

from pogosim.batch.configurations.option_words import (
    DEFAULT,
    DOMAIN,
    LIST,
    RANGE,
    RANGE_WORDS,
    OptionsError,
    offers_options,
    refuse_other_keys,
    refuse_unknown,
    shown,
)
from pogosim.yaml_1_2 import plain

MAX_VALUES = 1_000_000


def expand_batch_options(node: Any) -> list[Any]:
    """Return the values that a node stands for in a batch, in order.

    Args:
        node: A map with `batch_options` (a list) or `batch_options_range` (`start`, `stop`, `step`, and optionally
            `inclusive` and `type`, `int` or `float`); or with `default_option` only, or an `optimization_domain`, which
            stand for one value. Anything else is one value, itself.

    Returns:
        At least one value. A node without options and without a default remains as it is.

    Raises:
        OptionsError: The options are wrong.
    """
    if not offers_options(node):
        return [node]
    refuse_other_keys(node, ())
    if LIST in node and RANGE in node:
        raise OptionsError(f"expected either {LIST} or {RANGE}, found both; remove one")
    if LIST in node:
        return listed(node[LIST])
    if RANGE in node:
        return expand_range(node[RANGE])
    if DEFAULT in node:
        return [node[DEFAULT]]
    domain = node[DOMAIN]
    return [domain["init"]] if isinstance(domain, dict) and "init" in domain else [node]


def single_value(node: Any) -> Any:
    """Return the value that a single run takes: `default_option`, else the start of a search, else None.

    Raises:
        OptionsError: The options have another key.
    """
    if not offers_options(node):
        return node
    refuse_other_keys(node, ())
    domain = node.get(DOMAIN)
    return node[DEFAULT] if DEFAULT in node else domain.get("init") if isinstance(domain, dict) else None


def listed(options: Any) -> list[Any]:
    """Return the values of `batch_options`."""
    if not isinstance(options, list):
        is_value = options is not None and not isinstance(options, dict)
        found = "a map" if isinstance(options, dict) else shown(options)
        raise OptionsError(
            f"{LIST}: expected a list of values, found {found}" + (f"; write [{shown(options)}]" if is_value else "")
        )
    if not options:
        raise OptionsError(f"{LIST}: expected at least one value, found an empty list")
    return list(options)


def expand_range(options: Any) -> list[Any]:
    """Return the values of `batch_options_range`; calculated in decimals, so 3 steps of 0.1 are 0.3."""
    if not isinstance(options, dict):
        raise OptionsError(f"{RANGE}: expected a map, such as {{start: 0, stop: 10, step: 1}}, found {shown(options)}")
    refuse_unknown(options, RANGE_WORDS, (RANGE,))
    start, stop, step = (number_in(options, key) for key in ("start", "stop", "step"))
    if step == 0:
        raise OptionsError(f"{RANGE}: step is 0; give a step from start towards stop")
    inclusive = plain(options.get("inclusive", False))
    if not isinstance(inclusive, bool):
        raise OptionsError(f"{RANGE}: inclusive: expected true or false, found {shown(inclusive)}")
    steps = (stop - start) / step
    count = max(0, math.floor(steps) + 1 if inclusive else math.ceil(steps))
    if count == 0:
        raise OptionsError(
            f"{RANGE}: there is no value from {start} to {stop} in steps of {step}; give another stop, "
            "a step of the other sign, or inclusive: true"
        )
    if count > MAX_VALUES:
        raise OptionsError(f"{RANGE}: there are more than {MAX_VALUES} values; give a larger step")
    values = [start + i * step for i in range(count)]
    integers = all(value == value.to_integral_value() for value in (start, step))
    kind = options.get("type", "int" if integers else "float")
    if kind not in ("int", "float"):
        raise OptionsError(f"{RANGE}: type: expected int or float, found {shown(kind)}")
    if kind == "int" and not integers:
        raise OptionsError(f"{RANGE}: type is int, but start {start} or step {step} is not a whole number")
    numbers = [int(value) if kind == "int" else float(value) for value in values]
    if any(number == following for number, following in itertools.pairwise(numbers)):
        raise OptionsError(f"{RANGE}: a step of {step} is too small to tell values apart; give a larger one")
    return numbers


def number_in(options: dict[str, Any], key: str) -> Decimal:
    """Return a number of a range, exactly as it is written."""
    if key not in options:
        raise OptionsError(f"{RANGE}: '{key}' is missing; expected start, stop and step")
    value = options[key]
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not -1e300 < value < 1e300:
        raise OptionsError(f"{RANGE}: {key}: expected a number, found {shown(value)}")
    return Decimal(str(value))
