"""The command line of a subcommand."""

from __future__ import annotations

import argparse
import contextlib
import sys
import warnings
from collections.abc import Iterator
from typing import Any, NoReturn

from pogosim.lines import say_error


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


def complain(prog: str, problem: object) -> int:
    """Print what is wrong; returns the exit code 2."""
    say_error(f"{prog}: {problem}")
    return 2
