"""Functions for scripts that were written for other Pogosim packages: tables of dataframes, by the names of the tables.

from pogosim.am import compute_polar_order  # or from pogosim.compat.am
rows, metadata = load_dataframe("result.feather")
print(compute_polar_order(rows))

Each table that an analysis writes, `NAME.csv`, is a function `compute_NAME(rows, metadata=None, **options)` of the
module that is named after the analysis: `am`, `locomotion`, `neighbors`, `network` and `coverage`. It returns what
`pogosim analyze` would write, with columns for the run, the arena and the varied parameters. `metadata` is needed only
if the rows have lost their `attrs`. Options are those of the command line, by the same names: `compute_psi_k(rows,
psi_k=4)`. These modules have the functions of `pogosim.analysis` that belong to the analysis, too.
"""

from __future__ import annotations

import importlib
from typing import Any

from pogosim.nearest_name import nearest_name

# Modules of pogosim.analysis whose functions each module has.
MODULES = {
    "am": (
        *("bond_order", "correlations", "directions", "flow", "fluctuations", "milling", "motion", "order"),
        "structure_factor",
    ),
    "coverage": ("coverage", "voronoi"),
    "locomotion": ("density", "displacement", "motion", "persistence"),
    "neighbors": ("listed_neighbours", "neighbourhood"),
    "network": ("laplacian", "network"),
}


def functions_of(module: str) -> dict[str, Any]:
    """Return the functions of a module of this package by name."""
    found: dict[str, Any] = importlib.import_module(f"pogosim.compat.{module}").FUNCTIONS
    return found


def attribute(module: str, name: str) -> Any:
    """Return a function of `pogosim.analysis` or of this package for `pogosim.MODULE.name`.

    Raises:
        AttributeError: There is none; the message names those that there are.
    """
    if name.startswith("_"):
        raise AttributeError(f"module 'pogosim.{module}' has no attribute '{name}'")
    for source in MODULES[module]:
        found = getattr(importlib.import_module(f"pogosim.analysis.{source}"), name, None)
        if getattr(found, "__module__", "") == f"pogosim.analysis.{source}":
            return found
    own = functions_of(module)
    if name in own:
        return own[name]
    near = nearest_name(name, own)
    question = f" (did you mean {near}?)" if near else ""
    raise AttributeError(
        f"module 'pogosim.{module}' has no function '{name}'{question}; beside its own functions, it has those of "
        f"pogosim.compat.{module}: {', '.join(own)}; see docs/porting.md"
    )
