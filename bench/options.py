"""What the command lines of benchmarks have in common. Needs no package, so that wrong usage is told first."""

from __future__ import annotations

import argparse
from pathlib import Path


def at_least_one(text: str) -> int:
    """Return a whole number above 0."""
    try:
        value = int(text)
    except ValueError:
        value = 0
    if value < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number above 0")
    return value


def seconds(text: str) -> float:
    """Return a time above 0 s."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of seconds above 0")
    return value


def check_built(parser: argparse.ArgumentParser, *files: Path) -> None:
    """End with one line and exit code 2 if something is not built."""
    for file in files:
        if not file.exists():
            parser.error(f"{file} is not there; ./build.sh builds the library and the examples")
