"""A `SwarmEnv` of one run as an environment of Gymnasium."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.arguments import without_numpy
from pogosim.learning.interfaces import RENDER_MODES, RUN, Rendering, agent_is_robot, drive, info_of_run, needs, one_run
from pogosim.learning.swarm_env import DISABLED, SwarmEnv

try:
    import gymnasium
    from gymnasium import spaces
except ImportError as error:
    raise ImportError(needs("gymnasium")) from error

Array = npt.NDArray[np.float32]


class GymnasiumEnv(gymnasium.Env[Array, Array]):
    """One swarm, or one robot, for learners of Gymnasium.

        env = GymnasiumEnv(SwarmEnv(None, "conf.yaml", ...))

    With each="run", observations have the shape (robots, inputs), actions (robots, outputs), and the reward is the mean
    of the robots'. With each="robot", for a swarm of one, shapes are (inputs,) and (outputs,).

    Attributes:
        swarm_env: The environment of arrays. It does not begin episodes anew by itself any more.
    """

    metadata: dict[str, Any] = {"render_modes": list(RENDER_MODES)}  # noqa: RUF012 -- as Gymnasium has it

    def __init__(self, env: SwarmEnv, each: str = RUN, render_mode: str | None = None) -> None:
        """Describe observations and actions.

        Args:
            env: With one run.
            each: What the agent is: "run", all robots, or "robot".
            render_mode: None, "rgb_array", or "human": a page in a browser, or a view in a notebook, in real time.

        Raises:
            ConfigurationError: An interface drives it already, there are more runs, or with each="robot" more robots.
        """
        self.swarm_env = one_run(env)
        self._is_robot = agent_is_robot(each, env, most=1)
        self.metadata = {**self.metadata, "render_fps": round(1 / env.decision_s)}
        self.render_mode = render_mode
        self._rendering = Rendering(env, render_mode)
        self.observation_space = self._box(env.observation_low, env.observation_high)
        self.action_space = self._box(env.action_low, env.action_high)
        drive(env, self, DISABLED)

    def _box(self, low: Array, high: Array) -> Any:
        if self._is_robot:
            return spaces.Box(low, high, dtype=np.float32)
        robots = self.swarm_env.robots
        return spaces.Box(np.tile(low, (robots, 1)), np.tile(high, (robots, 1)), dtype=np.float32)

    def _own(self, of_run: Array) -> Array:
        """Return a copy of what the agent sees. Shape of `of_run`: (robots, inputs)."""
        return of_run[0].copy() if self._is_robot else of_run.copy()

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        """Begin an episode, see `SwarmEnv.reset`. Equal seeds give equal episodes."""
        seed = without_numpy(seed)
        super().reset(seed=seed, options=options)
        observation, info = self.swarm_env.reset(seed)
        self._rendering.after_reset()
        return self._own(observation[0]), info_of_run(info)

    def step(self, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        """Act for `decision_s`, see `SwarmEnv.step`."""
        actions = np.asarray(action)[None]
        observation, reward, terminated, truncated, info = self.swarm_env.step(
            actions[None] if self._is_robot else actions
        )
        self._rendering.after_step()
        return (
            self._own(observation[0]),
            float(reward.mean()),
            bool(terminated[0]),
            bool(truncated[0]),
            info_of_run(info),
        )

    def render(self) -> npt.NDArray[np.uint8] | None:
        """Return a picture of the arena, shape (800, 800, 3); None in another mode."""
        return self._rendering.picture()

    def close(self) -> None:
        """End the run."""
        self._rendering.close()
        self.swarm_env.close()
