"""A `SwarmEnv` of one run as a parallel environment of PettingZoo: each robot is an agent."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.arguments import shown
from pogosim.learning.interfaces import RENDER_MODES, Rendering, drive, info_of_run, needs, one_run
from pogosim.learning.swarm_env import DISABLED, SwarmEnv
from pogosim.simulation import ConfigurationError

try:
    from gymnasium import spaces
    from pettingzoo import ParallelEnv
except ImportError as error:
    raise ImportError(needs("pettingzoo")) from error

Array = npt.NDArray[np.float32]
Infos = dict[str, dict[str, Any]]


class PettingZooEnv(ParallelEnv[str, Array, Array]):
    """A swarm whose robots are agents: "robot_0", "robot_1", ...

        env = PettingZooEnv(SwarmEnv(None, "conf.yaml", ...))

    Observations have the shape (inputs,), and actions (outputs,). All agents begin and end together.

    Attributes:
        swarm_env: The environment of arrays. It does not begin episodes anew by itself any more.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 -- as PettingZoo has it
        "name": "pogosim_swarm_v0",
        "render_modes": list(RENDER_MODES),
    }

    def __init__(self, env: SwarmEnv, render_mode: str | None = None) -> None:
        """Describe the agents.

        Args:
            env: With one run.
            render_mode: As of `GymnasiumEnv`.

        Raises:
            ConfigurationError: An interface drives it already, there are more runs.
        """
        self.swarm_env = one_run(env)
        self.metadata = {**self.metadata, "render_fps": round(1 / env.decision_s)}
        self.render_mode = render_mode
        self._rendering = Rendering(env, render_mode)
        self.possible_agents = [f"robot_{robot}" for robot in range(env.robots)]
        self.agents: list[str] = []
        self.observation_spaces = {
            agent: spaces.Box(env.observation_low, env.observation_high) for agent in self.possible_agents
        }
        self.action_spaces = {agent: spaces.Box(env.action_low, env.action_high) for agent in self.possible_agents}
        drive(env, self, DISABLED)

    def observation_space(self, agent: str) -> spaces.Space[Array]:
        """What an agent sees."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Space[Array]:
        """What an agent does."""
        return self.action_spaces[agent]

    def _by_agent(self, of_robots: npt.NDArray[Any]) -> dict[str, Any]:
        return dict(zip(self.possible_agents, of_robots.copy(), strict=True))

    def _infos(self, info: dict[str, Any]) -> Infos:
        return {agent: info_of_run(info) for agent in self.possible_agents}

    def reset(self, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[dict[str, Array], Infos]:
        """Begin an episode, see `SwarmEnv.reset`. Equal seeds give equal episodes; None: the next one."""
        del options
        observation, info = self.swarm_env.reset(seed)
        self._rendering.after_reset()
        self.agents = list(self.possible_agents)
        return self._by_agent(observation[0]), self._infos(info)

    def step(
        self, actions: Mapping[str, Array]
    ) -> tuple[dict[str, Array], dict[str, float], dict[str, bool], dict[str, bool], Infos]:
        """Act for `decision_s`, see `SwarmEnv.step`. After the end of an episode, all maps are empty.

        Raises:
            ConfigurationError: The actions are not those of all agents.
        """
        if not self.agents:
            return {}, {}, {}, {}, {}
        if not isinstance(actions, Mapping) or actions.keys() != set(self.agents):
            found = ", ".join(map(str, actions)) if isinstance(actions, Mapping) else shown(actions)
            raise ConfigurationError(
                f"actions: expected a map from each of the agents {', '.join(self.agents)}, found {found}"
            )
        of_robots = [actions[agent] for agent in self.agents]
        observation, reward, terminated, truncated, info = self.swarm_env.step([of_robots])
        self._rendering.after_step()
        agents = self.agents
        if terminated[0] or truncated[0]:
            self.agents = []
        return (
            self._by_agent(observation[0]),
            dict(zip(agents, reward[0].tolist(), strict=True)),
            dict.fromkeys(agents, bool(terminated[0])),
            dict.fromkeys(agents, bool(truncated[0])),
            self._infos(info),
        )

    def render(self) -> npt.NDArray[np.uint8] | None:
        """Return a picture of the arena, shape (800, 800, 3); None in another mode."""
        return self._rendering.picture()

    def close(self) -> None:
        """End the run."""
        self._rendering.close()
        self.swarm_env.close()
