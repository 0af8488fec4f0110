"""The command line of a subcommand."""

from __future__ import annotations

import argparse
import sys
from typing import NoReturn


class Parser(argparse.ArgumentParser):
    """Says in one line what is wrong, then ends with exit code 2."""

    def error(self, message: str) -> NoReturn:
        """Print what is wrong, and exit."""
        print(f"{self.prog}: {message}; {self.prog} --help explains the options", file=sys.stderr)
        sys.exit(2)


def warn(prog: str, text: object) -> None:
    """Print a warning as one line."""
    print(f"{prog}: warning: {text}", file=sys.stderr)


def complain(prog: str, problem: object) -> int:
    """Print what is wrong; returns the exit code 2."""
    print(f"{prog}: {problem}", file=sys.stderr)
    return 2
