"""An environment of Gymnasium: one robot that looks for light."""

from __future__ import annotations

import time
import webbrowser
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from commanded_robots import ACTIONS, OBSERVATIONS, Array, CommandedRobots
from pogosim.extras import installing

try:
    import gymnasium
    from gymnasium import spaces
except ImportError as error:
    message = f"this environment needs the Python package 'gymnasium'; install it: {installing('learning')}"
    raise ImportError(message) from error

if TYPE_CHECKING:
    from pogosim.watch.serving import LivePage

BRIGHTEST = 30000.0  # sensor counts, below the lamp


class LightSeeker(gymnasium.Env[Array, Array]):
    """One robot starts anywhere in the arena; the brighter it is where it is, the better.

    - Observation, shape (7,), each from -1 to 1: see `OBSERVATIONS`. The robot hears no others.
    - Action, shape (2,), each from -1 to 1: the power of the left and of the right motor.
    - Reward of each step of 0.2 s: the light at the robot, 0 to 1.

    An episode is truncated after 100 steps, 20 s.
    """

    metadata = {"render_modes": ["rgb_array", "human"], "render_fps": 5}  # noqa: RUF012 -- as Gymnasium has it

    def __init__(self, episode_steps: int = 100, render_mode: str | None = None) -> None:
        """Describe observations and actions; the run begins with `reset`.

        `render_mode`: None, "rgb_array", or "human": a page in a browser, in real time.
        """
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise ValueError(f"render_mode: expected None, 'rgb_array' or 'human', found {render_mode!r}")
        self.render_mode = render_mode
        self._page: LivePage | None = None
        self.observation_space = spaces.Box(-1.0, 1.0, (len(OBSERVATIONS),), np.float32)
        self.action_space = spaces.Box(-1.0, 1.0, (len(ACTIONS),), np.float32)
        self.episode_steps = episode_steps
        self._robots = CommandedRobots(1, BRIGHTEST)
        self._step = 0

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        """Begin an episode. Equal seeds give equal episodes."""
        super().reset(seed=seed, options=options)
        self._step = 0
        observation = self._robots.reset(int(self.np_random.integers(2**32)))[0]
        if self.render_mode == "human" and self._page is None:
            from pogosim.watch.serving import LivePage  # needs the package websockets

            assert self._robots.simulation is not None
            self._page = LivePage(self._robots.simulation)
            webbrowser.open(self._page.address)
        return observation, {}

    def step(self, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        """Drive for 0.2 s. Powers beyond -1 and 1 count as these; what is no two finite numbers raises ValueError."""
        if self.render_mode == "human":
            time.sleep(1.0 / self.metadata["render_fps"])
        (observation,) = self._robots.act([action])
        self._step += 1
        return observation, self._light(), False, self._step >= self.episode_steps, {}

    def _light(self) -> float:
        assert self._robots.simulation is not None
        return float(self._robots.simulation.light_levels[0]) / BRIGHTEST

    def render(self) -> npt.NDArray[np.uint8] | None:
        """Return a picture of the arena, shape (800, 800, 3); None in another mode, and before `reset`."""
        simulation = self._robots.simulation
        return None if self.render_mode != "rgb_array" or simulation is None else simulation.render()

    def close(self) -> None:
        """End the run."""
        if self._page is not None:
            self._page.close()
            self._page = None
        self._robots.close()
