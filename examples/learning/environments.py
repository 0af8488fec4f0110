"""Two environments of the robots of main.c, whose actions come from Python: one looks for light, others gather."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from pogosim.learning import SwarmArrays, SwarmEnv

ROOT = Path(__file__).resolve().parents[2]
BRIGHTEST = 30000  # sensor counts, below the lamp
NEAR_MM = 200.0
# Numbers of a robot's observation, as main.c has them, each from -1 to 1.
OBSERVATIONS = ("light", "light ahead", "light to the right", "heard in front", "right", "back", "left")
ACTIONS = ("right motor", "left motor")


def commanded_robots(reward: Any, settings: dict[str, Any], **options: Any) -> SwarmEnv:
    """Return an environment of robots that observe, get an action each, and go on for 0.2 s, a hundred times."""
    return SwarmEnv(
        ROOT / "examples" / "learning" / "learning.so",
        ROOT / "conf" / "learning.yaml",
        observation=[("user_data.observation", -1, 1)],
        actions=[("user_data.action", -1, 1)],
        reward=reward,
        set={"parameters.is_commanded": True, **settings},
        **{"decision_s": 0.2, "end": 20.0, **options},
    )


def light_seeker(**options: Any) -> SwarmEnv:
    """Return an environment of one robot that starts anywhere: the brighter it is where it is, the better.

    The reward is the light at the robot, 0 to 1. `options`: as of `SwarmEnv`.
    """
    settings = {"objects.robots.nb": 1, "objects.lamp.value": BRIGHTEST}
    return commanded_robots(f"light / {BRIGHTEST}", settings, **options)


def nearness(swarm: SwarmArrays) -> npt.NDArray[np.float64]:
    """Return the mean of exp(-d / 200 mm) over the distances d of each robot to all others. Shape (runs, robots)."""
    places = swarm.positions.astype(np.float64)
    distances = np.hypot(*np.moveaxis(places[:, :, None] - places[:, None], -1, 0))
    near: npt.NDArray[np.float64] = np.exp(-distances / NEAR_MM).sum(axis=-1)
    return (near - 1.0) / max(1, swarm.robots - 1)  # each is at distance 0 from itself


def gathering(robots: int = 8, **options: Any) -> SwarmEnv:
    """Return an environment of robots that start anywhere in the dark: the nearer the others, the better.

    They know of each other by messages alone. The reward of each is `nearness`. `options`: as of `SwarmEnv`.
    """
    settings = {"objects.robots.nb": robots, "objects.lamp.value": 0}
    return commanded_robots(nearness, settings, **options)
