"""All combinations of the options in a configuration, and the one that a single run takes.

The product is taken in the order of appearance: the option that comes last in the file varies fastest. Maps are merged
as the simulator does for a single run.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

from pogosim.batch.configurations.option_words import (
    CHOICES,
    DEFAULT,
    DEFAULT_ALTERNATIVE,
    HIERARCHICAL_OPTIONS,
    LIST,
    NAME,
    NOT_EXPANDED,
    RANGE,
    CombinationsError,
    OptionsError,
    check_options,
    offers_options,
    shown,
)
from pogosim.batch.configurations.options import expand_batch_options, single_value

MAX_COMBINATIONS = 1_000_000
MAX_DEPTH = 200

Choices = dict[str, str]
# The value of a node in one combination, the alternatives chosen in it, and the keys that name them.
Variant = tuple[Any, Choices, Choices]
# An alternative of a map: its name, the key that the name is given in, and the merged map.
Alternative = tuple[str, str | None, dict[str, Any]]


def overlay(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    """Return a map with another one laid over it: maps are merged key by key, anything else is replaced."""
    merged = dict(below)
    for key, value in above.items():
        under = merged.get(key)
        if isinstance(under, dict) and isinstance(value, dict) and not offers_options(under):
            merged[key] = overlay(under, value)
        else:
            merged[key] = value
    return merged


def alternatives_of(node: dict[str, Any], path: tuple[str, ...]) -> Iterator[Alternative]:
    """Yield the alternatives of a map; `default` only if there is no other."""
    options = node[HIERARCHICAL_OPTIONS]
    path = (*path, HIERARCHICAL_OPTIONS)
    if not isinstance(options, dict):
        raise CombinationsError(path, f"expected a map of alternatives, found {shown(options)}")
    key = options.get(NAME)
    if key is not None and (not isinstance(key, str) or not key):
        raise CombinationsError((*path, NAME), f"expected the name of a key, found {shown(key)}")
    names = [name for name in options if name not in (NAME, DEFAULT_ALTERNATIVE)]
    if not names and DEFAULT_ALTERNATIVE not in options:
        raise CombinationsError(path, "expected at least one alternative, found none")
    siblings = {name: value for name, value in node.items() if name != HIERARCHICAL_OPTIONS}
    for name in names or [DEFAULT_ALTERNATIVE]:
        chosen = {} if options[name] is None else options[name]
        if not isinstance(chosen, dict):
            raise CombinationsError((*path, str(name)), f"expected a map of keys and values, found {shown(chosen)}")
        yield str(name), key, overlay(siblings, chosen)


def known_alternative(node: dict[str, Any], path: tuple[str, ...]) -> list[Alternative]:  # noqa: ARG001
    """Return the alternative `default`, or the map alone if there is none."""
    options = node[HIERARCHICAL_OPTIONS] if isinstance(node[HIERARCHICAL_OPTIONS], dict) else {}
    siblings = {name: value for name, value in node.items() if name != HIERARCHICAL_OPTIONS}
    chosen = options.get(DEFAULT_ALTERNATIVE)
    merged = overlay(siblings, chosen) if isinstance(chosen, dict) else siblings
    return [(DEFAULT_ALTERNATIVE, options.get(NAME), merged)]


def default_alternative(node: dict[str, Any], path: tuple[str, ...]) -> list[Alternative]:
    """Return the alternative that a single run takes."""
    list(alternatives_of(node, path))  # which checks them
    if not isinstance(node[HIERARCHICAL_OPTIONS].get(DEFAULT_ALTERNATIVE), dict):
        message = f"has no alternative '{DEFAULT_ALTERNATIVE}', which a single run takes; add one"
        raise CombinationsError((*path, HIERARCHICAL_OPTIONS), message)
    return known_alternative(node, path)


def default_value(node: dict[str, Any]) -> list[Any]:
    """Return the value that a single run takes."""
    value = single_value(node)
    if value is None and DEFAULT not in node:
        word = LIST if LIST in node else RANGE
        raise OptionsError(f"has {word} and no {DEFAULT}, which a single run takes; add it, or use pogobatch run")
    return [value]


class Choice(NamedTuple):
    """What is taken where a configuration offers something."""

    alternatives: Callable[[dict[str, Any], tuple[str, ...]], Iterable[Alternative]]
    values: Callable[[dict[str, Any]], list[Any]]


EVERYTHING = Choice(alternatives_of, expand_batch_options)
DEFAULTS = Choice(default_alternative, default_value)  # as in a single run
KNOWN = Choice(known_alternative, lambda node: [single_value(node)])  # the same; None where there is no default


def variants_of(node: Any, path: tuple[str, ...], choice: Choice = EVERYTHING) -> list[Variant]:
    """Return all variants of a node, in order; of DEFAULTS, there is one."""
    if len(path) > MAX_DEPTH:
        raise CombinationsError(path[:3], f"nested deeper than {MAX_DEPTH} levels")
    if isinstance(node, dict) and HIERARCHICAL_OPTIONS in node:
        found = []
        for name, key, merged in choice.alternatives(node, path):
            chosen = {".".join(path): name} if path else {}
            named = {key: name} if key else {}
            found += [
                (value, {**chosen, **choices}, {**named, **names})
                for value, choices, names in variants_of(merged, path, choice)
            ]
        return found
    if offers_options(node):
        try:
            values = choice.values(node)
        except OptionsError as error:
            raise CombinationsError(path, str(error)) from None
        return [
            variant
            for value in values
            for variant in ([(node, {}, {})] if value is node else variants_of(value, path, choice))
        ]
    if isinstance(node, dict):
        children = [
            (
                key,
                [(value, {}, {})]
                if not path and key in NOT_EXPANDED
                else variants_of(value, (*path, str(key)), choice),
            )
            for key, value in node.items()
        ]
        return product(children, path, dict)
    if isinstance(node, list):
        items = [(number, variants_of(value, (*path, str(number)), choice)) for number, value in enumerate(node)]
        return product(items, path, lambda pairs: [value for _, value in pairs])
    return [(node, {}, {})]


def product(
    children: list[tuple[Any, list[Variant]]], path: tuple[str, ...], build: Callable[[list[tuple[Any, Any]]], Any]
) -> list[Variant]:
    """Return the product of the variants of children; that of the last child varies fastest."""
    count = math.prod(len(variants) for _, variants in children)
    if count > MAX_COMBINATIONS:
        raise CombinationsError(path, f"{count} combinations are more than {MAX_COMBINATIONS}; remove some options")
    rows: list[tuple[list[tuple[Any, Any]], Choices, Choices]] = [([], {}, {})]
    for key, variants in children:
        if len(variants) == 1:
            value, choices, names = variants[0]
            for pairs, chosen, named in rows:
                pairs.append((key, value))
                chosen.update(choices)
                named.update(names)
            continue
        rows = [
            ([*pairs, (key, value)], {**chosen, **choices}, {**named, **names})
            for pairs, chosen, named in rows
            for value, choices, names in variants
        ]
    return [(build(pairs), choices, names) for pairs, choices, names in rows]


def combinations_of(configuration: dict[str, Any], choice: Choice = EVERYTHING) -> list[dict[str, Any]]:
    """Return the configuration of every combination of options, in order of appearance.

    Args:
        configuration: Configuration with options; it is not changed.
        choice: What is taken of them.

    Returns:
        At least one configuration. Where alternatives were chosen (`batch_hierarchical_options`), the key
        `_batch_choice_names` has their names by dotted path, and the key called like their `name` has the name.

    Raises:
        CombinationsError: Options are wrong, or there are more than a million combinations.
    """
    check_options(configuration)
    combinations = []
    for value, choices, names in variants_of(configuration, (), choice):
        combination = copy.deepcopy(value)
        for key, name in names.items():
            combination[key] = name
        if choices:
            combination[CHOICES] = choices
        combinations.append(combination)
    return combinations


def resolved(configuration: dict[str, Any]) -> dict[str, Any]:
    """Return the configuration of a single run: the `default_option` of all options, the alternative `default`.

    Raises:
        CombinationsError: Options have no default, or are wrong.
    """
    return combinations_of(configuration, DEFAULTS)[0]
