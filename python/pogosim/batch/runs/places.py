"""Where a value of the configuration of a run, which a tool writes, stands in the file that the user wrote."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

import yaml

from pogosim.batch.configurations.combinations import variants_of
from pogosim.batch.configurations.configuration import BatchLoader, Configuration, line_of
from pogosim.batch.configurations.option_words import CHOICES, DOMAIN, HIERARCHICAL_OPTIONS, LIST, identities
from pogosim.batch.configurations.paths import get_by_dotted_path
from pogosim.batch.runs.run import Task
from pogosim.batch.runs.run_files import is_nested
from pogosim.batch.runs.run_log import OWN

Path = tuple[str, ...]

PLACE = re.compile(re.escape(OWN) + r"(?::(\d+))?")


def in_the_users_file(text: str, task: Task, entries: dict[str, Any], configuration: Configuration) -> str:
    """Return messages of a run with places in the file of the user, in place of those in its own configuration.

    Args:
        text: Messages of `pogosim.batch.runs.run.Outcome`.
        task: The run.
        entries: The configuration of its combination.
        configuration: The file with the options.
    """

    def place(found: re.Match[str]) -> str:
        line = line_in(configuration, path_at(task, int(found[1])), entries) if found[1] else 0
        return f"{configuration.path}:{line}" if line else str(configuration.path)

    return PLACE.sub(place, text)


def path_at(task: Task, line: int) -> Path:
    """Return the path of what stands at a line of the configuration of a run."""
    beyond = line - task.text.count("\n") - 1
    added = [setting for setting, _ in task.outputs if not is_nested(setting)]
    if 0 <= beyond < len(added):
        return (added[beyond],)
    places = [place for place in places_in(yaml.compose(task.text, Loader=BatchLoader), ()) if place[0] <= line]
    return max(places, key=lambda place: (place[0], len(place[1])), default=(0, ()))[1]


def places_in(node: yaml.Node | None, path: Path) -> Iterator[tuple[int, Path]]:
    """Yield the lines of all values below a node, each with its path."""
    for step, key, value in children_of(node):
        yield line_of(key), (*path, step)
        yield from places_in(value, (*path, step))


def children_of(node: yaml.Node | None) -> Iterator[tuple[str, yaml.Node, yaml.Node]]:
    """Yield the entries of a map or a list: name or number, the node that says where it is, and its value."""
    if isinstance(node, yaml.MappingNode):
        yield from ((str(key.value), key, value) for key, value in node.value)
    elif isinstance(node, yaml.SequenceNode):
        yield from ((str(number), item, item) for number, item in enumerate(node.value))


def line_in(configuration: Configuration, path: Path, entries: dict[str, Any]) -> int:
    """Return the line where a combination has an entry from; 0 if the file does not have it.

    Each item of a list of options has its own line.
    """
    place = written_path(configuration.entries, path, (), entries)
    return 0 if place is None else configuration.line_at(place)


def written_path(node: Any, path: Path, above: Path, entries: dict[str, Any]) -> Path | None:
    """Return the path in the file, below a node, of an entry of a combination; None if it is not there.

    Args:
        node: What the file has there.
        path: Path of the entry, below this node.
        above: Path of this node.
        entries: The combination.
    """
    if isinstance(node, dict) and HIERARCHICAL_OPTIONS in node:
        chosen = entries.get(CHOICES, {}).get(".".join(above), "default")
        inner = node[HIERARCHICAL_OPTIONS].get(chosen)
        found = written_path(inner, path, above, entries) if path else None
        if found is not None:
            return (HIERARCHICAL_OPTIONS, chosen, *found)
    if isinstance(node, dict) and isinstance(node.get(LIST), list):
        number = chosen_number(node[LIST], get_by_dotted_path(entries, above))
        inner = None if number is None else written_path(node[LIST][number], path, above, entries)
        return () if inner is None else (LIST, str(number), *inner)
    if not path:
        return ()
    if isinstance(node, dict) and path[0] not in node:
        return () if DOMAIN in node else None
    try:
        found = written_path(get_by_dotted_path(node, path[:1]), path[1:], (*above, path[0]), entries)
    except KeyError:
        return None
    return None if found is None else (path[0], *found)


def chosen_number(options: Sequence[Any], value: Any) -> int | None:
    """Return the index of the option that gives this value, also if it contains options itself."""
    known = identities(value)[0]
    for number, option in enumerate(options):
        if any(identities(one)[0] == known for one, _, _ in variants_of(option, ())):
            return number
    return None
