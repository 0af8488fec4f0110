"""Environments for learning: `SwarmEnv`, many runs as plain arrays, and its interfaces for Gymnasium and PettingZoo."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pogosim.deferred import on_demand

if TYPE_CHECKING:
    from pogosim.learning.gymnasium_env import GymnasiumEnv
    from pogosim.learning.gymnasium_vector_env import GymnasiumVectorEnv
    from pogosim.learning.pettingzoo_env import PettingZooEnv
    from pogosim.learning.quantities import Quantity
    from pogosim.learning.swarm_arrays import SwarmArrays
    from pogosim.learning.swarm_env import EnvState, SwarmEnv

__all__ = [
    "EnvState",
    "GymnasiumEnv",
    "GymnasiumVectorEnv",
    "PettingZooEnv",
    "Quantity",
    "SwarmArrays",
    "SwarmEnv",
]

# The modules they are in, imported when one is asked for: Gymnasium and PettingZoo are optional packages.
MODULES = {
    "EnvState": "swarm_env",
    "GymnasiumEnv": "gymnasium_env",
    "GymnasiumVectorEnv": "gymnasium_vector_env",
    "PettingZooEnv": "pettingzoo_env",
    "Quantity": "quantities",
    "SwarmArrays": "swarm_arrays",
    "SwarmEnv": "swarm_env",
}
__getattr__, __dir__ = on_demand(__name__, MODULES)
