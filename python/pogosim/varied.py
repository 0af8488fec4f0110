"""What differs between configurations, and what they have in common."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

MISSING = object()

OBJECTS = "objects"  # the entry of configurations, and that of metadata which says what those objects have

# What differs between any two runs without being a parameter.
NO_PARAMETERS = (
    "seed",
    "data_filename",
    "message_log",
    "console_filename",
    "frames_name",
    "flash_state.output_file",
    "result_filename_format",
    "result_new_columns",
)


def leaves(node: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the values of a configuration with their dotted paths; a list is one value."""
    if isinstance(node, dict) and node:
        for key, value in node.items():
            yield from leaves(value, f"{path}.{key}" if path else str(key))
    elif path:
        yield path, node


def varied_parameters(configurations: Sequence[dict[str, Any]]) -> dict[str, list[Any]]:
    """Return what differs between configurations: dotted paths, with a value for each (None: not there)."""
    flat = [dict(leaves(configuration)) for configuration in configurations]
    paths = list(dict.fromkeys(path for leaf in flat for path in leaf if path not in NO_PARAMETERS))
    values = {path: [leaf.get(path) for leaf in flat] for path in paths}
    return {path: found for path, found in values.items() if any(differ(value, found[0]) for value in found[1:])}


def differ(a: Any, b: Any) -> bool:
    """Tell whether two values of configurations differ; two that are not a number do not."""
    return bool(a != b) and not (a != a and b != b)


def plain(value: Any) -> Any:
    """Copy nested dictionaries and lists; arrays become lists, which pandas can compare and save."""
    if isinstance(value, dict):
        return {key: plain(child) for key, child in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(child) for child in value]
    return value.tolist() if isinstance(value, np.ndarray) else value


def in_common(values: Sequence[Any]) -> Any:
    """Return what values have in common: the value, of maps the common entries; MISSING if there is nothing."""
    first = values[0]
    if all(isinstance(value, dict) for value in values):
        keys = [key for key in first if all(key in value for value in values)]
        common = {key: in_common([value[key] for value in values]) for key in keys}
        kept = {key: value for key, value in common.items() if value is not MISSING}
        return kept if kept or not first else MISSING
    return first if all(plain(value) == plain(first) for value in values[1:]) else MISSING


def is_facts(value: Any) -> bool:
    """Tell whether a value is what metadata `objects` say of an entry."""
    return isinstance(value, Mapping) and isinstance(value.get("has"), (list, tuple))


def facts_in_common(of_runs: Sequence[Any]) -> dict[str, Any]:
    """Return what the metadata `objects` of several runs have in common, of entries that are in all of them."""
    if not all(isinstance(told, Mapping) for told in of_runs):
        return {}
    common = {}
    for category in of_runs[0]:
        lists = [told.get(category) for told in of_runs]
        if all(isinstance(own, list) and len(own) == len(lists[0]) for own in lists):
            shared = [in_common(entries) for entries in zip(*lists, strict=True)]
            if all(map(is_facts, shared)):
                common[category] = shared
    return common
