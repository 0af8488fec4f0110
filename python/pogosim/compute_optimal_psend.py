"""`python -m pogosim.compute_optimal_psend`: how often robots should send, `pogosim best-psend` under another name."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from pogosim.command.main import ended
from pogosim.communication import sending


def main(arguments: Sequence[str] | None = None, prog: str = "compute_optimal_psend") -> int:
    """Run the command; returns its exit code."""
    return sending.main(arguments, prog)


if __name__ == "__main__":
    sys.exit(ended("compute_optimal_psend", main))
