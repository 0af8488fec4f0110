"""Proximity graphs: `python -m pogosim.network` is `pogosim analyze network`; and its functions, for scripts.

python -m pogosim.network -i results/result.feather -o figures
"""

from __future__ import annotations

import sys

from pogosim.analysis.laplacian import Spectrum, largest_component, spectrum
from pogosim.analysis.network import averaged_spectra, contact_time_s, graph_over_time, instantaneous_spectra
from pogosim.reports.network import main

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

if __name__ == "__main__":
    sys.exit(main(prog="python -m pogosim.network"))
