"""Collective order of swarms: the command `pogosim analyze collective`, and its functions for scripts.

python -m pogosim.am -i results/result.feather -o results/collective
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from pogosim.analysis.bond_order import bond_order
from pogosim.analysis.correlations import correlation_length, pair_correlation, vector_correlation
from pogosim.analysis.directions import directions_of_headings, directions_of_motion
from pogosim.analysis.flow import VelocityField, velocity_field, velocity_fields
from pogosim.analysis.fluctuations import mean_square_speed, number_fluctuations
from pogosim.analysis.milling import centre_of_mass, milling
from pogosim.analysis.motion import velocity
from pogosim.analysis.order import local_alignment, nematic_order, polar_order
from pogosim.analysis.structure_factor import structure_factor
from pogosim.compat import attribute
from pogosim.reports.command import analyze

__all__ = [
    "VelocityField",
    "bond_order",
    "centre_of_mass",
    "correlation_length",
    "directions_of_headings",
    "directions_of_motion",
    "local_alignment",
    "main",
    "mean_square_speed",
    "milling",
    "nematic_order",
    "number_fluctuations",
    "pair_correlation",
    "polar_order",
    "structure_factor",
    "vector_correlation",
    "velocity",
    "velocity_field",
    "velocity_fields",
]


def __getattr__(name: str) -> Any:
    """Find a function of `pogosim.compat`."""
    return attribute("am", name)


def main(arguments: Sequence[str] | None = None, prog: str = "python -m pogosim.am") -> int:
    """Run the command line, which is that of `pogosim analyze collective`. Returns the exit code."""
    return analyze("collective", arguments, prog)


if __name__ == "__main__":
    sys.exit(main())
