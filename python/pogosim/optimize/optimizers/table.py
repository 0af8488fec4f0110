"""All optimisers by name. A new one is a class with `ask` and `tell`, and a line here."""

from __future__ import annotations

from pogosim.optimize.errors import OptimizeError
from pogosim.optimize.optimizers.base import Optimizer
from pogosim.optimize.optimizers.cmaes import CmaEs
from pogosim.optimize.optimizers.quality_diversity import CmaMae, CmaMe, MapElites
from pogosim.optimize.optimizers.random_search import RandomSearch
from pogosim.optimize.optimizers.tpe import Tpe
from pogosim.optimize.settings import Settings
from pogosim.optimize.variables import Space

OPTIMIZERS: dict[str, type[Optimizer]] = {
    "cmaes": CmaEs,
    "random": RandomSearch,
    "mapelites": MapElites,
    "cma_me": CmaMe,
    "cma_mae": CmaMae,
    "tpe": Tpe,
}
# Those that need features.
WITH_FEATURES = ("mapelites", "cma_me", "cma_mae")


def optimizer_for(space: Space, settings: Settings) -> Optimizer:
    """Return the optimiser that settings name.

    Raises:
        OptimizeError: There is none of that name, or it needs a package that is not installed.
    """
    if settings.optimizer not in OPTIMIZERS:
        raise OptimizeError(f"--optimizer: expected one of {', '.join(OPTIMIZERS)}; found '{settings.optimizer}'")
    return OPTIMIZERS[settings.optimizer](space, settings)
