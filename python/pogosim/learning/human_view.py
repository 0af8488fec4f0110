"""A run of an environment on a screen, in real time."""

from __future__ import annotations

import time
import webbrowser
from typing import TYPE_CHECKING

from pogosim.simulation import Simulation
from pogosim.watch.in_notebooks import is_in_notebook

if TYPE_CHECKING:
    from pogosim.watch.serving import LivePage


class HumanView:
    """A live page in the browser, or a view in a notebook. It shows what another thread does with the run."""

    def __init__(self, simulation: Simulation) -> None:
        """Open it.

        Raises:
            ImportError: The package websockets is missing, or in a notebook anywidget.
        """
        self._page: LivePage | None = None
        if is_in_notebook():
            simulation.view()._ipython_display_()
        else:
            from pogosim.watch.serving import LivePage

            self._page = LivePage(simulation)
            webbrowser.open(self._page.address)
        self._next_s = time.monotonic()

    def wait(self, duration_s: float) -> None:
        """Wait until so much time has passed since the last call, so that the run goes on in real time."""
        self._next_s = max(self._next_s + duration_s, time.monotonic())
        time.sleep(max(0.0, self._next_s - time.monotonic()))

    def close(self) -> None:
        """Show it no more."""
        if self._page is not None:
            self._page.close()
            self._page = None
