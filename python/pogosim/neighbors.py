"""Neighbours of robots: functions for scripts, see `pogosim.compat`.

`python -m pogosim.neighbors` is `pogosim analyze neighbors`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from pogosim.compat import attribute
from pogosim.reports.command import analyze


def __getattr__(name: str) -> Any:
    """Find a function of the analysis, or of `pogosim.compat.neighbors`."""
    return attribute("neighbors", name)


def main(arguments: Sequence[str] | None = None, prog: str = "python -m pogosim.neighbors") -> int:
    """Run the command line, which is that of `pogosim analyze neighbors`. Returns the exit code."""
    return analyze("neighbors", arguments, prog)


if __name__ == "__main__":
    sys.exit(main())
