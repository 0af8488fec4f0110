"""One picture of every initial formation.

    .venv/bin/python docs/figures/all.py formations

Runs helloworld for no time at all, once per formation.
"""

from __future__ import annotations

import math
import subprocess
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
import yaml
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon
from pictures import ROOT, Picture, from_figure
from pogosim.swarm_picture import read_swarm

NAMES = ("formations.png",)
RADIUS_MM = 26.5
COUNT = 60
FORMATIONS = (
    "random",
    "random_near_walls",
    "disk",
    "chessboard",
    "aligned_random",
    "aligned_random_near_walls",
    "aligned_disk",
    "aligned_chessboard",
    "lattice",
    "aligned_lattice",
    "lloyd",
    "power_lloyd",
    "imported",
)


def spiral() -> str:
    """Return a CSV file for `imported`: x, y and angle of robots along a spiral."""
    turns = np.sqrt(np.linspace(0.5, 11.0, COUNT)) * 2.0 * math.pi
    lines = [f"{460 + 17 * t * math.cos(t)},{540 + 17 * t * math.sin(t)},{t + math.pi / 2}" for t in turns]
    return "\n".join(["x,y,angle", *lines, ""])


def place(folder: Path, name: str, options: Mapping[str, object]) -> Path:
    """Run the simulator for no time; return its data file, which holds the poses at time 0."""
    data = folder / f"{name}.feather"
    configuration = {
        "arena_file": str(ROOT / "arenas/disk.csv"),
        "initial_formation": name,
        "formation_filename": str(folder / "spiral.csv"),
        "seed": 1,
        "simulation_time": 0,
        "data_filename": str(data),
        "objects": {"robots": {"type": "pogobot", "nb": COUNT, "geometry": "disk", "radius": RADIUS_MM}},
        **options,
    }
    (folder / "run.yaml").write_text(yaml.safe_dump(configuration), encoding="utf-8")
    program = ROOT / "examples/helloworld/helloworld"
    subprocess.run([program, "-c", folder / "run.yaml", "-g", "-q"], check=True, timeout=60)
    return data


def draw_swarm(axes: Axes, data: Path) -> pd.DataFrame:
    """Draw walls, and robots with a line along their heading; return the robots."""
    swarm = read_swarm(data)
    rows = swarm.rows
    for polygon in swarm.polygons:
        axes.add_patch(Polygon(polygon, fill=False, edgecolor="0.3"))
    position = rows[["x", "y"]].to_numpy(dtype=float)
    heading = np.column_stack([np.cos(rows["angle"]), np.sin(rows["angle"])])
    bodies = [Circle((x, y), RADIUS_MM) for x, y in position]
    axes.add_collection(PatchCollection(bodies, facecolor="#7fb3d5", edgecolor="0.3"))
    ticks = np.stack([position, position + RADIUS_MM * heading], axis=1)
    axes.add_collection(LineCollection(list(ticks), colors="k", linewidths=1.0))
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.invert_yaxis()
    axes.set_axis_off()
    return rows


def draw(folder: Path) -> dict[str, Picture]:
    """Draw all formations in one figure."""
    figure = Figure(figsize=(11.0, 7.4), layout="constrained")
    panels = list(figure.subplots(3, 5).flat)
    panels_of: list[tuple[str, dict[str, object]]] = [(name, {}) for name in FORMATIONS]
    panels_of += [("chessboard", {"formation_cluster_at_center": False}), ("lattice", {"lattice_kind": "square"})]
    drawn = []
    (folder / "spiral.csv").write_text(spiral(), encoding="utf-8")
    for axes, (name, options) in zip(panels, panels_of, strict=True):
        drawn.append(draw_swarm(axes, place(folder, name, options)))
        axes.set_title("\n".join([name, *(f"{k}: {str(v).lower()}" for k, v in options.items())]), fontsize=8)
    return {"formations.png": from_figure(figure, 85, *drawn)}
