"""Reading a configuration with options, as the simulator reads it."""

from __future__ import annotations

import contextlib
import logging
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import yaml

from pogosim.batch.configurations.combinations import KNOWN, combinations_of, resolved, variants_of
from pogosim.batch.configurations.names import NamesError
from pogosim.batch.configurations.option_words import HIERARCHICAL_OPTIONS, CombinationsError
from pogosim.batch.configurations.tool_maps import without_tool_maps
from pogosim.batch.errors import BatchError, cannot, one_line
from pogosim.yaml_1_2 import (
    BOOLEAN,
    FLOAT,
    INTEGER,
    WRONG_VALUES,
    ConfigurationDumper,
    ConfigurationLoader,
    StructureError,
    as_written,
    boolean_as_written,
    dump_yaml,
    problem_of,
)

# As in the simulator: few aliases of aliases can stand for more values than memory holds.
MAX_VALUES = 1_000_000

log = logging.getLogger("pogobatch")


class BatchLoader(ConfigurationLoader):
    """Only true and false are booleans: yes, no, on and off reach the program as they are written."""

    yaml_implicit_resolvers = {  # noqa: RUF012
        first: [(tag, pattern) for tag, pattern in resolvers if tag != "tag:yaml.org,2002:bool"]
        for first, resolvers in ConfigurationLoader.yaml_implicit_resolvers.items()
    }


BatchLoader.add_constructor(INTEGER, as_written)
BatchLoader.add_constructor(FLOAT, as_written)
BatchLoader.add_constructor(BOOLEAN, boolean_as_written)
BatchLoader.add_implicit_resolver(
    "tag:yaml.org,2002:bool", re.compile(r"(true|True|TRUE|false|False|FALSE)$"), list("tTfF")
)


class BatchDumper(ConfigurationDumper):
    """Writes words such as "on" as BatchLoader reads them, without quotation marks."""

    yaml_implicit_resolvers = {  # noqa: RUF012
        first: list(resolvers) for first, resolvers in BatchLoader.yaml_implicit_resolvers.items()
    }


def dump_configuration(entries: dict[str, Any]) -> str:
    """Write a configuration for the simulator."""
    return dump_yaml(entries, dumper=BatchDumper)


class Configuration:
    """A configuration file: its text, its entries, and the lines they stand on.

    Attributes:
        entries: What it says, without the maps that are for batch tools alone.
        seeds: Seeds that it asks for; None: it says nothing.
    """

    def __init__(self, path: str | Path) -> None:
        """Read a file.

        Raises:
            BatchError: It cannot be read, or is no YAML map.
        """
        self.path = Path(path)
        self.values = 0
        if self.path.exists() and not (self.path.is_file() or self.path.is_dir()):
            raise BatchError(f"{path} is not a configuration: it is not a file")
        try:
            self.text = self.path.read_bytes().decode()
        except OSError as error:
            raise cannot("read the configuration", path, error) from None
        except UnicodeDecodeError:
            raise BatchError(f"{path} is not a configuration: it is not text in UTF-8") from None
        loader: BatchLoader | None = None
        try:
            loader = BatchLoader(self.text)
            self.root = loader.get_node() if loader.check_node() else None
            self.warn_of_another_document(loader)
            if isinstance(self.root, yaml.MappingNode):
                self.take_repeated_keys(self.root, ())
                self.entries: dict[str, Any] = loader.construct_document(self.root)
        except StructureError as error:
            raise BatchError(f"{path}:{problem_of(error).removeprefix('line ')}") from None
        except yaml.MarkedYAMLError as error:
            line = error.problem_mark.line + 1 if error.problem_mark else 1
            raise BatchError(f"{path}:{line}: not valid YAML: {one_line(error.problem)}") from None
        except WRONG_VALUES as error:
            raise BatchError(f"{path} is not valid YAML: {problem_of(error)}") from None
        finally:
            if loader is not None:
                loader.dispose()
        if self.root is None:
            raise BatchError(f"{path} is empty; a configuration needs at least arena_file and objects")
        if not isinstance(self.root, yaml.MappingNode):
            raise BatchError(f"{path} is not a configuration: expected a map of keys and values")
        self.moved: dict[str, tuple[str, ...]] = {}
        self.take_tool_maps()

    def take_tool_maps(self) -> None:
        """Take out what is for batch tools alone.

        Raises:
            BatchError: It is wrong.
        """
        with self.placing_errors():
            maps = without_tool_maps(self.entries, lambda at, text: log.warning("%s: %s", self.where(at), text))
        self.entries, self.moved, self.seeds = maps.entries, maps.moved, maps.seeds

    def warn_of_another_document(self, loader: BatchLoader) -> None:
        """Say that a second document of the file is not used, as the simulator does."""
        if loader.check_node():
            event: Any = loader.peek_event()  # type: ignore[no-untyped-call]
            line = event.start_mark.line + 1
            loader.get_node()  # it must be valid, though
            log.warning("%s:%d: a second document starts here; only the first one is used", self.path, line)

    def take_repeated_keys(self, node: yaml.Node, path: tuple[str, ...]) -> None:
        """Make a list of categories with the same name; of other keys that are repeated, the last one counts."""
        self.values += 1
        if self.values > MAX_VALUES:
            raise BatchError(f"{self.path}: its aliases stand for more than {MAX_VALUES} values; use fewer of them")
        if isinstance(node, yaml.SequenceNode):
            for number, item in enumerate(node.value):
                self.take_repeated_keys(item, (*path, str(number)))
        if not isinstance(node, yaml.MappingNode):
            return
        entries: dict[str, tuple[yaml.Node, yaml.Node]] = {}
        merged = [pair for pair in node.value if pair[0].tag == "tag:yaml.org,2002:merge"]
        for key, value in node.value:
            name = str(key.value)
            if key.tag == "tag:yaml.org,2002:merge":
                continue
            if name in entries and is_in_objects(path) and not name.startswith("batch_"):
                entries[name] = (key, joined(entries[name][1], value))
            else:
                if name in entries:
                    log.warning("%s:%d: duplicate key '%s'; the last one is used", self.path, line_of(key), name)
                entries[name] = (key, value)
        node.value = [*merged, *entries.values()]
        for name, (_, value) in entries.items():
            self.take_repeated_keys(value, (*path, name))

    def resolved(self) -> dict[str, Any]:
        """Return the configuration of a single run.

        Raises:
            BatchError: Options have no default, or are wrong.
        """
        with self.placing_errors():
            return resolved(self.entries)

    def of_one_run(self) -> dict[str, Any]:
        """Return what a single run takes of each option; None where an option has no default.

        Raises:
            BatchError: Options have other keys.
        """
        with self.placing_errors():
            ((entries, _, _),) = variants_of(self.entries, (), KNOWN)
            return dict(entries)

    def combinations(self) -> list[dict[str, Any]]:
        """Return the configuration of every combination of options, see `combinations_of`.

        Raises:
            BatchError: Options are wrong, or too many.
        """
        with self.placing_errors():
            return combinations_of(self.entries)

    @contextlib.contextmanager
    def placing_errors(self) -> Iterator[None]:
        """Raise BatchError, with the place in the file, for what a block finds wrong with options or names."""
        try:
            yield
        except CombinationsError as error:
            raise BatchError(f"{self.where(error.path, error.key)}: {error.args[0]}") from None
        except NamesError as error:
            raise BatchError(f"{self.where((error.key,))}{str(error).removeprefix(error.key)}") from None

    def where(self, path: Sequence[str], key: str = "") -> str:
        """Return where an entry stands: "conf/a.yaml:12: objects.robots.nb"; of all, the name of the file.

        Args:
            path: Path of the entry.
            key: A key in it, whose line is given; empty: the line of the entry.
        """
        path = self.written_at(path)
        line = self.line_at([*path, key] if key else path)
        return f"{self.path}{f':{line}' if line else ''}{': ' if path else ''}{'.'.join(path)}"

    def written_at(self, path: Sequence[str]) -> Sequence[str]:
        """Return the path in the file of an entry."""
        return [*self.moved[path[0]], *path[1:]] if path and path[0] in self.moved else path

    def line_at(self, path: Sequence[str]) -> int:
        """Return the line of an entry, or of the last that there is on the way to it; 0 of the whole file."""
        node, line = self.root, 0
        for step in self.written_at(path):
            if isinstance(node, yaml.MappingNode):
                pair = next(((key, value) for key, value in node.value if str(key.value) == step), None)
                if pair is None:
                    break
                line, node = line_of(pair[0]), pair[1]
            elif isinstance(node, yaml.SequenceNode) and step.isdecimal() and int(step) < len(node.value):
                node = node.value[int(step)]
                line = line_of(node)
            else:
                break
        return line or (1 if path else 0)


def line_of(node: yaml.Node) -> int:
    """Return the line of a node, from 1 on."""
    return int(node.start_mark.line) + 1


def joined(first: yaml.Node, second: yaml.Node) -> yaml.SequenceNode:
    """Return a list of both: the entries of lists, and anything else as an entry."""
    items = [item for node in (first, second) for item in (node.value if is_list(node) else [node])]
    return yaml.SequenceNode("tag:yaml.org,2002:seq", items, first.start_mark, second.end_mark)


def is_list(node: yaml.Node) -> bool:
    """Tell whether a node is a list."""
    return isinstance(node, yaml.SequenceNode)


def is_in_objects(path: Sequence[str]) -> bool:
    """Tell whether the entries at a path are categories: those of `objects`, or of its alternatives."""
    kept: list[str] = []
    steps = iter(path)
    for step in steps:
        if step == HIERARCHICAL_OPTIONS:
            next(steps, None)  # the name of the alternative
        else:
            kept.append(step)
    return kept == ["objects"]
