"""The table of docs/installing.md: packages that only some tools need.

.venv/bin/python docs/figures/all.py extras
"""

from __future__ import annotations

import shlex
from pathlib import Path

from pogosim.extras import EXTRAS
from quotes import Quote

NAMES = ("installing.md: extras",)
PURPOSES = {
    "dask": "batches with `--backend dask` or `--scheduler`",
    "slurm": "batches with `--slurm` or `--jobqueue`",
    "watch": "[`pogosim watch`](live.md#in-a-browser)",
    "notebook": "[live views in notebooks](live.md#in-a-notebook)",
    "learning": "[learning](learning.md)",
    "policy": "[policies in `.onnx` files](policy_export.md#files)",
    "optimize": "`pogoptim` with `tpe`, `mapelites`, `cma_me` and `cma_mae`, and [MAP-Elites of policies](learners.md)",
}


def draw(_folder: Path) -> dict[str, Quote]:
    """Write the table."""
    rows = [
        f"| {PURPOSES[extra]} | `.venv/bin/python -m pip install {shlex.join(packages)}` |"
        for extra, packages in EXTRAS.items()
        if extra in PURPOSES  # `optim` is another name
    ]
    return {NAMES[0]: Quote(("| for | command in a checkout |", "|---|---|", *rows))}
