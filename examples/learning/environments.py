"""Two environments of the robots of main.c, whose actions come from Python: one looks for light, others gather."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pogosim.learning import SwarmEnv
from pogosim.learning.tasks import nearness

ROOT = Path(__file__).resolve().parents[2]
BRIGHTEST = 30000  # sensor counts, below the lamp
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


def gathering(robots: int = 8, **options: Any) -> SwarmEnv:
    """Return an environment of robots that start anywhere in the dark: the nearer the others, the better.

    They know of each other by messages alone. The reward of each is `nearness`. `options`: as of `SwarmEnv`.
    """
    settings = {"objects.robots.nb": robots, "objects.lamp.value": 0}
    return commanded_robots(nearness, settings, **options)
