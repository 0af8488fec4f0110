"""What scripts that were written for other Pogosim packages find here: functions and commands by other names.

from pogosim.am import compute_polar_order
rows, metadata = load_dataframe("result.feather")
print(compute_polar_order(rows))

Each table that an analysis writes, `NAME.csv`, is a function `compute_NAME(rows, metadata=None, **options)` of the
module that is named after the analysis: `am`, `locomotion`, `neighbors`, `network` and `coverage`. It returns what
`pogosim analyze` would write, with columns for the run, the arena and the varied parameters. `metadata` is needed only
if the rows have lost their `attrs`. Options are those of the command line, by the same names: `compute_psi_k(rows,
psi_k=4)`. These modules have the functions of `pogosim.analysis` that belong to the analysis, too.
"""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable, Sequence
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

# Analyses by the modules that are not named after them.
ANALYSES = {"am": "collective"}


def command(module: str, usual: str = "") -> Callable[..., int]:
    """Return the `main(arguments, prog)` of `python -m pogosim.MODULE`, which is `pogosim analyze ANALYSIS`.

    Args:
        module: Its name.
        usual: What messages call the command; empty: `python -m pogosim.MODULE`.
    """

    def main(arguments: Sequence[str] | None = None, prog: str = usual or f"python -m pogosim.{module}") -> int:
        """Run the command line. Returns the exit code."""
        from pogosim.reports.command import analyze

        return analyze(ANALYSES.get(module, module), arguments, prog)

    return main


def functions_of(module: str) -> dict[str, Any]:
    """Return the functions of the tables of a module by name."""
    from pogosim.compat.tables import FUNCTIONS  # takes a while

    found: dict[str, Any] = FUNCTIONS[module]
    return found


def attributes(module: str) -> Callable[[str], Any]:
    """Return what finds the functions of `pogosim.MODULE`: its `__getattr__`."""
    return functools.partial(attribute, module)


def attribute(module: str, name: str) -> Any:
    """Return a function of `pogosim.analysis` or of a table for `pogosim.MODULE.name`.

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
        f"pogosim.compat: {', '.join(own)}; see docs/porting.md"
    )
