"""Entries of nested maps and lists by their dotted path, as in `--set objects.robots.nb=50`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

Path = str | Sequence[str]


def steps_of(path: Path) -> list[str]:
    """Return the keys of a path: "objects.robots.nb" has three."""
    return path.split(".") if isinstance(path, str) else [str(step) for step in path]


def child(node: Any, step: str) -> Any:
    """Return the entry of a map, or the element of a list at a number (0-based).

    Raises:
        KeyError: There is none.
    """
    if isinstance(node, dict):
        if step in node:
            return node[step]
        return next(value for key, value in node.items() if str(key) == step) if step in map(str, node) else fail(step)
    if isinstance(node, list) and step.isdecimal() and int(step) < len(node):
        return node[int(step)]
    return fail(step)


def fail(step: str) -> Any:
    """Raise KeyError."""
    raise KeyError(step)


def get_by_dotted_path(tree: Any, path: Path) -> Any:
    """Return the entry at a dotted path.

    Raises:
        KeyError: There is none.
    """
    for step in steps_of(path):
        tree = child(tree, step)
    return tree


def set_in_dict(tree: dict[str, Any], path: Path, value: Any) -> None:
    """Set the entry at a dotted path; maps that are missing on the way are made.

    Raises:
        KeyError: Something on the way is neither a map nor a list with that element.
    """
    *parents, last = steps_of(path)
    node: Any = tree
    for step in parents:
        if isinstance(node, dict) and step not in node:
            node[step] = {}
        node = child(node, step)
    if isinstance(node, dict):
        node[last] = value
    elif isinstance(node, list) and last.isdecimal() and int(last) < len(node):
        node[int(last)] = value
    else:
        raise KeyError(last)
