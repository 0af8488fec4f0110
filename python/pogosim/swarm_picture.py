"""Draw a run: trajectories, and the robots with their LEDs, at the end or at chosen times.

    python -m pogosim.swarm_picture results/demo/data.feather results/demo/swarm.png

Trails take the colour that the robot's head LED had at the time, and fade into the past. Objects have the shapes, and
the floor the light, that the configuration in the file's metadata says; membranes lie where their dots do
(serialize_dot_pose: true).
"""

from __future__ import annotations

import sys

from pogosim.errors import PictureError
from pogosim.picture.command import main
from pogosim.picture.figure import draw, notes, round_length, title
from pogosim.picture.layers import draw_scene, thinned, trail_segments
from pogosim.picture.palette import DARK_LED, FLOOR, INK, PAPER, led_brightness, led_colours
from pogosim.picture.swarm import Swarm, read_swarm

__all__ = [
    "DARK_LED",
    "FLOOR",
    "INK",
    "PAPER",
    "PictureError",
    "Swarm",
    "draw",
    "draw_scene",
    "led_brightness",
    "led_colours",
    "main",
    "notes",
    "read_swarm",
    "round_length",
    "thinned",
    "title",
    "trail_segments",
]


if __name__ == "__main__":
    sys.exit(main())
