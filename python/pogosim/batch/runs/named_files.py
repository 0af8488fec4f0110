"""The files that a configuration names, and those that they name in turn."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pogosim.yaml_1_2 import WRONG_VALUES, parse_yaml

LONGEST_NAME = 1023


@dataclass(frozen=True)
class NamedFile:
    """A file that is there.

    Attributes:
        path: Where it is.
        what: What it is to the run: "arena_file of conf.yaml".
        key: The last part of its key in the configuration; "": it is not named there.
    """

    path: Path
    what: str
    key: str = ""


def texts_at(node: Any, key: str = "") -> Iterator[tuple[str, str]]:
    """Yield all strings in a configuration, each after its dotted key."""
    if isinstance(node, dict):
        for name, value in node.items():
            yield from texts_at(value, f"{key}.{name}" if key else str(name))
    elif isinstance(node, list):
        for place, value in enumerate(node):
            yield from texts_at(value, f"{key}.{place}" if key else str(place))
    elif isinstance(node, str):
        yield key, node


def may_be_a_name(text: str) -> bool:
    """Tell whether a string in a configuration can be the name of a file."""
    return 0 < len(text) <= LONGEST_NAME and "\0" not in text


def entries_in(path: Path) -> Any:
    """Return what a file in YAML holds, such as a robot model; None: it is no such file."""
    return any_entries_in(path) if path.suffix in (".yaml", ".yml") else None


def any_entries_in(path: Path) -> Any:
    """Return what a file holds whose name may end otherwise; None: it is no YAML."""
    try:
        return parse_yaml(path.read_text())
    except (OSError, *WRONG_VALUES):
        return None


def named_files(node: Any, folders: Sequence[Path], of: str, seen: set[Path] | None = None) -> Iterator[NamedFile]:
    """Yield the files that a configuration names, and those that files in YAML among them name; each once.

    Args:
        node: The configuration, or a part of it.
        folders: Where relative names are searched; a name may be found in several.
        of: What the configuration is called.
        seen: Those that were yielded before, to which these are added; None: none.
    """
    seen = set() if seen is None else seen
    for key, text in texts_at(node):
        for path in (folder / text for folder in folders if may_be_a_name(text)):
            if path in seen or not os.path.isfile(path):  # noqa: PTH113 -- Path.is_file raises for long names
                continue
            seen.add(path)
            yield NamedFile(path, f"{key} of {of}", key.rpartition(".")[2])
            yield from named_files(entries_in(path), (*folders, path.parent), str(path), seen)
