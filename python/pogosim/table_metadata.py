"""What a table says of the runs that it is of: as the simulator or a batch wrote it, or as pandas saved it."""

from __future__ import annotations

import ast
import json
from typing import TYPE_CHECKING, Any

import yaml

from pogosim.varied import plain
from pogosim.yaml_1_2 import WRONG_VALUES, parse_yaml

if TYPE_CHECKING:
    import pyarrow as pa

# One of these is in each file of a run or a batch.
OF_RUNS = ("configuration", "resolved_configuration", "arena_polygons", "combinations", "program_version")


class NoMetadataWarning(RuntimeWarning):
    """A table says nothing of its run: its arena, its borders, and the sizes of its robots are unknown."""


def are_of_runs(metadata: dict[str, Any]) -> bool:
    """Tell whether metadata are those of a run or of a batch."""
    return any(name in metadata for name in OF_RUNS)


def metadata_of(schema: pa.Schema) -> dict[str, Any]:
    """Return the metadata of a table: texts; of a dataframe that pandas saved with its `attrs`, those, parsed."""
    texts = {
        key.decode("utf-8", "replace"): value.decode("utf-8", "replace")
        for key, value in (schema.metadata or {}).items()
    }
    if are_of_runs(texts):
        return texts
    return next((attrs for attrs in saved_attrs(texts) if are_of_runs(attrs)), texts)


def parse_configuration(text: Any) -> dict[str, Any]:
    """Parse the configuration stored in a data file: YAML, JSON or a Python literal; or a map already, as in `attrs`.

    Returns:
        The configuration; empty if the text is not a map in any of the three.
    """
    if isinstance(text, dict):
        return text
    for parse in (parse_yaml, json.loads, ast.literal_eval):
        try:
            value = parse(text)
            plain(value)  # unless it refers to itself
        except (*WRONG_VALUES, SyntaxError, MemoryError):
            continue
        if isinstance(value, dict):
            return value
    return {}


def parse_facts(stored: Any) -> Any:
    """Parse the metadata `objects`: JSON; or a map already, as in `attrs`. What is neither stays as it is stored."""
    try:
        return json.loads(stored) if isinstance(stored, str) else stored
    except (ValueError, RecursionError):
        return stored


def saved_attrs(texts: dict[str, str]) -> list[dict[str, Any]]:
    """Return the `attrs` that pandas and pyarrow wrote into the metadata of a table, in JSON."""
    found = []
    for name, key in (("pandas", "attributes"), ("PANDAS_ATTRS", None)):
        try:
            saved = json.loads(texts.get(name, ""))
        except (ValueError, RecursionError):
            continue
        attrs = saved.get(key) if key and isinstance(saved, dict) else saved
        if isinstance(attrs, dict):
            found.append(attrs)
    return found


class SharedMap(dict[str, Any]):
    """A dictionary whose deep copy is itself."""

    def __deepcopy__(self, memo: dict[int, Any]) -> SharedMap:
        return self


class SharedList(list[Any]):
    """A list whose deep copy is itself."""

    def __deepcopy__(self, memo: dict[int, Any]) -> SharedList:
        return self


def shared(value: Any) -> Any:
    """Return a map or a list that deep copies share; any other value as it is."""
    if isinstance(value, dict):
        return SharedMap(value)
    return SharedList(value) if isinstance(value, list) else value


# YAML writes them as what they are. Not all builds of PyYAML have those in C.
for name in ("SafeDumper", "Dumper", "CSafeDumper", "CDumper"):
    if dumper := getattr(yaml, name, None):
        dumper.add_representer(SharedMap, dumper.represent_dict)
        dumper.add_representer(SharedList, dumper.represent_list)
