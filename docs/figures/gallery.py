"""Six examples, each with its configuration.

    .venv/bin/python docs/figures/gallery.py

Needs the examples (./build.sh). Runs them and draws docs/gallery.png.
"""

from __future__ import annotations

import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure
from pogosim.swarm_picture import INK, PAPER, draw_scene, read_swarm

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Picture:
    """An example to run, and when to look."""

    example: str
    shows: str
    configuration: str
    end_s: float
    tail_s: float
    settings: tuple[str, ...] = ()


PICTURES = (
    Picture("phototaxis", "robots stay, in blue, where it is bright", "phototaxis", 30.0, 8.0),
    Picture("walls", "blue: heard the wall; yellow: heard the membrane", "walls_and_membranes", 14.0, 10.0),
    Picture("lighthouse_localization", "each knows where: the hue is its bearing", "lighthouse", 21.0, 6.0),
    Picture("vicsek", "a flock, coloured by heading", "vicsek", 60.0, 4.0),
    Picture("naming_game", "words spread, one will win", "naming_game", 2.2, 2.0),
    Picture("ssr", "robots have heard that this is an annulus", "ssr", 400.0, 5.0, ("arena_file=arenas/annulus.csv",)),
)


def run(picture: Picture, data: Path) -> None:
    """Run an example, with the colours of its LEDs in the data file."""
    command = [f"examples/{picture.example}/{picture.example}", "-c", f"conf/{picture.configuration}.yaml", "-g", "-q"]
    settings = ("data_logger_led=true", "save_data_period=0.2", f"data_filename={data}", "enable_console_logging=false")
    for setting in (f"simulation_time={picture.end_s}", *settings, *picture.settings):
        command += ["--set", setting]
    subprocess.run(command, cwd=ROOT, check=True)


def main() -> None:
    """Draw docs/gallery.png."""
    figure = Figure(figsize=(12, 8.6), facecolor=PAPER, layout="constrained")
    for axes, picture in zip(figure.subplots(2, 3).flat, PICTURES, strict=True):
        with tempfile.TemporaryDirectory() as folder:
            data = Path(folder) / "data.feather"
            run(picture, data)
            draw_scene(axes, read_swarm(data), picture.tail_s)
        axes.set_title(f"{picture.example}\n{picture.shows}", color=INK, fontsize=11)
    figure.savefig(ROOT / "docs" / "gallery.png", dpi=80)


if __name__ == "__main__":
    main()
