"""Voronoi cells and coverage: `python -m pogosim.coverage` is `pogosim analyze coverage`; its functions, for scripts.

python -m pogosim.coverage -i results/result.feather -o figures
"""

from __future__ import annotations

import sys

from pogosim.analysis.coverage import coverage_over_time, covered_area
from pogosim.analysis.voronoi import voronoi_areas, voronoi_cells
from pogosim.reports.coverage import main

__all__ = ["coverage_over_time", "covered_area", "main", "voronoi_areas", "voronoi_cells"]

if __name__ == "__main__":
    sys.exit(main(prog="python -m pogosim.coverage"))
