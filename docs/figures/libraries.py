"""The table of docs/licences.md: libraries in a wheel, and their licences.

.venv/bin/python docs/figures/all.py libraries
"""

from __future__ import annotations

import sys
from pathlib import Path

from pictures import ROOT
from quotes import Quote

sys.path.insert(0, str(ROOT / "scripts"))

from wheel_licences import LIBRARIES

NAMES = ("licences.md: libraries",)


def draw(_folder: Path) -> dict[str, Quote]:
    """Write the table."""
    rows = [f"| {name} | {library.licence} |" for name, library in LIBRARIES.items()]
    return {NAMES[0]: Quote(("| library | licence (SPDX) |", "|---|---|", *rows))}
