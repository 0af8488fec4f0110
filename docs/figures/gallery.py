"""Six examples, each with its configuration.

    .venv/bin/python docs/figures/all.py gallery

Each runs with the configuration that shows it best.
"""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure
from pictures import ROOT, Picture, from_figure
from pogosim.swarm_picture import INK, PAPER, draw_scene, read_swarm

NAMES = ("gallery.png",)


@dataclass(frozen=True)
class Example:
    """An example to run, and when to look."""

    name: str
    shows: str
    configuration: str
    end_s: float
    tail_s: float
    settings: tuple[str, ...] = ()


EXAMPLES = (
    Example("phototaxis", "robots stay, in blue, where it is bright", "phototaxis", 30.0, 8.0),
    Example("walls", "blue: heard the wall; yellow: heard the membrane", "walls_and_membranes", 14.0, 10.0),
    Example("lighthouse_localization", "each knows where: the hue is its bearing", "lighthouse", 21.0, 6.0),
    Example("vicsek", "a flock, coloured by heading", "vicsek", 60.0, 4.0),
    Example("naming_game", "words spread, one will win", "naming_game", 2.2, 2.0),
    Example("ssr", "robots have heard that this is an annulus", "ssr", 400.0, 5.0, ("arena_file=arenas/annulus.csv",)),
)


def run(example: Example, data: Path) -> None:
    """Run an example, with the colours of its LEDs in the data file."""
    command = [f"examples/{example.name}/{example.name}", "-c", f"conf/{example.configuration}.yaml", "-g", "-q"]
    settings = ("data_logger_led=true", "save_data_period=0.2", f"data_filename={data}", "enable_console_logging=false")
    for setting in (f"simulation_time={example.end_s}", *settings, *example.settings):
        command += ["--set", setting]
    subprocess.run(command, cwd=ROOT, check=True)


def draw(folder: Path) -> dict[str, Picture]:
    """Run all and draw them in one figure."""
    figure = Figure(figsize=(12, 8.6), facecolor=PAPER, layout="constrained")
    drawn = []
    for axes, example in zip(figure.subplots(2, 3).flat, EXAMPLES, strict=True):
        data = folder / f"{example.name}.feather"
        run(example, data)
        swarm = read_swarm(data)
        draw_scene(axes, swarm, example.tail_s)
        drawn.append(swarm.rows)
        axes.set_title(f"{example.name}\n{example.shows}", color=INK, fontsize=11)
    return {"gallery.png": from_figure(figure, 80, *drawn)}
