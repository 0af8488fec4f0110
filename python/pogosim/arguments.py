"""Checks of the arguments of the package's functions: returns plain values, or raises a one-line error."""

from __future__ import annotations

import itertools
import math
import numbers
import operator
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any

DEEPEST = 200  # of maps and lists in each other
MOST_VALUES = 1_000_000  # in all maps and lists of an argument
MOST_BITS = 1024  # of an integer: no larger one is a floating-point number
SHOWN_CHARACTERS = 60


def shown(value: Any) -> str:
    """Return a value as errors show it, in a line."""
    if isinstance(value, str) and len(value) > SHOWN_CHARACTERS:
        begin = str.__str__(value)[: SHOWN_CHARACTERS // 2]
        return f"{begin!r}... ({len(value)} characters)"
    try:
        text = repr(value)
    except Exception:  # of a class of the caller
        text = ""
    is_short = 0 < len(text) <= SHOWN_CHARACTERS and text.isprintable()
    return text if is_short else f"a value of type {type(value).__name__}"


def without_numpy(value: Any) -> Any:
    """Return a scalar or array of NumPy, pandas or PyTorch as numbers and lists of Python; other values as they are.

    Arrays with too many elements, which may be more than memory has, stay as they are.
    """
    as_python = getattr(value, "tolist", None)
    return as_python() if callable(as_python) and not isinstance(value, type) and not is_too_large(value) else value


def is_too_large(value: Any) -> bool:
    """Tell whether a value is an array with too many elements."""
    size = getattr(value, "size", None)
    return isinstance(size, int) and size > MOST_VALUES


def is_text(value: Any) -> bool:
    """Tell whether a value is text that a C string can hold."""
    if not isinstance(value, str) or "\0" in value:
        return False
    try:
        value.encode()
    except UnicodeEncodeError:
        return False
    return True


def is_file_name(text: str) -> bool:
    """Tell whether text can be the name of a file."""
    try:
        os.fsencode(text)
    except UnicodeEncodeError:
        return False
    return True


def number(value: Any, default: float) -> float:
    """Return a configuration's value as a finite number; `default` if it is none."""
    try:
        found = float(value)
    except (TypeError, ValueError, OverflowError):
        return default
    return found if math.isfinite(found) else default


@dataclass(frozen=True)
class Arguments:
    """Checks of arguments. A value of another kind raises `error`, with the name of the argument.

    Attributes:
        error: Type of the exceptions.
    """

    error: type[Exception] = ValueError

    def refused(self, name: str, expected: str, value: Any) -> Exception:
        """Return the exception for a wrong value."""
        return self.error(f"{name}: expected {expected}, found {shown(value)}")

    def integer(self, name: str, value: Any, least: int | None = None, most: int | None = None) -> int:
        """Return an integer; True and 3.0 are refused."""
        found = without_numpy(value)
        expected = "an integer"
        if most is not None:
            expected += f" from {least} to {most}"
        elif least is not None:
            expected += f" of at least {least}"
        try:
            number = operator.index(found)
        except TypeError:
            raise self.refused(name, expected, value) from None
        is_outside = (least is not None and number < least) or (most is not None and number > most)
        if isinstance(found, bool) or is_outside:
            raise self.refused(name, expected, found)
        return number

    def number(self, name: str, value: Any, expected: str = "a number") -> float:
        """Return a number, which may be infinite or NaN."""
        found = without_numpy(value)
        if isinstance(found, bool) or not isinstance(found, numbers.Real):
            raise self.refused(name, expected, value)
        try:
            return float(found)
        except OverflowError:
            raise self.refused(name, expected, value) from None

    def finite(self, name: str, value: Any) -> float:
        """Return a finite number."""
        number = self.number(name, value, "a finite number")
        if not math.isfinite(number):
            raise self.refused(name, "a finite number", number)
        return number

    def numbers(self, name: str, values: Any, count: int) -> list[float]:
        """Return a list of `count` numbers."""
        found = without_numpy(values)
        if not isinstance(found, (list, tuple)) or len(found) != count:
            raise self.refused(name, f"{count} numbers", values)
        return [self.number(name, item) for item in found]

    def boolean(self, name: str, value: Any) -> bool:
        """Return True or False; other truth values are refused."""
        found = without_numpy(value)
        if not isinstance(found, bool):
            raise self.refused(name, "True or False", value)
        return found

    def text(self, name: str, value: Any) -> str:
        """Return text without NUL characters."""
        found = without_numpy(value)
        if not is_text(found):
            raise self.refused(name, "text", value)
        return str.__str__(found)

    def path(self, name: str, value: Any) -> Path:
        """Return the path of a file or folder."""
        found = os.fspath(value) if isinstance(value, os.PathLike) else value
        if not isinstance(found, str) or not found or "\0" in found or not is_file_name(found):
            raise self.refused(name, "the path of a file (str or pathlib.Path)", value)
        return Path(found)

    def value(self, name: str, value: Any, depth: int = 0, count: Iterator[int] | None = None) -> Any:
        """Return a value for YAML: text, numbers, True, False, None, and lists and maps of them.

        Enums are their values; paths, text; tuples, ranges and arrays, lists.
        """
        count = itertools.count() if count is None else count
        if next(count) > MOST_VALUES or is_too_large(value):
            raise self.error(f"{name.partition('[')[0]}: expected {MOST_VALUES} values at most, found more")
        if depth > DEEPEST:
            raise self.error(f"{name.partition('[')[0]}: maps and lists are nested too deeply, or contain themselves")
        found = without_numpy(value.value if isinstance(value, Enum) else value)
        if isinstance(found, Path):
            found = str(found)
        if found is None or isinstance(found, bool):
            return found
        if is_text(found):
            return str.__str__(found)
        if isinstance(found, int):
            if found.bit_length() > MOST_BITS:
                raise self.error(f"{name}: expected a number of at most {MOST_BITS} bits, found an integer of more")
            return int(found)
        if isinstance(found, float):
            return float(found)
        if isinstance(found, (list, tuple, range)):
            return [self.value(f"{name}[{index}]", item, depth + 1, count) for index, item in enumerate(found)]
        if isinstance(found, Mapping):
            return {
                self.value(f"a key of {name}", key, depth + 1, count): self.value(
                    f"{name}.{key}", item, depth + 1, count
                )
                for key, item in found.items()
            }
        raise self.refused(name, "text, a number, True, False, None, a list or a map", value)
