"""Large packages that are imported when they are used for the first time, by modules that may not need them.

    from pogosim.deferred import pandas as pd

A window in a browser, for example, imports how columns are drawn, but no table comes before one is asked for.
"""

from __future__ import annotations

import importlib
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


if TYPE_CHECKING:
    import pandas as pandas
    import shapely as shapely
    from scipy import spatial as spatial
else:
    pandas, shapely, spatial = map(Deferred, ("pandas", "shapely", "scipy.spatial"))
