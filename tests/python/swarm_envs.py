"""Environments of a small swarm for tests."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from pogosim.learning import SwarmEnv
from running import scene

ROBOTS = 3
SETTINGS: dict[str, Any] = {
    "simulation_time": 10,
    "time_step": 0.01,
    "arena_surface": 1e6,
    "objects.robots.nb": ROBOTS,
    "objects.robots.msg_success_rate": {"type": "static", "rate": 1.0},
    "objects.lamp": {
        "type": "static_light", "light_mode": "gradient", "geometry": "disk", "radius": 1200,
        "x": 500, "y": 500, "value": 1000, "gradient_radius": 900,
    },
}  # fmt: skip


def hosted_env(changes: dict[str, Any] | None = None, **options: Any) -> SwarmEnv:
    """Return an environment of robots that this process drives, in a scene with some keys changed."""
    usual: dict[str, Any] = {"observation": ["photosensors"], "actions": ["motors"], "reward": "light", "end": 1.0}
    return SwarmEnv(None, scene(SETTINGS | (changes or {})), **usual | options)


def any_actions(env: SwarmEnv, seed: int) -> npt.NDArray[np.float64]:
    """Return actions in their ranges."""
    shape = (len(env), env.robots, len(env.outputs))
    return np.random.default_rng(seed).uniform(env.action_low, env.action_high, shape)


def history(env: SwarmEnv, seed: Any, steps: int) -> list[Any]:
    """Return all that some steps with any actions give, copied."""
    found: list[Any] = [env.reset(seed=seed)[0].copy()]
    for step in range(steps):
        observation, *rest, info = env.step(any_actions(env, step))
        found += [observation.copy(), *rest, info["seed"]]
    return found


def are_equal(a: list[Any], b: list[Any]) -> bool:
    """Tell whether arrays are the same, bit for bit."""
    return len(a) == len(b) and all(np.array_equal(one, other) for one, other in zip(a, b, strict=True))
