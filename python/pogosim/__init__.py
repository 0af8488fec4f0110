"""Tools for the Pogosim simulator of Pogobot swarms, and the simulator itself: `pogosim.Simulation`."""

from __future__ import annotations

import importlib.util
import os
import warnings
from typing import TYPE_CHECKING, Any

import pogobot_simulator

if TYPE_CHECKING:
    from pogosim.simulation import (
        ConfigurationError,
        ProgramFailedError,
        Simulation,
        SimulationError,
        VectorSimulation,
    )

# Commands of a notebook (!python -m ...) inherit its backend, which matplotlib refuses where it is not installed.
IS_INLINE = os.environ.get("MPLBACKEND", "").startswith("module://matplotlib_inline")
if IS_INLINE and importlib.util.find_spec("matplotlib_inline") is None:
    os.environ["MPLBACKEND"] = "agg"

if _problem := pogobot_simulator.mixed(pogobot_simulator.OTHERS):
    raise ImportError(_problem)
if _problem := pogobot_simulator.beside(pogobot_simulator.OTHERS):
    warnings.warn_explicit(_problem, UserWarning, str(pogobot_simulator.FOLDER / "pogosim"), 1)

# A copy of that in include/pogosim/version.h: no build succeeds with another one, see cmake/version.cmake.
__version__ = "0.11.0"
__all__ = ["ConfigurationError", "ProgramFailedError", "Simulation", "SimulationError", "VectorSimulation"]


def __getattr__(name: str) -> Any:
    """Load the simulator when it is used for the first time: commands need not wait for it."""
    if name not in __all__:
        raise AttributeError(f"module 'pogosim' has no attribute '{name}'")
    import pogosim.simulation

    return getattr(pogosim.simulation, name)
