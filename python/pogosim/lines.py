"""Printing of all lines of the tools, with control characters escaped, so that file names cannot control a terminal."""

from __future__ import annotations

import contextlib
import logging
import os
import sys
import unicodedata
from collections.abc import Iterable

LONGEST = 10_000  # characters of a line, more than a path has; the rest is cut


def printable(text: object) -> str:
    """Return a text as one line, with control characters, bidirectional marks and undecodable bytes escaped."""
    line = str(text)
    if len(line) > LONGEST:
        line = f"{line[:LONGEST]}... and {len(line) - LONGEST} more characters"
    if line.isprintable():
        return line
    return "".join(c if c.isprintable() or unicodedata.category(c) == "Zs" else escaped(c) for c in line)


def printable_lines(text: object) -> str:
    """Return a text of one or more lines, with all else escaped; blanks at its end are left out."""
    return "\n".join(map(printable, str(text).rstrip().split("\n")))


def escaped(character: str) -> str:
    """Return a character as Python writes it in a string."""
    return character.encode("unicode_escape").decode("ascii")


def say(*lines: object) -> None:
    """Print lines; what the terminal cannot show is escaped.

    Raises:
        OSError: The standard output cannot be written. Nothing more is written to it, then.
    """
    say_text("\n".join(map(printable, lines)))


def say_text(text: str) -> None:
    """Print a text as it is, however long; what the terminal cannot show is escaped.

    Raises:
        OSError: The standard output cannot be written. Nothing more is written to it, then.
    """
    say_parts([text])


def say_parts(parts: Iterable[str]) -> None:
    """Print a text as say_text() does, part by part as they are made.

    Raises:
        OSError: The standard output cannot be written. Nothing more is written to it, then.
    """
    if sys.stdout is None:
        return
    encoding = sys.stdout.encoding or "utf-8"
    try:
        for part in parts:
            print(part.encode(encoding, "backslashreplace").decode(encoding), end="")
        print(flush=True)
    except OSError:
        # Otherwise, Python would flush again when it exits, and fail again.
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)
        raise


def say_error(*lines: object) -> None:
    """Print lines on standard error, if it can be written."""
    with contextlib.suppress(OSError):
        if sys.stderr is not None:
            print(*map(printable, lines), sep="\n", file=sys.stderr)


class LineFormatter(logging.Formatter):
    """Makes one line of a record of the log."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the line."""
        return printable(super().format(record))


def counted(number: int, what: str) -> str:
    """Return a number of things: "1 job", "2 jobs"."""
    return f"{number} {what}{'s' if number != 1 else ''}"
