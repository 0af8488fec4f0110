"""What the interfaces for Gymnasium and PettingZoo have in common."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.extras import installing
from pogosim.learning.human_view import HumanView
from pogosim.learning.swarm_env import SwarmEnv
from pogosim.simulation import ConfigurationError
from pogosim.simulation.errors import given

RENDER_MODES = ("rgb_array", "human")
RUN, ROBOT = "run", "robot"


def needs(package: str) -> str:
    """Return what is said where an optional package is missing."""
    return f"this environment needs the Python package '{package}'; install it: {installing('learning')}"


def swarm_env(env: Any) -> SwarmEnv:
    """Return an environment of plain arrays that no interface drives.

    Raises:
        ConfigurationError: It is none, or one drives it: both would step the same runs.
    """
    if not isinstance(env, SwarmEnv):
        raise given.refused("env", "a SwarmEnv", env)
    if env.interface:
        raise ConfigurationError(f"env: a {env.interface} drives this SwarmEnv: make another one")
    return env


def one_run(env: Any) -> SwarmEnv:
    """Return an environment with one run that no interface drives.

    Raises:
        ConfigurationError: It is none, or has more runs.
    """
    swarm = swarm_env(env)
    if len(swarm) != 1:
        raise ConfigurationError(f"env: expected a SwarmEnv with runs=1, found {len(swarm)}: use GymnasiumVectorEnv")
    return swarm


def drive(env: SwarmEnv, interface: object, autoreset: str) -> None:
    """Let an interface drive an environment, whose episodes begin anew as it says from now on."""
    env.interface = type(interface).__name__
    env.autoreset = autoreset


def agent_is_robot(each: Any, env: SwarmEnv, *, most: int | None = None) -> bool:
    """Tell whether each robot, and not each run, is an agent.

    Args:
        each: "run" or "robot".
        env: The environment.
        most: How many robots a run may have if each is an agent; None: any number.

    Raises:
        ConfigurationError: It is another word, or there are more robots.
    """
    if each not in (RUN, ROBOT):
        raise given.refused("each", f"{RUN!r} or {ROBOT!r}", each)
    if each == ROBOT and most is not None and env.robots > most:
        raise ConfigurationError(
            f"each={ROBOT!r}: expected one robot {env.swarm.category!r}, found {env.robots}: use PettingZooEnv or "
            f"GymnasiumVectorEnv, or each={RUN!r}"
        )
    return bool(each == ROBOT)


class Rendering:
    """Pictures of the first run, or a view of it on the screen."""

    def __init__(self, env: SwarmEnv, mode: Any) -> None:
        """Take note of how.

        Raises:
            ConfigurationError: The mode is not one of RENDER_MODES or None.
        """
        if mode not in (None, *RENDER_MODES):
            raise given.refused("render_mode", "None, 'rgb_array' or 'human'", mode)
        self._env = env
        self._mode = mode
        self._view: HumanView | None = None

    def after_reset(self) -> None:
        """Show the run, if a person looks."""
        if self._mode == "human" and self._view is None:
            self._view = HumanView(self._env.runs[0])

    def after_step(self) -> None:
        """Go on in real time, if a person looks."""
        if self._view is not None:
            self._view.wait(self._env.decision_s)

    def picture(self, run: int = 0) -> npt.NDArray[np.uint8] | None:
        """Return a picture, shape (800, 800, 3); None in another mode."""
        return self._env.render(run) if self._mode == "rgb_array" else None

    def close(self) -> None:
        """Show it no more."""
        if self._view is not None:
            self._view.close()
            self._view = None


def info_of_run(info: dict[str, Any], run: int = 0) -> dict[str, Any]:
    """Return what `info` says of one run."""
    drawn = {key: values[run] for key, values in info["randomized"].items()}
    return {"seed": int(info["seed"][run]), **({"randomized": drawn} if drawn else {})}
