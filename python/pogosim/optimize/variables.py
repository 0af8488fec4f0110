"""What a configuration leaves to a search: its variables, and the configuration that values of them make."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.batch.configurations.combinations import alternatives_of, overlay
from pogosim.batch.configurations.option_words import (
    DOMAIN,
    HIERARCHICAL_OPTIONS,
    NAME,
    NOT_EXPANDED,
    CombinationsError,
    OptionsError,
    check_options,
)
from pogosim.optimize.domain import Categorical, Domain, domain_of, has_init

Floats = npt.NDArray[np.float64]
Path = tuple[str, ...]
Values = dict[str, Any]  # of the variables in use, by name


@dataclass(frozen=True)
class Variable:
    """Something in a configuration that a search chooses.

    Attributes:
        path: Where it is: keys from the top level on, with the names of alternatives (`batch_hierarchical_options`) in
            which it is. The path of a map with alternatives stands for the choice of one.
        domain: Its values.
        label: The `name` that alternatives have in the configuration, or empty.
        has_init: The configuration says where a search starts; otherwise it is the middle, or the first choice.
    """

    path: Path
    domain: Domain
    label: str = ""
    has_init: bool = False

    @property
    def name(self) -> str:
        """Its label, or else its dotted path."""
        return self.label or ".".join(self.path)


def variables_of(entries: dict[str, Any]) -> list[Variable]:
    """Return the variables of a configuration, in order of appearance.

    Raises:
        CombinationsError: A domain is wrong.
    """
    return [
        variable
        for key, value in entries.items()
        if key not in NOT_EXPANDED
        for variable in variables_in(value, (str(key),))
    ]


def variables_in(node: Any, path: Path) -> Iterator[Variable]:
    """Yield the variables of a node and of what is below it."""
    if isinstance(node, list):
        for number, item in enumerate(node):
            yield from variables_in(item, (*path, str(number)))
        return
    if not isinstance(node, dict):
        return
    if DOMAIN in node:
        try:
            domain = domain_of(node)
        except OptionsError as error:
            raise CombinationsError(path, str(error)) from None
        yield Variable(path, domain, has_init=has_init(node, domain))
        return
    for key, value in node.items():
        if key != HIERARCHICAL_OPTIONS:
            yield from variables_in(value, (*path, str(key)))
    if HIERARCHICAL_OPTIONS in node:
        names = [name for name, _, _ in alternatives_of(node, path)]
        if len(names) > 1:
            yield Variable(path, Categorical(tuple(names), 0), node[HIERARCHICAL_OPTIONS].get(NAME) or "")
        for name in names:
            chosen = alternative(node, name)
            for key, value in chosen.items():
                yield from variables_in(value, (*path, name, str(key)))


def alternative(node: dict[str, Any], name: str) -> dict[str, Any]:
    """Return the entries of an alternative of a map."""
    options = node[HIERARCHICAL_OPTIONS]
    entries = next(value for key, value in options.items() if str(key) == name)
    return entries or {}


def with_own_names(variables: list[Variable]) -> list[Variable]:
    """Return variables of which no two have the same name: labels that several have are left out."""
    names = Counter(variable.name for variable in variables)
    return [replace(variable, label="") if names[variable.name] > 1 else variable for variable in variables]


class Space:
    """All variables of a configuration, and the configuration that a point of the unit cube stands for.

    Args:
        entries: The configuration; it is not changed.

    Attributes:
        variables: In order of appearance; at least one. A point has as many coordinates, from 0 to 1.

    Raises:
        CombinationsError: Options or a domain are wrong, or there is no domain.
    """

    def __init__(self, entries: dict[str, Any]) -> None:
        check_options(entries)
        self.entries = entries
        self.variables = with_own_names(variables_of(entries))
        if not self.variables:
            raise CombinationsError(
                (),
                f"nothing to optimise: no key has an {DOMAIN}, such as "
                "run_duration_max: {optimization_domain: {type: int, min: 10, max: 1000, init: 50}}",
            )

    @property
    def init(self) -> Floats:
        """The point where a search starts, of shape (variables,)."""
        return np.array([variable.domain.start for variable in self.variables])

    def values_at(self, point: Sequence[float] | Floats) -> Values:
        """Return the values of the variables in use at a point: none of an alternative that is not chosen."""
        positions = {variable.path: float(x) for variable, x in zip(self.variables, point, strict=True)}
        chosen: Values = {}

        def take(variable: Variable) -> Any:
            value = variable.domain.value_at(positions[variable.path])
            chosen[variable.name] = value
            return value

        self.walk(take, is_flat=False)
        # In the order of the variables, whatever the order of the walk.
        return {variable.name: chosen[variable.name] for variable in self.variables if variable.name in chosen}

    def configuration(self, values: Values, is_flat: bool = False) -> dict[str, Any]:
        """Return the configuration that values make.

        Args:
            values: Values of the variables in use.
            is_flat: Merge the chosen alternatives into their maps, as the simulator reads them. Otherwise, they remain
                alternatives, each the only one of its map, so that columns can have their names.
        """
        return self.walk(lambda variable: values[variable.name], is_flat)

    def walk(self, take: Callable[[Variable], Any], is_flat: bool) -> dict[str, Any]:
        """Return the configuration with all variables in use replaced."""
        by_path = {variable.path: variable for variable in self.variables}
        named: dict[str, str] = {}

        def replaced(node: Any, path: Path) -> Any:
            if isinstance(node, list):
                return [replaced(item, (*path, str(number))) for number, item in enumerate(node)]
            if not isinstance(node, dict):
                return node
            if DOMAIN in node:
                return take(by_path[path])
            siblings = {
                key: replaced(value, (*path, str(key))) for key, value in node.items() if key != HIERARCHICAL_OPTIONS
            }
            return with_alternative(node, path, siblings) if HIERARCHICAL_OPTIONS in node else siblings

        def with_alternative(node: dict[str, Any], path: Path, siblings: dict[str, Any]) -> dict[str, Any]:
            names = [name for name, _, _ in alternatives_of(node, path)]
            name = take(by_path[path]) if path in by_path else names[0]
            branch = {key: replaced(value, (*path, name, str(key))) for key, value in alternative(node, name).items()}
            key = node[HIERARCHICAL_OPTIONS].get(NAME)
            if not is_flat:
                return {**siblings, HIERARCHICAL_OPTIONS: {**({NAME: key} if key else {}), name: branch}}
            if key:
                named[key] = name
            return overlay(siblings, branch)

        walked = {
            key: value if key in NOT_EXPANDED else replaced(value, (str(key),)) for key, value in self.entries.items()
        }
        return {**walked, **named}


def as_json(values: Values) -> str:
    """Return values as one line of JSON."""
    return json.dumps(values, default=str, ensure_ascii=False)
