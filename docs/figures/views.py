"""The same moment of the demonstration as four views show it: the section `view` of the configuration.

.venv/bin/python docs/figures/all.py views
"""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pandas as pd
from pictures import ROOT, Picture, fingerprint
from PIL import Image
from pogosim import Simulation

NAMES = ("views.png",)
STEPS = 1600
SIDE = 600  # pixels of each picture
VIEWS: tuple[dict[str, object], ...] = (
    {"links": "below"},
    {"color_by": "speed", "velocities": True},
    {"heat_map": "density", "color_by": "angle"},
    {"theme": "light", "labels": True, "heard": True, "palette": "color_blind"},
)


def draw(_: Path) -> dict[str, Picture]:
    """Run the demonstration once for each view; they lie beside and below each other."""
    program, configuration = ROOT / "examples" / "hanabi" / "hanabi.so", ROOT / "conf" / "demo.yaml"
    pictures, seen = [], pd.DataFrame()
    for view in VIEWS:
        settings = {"enable_data_logging": False, **{f"view.{key}": value for key, value in view.items()}}
        with Simulation(program, configuration, set=settings) as simulation:
            simulation.step(STEPS)
            pictures.append(simulation.render(SIDE, SIDE))
            seen = pd.DataFrame(simulation.positions.copy(), columns=["x", "y"])
    rows = [np.concatenate(pictures[i : i + 2], axis=1) for i in (0, 2)]
    file = io.BytesIO()
    Image.fromarray(np.concatenate(rows)).save(file, "PNG", optimize=True)
    return {"views.png": Picture(file.getvalue(), fingerprint(seen), is_exact=False)}
