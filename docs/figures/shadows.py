"""Light of a lamp among bodies and a wall, without and with shadows.

.venv/bin/python docs/figures/all.py shadows
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from pictures import Picture, from_figure
from pogosim import Simulation
from pogosim.object_facts import entries_in
from pogosim.picture.layers import placed
from pogosim.shapes import shape_of

NAMES = ("shadows.png",)
SIDE_MM = 1000
CELLS = 200  # along each side of the map
BRIGHTEST = 20000
WALL_MM = ((620, 100), (660, 100), (660, 420), (620, 420))
TRAY = [
    {"geometry": "rectangle", "body_width": 20, "body_height": 200},
    {"geometry": "rectangle", "body_width": 120, "body_height": 20, "x": 60, "y": -90},
    {"geometry": "rectangle", "body_width": 120, "body_height": 20, "x": 60, "y": 90},
]


def configuration(folder: Path, *, shadows: bool) -> dict[str, Any]:
    """Return a scene of fixed bodies and robots that stand still."""
    lines = [(0, 0), (SIDE_MM, 0), (SIDE_MM, SIDE_MM), (0, SIDE_MM), None, *WALL_MM]
    (folder / "arena.csv").write_text("\n".join("" if at is None else f"{at[0]},{at[1]}" for at in lines) + "\n")
    lamp = {"type": "static_light", "geometry": "disk", "radius": 1000, "light_mode": "gradient", "x": 420, "y": 420}
    body = {"type": "passive_object", "body_fixed": True}
    return {
        "arena_file": str(folder / "arena.csv"),
        "arena_surface": "file",
        "light_map_nb_bin_x": CELLS,
        "light_map_nb_bin_y": CELLS,
        "enable_data_logging": False,
        "seed": 1,
        "objects": {
            "lamp": {**lamp, "value": BRIGHTEST, "casts_shadows": shadows},
            "box": {**body, "geometry": "rectangle", "body_width": 140, "body_height": 50, "poses": [[200, 600, 0.6]]},
            "pillars": {**body, "geometry": "disk", "radius": 30, "poses": [[420, 200, 0], [250, 330, 0]]},
            "tray": {**body, "geometry": "compound", "parts": TRAY, "poses": [[600, 700, 3.9]]},
            "robots": {"type": "pogobot", "brain": "host", "poses": [[330, 480, 0], [450, 560, 2], [800, 560, 1]]},
        },
    }


def draw_panel(axes: Axes, folder: Path, *, shadows: bool) -> pd.DataFrame:
    """Draw the light and the bodies; return the light."""
    settings = configuration(folder, shadows=shadows)
    path = folder / "scene.yaml"
    path.write_text(yaml.safe_dump(settings, sort_keys=False), encoding="utf-8")
    with Simulation(None, str(path)) as simulation:
        simulation.step(1)
        light = np.array(simulation.light_map)
    axes.imshow(light, cmap="inferno", vmin=0, vmax=BRIGHTEST, extent=(0, SIDE_MM, SIDE_MM, 0))
    axes.add_patch(Polygon(WALL_MM, facecolor="0.35", edgecolor="white", linewidth=0.8))
    for own in entries_in(settings):
        poses = np.array(own.settings.get("poses", ()), dtype=float).reshape(-1, 3)
        fill = "tab:cyan" if own.category == "robots" else "0.55"
        for corners in placed(shape_of(own.settings).outline(), poses[:, :2], poses[:, 2]):
            axes.add_patch(Polygon(corners, facecolor=fill, edgecolor="black"))
    axes.set_title("casts_shadows: true" if shadows else "casts_shadows: false (default)", fontsize=9)
    axes.set_xticks([])
    axes.set_yticks([])
    return pd.DataFrame(light, columns=[str(i) for i in range(CELLS)])


def draw(folder: Path) -> dict[str, Picture]:
    """Draw both side by side."""
    figure = Figure(figsize=(8.4, 4.4), layout="constrained")
    panels = figure.subplots(1, 2)
    lights = [draw_panel(axes, folder, shadows=shadows) for axes, shadows in zip(panels, (False, True), strict=True)]
    return {"shadows.png": from_figure(figure, 85, *lights)}
