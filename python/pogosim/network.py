"""Proximity graphs: `python -m pogosim.network` is `pogosim analyze network`; and its functions, for scripts.

python -m pogosim.network -i results/result.feather -o figures
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from pogosim.analysis.laplacian import Spectrum, largest_component, spectrum
from pogosim.analysis.network import averaged_spectra, contact_time_s, graph_over_time, instantaneous_spectra
from pogosim.compat import attribute
from pogosim.reports.command import analyze

__all__ = [
    "Spectrum",
    "averaged_spectra",
    "contact_time_s",
    "graph_over_time",
    "instantaneous_spectra",
    "largest_component",
    "main",
    "spectrum",
]


def __getattr__(name: str) -> Any:
    """Find a function of `pogosim.compat`."""
    return attribute("network", name)


def main(arguments: Sequence[str] | None = None, prog: str = "python -m pogosim.network") -> int:
    """Run the command line, which is that of `pogosim analyze network`. Returns the exit code."""
    return analyze("network", arguments, prog)


if __name__ == "__main__":
    sys.exit(main())
