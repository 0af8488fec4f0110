"""Metadata of dataframes that copies share.

pandas makes a deep copy of all `attrs` with every selection, df["x"] too, which takes longer than most selections.
"""

from __future__ import annotations

from typing import Any

import yaml


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
