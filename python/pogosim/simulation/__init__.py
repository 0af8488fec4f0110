"""Runs inside this process: `Simulation`, one run, and `VectorSimulation`, many at once."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pogosim.simulation.arrays import Columns
    from pogosim.simulation.brain import Brain
    from pogosim.simulation.errors import ConfigurationError, ProgramFailedError, SimulationError
    from pogosim.simulation.run import Simulation
    from pogosim.simulation.saved_state import SavedState
    from pogosim.simulation.vector import VectorSimulation

__all__ = [
    "Brain",
    "Columns",
    "ConfigurationError",
    "ProgramFailedError",
    "SavedState",
    "Simulation",
    "SimulationError",
    "VectorSimulation",
]

# The modules they are in, which are imported when one is asked for: a command may need the errors only.
MODULES = {
    "Brain": "brain",
    "Columns": "arrays",
    "ConfigurationError": "errors",
    "ProgramFailedError": "errors",
    "SavedState": "saved_state",
    "Simulation": "run",
    "SimulationError": "errors",
    "VectorSimulation": "vector",
}


def __getattr__(name: str) -> Any:
    """Return what is used for the first time."""
    if name not in MODULES:
        raise AttributeError(f"module 'pogosim.simulation' has no attribute '{name}'")
    found = getattr(importlib.import_module(f"pogosim.simulation.{MODULES[name]}"), name)
    globals()[name] = found
    return found
