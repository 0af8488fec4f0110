"""Voronoi cells and coverage: `python -m pogosim.coverage` is `pogosim analyze coverage`; its functions, for scripts.

python -m pogosim.coverage -i results/result.feather -o figures
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from pogosim.analysis.coverage import coverage_over_time, covered_area
from pogosim.analysis.voronoi import voronoi_areas, voronoi_cells
from pogosim.compat import attribute
from pogosim.reports.command import analyze

__all__ = ["coverage_over_time", "covered_area", "main", "voronoi_areas", "voronoi_cells"]


def __getattr__(name: str) -> Any:
    """Find a function of `pogosim.compat`."""
    return attribute("coverage", name)


def main(arguments: Sequence[str] | None = None, prog: str = "python -m pogosim.coverage") -> int:
    """Run the command line, which is that of `pogosim analyze coverage`. Returns the exit code."""
    return analyze("coverage", arguments, prog)


if __name__ == "__main__":
    sys.exit(main())
