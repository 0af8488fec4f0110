"""Lines of comma-separated values, read by the rules of a run (src/geometry/csv_text.hpp)."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from pogosim.errors import CalibrationError

LINE_END = re.compile(r"\r\n|\r|\n")
QUOTED = re.compile(r'"[^"]*"(?:"[^"]*")*')
NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
COMMENT = "#"
DELIMITERS = ",;\t"


class CsvLine(NamedTuple):
    """A line that is neither blank nor a comment.

    Attributes:
        number: Its number in the file, from 1 on.
        fields: Its texts, without blanks and quotes around them.
    """

    number: int
    fields: list[str]


def read_lines(path: Path) -> list[CsvLine]:
    """Return the lines of a file; bytes that are not UTF-8 are there as escape sequences.

    Raises:
        CalibrationError: Quotes are not closed.
        OSError: It cannot be read.
    """
    text = path.read_bytes().decode("utf-8-sig", errors="backslashreplace")
    return list(lines_in(text, delimiter_of(text), path))


def delimiter_of(text: str) -> str:
    """Return what separates fields: the most frequent of comma, semicolon and tab in the first line with data."""
    lines = (line.strip() for line in LINE_END.split(text))
    first = next((line for line in lines if line and not line.startswith(COMMENT)), "")
    return max(DELIMITERS, key=first.count)


def lines_in(text: str, delimiter: str, path: Path) -> Iterator[CsvLine]:
    """Yield the lines of a text; a field in double quotes may have line ends.

    Raises:
        CalibrationError: Quotes are not closed.
    """
    blanks = " \v\f" if delimiter == "\t" else " \t\v\f"
    start_of_field = re.compile(f"[{blanks}]*")
    end_of_field = re.compile(rf"{delimiter}|\r\n|\r|\n|\Z")
    number, at = 1, 0
    while at < len(text):
        begun, first = at, start_of_field.match(text, at)
        fields = []
        if first and text.startswith(COMMENT, first.end()):
            end = LINE_END.search(text, at)
            at = end.end() if end else len(text)
        else:
            found = delimiter
            while found == delimiter:
                start = start_of_field.match(text, at).end()  # type: ignore[union-attr]
                quoted = QUOTED.match(text, start)
                if text.startswith('"', start) and (quoted is None or text.startswith('"', quoted.end())):
                    raise CalibrationError(
                        f"{path}:{number}: a text in double quotes begins on this line and does not end"
                    )
                end = end_of_field.search(text, quoted.end() if quoted else at)
                assert end is not None  # at the end of the text
                fields.append(without_quotes(text[at : end.start()].strip(blanks)))
                found, at = end[0], end.end()
        if any(fields) or len(fields) > 1:
            yield CsvLine(number, fields)
        number += len(LINE_END.findall(text, begun, at))


def without_quotes(field: str) -> str:
    """Return what stands between the quotes around a field, if it has them; two of them stand for one there."""
    if len(field) < 2 or not (field[0] == field[-1] == '"'):
        return field
    return field[1:-1].strip(" \t\v\f").replace('""', '"')


def number_in(field: str) -> float:
    """Return the finite decimal number that a field is, or not a number."""
    value = float(field) if NUMBER.fullmatch(field) else math.nan
    return value if math.isfinite(value) else math.nan
