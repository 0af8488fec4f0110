"""Voronoi cells and coverage: functions for scripts, see `pogosim.compat`.

`python -m pogosim.coverage` is `pogosim analyze coverage`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from pogosim.compat import attribute
from pogosim.reports.command import analyze


def __getattr__(name: str) -> Any:
    """Find a function of the analysis, or of `pogosim.compat.coverage`."""
    return attribute("coverage", name)


def main(arguments: Sequence[str] | None = None, prog: str = "python -m pogosim.coverage") -> int:
    """Run the command line, which is that of `pogosim analyze coverage`. Returns the exit code."""
    return analyze("coverage", arguments, prog)


if __name__ == "__main__":
    sys.exit(main())
