"""What distinguishes combinations in the results: names of files and constant columns."""

from __future__ import annotations

import os
import re
import string
from collections.abc import Container, Mapping, Sequence
from pathlib import Path, PurePath
from typing import Any

from pogosim.arguments import is_text
from pogosim.batch.configurations.option_words import CHOICES, shown
from pogosim.batch.configurations.paths import get_by_dotted_path
from pogosim.table_formats import EXPECTED, format_of
from pogosim.yaml_1_2 import dump_yaml, plain

FORMAT = "result_filename_format"
COLUMNS = "result_new_columns"
DEFAULT_FORMAT = "result.feather"
FILE_SUFFIXES = {".csv", ".feather", ".parquet", ".json", ".png", ".svg", ".txt", ".yaml", ".yml"}


WIDE = re.compile(r"\d{4}")  # of a field: {objects.robots.nb:1000d}


class NamesError(ValueError):
    """A format or a list of columns is wrong; says what was expected.

    Attributes:
        key: The key of the configuration that is wrong.
    """

    def __init__(self, key: str, message: str) -> None:
        super().__init__(f"{key}: {message}")
        self.key = key


def without_folder(value: Any) -> Any:
    """Return the stem of a path, "disk" of "arenas/disk.csv"; any other value, as "m/s", as it is."""
    if not isinstance(value, str):
        return value
    path = PurePath(value)
    is_path = path.suffix.lower() in FILE_SUFFIXES or value.startswith(("/", "./", "../"))
    return path.stem if is_path and path.stem else value


def value_at(entries: dict[str, Any], path: str, is_whole: bool = False) -> Any:
    """Return what stands for a key in results: the name of the chosen alternative, the stem of a path, or the value.

    Args:
        entries: The configuration of a combination.
        path: The key.
        is_whole: A path is not reduced to its stem.

    Raises:
        KeyError: There is no such key.
    """
    choices = entries.get(CHOICES)
    if isinstance(choices, dict) and path in choices:
        return choices[path]
    value = plain(get_by_dotted_path(entries, path))
    return value if is_whole else without_folder(value)


class DottedFormatter(string.Formatter):
    """Formats with dotted paths as fields: "result_{objects.robots.nb:03d}.feather"."""

    def get_field(self, field_name: str, args: Sequence[Any], kwargs: Mapping[str, Any]) -> Any:  # noqa: ARG002
        """Return the value of a field."""
        if not field_name or field_name.isdecimal():
            raise NamesError(FORMAT, "a field without a name; write a key in it, such as {objects.robots.nb}")
        try:
            value = value_at(dict(kwargs), field_name)
        except KeyError:
            raise NamesError(
                FORMAT,
                f"there is no key '{field_name}' in the configuration; expected the dotted path of a key, "
                "such as {objects.robots.nb}",
            ) from None
        if isinstance(value, str) and field_name not in kwargs.get(CHOICES, {}):
            value = value.replace("/", "_")  # "m/s" makes no folder
        if isinstance(value, (dict, list)):
            raise NamesError(FORMAT, f"'{field_name}' is not a single value but {shown(value)}; choose a key below it")
        return value, field_name


def file_name(entries: dict[str, Any]) -> str:
    """Return the name of the file with the results of a combination.

    Raises:
        NamesError: `result_filename_format` is wrong.
    """
    pattern = entries.get(FORMAT, DEFAULT_FORMAT)
    if not isinstance(pattern, str) or not pattern:
        raise NamesError(
            FORMAT, f"expected a name such as result_{{objects.robots.nb}}.feather, found {shown(pattern)}"
        )
    if WIDE.search(pattern):
        raise NamesError(FORMAT, f"'{shown(pattern)}' makes a name too long for a file")
    try:
        name = DottedFormatter().vformat(pattern, (), entries)
    except NamesError:
        raise
    except (ValueError, TypeError, AttributeError, KeyError, IndexError) as error:
        raise NamesError(FORMAT, f"'{pattern}' is not a format of Python: {error}") from None
    if not name or name.endswith("/") or "\0" in name:
        raise NamesError(FORMAT, f"'{pattern}' gives no name of a file")
    if not is_text(name):
        raise NamesError(FORMAT, f"'{pattern}' gives a name that is no text in UTF-8")
    if format_of(name) is None:
        raise NamesError(FORMAT, f"the format of {shown(name)} is unknown; expected {EXPECTED}")
    if leads_out(name):
        raise NamesError(
            FORMAT, f"{shown(name)} is not in the folder of the results; name a file in it, and the folder with -o"
        )
    return name


def leads_out(name: str) -> bool:
    """Tell whether a path leads out of the folder that it is relative to, as it is written."""
    return os.path.isabs(name) or os.path.normpath(name).split("/")[0] == ".."  # noqa: PTH117


def is_linked_out(path: str, folder: str) -> bool:
    """Tell whether a path in a folder leads out of it by symbolic links."""
    real = Path(folder).resolve()
    return not Path(path).resolve().is_relative_to(real)


def ambiguous(combinations: Sequence[dict[str, Any]]) -> frozenset[str]:
    """Return the keys among the new columns whose paths have the same stem in some combinations without being the same.

    Raises:
        NamesError: `result_new_columns` is wrong.
    """
    found = set()
    paths: dict[tuple[str, str], str] = {}  # by key and stem
    for entries in combinations:
        for name, stem in new_columns(entries).items():
            whole = cell(entries, name, is_whole=True)
            if isinstance(whole, str) and paths.setdefault((name, stem), whole) != whole:
                found.add(name)
    return frozenset(found)


def new_columns(entries: dict[str, Any], whole: Container[str] = ()) -> dict[str, Any]:
    """Return the constant columns of a combination: names (dotted paths), and values (None: it has no such key).

    Args:
        entries: The configuration of a combination.
        whole: Keys whose paths are not reduced to their stems.

    Raises:
        NamesError: `result_new_columns` is wrong.
    """
    names = entries.get(COLUMNS)
    if names is None:
        return {}
    if isinstance(names, str):
        names = [names]
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise NamesError(COLUMNS, f"expected a list of keys, such as [arena_file], found {shown(names)}")
    return {name: cell(entries, name, name in whole) for name in names}


def cell(entries: dict[str, Any], path: str, is_whole: bool = False) -> Any:
    """Return what a column has for a key: a single value, lists and maps as YAML, or None if there is no such key."""
    try:
        value = value_at(entries, path, is_whole)
    except KeyError:
        return None
    return dump_yaml(value, is_flow=True).strip() if isinstance(value, (dict, list)) else plain(value)


def has_key(entries: dict[str, Any], path: str) -> bool:
    """Tell whether a combination has a key, or an alternative chosen there."""
    try:
        value_at(entries, path)
    except KeyError:
        return False
    return True
