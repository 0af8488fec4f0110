"""All optimisers by name. A new one is a class with `ask`, `begin` and `tell`, and a line here, or an entry point."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pogosim.errors import OptimizeError
from pogosim.extensions import ExtensionError, Own, Table, takes

if TYPE_CHECKING:
    from pogosim.optimize.optimizers.base import Optimizer
    from pogosim.optimize.settings import Settings
    from pogosim.optimize.variables import Space


def is_optimizer(found: Any) -> bool:
    """Tell whether something makes optimisers."""
    methods = all(callable(getattr(found, name, None)) for name in ("ask", "begin", "tell"))
    return isinstance(found, type) and methods and takes(found, "space", "settings")


IN_THIS_FOLDER = "pogosim.optimize.optimizers"
OPTIMIZERS = Table(
    "pogosim.optimizers",
    "optimiser",
    "a class, made of a space and settings, with ask(), begin() and tell()",
    is_optimizer,
    {
        "cmaes": Own(f"{IN_THIS_FOLDER}.cmaes:CmaEs"),
        "random": Own(f"{IN_THIS_FOLDER}.random_search:RandomSearch"),
        "mapelites": Own(f"{IN_THIS_FOLDER}.quality_diversity:MapElites"),
        "cma_me": Own(f"{IN_THIS_FOLDER}.quality_diversity:CmaMe"),
        "cma_mae": Own(f"{IN_THIS_FOLDER}.quality_diversity:CmaMae"),
        "tpe": Own(f"{IN_THIS_FOLDER}.tpe:Tpe"),
    },
)


def check_optimizer(settings: Settings) -> None:
    """Check the name of an optimiser, without importing it.

    Raises:
        OptimizeError: There is none of that name, or several packages have one.
    """
    place = settings.place_of("optimizer")
    try:
        if OPTIMIZERS.find(settings.optimizer) is None:
            known = ", ".join(OPTIMIZERS.names())
            raise OptimizeError(f"{place}: expected one of {known}; found '{settings.optimizer}'")
    except ExtensionError as error:
        raise OptimizeError(f"{place}: {error}") from None


def optimizer_for(space: Space, settings: Settings) -> Optimizer:
    """Return the optimiser that settings name.

    Raises:
        OptimizeError: There is none of that name, it cannot be imported, or it needs a package that is not installed.
        PackageFailedError: It is of another package, and cannot be made.
    """
    check_optimizer(settings)
    try:
        kind = OPTIMIZERS.load(settings.optimizer)
        with OPTIMIZERS.calling(settings.optimizer):
            made: Optimizer = kind(space, settings)
    except ExtensionError as error:
        raise OptimizeError(f"{settings.place_of('optimizer')}: {error}") from None
    return made
