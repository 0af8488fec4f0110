"""The picture of docs/data_file.md: what ./demo.sh draws.

    .venv/bin/python docs/figures/all.py swarm

It is the run of conf/demo.yaml.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

from pictures import ROOT, Picture, from_figure
from pogosim.swarm_picture import draw as draw_swarm
from pogosim.swarm_picture import read_swarm

NAMES = ("swarm.png",)


def draw(folder: Path) -> dict[str, Picture]:
    """Run the demonstration."""
    data = folder / "data.feather"
    command = ["examples/hanabi/hanabi", "-c", "conf/demo.yaml", "-g", "-q", "--set", f"data_filename={data}"]
    subprocess.run(command, cwd=ROOT, check=True, timeout=120)
    swarm = read_swarm(data)
    return {"swarm.png": from_figure(draw_swarm(swarm), 80, swarm.rows)}
