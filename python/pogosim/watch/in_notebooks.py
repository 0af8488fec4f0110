"""What a notebook shows for a run in the last line of a cell."""

from __future__ import annotations

import importlib.util
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pogosim.simulation import Simulation


def is_in_notebook() -> bool:
    """Tell whether this process is the kernel of a notebook."""
    shell = sys.modules.get("IPython")
    own = shell.get_ipython() if shell is not None else None
    return getattr(own, "kernel", None) is not None


def show(simulation: Simulation) -> None:
    """Show a live view.

    Raises:
        NotImplementedError: There is none here: IPython shows a picture then.
    """
    if simulation._is_closed or not is_in_notebook() or importlib.util.find_spec("anywidget") is None:
        raise NotImplementedError
    simulation.view()._ipython_display_()
