"""Runs inside this process: `Simulation`, one run, and `VectorSimulation`, many at once."""

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
