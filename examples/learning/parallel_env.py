"""An environment of PettingZoo: robots that gather, each of them an agent."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from commanded_robots import ACTIONS, OBSERVATIONS, Array, CommandedRobots
from pogosim.extras import installing

try:
    from gymnasium import spaces
    from pettingzoo import ParallelEnv
except ImportError as error:
    message = f"this environment needs the Python package 'pettingzoo'; install it: {installing('learning')}"
    raise ImportError(message) from error

NEAR_MM = 200.0


class Gathering(ParallelEnv[str, Array, Array]):
    """Robots start anywhere in the dark; the nearer the others, the better. They know of them by messages alone.

    - Observation of each, shape (7,), each from -1 to 1: see `OBSERVATIONS`.
    - Action of each, shape (2,), each from -1 to 1: the power of the left and of the right motor.
    - Reward of each, for each step of 0.2 s: the mean of exp(-d / 200 mm) over the distances d to all others, 0 to 1.

    An episode is truncated after 100 steps, 20 s.
    """

    metadata = {"name": "pogosim_gathering_v0", "render_modes": []}  # noqa: RUF012 -- as PettingZoo has it

    def __init__(self, robots: int = 8, episode_steps: int = 100) -> None:
        """Describe the agents; the run begins with `reset`."""
        self.possible_agents = [f"robot_{i}" for i in range(robots)]
        self.agents: list[str] = []
        self.episode_steps = episode_steps
        self._observation_space = spaces.Box(-1.0, 1.0, (len(OBSERVATIONS),), np.float32)
        self.observation_spaces = dict.fromkeys(self.possible_agents, self._observation_space)
        self.action_spaces = {
            agent: spaces.Box(-1.0, 1.0, (len(ACTIONS),), np.float32) for agent in self.possible_agents
        }
        self._robots = CommandedRobots(robots, lamp=0.0)
        self._random = np.random.default_rng()
        self._step = 0

    def observation_space(self, agent: str) -> spaces.Space[Array]:
        """What an agent observes."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Space[Array]:
        """What an agent does."""
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Array], dict[str, dict[str, Any]]]:
        """Begin an episode. Equal seeds give equal episodes; without one, the next episode of the last seed."""
        del options
        if seed is not None:
            self._random = np.random.default_rng(seed)
        self._step = 0
        self.agents = list(self.possible_agents)
        observations = self._robots.reset(int(self._random.integers(2**32)))
        return dict(zip(self.agents, observations, strict=True)), {agent: {} for agent in self.agents}

    def step(
        self, actions: dict[str, Array]
    ) -> tuple[dict[str, Array], dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]]:
        """Drive for 0.2 s. Actions that are not two finite numbers for each agent raise ValueError."""
        if not self.agents:
            return {}, {}, {}, {}, {}
        if not isinstance(actions, Mapping) or actions.keys() != set(self.agents):
            found = ", ".join(map(str, actions)) if isinstance(actions, Mapping) else repr(actions)
            raise ValueError(f"actions: expected a map from each of the agents {', '.join(self.agents)}, found {found}")
        observations = self._robots.act([actions[agent] for agent in self.agents])
        self._step += 1
        agents, is_over = self.agents, self._step >= self.episode_steps
        if is_over:
            self.agents = []
        return (
            dict(zip(agents, observations, strict=True)),
            dict(zip(agents, self._nearness().tolist(), strict=True)),
            dict.fromkeys(agents, False),
            dict.fromkeys(agents, is_over),
            {agent: {} for agent in agents},
        )

    def _nearness(self) -> Array:
        assert self._robots.simulation is not None
        places = self._robots.simulation.positions
        distances = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1))
        near = np.exp(-distances / NEAR_MM)
        of_others: Array = (near.sum(axis=1) - 1.0) / max(1, len(places) - 1)  # each is at distance 0 from itself
        return of_others

    def close(self) -> None:
        """End the run."""
        self._robots.close()
