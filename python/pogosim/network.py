"""Proximity graphs: functions for scripts, see `pogosim.compat`.

`python -m pogosim.network` is `pogosim analyze network`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from pogosim.compat import attribute
from pogosim.reports.command import analyze


def __getattr__(name: str) -> Any:
    """Find a function of the analysis, or of `pogosim.compat.network`."""
    return attribute("network", name)


def main(arguments: Sequence[str] | None = None, prog: str = "python -m pogosim.network") -> int:
    """Run the command line, which is that of `pogosim analyze network`. Returns the exit code."""
    return analyze("network", arguments, prog)


if __name__ == "__main__":
    sys.exit(main())
