"""A `SwarmEnv` as a vector environment of Gymnasium."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.learning.interfaces import RENDER_MODES, ROBOT, Rendering, agent_is_robot, drive, needs, swarm_env
from pogosim.learning.swarm_env import SwarmEnv
from pogosim.simulation import ConfigurationError
from pogosim.simulation.errors import given

try:
    from gymnasium import spaces
    from gymnasium.vector import AutoresetMode, VectorEnv
    from gymnasium.vector.utils import batch_space
except ImportError as error:
    raise ImportError(needs("gymnasium")) from error

Array = npt.NDArray[Any]


class GymnasiumVectorEnv(VectorEnv[Array, Array, Array]):
    """Many runs at once for learners of Gymnasium.

        envs = GymnasiumVectorEnv(SwarmEnv(None, "conf.yaml", ..., runs=16))

    With each="robot", each robot of each run is an environment of its own: all share a policy, and those of a run begin
    and end together. There are runs * robots, robots of a run side by side, with observations of shape (inputs,). With
    each="run", there are as many as runs, with observations of shape (robots, inputs), and rewards are means of the
    robots'.

    Attributes:
        swarm_env: The environment of arrays.
    """

    def __init__(self, env: SwarmEnv, each: str = ROBOT, render_mode: str | None = None) -> None:
        """Describe observations and actions.

        Args:
            env: Its `autoreset` is that of this one.
            each: What an agent is: "robot" or "run".
            render_mode: None, "rgb_array", or "human": the first run, see `GymnasiumEnv`.

        Raises:
            ConfigurationError: An argument is wrong, or an interface drives the environment already.
        """
        self.swarm_env = swarm_env(env)
        self._is_robot = agent_is_robot(each, env)
        self._agents = env.robots if self._is_robot else 1  # of a run
        self.num_envs = len(env) * self._agents
        self.metadata = {
            "render_modes": list(RENDER_MODES),
            "render_fps": round(1 / env.decision_s),
            "autoreset_mode": AutoresetMode(env.autoreset),
        }
        self.render_mode = render_mode
        self._rendering = Rendering(env, render_mode)
        self.single_observation_space = self._box(env.observation_low, env.observation_high)
        self.single_action_space = self._box(env.action_low, env.action_high)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        drive(env, self, env.autoreset)

    def _box(self, low: Array, high: Array) -> spaces.Box:
        shape = () if self._is_robot else (self.swarm_env.robots,)
        return spaces.Box(np.broadcast_to(low, (*shape, len(low))), np.broadcast_to(high, (*shape, len(high))))

    def _own(self, of_runs: Array) -> Array:
        """Return a copy of what the agents see. Shape of `of_runs`: (runs, robots, inputs)."""
        return of_runs.reshape(-1, of_runs.shape[-1]).copy() if self._is_robot else of_runs.copy()

    def _repeated(self, of_runs: Array) -> Array:
        """Return what holds of a run for each of its agents."""
        return np.repeat(of_runs, self._agents)

    def _infos(self, info: dict[str, Any], has: Array) -> dict[str, Any]:
        """Return `info` as vector environments have it. `has`: which agents it is of."""
        infos: dict[str, Any] = {"seed": np.where(has, self._repeated(info["seed"]), 0), "_seed": has}
        if info["randomized"]:
            infos["randomized"] = {"_" + key: has for key in info["randomized"]} | {
                key: self._repeated(values) for key, values in info["randomized"].items()
            }
            infos["_randomized"] = has
        return infos

    def reset(
        self, *, seed: int | list[int] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Array, dict[str, Any]]:
        """Begin episodes.

        Args:
            seed: As of `SwarmEnv.reset`.
            options: {"reset_mask": which environments begin anew, of shape (num_envs,)}; None: all.

        Raises:
            ConfigurationError: An argument is wrong, or a mask parts the robots of a run.
        """
        super().reset(seed=seed if isinstance(seed, int) else None)
        if options is not None and not isinstance(options, Mapping):
            raise given.refused("options", "a map", options)
        mask = (options or {}).get("reset_mask")
        which = None if mask is None else self._runs_of(mask)
        observation, info = self.swarm_env.reset(seed, which)
        self._rendering.after_reset()
        has = np.ones(self.num_envs, dtype=np.bool_) if which is None else self._repeated(which)
        return self._own(observation), self._infos(info, has)

    def _runs_of(self, mask: Any) -> npt.NDArray[np.bool_]:
        """Return the runs that a mask of agents chooses."""
        if not isinstance(mask, np.ndarray) or mask.shape != (self.num_envs,) or mask.dtype != np.bool_:
            raise given.refused("options['reset_mask']", f"an array of {self.num_envs} booleans", mask)
        by_run = mask.reshape(len(self.swarm_env), self._agents)
        if (by_run != by_run[:, :1]).any():
            raise ConfigurationError("options['reset_mask']: robots of a run begin together")
        return by_run[:, 0]

    def step(self, actions: Array) -> tuple[Array, Array, Array, Array, dict[str, Any]]:
        """Act for `decision_s`, see `SwarmEnv.step`."""
        given_actions = np.asarray(actions)
        if self._is_robot and given_actions.shape[:1] == (self.num_envs,):
            given_actions = given_actions.reshape(len(self.swarm_env), self._agents, *given_actions.shape[1:])
        observation, reward, terminated, truncated, info = self.swarm_env.step(given_actions)
        self._rendering.after_step()
        infos = self._infos(info, np.ones(self.num_envs, dtype=np.bool_))
        if "final_obs" in info:
            has_ended = self._repeated(terminated | truncated)
            last = np.full(self.num_envs, None, dtype=object)
            last_observation = self._own(info["final_obs"])
            for agent in np.flatnonzero(has_ended):
                last[agent] = last_observation[agent]
            infos |= {"final_obs": last, "_final_obs": has_ended}
            infos |= {"final_info": self._infos(info["final_info"], has_ended), "_final_info": has_ended}
        return (
            self._own(observation),
            reward.reshape(-1) if self._is_robot else reward.mean(axis=1),
            self._repeated(terminated),
            self._repeated(truncated),
            infos,
        )

    def render(self) -> tuple[npt.NDArray[np.uint8], ...] | None:
        """Return a picture of each run, shape (800, 800, 3); None in another mode than "rgb_array"."""
        pictures = [self._rendering.picture(run) for run in range(len(self.swarm_env))]
        return tuple(picture for picture in pictures if picture is not None) or None

    def close_extras(self, **kwargs: Any) -> None:  # noqa: ARG002 -- as Gymnasium has it
        """End all runs."""
        self._rendering.close()
        self.swarm_env.close()
