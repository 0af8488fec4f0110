"""Runs inside this process: `Simulation`, one run, and `VectorSimulation`, many at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pogosim.deferred import on_demand

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
__getattr__, __dir__ = on_demand(__name__, MODULES)
