"""YAML with the values of YAML 1.2, as the simulator reads and writes it."""

from __future__ import annotations

import re
from typing import Any

import yaml
from yaml.composer import Composer
from yaml.constructor import SafeConstructor
from yaml.resolver import Resolver

INTEGER = "tag:yaml.org,2002:int"
FLOAT = "tag:yaml.org,2002:float"
BOOLEAN = "tag:yaml.org,2002:bool"

# Tags that PyYAML (YAML 1.1) resolves and the simulator does not.
ONLY_IN_YAML_1_1 = (INTEGER, FLOAT, "tag:yaml.org,2002:timestamp", "tag:yaml.org,2002:value")


MAX_DEPTH = 100  # as in the simulator
TOO_DEEP = f"nested deeper than {MAX_DEPTH} levels once aliases are followed"


class StructureError(yaml.MarkedYAMLError):
    """Valid YAML that is no configuration: nested without end, or by an alias within itself."""


class BoundedComposer(Composer):
    """Composes nodes up to a depth; PyYAML knows no bound but that of Python's calls."""

    around: tuple[str | None, ...] = ()  # anchors of the values in which the next one is, None: it has none

    def compose_node(self, parent: yaml.Node | None, index: Any) -> yaml.Node | None:
        """Compose a node, at any place.

        Raises:
            StructureError: It is nested too deeply, or in itself.
        """
        event: Any = self.peek_event()  # type: ignore[attr-defined]
        mark: Any = event.start_mark
        if isinstance(event, yaml.AliasEvent) and event.anchor in self.around:
            problem = f"this alias (*{event.anchor}) is inside the value it refers to"
            raise StructureError(problem=problem, problem_mark=mark)
        if len(self.around) > MAX_DEPTH:
            raise StructureError(problem=TOO_DEEP, problem_mark=mark)
        outer, self.around = self.around, (*self.around, event.anchor)
        node: yaml.Node | None = super().compose_node(parent, index)
        self.around = outer
        return node


def problem_of(error: Exception) -> str:
    """Return what is wrong with text that cannot be parsed, in one line."""
    if isinstance(error, yaml.MarkedYAMLError) and error.problem_mark is not None:
        return f"line {error.problem_mark.line + 1}: {' '.join(str(error.problem).split())}"
    return TOO_DEEP if isinstance(error, RecursionError) else " ".join(str(error).split())


class ConfigurationLoader(BoundedComposer, yaml.SafeLoader):
    """YAML with the numbers of YAML 1.2, as the simulator reads them: 2.22e6 and 1e3 are numbers, 010 is ten."""

    # Resolvers that are added to a class are added to a copy of this.
    yaml_implicit_resolvers = {  # noqa: RUF012
        first: [(tag, pattern) for tag, pattern in resolvers if tag not in ONLY_IN_YAML_1_1]
        for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
    }


def construct_integer(loader: yaml.SafeLoader, node: yaml.ScalarNode) -> int:
    """Construct a decimal, hexadecimal (0x1F) or octal (0o17) integer."""
    text = loader.construct_scalar(node).lower()
    bases = {"0x": 16, "0o": 8}
    return int(text, bases.get(text.lstrip("+-")[:2], 10))


ConfigurationLoader.add_implicit_resolver(
    INTEGER, re.compile(r"[-+]?([0-9]+|0[xX][0-9a-fA-F]+|0o[0-7]+)$"), list("-+0123456789")
)
ConfigurationLoader.add_implicit_resolver(
    FLOAT,
    re.compile(
        r"""[-+]?([0-9]+\.[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?$
        |[-+]?[0-9]+[eE][-+]?[0-9]+$
        |[-+]?\.(inf|Inf|INF)$
        |\.(nan|NaN|NAN)$""",
        re.VERBOSE,
    ),
    list("-+.0123456789"),
)
ConfigurationLoader.add_constructor(INTEGER, construct_integer)


def fast_loader() -> type[Any]:
    """Return a loader of the same values that is several times as fast, if PyYAML has libyaml.

    libyaml finds the words, Python puts them together: what PyYAML would put together in C overflows the stack if it is
    nested deeply, as in a damaged file. Its errors have fewer words.
    """
    try:
        from yaml.cyaml import CParser  # type: ignore[attr-defined]
    except ImportError:
        return ConfigurationLoader

    class FastLoader(BoundedComposer, CParser, SafeConstructor, Resolver):
        yaml_implicit_resolvers = ConfigurationLoader.yaml_implicit_resolvers
        yaml_constructors = ConfigurationLoader.yaml_constructors

        def __init__(self, stream: str) -> None:
            CParser.__init__(self, stream)
            SafeConstructor.__init__(self)
            Resolver.__init__(self)
            self.anchors: dict[str, yaml.Node] = {}

    return FastLoader


METADATA_LOADER = fast_loader()

# What PyYAML raises for text that is no YAML, and for values that do not fit their tags (!!bool x, !!timestamp x).
WRONG_VALUES = (yaml.YAMLError, ValueError, RecursionError, KeyError, IndexError, AttributeError, TypeError)


def parse_yaml(text: str) -> Any:
    """Parse YAML, with numbers as the simulator reads them.

    Raises:
        WRONG_VALUES: It cannot be parsed.
    """
    return yaml.load(text, Loader=METADATA_LOADER)


class ConfigurationDumper(getattr(yaml, "CSafeDumper", yaml.SafeDumper)):  # type: ignore[misc]
    """Writes YAML that the simulator and ConfigurationLoader read back as the same values."""

    yaml_implicit_resolvers = {  # noqa: RUF012
        first: list(resolvers) for first, resolvers in ConfigurationLoader.yaml_implicit_resolvers.items()
    }

    def ignore_aliases(self, data: Any) -> bool:  # noqa: ARG002
        """Write repeated values in full."""
        return True


class WrittenInt(int):
    """An integer that knows how it was written: a program may read 0777 as a text."""

    text = ""


class WrittenFloat(float):
    """A number that knows how it was written, as 1.10 was."""

    text = ""


class WrittenBool(str):
    """A boolean that was written in another way than true or false, as TRUE was; Python's own cannot know that."""

    @property
    def text(self) -> str:
        """How it was written."""
        return str(self)


Written = WrittenInt | WrittenFloat | WrittenBool


def plain(value: Any) -> Any:
    """Return a number or a boolean that does not know how it was written; any other value as it is."""
    if isinstance(value, WrittenBool):
        return SafeConstructor.bool_values[value.lower()]
    return int(value) if isinstance(value, WrittenInt) else float(value) if isinstance(value, WrittenFloat) else value


def boolean_as_written(loader: yaml.SafeLoader, node: yaml.ScalarNode) -> bool | WrittenBool:
    """Construct a boolean, which knows how it was written unless that is true or false."""
    value = loader.construct_yaml_bool(node)
    return value if node.value in ("true", "false") else WrittenBool(node.value)


def as_written(loader: yaml.SafeLoader, node: yaml.ScalarNode) -> WrittenInt | WrittenFloat:
    """Construct a number that knows how it was written."""
    is_whole = node.tag == INTEGER
    value = WrittenInt(construct_integer(loader, node)) if is_whole else WrittenFloat(loader.construct_yaml_float(node))
    value.text = str(node.value)
    return value


TAGS = {WrittenInt: INTEGER, WrittenFloat: FLOAT, WrittenBool: BOOLEAN}


def represent_written(dumper: Any, value: Written) -> yaml.ScalarNode:
    """Represent a number or a boolean as it was written."""
    node: yaml.ScalarNode = dumper.represent_scalar(TAGS[type(value)], value.text)
    return node


for written in TAGS:
    ConfigurationDumper.add_representer(written, represent_written)


def dump_yaml(value: Any, is_flow: bool = False, dumper: Any = ConfigurationDumper) -> str:
    """Write a value as YAML, in the order of its keys; a single value on one line, and with `is_flow` any value."""
    text: str = yaml.dump(
        value, Dumper=dumper, sort_keys=False, allow_unicode=True, width=1 << 30, default_flow_style=is_flow
    )
    return text[: -len("...\n")] if text.endswith("\n...\n") else text
