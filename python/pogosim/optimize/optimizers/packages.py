"""Packages that only some optimisers need."""

from __future__ import annotations

import importlib
from typing import Any

from pogosim.extras import installing
from pogosim.optimize.errors import OptimizeError


def imported(name: str, optimizer: str) -> Any:
    """Import a package.

    Raises:
        OptimizeError: It is not installed; says how to install it.
    """
    try:
        return importlib.import_module(name)
    except ImportError:
        package = name.partition(".")[0]
        raise OptimizeError(
            f"--optimizer {optimizer} needs the Python package '{package}'; install it: {installing('optimize')}"
        ) from None
