"""How robots move: `python -m pogosim.locomotion -i results/result.feather -o locomotion`.

The same as `pogosim analyze locomotion`; its functions are those of `pogosim.analysis`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from pogosim.analysis.density import count_density, kernel_density
from pogosim.analysis.displacement import (
    compute_msd_per_agent,
    diffusion_coefficient,
    diffusion_coefficients,
    diffusion_exponent,
    displacement_by_lag,
    mean_squared_displacement,
    msd_per_agent,
    squared_displacement,
)
from pogosim.analysis.motion import angular_velocity, path_length, peclet_numbers, speed, straightness, velocity
from pogosim.analysis.persistence import (
    heading_autocorrelation,
    persistence_length,
    persistence_time,
    velocity_autocorrelation,
)
from pogosim.compat import attribute
from pogosim.reports.command import analyze

__all__ = [
    "angular_velocity",
    "compute_msd_per_agent",
    "count_density",
    "diffusion_coefficient",
    "diffusion_coefficients",
    "diffusion_exponent",
    "displacement_by_lag",
    "heading_autocorrelation",
    "kernel_density",
    "main",
    "mean_squared_displacement",
    "msd_per_agent",
    "path_length",
    "peclet_numbers",
    "persistence_length",
    "persistence_time",
    "speed",
    "squared_displacement",
    "straightness",
    "velocity",
    "velocity_autocorrelation",
]


def __getattr__(name: str) -> Any:
    """Find a function of `pogosim.compat`."""
    return attribute("locomotion", name)


def main(arguments: Sequence[str] | None = None, prog: str = "locomotion") -> int:
    """Run the command line, which is that of `pogosim analyze locomotion`. Returns the exit code."""
    return analyze("locomotion", arguments, prog)


if __name__ == "__main__":
    sys.exit(main())
