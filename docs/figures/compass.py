"""Robots that calibrate their magnetometers, and drive by them.

    .venv/bin/python docs/figures/all.py compass

Three runs of conf/magnetic_compass.yaml with one flash file.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from pictures import ROOT, Picture, from_figure
from pogosim.swarm_picture import INK, PAPER, draw_scene, read_swarm
from pogosim.utils import load_dataframe

NAMES = ("compass.png",)
SHOWN = (0, 3, 6)  # robots whose readings are drawn
RUNS = (
    ("first run: they turn, and keep what they find", ()),
    ("second run: they drive by compass", ()),
    ("third run: without it", ("parameters.use_compass=false",)),
)


def run(folder: Path, data: Path, *settings: str) -> None:
    """Run the example with the flash file of this folder."""
    flash = folder / "robots.flash"
    command = ["examples/magnetic_compass/magnetic_compass", "-c", "conf/magnetic_compass.yaml", "-g", "-q"]
    files = (f"flash_state.input_file={flash}", f"flash_state.output_file={flash}", f"data_filename={data}")
    for setting in (*files, "enable_console_logging=false", *settings):
        command += ["--set", setting]
    subprocess.run(command, cwd=ROOT, check=True, timeout=120)


def draw_readings(axes: Axes, rows: pd.DataFrame) -> None:
    """Draw the readings of some robots, and the ellipses that the robots have fitted (their axes are hardly turned)."""
    angle = np.linspace(0, 2 * np.pi, 200)
    for number, robot in enumerate(SHOWN):
        own = rows[(rows["robot_id"] == robot) & (rows["time"] > 0)]
        end = own.iloc[-1]
        turning = own[own["phase"] == 0]
        colour = f"C{number}"
        axes.plot(turning["magnetic_x"], turning["magnetic_y"], ".", color=colour, markersize=4, alpha=0.6)
        x = end["centre_x"] + end["major_radius"] * np.cos(angle)
        y = end["centre_y"] + end["minor_radius"] * np.sin(angle)
        axes.plot(x, y, color=colour, linewidth=1, label=f"robot {robot}")
        axes.plot(end["centre_x"], end["centre_y"], "+", color=colour, markersize=9 + 4 * number, zorder=3)
    axes.plot(0, 0, "+", color=INK, markersize=10)
    axes.set(xlabel="x (counts)", ylabel="y (counts)", aspect="equal")
    axes.yaxis.set_inverted(True)  # y points down, as in the arena
    axes.set_title("readings while robots turn, and the ellipses", color=INK, fontsize=10)
    axes.legend(fontsize=8, loc="lower right")


def draw(folder: Path) -> dict[str, Picture]:
    """Run three times, and draw the readings beside the three runs."""
    figure = Figure(figsize=(9, 9), facecolor=PAPER, layout="constrained")
    grid = figure.subplots(2, 2)
    drawn: list[pd.DataFrame] = []
    for axes, (title, settings) in zip(list(grid.flat)[1:], RUNS, strict=True):
        data = folder / "run.feather"
        run(folder, data, *settings)
        if not drawn:
            draw_readings(grid[0, 0], load_dataframe(data)[0])
        swarm = read_swarm(data)
        draw_scene(axes, swarm)
        drawn.append(swarm.rows)
        axes.set_title(title, color=INK, fontsize=10)
    return {"compass.png": from_figure(figure, 80, *drawn)}
