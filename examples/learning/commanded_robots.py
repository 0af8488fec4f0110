"""Robots of examples/learning whose actions come from Python: what the environments have in common."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pogosim

Array = npt.NDArray[np.float32]

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "examples" / "learning" / "learning.so"
CONFIGURATION = ROOT / "conf" / "learning.yaml"
WARNED: set[str] = set()  # by all environments: each warning is passed on once
DECISION_STEPS = 20  # time steps of 0.01 s from one action to the next
OBSERVATIONS = ("light", "light ahead", "light to the right", "heard in front", "right", "back", "left")
ACTIONS = ("left motor", "right motor")


def are_actions(actions: Sequence[npt.ArrayLike]) -> bool:
    """Tell whether each of the actions is as many finite numbers as it has to be."""
    try:
        numbers = np.asarray(actions, np.float64)
    except (TypeError, ValueError):
        return False
    return numbers.shape == (len(actions), len(ACTIONS)) and bool((np.abs(numbers) <= np.finfo(np.float32).max).all())


class CommandedRobots:
    """A swarm that observes, gets an action for each robot, and goes on for 0.2 s.

    Attributes:
        simulation: The run; None before the first reset.
    """

    def __init__(self, robots: int, lamp: float) -> None:
        """Prepare runs.

        Args:
            robots: How many there are.
            lamp: Light in its middle, sensor counts.
        """
        self.simulation: pogosim.Simulation | None = None
        self._settings = {
            "objects.robots.nb": robots,
            "objects.lamp.value": lamp,
            "parameters.is_commanded": True,
            "simulation_time": 1e6,  # the environment says when an episode is over
            "enable_data_logging": False,
        }

    def reset(self, seed: int) -> Array:
        """Begin a run. Returns the first observations, shape (robots, observations)."""
        if self.simulation is None:
            self.simulation = pogosim.Simulation(PROGRAM, CONFIGURATION, seed=seed, set=self._settings, warned=WARNED)
        else:
            self.simulation.reset(seed)
        # Views of what the robots read and write.
        self._action = self.simulation.user_data["action"]
        self._observation = self.simulation.user_data["observation"]
        return self._observation.copy()

    def act(self, actions: Sequence[npt.ArrayLike]) -> Array:
        """Do what the actions say, one for each robot. Returns the observations.

        Raises:
            ValueError: An action is not two finite numbers.
        """
        if self.simulation is None:
            raise RuntimeError("reset the environment before its first step")
        if not are_actions(actions):
            wrong = next(number for number, action in enumerate(actions) if not are_actions([action]))
            raise ValueError(
                f"the action of robot {wrong}: expected the powers of the {' and of the '.join(ACTIONS)}, finite "
                f"numbers from -1 to 1, found {actions[wrong]!r}"
            )
        self._action[:] = actions
        self.simulation.step(DECISION_STEPS)
        return self._observation.copy()

    def close(self) -> None:
        """End the run."""
        if self.simulation is not None:
            self.simulation.close()
            self.simulation = None
