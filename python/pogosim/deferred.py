"""What is imported when it is used for the first time, by modules that may not need it.

    from pogosim.deferred import pandas as pd  # a large package
    __getattr__, __dir__ = on_demand(__name__, {"Columns": "arrays"})  # names of a package of ours, and their modules

A window in a browser, for example, imports how columns are drawn, but no table comes before one is asked for.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Mapping
from types import ModuleType
from typing import TYPE_CHECKING, Any


class Deferred(ModuleType):
    """Stands for a module; imports it when an attribute is asked for."""

    def __getattr__(self, name: str) -> Any:
        """Return an attribute of the module.

        Raises:
            ImportError: The module cannot be imported.
            AttributeError: It has no such attribute.
        """
        return getattr(importlib.import_module(self.__name__), name)


def on_demand(package: str, modules: Mapping[str, str]) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Return the functions `__getattr__` and `__dir__` of a package that imports its modules when a name is asked for.

    Args:
        package: The name of the package.
        modules: The module of each name that the package offers.
    """

    def attribute(name: str) -> Any:
        if name not in modules:
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        found = getattr(importlib.import_module(f"{package}.{modules[name]}"), name)
        setattr(sys.modules[package], name, found)
        return found

    def names() -> list[str]:
        return sorted({*vars(sys.modules[package]), *modules})

    return attribute, names


if TYPE_CHECKING:
    import pandas as pandas
    import shapely as shapely
    from scipy import spatial as spatial
else:
    pandas, shapely, spatial = map(Deferred, ("pandas", "shapely", "scipy.spatial"))
