"""Neighbours of robots: `python -m pogosim.neighbors` is `pogosim analyze neighbors`; and its functions, for scripts.

python -m pogosim.neighbors -i results/result.feather -o figures
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from pogosim.analysis.listed_neighbours import listed_distance, listed_neighbours
from pogosim.analysis.neighbourhood import (
    cluster_sizes,
    clusters,
    degrees,
    fano_factor,
    nearest_distances,
    neighbour_pairs,
    neighbours,
)
from pogosim.compat import attribute
from pogosim.reports.command import analyze

__all__ = [
    "cluster_sizes",
    "clusters",
    "degrees",
    "fano_factor",
    "listed_distance",
    "listed_neighbours",
    "main",
    "nearest_distances",
    "neighbour_pairs",
    "neighbours",
]


def __getattr__(name: str) -> Any:
    """Find a function of `pogosim.compat`."""
    return attribute("neighbors", name)


def main(arguments: Sequence[str] | None = None, prog: str = "python -m pogosim.neighbors") -> int:
    """Run the command line, which is that of `pogosim analyze neighbors`. Returns the exit code."""
    return analyze("neighbors", arguments, prog)


if __name__ == "__main__":
    sys.exit(main())
