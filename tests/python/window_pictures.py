"""What the window looks like, in pictures stored beside this file; test_window.py compares. To store them anew, and
then look at each:

    .venv/bin/python tests/python/window_pictures.py
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

import numpy as np
from display import Display, Picture, Shown, open_display, shown
from PIL import Image
from running import PROGRAMS, compile_program

FOLDER = Path(__file__).parent / "window_pictures"

# The first step is not due for years: the window shows time 0. Four robots in a square of 1 m.
SCENE: dict[str, object] = {
    "GUI_speed_up": 1.0e-6,
    "simulation_time": 10.0,
    "save_data_period": 0.01,
    "arena_file": "arenas/square.csv",
    "objects.robots.nb": 4,
    "objects.robots.poses": [[180, 520, 0], [270, 520, 1], [180, 850, 2], [540, 850, 3]],
    "objects.wall": {"type": "pogowall", "geometry": "arena"},
    "objects.block": {"type": "passive_object", "geometry": "rectangle", "poses": [[400, 870, 0.4]], "body_width": 90},
    "objects.ring": {"type": "membrane", "geometry": "disk", "radius": 90, "poses": [[860, 860]]},
    "objects.lamp": {
        "type": "static_light",
        "geometry": "disk",
        "radius": 220,
        "light_mode": "gradient",
        "value": 1000,
        "x": 800,
        "y": 250,
    },
}

# Pixels of the panel "Run".
PLACES = {"header View": (100, 168), "plot": (24, 322)}

# What is pressed and clicked, by name of the picture.
PICTURES: dict[str, list[str]] = {
    "start": [],
    "no_panels": ["F9"],
    "help": ["F1"],
    "light_and_channels": ["F9", "F7", "F5"],
    "plain": ["F9", "F6", "F8"],
    "inspector": ["space", *["s"] * 30, "robot"],
    "plot": ["space", *["s"] * 30, "header View", "plot", "robot"],
    "zoomed": ["F9", "plus", "plus", "plus", "plus", "plus", "Right", "Down"],
}


def robot_pixel(picture: Picture) -> tuple[float, float]:
    """Return where robot 0 is: the arena fills 95 % of the window."""
    height, width = picture.shape[:2]
    scale = 0.95 * min(width, height) / 1000
    return width / 2 + (180 - 500) * scale, height / 2 + (520 - 500) * scale


def settled(window: Shown) -> Picture:
    """Wait until the picture stays the same."""
    last = window.shot()
    for _ in range(100):
        time.sleep(0.25)
        now = window.shot()
        if now.shape == last.shape and bool((now == last).all()):
            return now
        last = now
    raise AssertionError("the picture never stays the same")


def take(display: Display, program: Path, folder: Path, name: str) -> Picture:
    """Take the picture of a name."""
    with shown(display, program, folder, SCENE) as window:
        first = settled(window)
        for key in PICTURES[name]:
            if key == "robot":
                window.click(*robot_pixel(first))
            elif key in PLACES:
                window.click(*PLACES[key])
                settled(window)  # what comes next is where it will be clicked
            else:
                window.keys(key)
        time.sleep(0.3)
        window.move_mouse(first.shape[1] - 2, first.shape[0] / 2)
        time.sleep(0.5)  # what was under the mouse goes dark again, on a busy machine not at once
        return settled(window)


def difference(a: Picture, b: Picture) -> float:
    """Share of the pixels that a person could tell apart: a channel differs by more than 24 of 255."""
    if a.shape != b.shape:
        return 1.0
    return float((np.abs(a.astype(int) - b.astype(int)).max(axis=-1) > 24).mean())


def main() -> None:
    """Store all pictures anew."""
    FOLDER.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder, open_display() as display:
        program = compile_program(Path(folder) / "window", PROGRAMS / "window.c")
        for name in PICTURES:
            Image.fromarray(take(display, program, Path(folder) / name, name)).save(
                FOLDER / f"{name}.png", optimize=True
            )


if __name__ == "__main__":
    main()
