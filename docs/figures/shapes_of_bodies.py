"""Bodies of all shapes among robots, at the start and after a minute.

    .venv/bin/python docs/figures/all.py shapes_of_bodies

Runs conf/shapes.yaml with examples/run_and_tumble.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

from matplotlib.figure import Figure
from pictures import ROOT, Picture, from_figure
from pogosim.picture.swarm import read_recording
from pogosim.swarm_picture import INK, PAPER, draw_scene
from pogosim.utils import load_dataframe

NAMES = ("shapes.png",)


def draw(folder: Path) -> dict[str, Picture]:
    """Draw both times side by side."""
    data = folder / "shapes.feather"
    program = str(ROOT / "examples/run_and_tumble/run_and_tumble")
    settings = f"data_filename={data}"
    command = [program, "-c", str(ROOT / "conf/shapes.yaml"), "-g", "-q", "--set", settings]
    subprocess.run(command, check=True, timeout=300, cwd=ROOT)
    figure = Figure(figsize=(10, 5.2), facecolor=PAPER, layout="constrained")
    for axes, time_s in zip(figure.subplots(1, 2), (0.0, 60.0), strict=True):
        draw_scene(axes, read_recording(data).until(time_s))
        axes.set_title(f"t = {time_s:g} s", color=INK, fontsize=10)
    return {"shapes.png": from_figure(figure, 80, load_dataframe(data)[0][["time", "robot_id", "x", "y"]])}
