"""Robots that hear one in their middle among pillars, a box and a wall, without and with what blocks infrared.

    .venv/bin/python docs/figures/all.py blocked

Runs probes twice, for some steps. The lines are those of the message log: from each emitter of the robot in the middle
to the centres of the robots that it reaches.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pandas as pd
import yaml
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from pictures import ROOT, Picture, from_figure
from pogosim.swarm_picture import INK, PAPER, draw_scene, read_swarm
from pogosim.utils import load_dataframe

NAMES = ("blocked.png",)
SIDE_MM = 640
RADIUS_MM = 12.0
ARENA = ((0, 0, SIDE_MM, SIDE_MM), (205, 200, 290, 208))  # the outline and a wall in it: two corners of each box
PILLARS = ([450.0, 320.0], [297.4, 448.0], [197.8, 275.5])


def corners(x: float, y: float, right: float, bottom: float) -> str:
    """Return a box as lines of an arena file."""
    return f"{x},{y}\n{right},{y}\n{right},{bottom}\n{x},{bottom}\n"


def poses() -> list[list[float]]:
    """Return the sender in the middle, and rings of robots around it."""
    middle = SIDE_MM / 2
    placed = [[middle, middle, 0.0]]
    for radius, count in ((85, 9), (175, 24), (255, 36)):
        for angle in 2 * np.pi * (np.arange(count) + 0.5) / count:
            placed.append([float(middle + radius * np.cos(angle)), float(middle + radius * np.sin(angle)), 0.0])
    return placed


def run(folder: Path, *, blocked: bool) -> tuple[Path, pd.DataFrame]:
    """Run for 0.2 s; return the data file, and the robots that the first one reaches."""
    (folder / "arena.csv").write_text("\n".join(corners(*box) for box in ARENA), encoding="utf-8")
    name = "blocked" if blocked else "free"
    data, log = folder / f"{name}.feather", folder / f"{name}_messages.feather"
    body = {"type": "passive_object", "body_fixed": True, "blocks_infrared": blocked}
    robots = {"type": "pogobot", "poses": poses(), "geometry": "disk", "radius": RADIUS_MM}
    configuration = {
        "arena_file": str(folder / "arena.csv"),
        "arena_surface": "file",
        "walls_block_infrared": blocked,
        "communication_ignore_occlusions": True,
        "simulation_time": 0.2,
        "seed": 1,
        "data_filename": str(data),
        "message_log": str(log),
        "objects": {
            "robots": {**robots, "communication_radius": 250},
            "pillars": {**body, "poses": [list(place) for place in PILLARS], "geometry": "disk", "radius": 22},
            "box": {
                **body,
                "x": 427.5,
                "y": 506.2,
                "angle": 2.618,
                "geometry": "rectangle",
                "body_width": 90,
                "body_height": 30,
            },
        },
        "parameters": {"payload_size": 3, "send_percent": 100},
    }
    (folder / "run.yaml").write_text(yaml.safe_dump(configuration), encoding="utf-8")
    program = ROOT / "examples/probes/probes"
    subprocess.run([program, "-c", folder / "run.yaml", "-g", "-q"], check=True, timeout=60)
    rows = load_dataframe(log)[0]
    first = rows[(rows["sender_id"] == 0) & rows["receiver"].notna()].drop_duplicates("receiver_id")
    return data, first[["receiver_id", "reaching_faces", "distance"]].reset_index(drop=True)


def draw_lines(axes: Axes, reached: pd.DataFrame) -> None:
    """Draw a line from each emitter to each robot that it reaches."""
    place = np.array(poses())[:, :2]
    lines = []
    for receiver, mask in zip(reached["receiver_id"].astype(int), reached["reaching_faces"].astype(int), strict=True):
        for face in range(4):
            if mask >> face & 1:
                angle = face * np.pi / 2
                lines.append([place[0] + RADIUS_MM * np.array([np.cos(angle), np.sin(angle)]), place[receiver]])
    axes.add_collection(LineCollection(lines, colors="#c0392b", linewidths=0.5, zorder=1.5))


def draw(folder: Path) -> dict[str, Picture]:
    """Draw both runs side by side."""
    figure = Figure(figsize=(10, 5.2), facecolor=PAPER, layout="constrained")
    drawn: list[pd.DataFrame] = []
    for axes, blocked in zip(figure.subplots(1, 2), (False, True), strict=True):
        data, reached = run(folder, blocked=blocked)
        draw_scene(axes, read_swarm(data))
        draw_lines(axes, reached)
        keys = "with walls_block_infrared and blocks_infrared" if blocked else "without"
        axes.set_title(f"{keys}: {len(reached)} robots", color=INK, fontsize=10)
        drawn.append(reached)
    return {"blocked.png": from_figure(figure, 80, *drawn)}
