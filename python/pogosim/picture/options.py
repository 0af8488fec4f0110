"""What the commands that draw a data file share: options, and saying what went wrong."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable

from pogosim.command.parser import complain, warnings_told
from pogosim.errors import AmbiguousStepsWarning, MissingColumnWarning, ToolError


def add_what_to_draw(parser: argparse.ArgumentParser) -> None:
    """Add the options of all commands that draw a data file."""
    parser.add_argument(
        "--color-by",
        metavar="COLUMN",
        help="colours show the values of this column (view.color_by of the run, or LEDs)",
    )
    parser.add_argument("--links", action="store_true", help="join robots near enough to hear each other")
    parser.add_argument("--run", type=int, metavar="N", help="of several runs, the one with this number (the first)")
    parser.add_argument(
        "--combination", type=int, metavar="N", help="of a batch with several combinations of options, this one (0)"
    )
    parser.add_argument("-q", "--quiet", action="store_true", help="do not say what was written")


def cannot_read(data: str, error: OSError) -> str:
    """Return why a data file, or one of those that fit a pattern, cannot be read."""
    if error.errno is None:  # nothing fits the pattern
        return f"cannot read '{data}': {error}"
    reason = "no such file" if isinstance(error, FileNotFoundError) else (error.strerror or str(error)).lower()
    return f"cannot read '{error.filename or data}': {reason}"


def report(prog: str, data: str, output: str, make: Callable[[], None]) -> int:
    """Make an output; returns the exit code: 0, or 2 after a line that says why it could not be made."""
    try:
        with warnings_told(prog, AmbiguousStepsWarning, MissingColumnWarning):
            make()
    except ToolError as error:
        return complain(prog, error)
    except OSError as error:
        if str(error.filename) == data:
            return complain(prog, cannot_read(data, error))
        # A folder for temporary files that is full, say, is told by its own name.
        place = f"{error.filename}: " if error.filename not in (None, os.path.realpath(output), output) else ""
        return complain(prog, f"cannot write '{output}': {place}{(error.strerror or str(error)).lower()}")
    return 0
