"""All optimisers by name. A new one is a class with `ask`, `begin` and `tell`, and a line here."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from pogosim.optimize.errors import OptimizeError

if TYPE_CHECKING:
    from pogosim.optimize.optimizers.base import Optimizer
    from pogosim.optimize.settings import Settings
    from pogosim.optimize.variables import Space

# Module in this folder, and class; imported when it is used.
OPTIMIZERS = {
    "cmaes": ("cmaes", "CmaEs"),
    "random": ("random_search", "RandomSearch"),
    "mapelites": ("quality_diversity", "MapElites"),
    "cma_me": ("quality_diversity", "CmaMe"),
    "cma_mae": ("quality_diversity", "CmaMae"),
    "tpe": ("tpe", "Tpe"),
}
# Those that need features.
WITH_FEATURES = ("mapelites", "cma_me", "cma_mae")


def check_optimizer(settings: Settings) -> None:
    """Check the name of an optimiser.

    Raises:
        OptimizeError: There is none of that name.
    """
    if settings.optimizer not in OPTIMIZERS:
        known = ", ".join(OPTIMIZERS)
        place = settings.place_of("optimizer")
        raise OptimizeError(f"{place}: expected one of {known}; found '{settings.optimizer}'")


def optimizer_for(space: Space, settings: Settings) -> Optimizer:
    """Return the optimiser that settings name.

    Raises:
        OptimizeError: There is none of that name, or it needs a package that is not installed.
    """
    check_optimizer(settings)
    module, name = OPTIMIZERS[settings.optimizer]
    chosen: Any = getattr(importlib.import_module(f"pogosim.optimize.optimizers.{module}"), name)
    made: Optimizer = chosen(space, settings)
    return made
