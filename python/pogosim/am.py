"""Collective order of swarms: functions for scripts, see `pogosim.compat`.

`python -m pogosim.am` is `pogosim analyze collective`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from pogosim.compat import attribute
from pogosim.reports.command import analyze


def __getattr__(name: str) -> Any:
    """Find a function of the analysis, or of `pogosim.compat.am`."""
    return attribute("am", name)


def main(arguments: Sequence[str] | None = None, prog: str = "python -m pogosim.am") -> int:
    """Run the command line, which is that of `pogosim analyze collective`. Returns the exit code."""
    return analyze("collective", arguments, prog)


if __name__ == "__main__":
    sys.exit(main())
