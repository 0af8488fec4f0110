"""The command line of a subcommand."""

from __future__ import annotations

import argparse
import sys
from typing import NoReturn

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


def complain(prog: str, problem: object) -> int:
    """Print what is wrong; returns the exit code 2."""
    say_error(f"{prog}: {problem}")
    return 2
