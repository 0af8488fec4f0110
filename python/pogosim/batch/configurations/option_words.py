"""The keys with which a configuration offers alternative values, and slips in them.

A misspelt key would silently leave out a part of a study. The simulator has the same lists
(src/config/option_keys.hpp), and refuses the same (src/config/check_options.cpp).
"""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from pogosim.nearest_name import advice, edit_distance
from pogosim.yaml_1_2 import WrittenBool, plain

DEFAULT = "default_option"
LIST = "batch_options"
RANGE = "batch_options_range"
DOMAIN = "optimization_domain"
HIERARCHICAL_OPTIONS = "batch_hierarchical_options"

# Keys of a map that replaces a value, of its ranges, and of its domains.
VALUE_WORDS = (DEFAULT, LIST, RANGE, DOMAIN)
RANGE_WORDS = ("start", "stop", "step", "inclusive", "type")
DOMAIN_WORDS = ("type", "min", "max", "init", "log", "choices")

# Keys of a map of alternatives; all others are their names.
NAME = "name"
DEFAULT_ALTERNATIVE = "default"

# In the configuration of a combination: the names of the chosen alternatives, by the dotted path of their map.
CHOICES = "_batch_choice_names"
# Keys of the top level that are no part of a run's world; nothing in them is an option.
FORMAT_OF_RESULTS, COLUMNS_OF_RESULTS = "result_filename_format", "result_new_columns"
TOOL_KEYS = (FORMAT_OF_RESULTS, COLUMNS_OF_RESULTS, "optimization")
NOT_EXPANDED = (*TOOL_KEYS, CHOICES)

SLIP = 2  # letters at most

Path = tuple[str, ...]


class OptionsError(ValueError):
    """The options of a node are wrong; says what was expected and what to write."""


class CombinationsError(OptionsError):
    """Options are wrong, or too many.

    Attributes:
        path: Where: keys from the top level on.
        key: The entry there that is wrong; empty: all of it.
    """

    def __init__(self, path: Path, message: str, key: str = "") -> None:
        super().__init__(message)
        self.path = path
        self.key = key

    def __str__(self) -> str:
        """Return the path and what is wrong there."""
        return f"{'.'.join(self.path)}: {self.args[0]}" if self.path else str(self.args[0])


def shown(value: Any) -> str:
    """Return a value as short text for a message."""
    text = "nothing" if value is None else f"'{value}'" if isinstance(value, str) else str(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def chosen_in(varied: Mapping[str, Sequence[Any]], number: int) -> dict[str, Any]:
    """Return what tells a combination from others: keys and its values. `varied` has the values of all."""
    return {key.removeprefix(f"{CHOICES}."): values[number] for key, values in varied.items()}


def offers_options(node: Any) -> bool:
    """Tell whether a node stands for a value to choose: what the simulator replaces by `default_option`."""
    return isinstance(node, dict) and any(key in node for key in VALUE_WORDS)


def is_slip_of(word: str, key: str) -> bool:
    """Tell whether a key is a word but for one or two letters."""
    return key != word and abs(len(key) - len(word)) <= SLIP and edit_distance(key, word) <= SLIP


def misspelt_option(key: Any) -> str | None:
    """Return the option word that a key misspells; None if it is such a word, or resembles none."""
    words = (*VALUE_WORDS, HIERARCHICAL_OPTIONS)
    if not isinstance(key, str) or key in words:
        return None
    return next((word for word in words if is_slip_of(word, key)), None)


def refuse_unknown(entries: Mapping[Any, Any], words: Iterable[str], path: Path = (), beside: str = "") -> None:
    """Raise CombinationsError for the first key that is none of the words, naming the nearest."""
    words = tuple(words)
    for key in entries:
        if key not in words:
            where = f" beside '{beside}'" if beside else ""
            raise CombinationsError(path, f"unknown key {shown(str(key))}{where}{advice(str(key), words)}", str(key))


def refuse_other_keys(node: Mapping[Any, Any], path: Path) -> None:
    """Raise CombinationsError for the first key of a map of options that is none of its words."""
    beside = next(key for key in node if key in VALUE_WORDS)
    refuse_unknown(
        {key: value for key, value in node.items() if key != HIERARCHICAL_OPTIONS}, VALUE_WORDS, path, beside
    )


def identities(value: Any) -> list[Hashable]:
    """Return what a value is to the simulator and in results; two values that share one of these are the same.

    So are 3, 3.0 and '3', and 1e4 and '10000.0', which a column of texts would not tell apart.
    """
    if isinstance(value, dict):
        return [("map", *((str(key), identities(inner)[0]) for key, inner in value.items()))]
    if isinstance(value, list):
        return [("list", *(identities(inner)[0] for inner in value))]
    text = getattr(value, "text", str(value))
    if value is None:
        return [("word", value)]
    if isinstance(value, (bool, WrittenBool)):
        return [("word", plain(value)), ("text", text), ("text", str(plain(value)).lower())]
    if isinstance(value, (int, float)):
        return [("number", value if value == value else "nan"), ("text", text), ("text", str(plain(value)))]
    return [("text", text)]


def refuse_twice(values: list[tuple[Path, Any]]) -> None:
    """Raise CombinationsError for the first of the values, each with its path, that is the same as one before it."""
    first: dict[Hashable, Any] = {}
    for path, value in values:
        known = identities(value)
        if same := [identity for identity in known if identity in first]:
            before, this = shown(first[same[0]]), shown(value)
            twice = f"{this} twice" if before == this else f"{before} and {this}, which are the same"
            message = f"expected different values, found {twice}; their runs would be the same: remove one"
            raise CombinationsError(path[:-1], message, path[-1])
        first.update(dict.fromkeys(known, value))


def check_options(entries: dict[str, Any]) -> None:
    """Look for slips in all keys of options.

    Raises:
        CombinationsError: A map of options has another key, or their ranges and domains do; or a key is a slip of these
            words and so makes a map that is none. Names that users choose may be like them, those of parameters, of
            categories and of alternatives, unless all of a map looks like options.
    """
    for key in entries:
        if slip := next((word for word in TOOL_KEYS if is_slip_of(word, str(key))), None):
            raise CombinationsError((), f"unknown key {shown(str(key))}; did you mean '{slip}'?", str(key))
    look_at(entries, (), "top level")


def look_at(node: Any, path: Path, names: str) -> None:
    """Check a node and everything below it; `names` says where its keys come from.

    "top level": the simulator, and tools. "": the simulator. "categories": the user, but not those below. "parameters":
    the user, and those below, too.
    """
    if isinstance(node, list):
        for number, item in enumerate(node):
            look_at(item, (*path, str(number)), below(names))
    if not isinstance(node, dict):
        return
    if offers_options(node):
        look_at_options(node, path, names)
    else:
        for key, value in node.items():
            if key != HIERARCHICAL_OPTIONS and not (names == "top level" and key in NOT_EXPANDED):
                if (word := misspelt_option(key)) and not may_be_a_name(key, word, node, names):
                    raise CombinationsError(path, f"unknown key '{key}'; did you mean '{word}'?", str(key))
                is_named = names == "top level" and key in ("objects", "parameters")
                inner = {"objects": "categories", "parameters": "parameters"}[key] if is_named else below(names)
                look_at(value, (*path, str(key)), inner)
    if isinstance(node.get(HIERARCHICAL_OPTIONS), dict):
        look_at_alternatives(node[HIERARCHICAL_OPTIONS], (*path, HIERARCHICAL_OPTIONS), names)


def below(names: str) -> str:
    """Return where the keys below come from."""
    return names if names == "parameters" else ""


def look_at_options(node: dict[str, Any], path: Path, names: str) -> None:
    """Look at a map of options, and at the values that they offer, which stand where the map does."""
    refuse_other_keys(node, path)
    if isinstance(node.get(RANGE), dict):
        refuse_unknown(node[RANGE], RANGE_WORDS, (*path, RANGE))
    options, choices = listed(node.get(LIST), (*path, LIST)), []
    values = [((*path, DEFAULT), node.get(DEFAULT))]
    if isinstance(domain := node.get(DOMAIN), dict):
        refuse_unknown(domain, DOMAIN_WORDS, (*path, DOMAIN))
        values += [((*path, DOMAIN, "init"), domain.get("init"))]
        choices = listed(domain.get("choices"), (*path, DOMAIN, "choices"))
    refuse_twice(options)
    refuse_twice(choices)
    values += [*options, *choices]
    for where, value in values:
        look_at(value, where, names)


def listed(values: Any, path: Path) -> list[tuple[Path, Any]]:
    """Return the items of a list with their paths."""
    return [((*path, str(number)), value) for number, value in enumerate(values)] if isinstance(values, list) else []


def may_be_a_name(key: str, word: str, node: dict[Any, Any], names: str) -> bool:
    """Tell whether a key of a map that is like a word of options may be a name that the user has chosen."""
    value = node[key]
    if names == "top level":
        is_one = value is not None and not isinstance(value, (dict, list))  # perhaps the name of an alternative
        return is_one or key in names_of_results(node)
    if names == "categories":
        return word != HIERARCHICAL_OPTIONS
    if names == "parameters":
        return not isinstance(value, dict) if word == HIERARCHICAL_OPTIONS else not is_meant_as_options(node)
    return False


def names_of_results(entries: dict[Any, Any]) -> set[str]:
    """Return the keys that columns and names of results are asked to have, of a whole configuration."""
    texts = list(texts_in([entries.get(COLUMNS_OF_RESULTS), entries.get(CHOICES)]))
    return {*texts, *re.findall(r"\{([^}:!]+)", str(entries.get(FORMAT_OF_RESULTS) or "")), *names_of_choices(entries)}


def texts_in(node: Any) -> Iterator[str]:
    """Yield all keys and values in maps and lists."""
    if isinstance(node, dict):
        yield from map(str, node)
        yield from texts_in(list(node.values()))
    elif isinstance(node, list):
        for item in node:
            yield from texts_in(item)
    else:
        yield str(node)


def names_of_choices(node: Any) -> Iterator[str]:
    """Yield the names under which results have the choices between alternatives, at any depth."""
    alternatives = node.get(HIERARCHICAL_OPTIONS) if isinstance(node, dict) else None
    if isinstance(alternatives, dict) and isinstance(name := alternatives.get(NAME), str):
        yield name
    for inner in node.values() if isinstance(node, dict) else node if isinstance(node, list) else ():
        yield from names_of_choices(inner)


def is_meant_as_options(node: dict[Any, Any]) -> bool:
    """Tell whether all keys are misspelt option words, and the value of at least one has the type of its word."""
    kinds = {LIST: list, RANGE: dict, DOMAIN: dict, HIERARCHICAL_OPTIONS: dict}
    words = {key: misspelt_option(key) for key in node}
    fits = [isinstance(node[key], kinds[word]) for key, word in words.items() if word in kinds]
    return None not in words.values() and any(fits)


def look_at_alternatives(alternatives: dict[str, Any], path: Path, names: str) -> None:
    """Look at what stands under `batch_hierarchical_options`."""
    for key, value in alternatives.items():
        if key == NAME:
            continue
        if not isinstance(value, dict) and value is not None and key != DEFAULT_ALTERNATIVE:
            slip = f"; did you mean '{NAME}'?" if is_slip_of(NAME, str(key)) else ""
            raise CombinationsError((*path, str(key)), f"expected a map of keys and values, found {shown(value)}{slip}")
        if DEFAULT_ALTERNATIVE not in alternatives and is_slip_of(DEFAULT_ALTERNATIVE, str(key)):
            raise CombinationsError(
                path,
                f"there is no '{DEFAULT_ALTERNATIVE}', which a single run takes; did you mean '{DEFAULT_ALTERNATIVE}', "
                f"not '{key}'?",
                str(key),
            )
        look_at(value, (*path, str(key)), names)
