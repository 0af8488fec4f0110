"""How robots move: functions for scripts, see `pogosim.compat`.

`python -m pogosim.locomotion` is `pogosim analyze locomotion`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from pogosim.compat import attribute
from pogosim.reports.command import analyze


def __getattr__(name: str) -> Any:
    """Find a function of the analysis, or of `pogosim.compat.locomotion`."""
    return attribute("locomotion", name)


def main(arguments: Sequence[str] | None = None, prog: str = "locomotion") -> int:
    """Run the command line, which is that of `pogosim analyze locomotion`. Returns the exit code."""
    return analyze("locomotion", arguments, prog)


if __name__ == "__main__":
    sys.exit(main())
