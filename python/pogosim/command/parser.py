"""The command line of a subcommand: its parser, types of numbers, and how it says what is wrong."""

from __future__ import annotations

import argparse
import contextlib
import math
import sys
import warnings
from collections.abc import Callable, Iterator
from typing import Any, NoReturn

from pogosim.errors import ToolError
from pogosim.extensions import said
from pogosim.lines import say, say_error
from pogosim.outputs import told


class Parser(argparse.ArgumentParser):
    """Says in one line what is wrong, then ends with exit code 2."""

    def error(self, message: str) -> NoReturn:
        """Print what is wrong, and exit."""
        say_error(f"{self.prog}: {message}; {self.prog} --help explains the options")
        sys.exit(2)


def warn(prog: str, text: object) -> None:
    """Print a warning as one line."""
    say_error(f"{prog}: warning: {text}")


@contextlib.contextmanager
def warnings_told(prog: str, *kinds: type[Warning]) -> Iterator[None]:
    """Print Python's warnings of some kinds as lines of a command, each once."""
    told = set()
    with warnings.catch_warnings():
        for kind in kinds:
            warnings.simplefilter("always", kind)
        show_others = warnings.showwarning

        def show(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
            if not issubclass(category, kinds):
                show_others(message, category, *place, **more)
            elif str(message) not in told:
                told.add(str(message))
                warn(prog, message)

        warnings.showwarning = show
        yield


def guarded(prog: str, run: Callable[[], int | None], place: object = "the output") -> int:
    """Run a command; says in one line what keeps it from its end, and returns the exit code 2 or a ToolError's then.

    Args:
        prog: Name of the command.
        run: Returns the exit code; None: 0.
        place: What is read or written, for errors of the system that name no file.
    """
    try:
        return run() or 0
    except ToolError as error:
        return complain(prog, error)
    except OSError as error:
        return complain(prog, told(error, str(place)))


def complain(prog: str, problem: object) -> int:
    """Print what is wrong; returns the exit code: that of a ToolError, 2 otherwise."""
    say_error(f"{prog}: {problem}")
    return problem.exit_code if isinstance(problem, ToolError) else ToolError.exit_code


def say_of_complete(prog: str, file: object, *lines: object) -> int:
    """Print lines about a file that has been written; returns the exit code: a closed output does not harm the file."""
    try:
        say(*lines)
    except OSError as error:
        return complain(prog, f"{file} is complete, but the standard output cannot be written: {error.strerror}")
    return 0


def finite(text: str) -> float:
    """Return a finite number."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"'{text}' is not a finite number")
    return value


def positive(text: str) -> float:
    """Return a number above 0."""
    if (value := finite(text)) <= 0.0:
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return value


def whole(least: int, most: int | None = None) -> Callable[[str], int]:
    """Return the type of whole numbers in a range, which includes both ends; None: without an upper end."""

    def checked(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = least - 1
        if value < least or (most is not None and value > most):
            which = f"of {least} or more" if most is None else f"from {least} to {most}"
            raise argparse.ArgumentTypeError(f"'{text}' is not a whole number {which}")
        return value

    return checked


def setting(text: str) -> tuple[str, Any]:
    """Return the key and the value that `--set KEY=VALUE` gives."""
    from pogosim.yaml_1_2 import WRONG_VALUES, parse_yaml  # takes a while

    key, sign, value = text.partition("=")
    if not key or not sign:
        raise argparse.ArgumentTypeError(f"expected KEY=VALUE, such as objects.robots.nb=50, found '{text}'")
    try:
        return key, parse_yaml(value)
    except WRONG_VALUES as error:
        raise argparse.ArgumentTypeError(f"{key}: not YAML: {said(error)}") from None
