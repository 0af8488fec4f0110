"""Errors of a batch, and how they are reported."""

from __future__ import annotations

import contextlib
import errno
import operator
import os
from pathlib import Path
from typing import Any

from pogosim.arguments import Arguments, shown
from pogosim.errors import ToolError
from pogosim.lines import printable, say


class BatchError(ToolError):
    """The batch cannot be done. The message is one line: where, what, what was expected, what to do."""

    def __init__(self, message: object = "") -> None:
        super().__init__(printable(message))


given = Arguments(BatchError)


class NoProgramError(BatchError):
    """No program is named, and a category needs one."""


class NothingSelectedError(BatchError):
    """No combination has the output that was asked for."""


def one_line(text: object) -> str:
    """Return a message without line breaks."""
    return " ".join(str(text).split())


def reason(error: OSError) -> str:
    """Return what the system says about a file: "No space left on device"."""
    return os.strerror(error.errno) if error.errno else one_line(error)


def cannot(task: str, path: str | Path, error: OSError) -> BatchError:
    """Return the error of a file that cannot be read or written: "cannot write results/a.feather: ..."."""
    is_full = error.errno in (errno.ENOSPC, errno.EDQUOT)
    advice = "; free space, then give the same command again: finished runs are kept" if is_full else ""
    return BatchError(f"cannot {task} {path}: {reason(error)}{advice}")


def check_is_file(path: Path) -> None:
    """Check that what is there, if anything is, is a file: to read a pipe or a device may never end.

    Raises:
        BatchError: It is none.
    """
    if path.exists() and not path.is_file():
        raise BatchError(f"{path} cannot be read: it is not a file")


def is_whole(value: Any) -> bool:
    """Tell whether a value is a whole number; true and false are none."""
    return isinstance(value, int) and not isinstance(value, bool)


def tell(text: str) -> None:
    """Print a line; a batch goes on even if the reader has gone."""
    with contextlib.suppress(OSError):
        say(text)


def at_least(smallest: int, value: Any, name: str, largest: int | None = None) -> int:
    """Return a whole number.

    Raises:
        BatchError: It is none, too small, or too large.
    """
    try:
        number = operator.index(value)
    except TypeError:
        number = smallest - 1
    if isinstance(value, bool) or number < smallest or (largest is not None and number > largest):
        range_text = f"of at least {smallest}" if largest is None else f"from {smallest} to {largest}"
        raise BatchError(f"{name}: expected a whole number {range_text}; found {shown(value)}")
    return number
