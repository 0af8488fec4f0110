"""Lamps at several moments, as robots see them.

    .venv/bin/python docs/figures/all.py lamps

Puts a tiny robot in each cell of the light map.
"""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import numpy as np
import pandas as pd
import yaml
from matplotlib.figure import Figure
from pictures import ROOT, Picture, from_figure
from pogosim.utils import load_dataframe

NAMES = ("lamps.png",)
CELLS = 64  # along each side of the map
SIDE_MM = 1000.0
BRIGHTEST = 20000
AMBIENT = {"type": "static_light", "geometry": "global", "value": 3000}
# Each: what is in the row, its lamps, and when to look, s.
SCENES: tuple[tuple[str, dict[str, dict[str, object]], tuple[float, ...]], ...] = (
    (
        "static_light\ngradient, photo start at 1 s",
        {
            "lamp": {
                "type": "static_light",
                "geometry": "disk",
                "radius": 350,
                "x": 500,
                "y": 500,
                "light_mode": "gradient",
                "value": BRIGHTEST,
                "photo_start_at": 1.0,
                "photo_start_value": BRIGHTEST,
            }
        },
        (0.5, 1.5, 2.5, 3.5),
    ),
    (
        "orbiting_static_light\n1 rad/s, adds to an even light",
        {
            "ambient": AMBIENT,
            "lamp": {
                "type": "orbiting_static_light",
                "geometry": "disk",
                "radius": 180,
                "x": 500,
                "y": 500,
                "orbit_radius": 270,
                "orbit_angular_speed": 1.0,
                "light_mode": "gradient",
                "value": BRIGHTEST - 3000,
            },
        },
        (0.0, 1.0, 2.0, 3.0),
    ),
    (
        "rotating_ray_of_light\n2 rad/s, over an even light",
        {
            "ambient": AMBIENT,
            "lamp": {
                "type": "rotating_ray_of_light",
                "geometry": "global",
                "angular_speed": 2.0,
                "value": 12000,
                "white_frame_duration": 0.3,
                "white_frame_value": BRIGHTEST,
            },
        },
        (0.2, 0.5, 1.0, 2.5),
    ),
    (
        "alternating_rays_of_light\npi/2 rad/s",
        {
            "lamp": {
                "type": "alternating_rays_of_light",
                "geometry": "global",
                "angular_speed": float(np.pi / 2),
                "value": 12000,
                "long_white_frame_duration": 0.5,
                "short_white_frame_duration": 0.2,
                "white_frame_value": BRIGHTEST,
            }
        },
        (0.2, 1.1, 1.6, 2.3),
    ),
)


def compile_probe(folder: Path) -> Path:
    """Compile light_levels.c against the built library."""
    environment = {**os.environ, "PKG_CONFIG_PATH": str(ROOT / "build/release")}
    asked = ["pkg-config", "--cflags", "--libs", "pogosim"]
    flags = subprocess.run(asked, env=environment, check=True, capture_output=True, text=True).stdout.split()
    program = folder / "light_levels"
    source = ROOT / "docs/figures/light_levels.c"
    subprocess.run(["cc", "-std=c11", str(source), "-o", str(program), *flags], check=True)
    return program


def positions(folder: Path) -> Path:
    """Write the centres of all cells, row by row, as a formation."""
    centres = (np.arange(CELLS) + 0.5) * SIDE_MM / CELLS
    lines = [f"{x},{y},0" for y in centres for x in centres]
    path = folder / "cells.csv"
    path.write_text("\n".join(["x,y,angle", *lines, ""]), encoding="utf-8")
    return path


def levels(program: Path, folder: Path, lamps: dict[str, dict[str, object]], end_s: float) -> pd.DataFrame:
    """Run with these lamps; return what the cells measure: a row per tenth of a second, a column per cell."""
    probes = {"type": "pogobot", "nb": CELLS**2, "geometry": "disk", "radius": 0.5, "communication_radius": 0}
    configuration = {
        "arena_file": str(ROOT / "arenas/square.csv"),
        "arena_surface": SIDE_MM**2,
        "light_map_nb_bin_x": CELLS,
        "light_map_nb_bin_y": CELLS,
        "initial_formation": "imported",
        "formation_filename": str(positions(folder)),
        "seed": 1,
        "simulation_time": end_s + 0.05,
        "save_data_period": 0.1,
        "data_filename": str(folder / "light.feather"),
        "objects": {**lamps, "robots": probes},
    }
    (folder / "run.yaml").write_text(yaml.safe_dump(configuration, sort_keys=False), encoding="utf-8")
    subprocess.run([str(program), "-c", str(folder / "run.yaml"), "-g", "-q"], check=True, timeout=120)
    rows, _ = load_dataframe(folder / "light.feather")
    return rows.pivot(index="time", columns="robot_id", values="light")


def draw(folder: Path) -> dict[str, Picture]:
    """One row per lamp, one column per moment."""
    figure = Figure(figsize=(8.0, 8.4), layout="constrained")
    grid = figure.subplots(len(SCENES), 4)
    program = compile_probe(folder)
    drawn = []
    for panels, (title, lamps, times_s) in zip(grid, SCENES, strict=True):
        measured = levels(program, folder, lamps, max(times_s))
        drawn.append(measured)
        for axes, time_s in zip(panels, times_s, strict=True):
            level = measured.loc[np.isclose(measured.index, time_s)].to_numpy().reshape(CELLS, CELLS)
            axes.imshow(level, cmap="inferno", vmin=0, vmax=BRIGHTEST, extent=(0, SIDE_MM, SIDE_MM, 0))
            axes.set_title(f"{time_s:.1f} s", fontsize=8)
            axes.set_xticks([])
            axes.set_yticks([])
        panels[0].set_ylabel(title, fontsize=8)
    return {"lamps.png": from_figure(figure, 85, *drawn)}
