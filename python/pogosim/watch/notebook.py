"""A live run in a notebook: JupyterLab, Jupyter Notebook, VS Code, Colab, by anywidget."""

from __future__ import annotations

import functools
import html
import os
import secrets
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pogosim.extras import installing
from pogosim.pages import data_uri
from pogosim.simulation import Simulation, SimulationError
from pogosim.simulation.arrays import RunState
from pogosim.simulation.errors import given
from pogosim.simulation.run import CLOSED
from pogosim.view import assets
from pogosim.watch.commands import RefusedError, read_command
from pogosim.watch.page import LIVE_PROGRAM, live_elements
from pogosim.watch.viewer import Viewer

try:
    import anywidget
    import traitlets
    from IPython.display import HTML, DisplayHandle, display
except ModuleNotFoundError as missing:
    raise SimulationError(
        f"a live view needs the Python package 'anywidget'; install it: {installing('notebook')}"
    ) from missing

FOLDER = Path(__file__).parent
STALL_S = 0.5  # while a cell is busy, the kernel does not hear that frames were shown
MOST_VIEWS = 50  # of one widget
MOST_STILLS = 20  # pictures of one widget that are kept up to date


@functools.cache
def notebook_program() -> str:
    """Return the module that shows a live run in a cell."""
    own = (FOLDER / "notebook.js").read_text(encoding="utf-8")
    return assets.module(*map(assets.text_of, LIVE_PROGRAM), own)


class RunView(anywidget.AnyWidget):
    """A live view of a run. Make one with `Simulation.view`.

    Attributes:
        simulation: The run.
        height: Pixels.
    """

    _esm = notebook_program()
    css = traitlets.Unicode(assets.text_of("view.css")).tag(sync=True)
    elements = traitlets.Unicode(live_elements()).tag(sync=True)
    height = traitlets.Int(560).tag(sync=True)
    still = traitlets.Unicode("").tag(sync=True)

    def __init__(self, simulation: Simulation, height: int) -> None:
        """Show a run."""
        self.simulation = simulation
        self._live = simulation._live_run
        self._viewers: dict[str, Viewer] = {}
        self._stills: list[DisplayHandle] = []
        self._seen: tuple[RunState, int] | None = None  # run and step of the still pictures
        super().__init__(height=height, still=f"pogosim-still-{secrets.token_hex(8)}")
        self.on_msg(self._hear)

    def play(self, speed: float | None = None) -> None:
        """Go on while cells return; `speed`: times real time, above 0, infinite: as fast as it goes; None: as before.

        Raises:
            ConfigurationError: It is no speed.
            SimulationError: The simulation is closed.
        """
        wanted = None if speed is None else given.number("speed", speed, "a number above 0")
        if wanted is not None and not wanted > 0.0:
            raise given.refused("speed", "a number above 0", speed)
        if self.simulation._is_closed:
            raise SimulationError(CLOSED)
        self._live.play(wanted)

    def pause(self) -> None:
        """Stop, and return when it stands still."""
        self._live.pause()
        self._keep_still()

    def _hear(self, _: Any, content: Any, buffers: Any) -> None:  # noqa: ARG002
        """Take a message of a view of this widget in a page."""
        if not isinstance(content, Mapping) or not isinstance(content.get("view"), str):
            return
        name, message = content["view"][:100], content.get("message")
        if message == {"do": "join"} and name not in self._viewers and len(self._viewers) < MOST_VIEWS:
            self._viewers[name] = Viewer(functools.partial(self._tell_view, name), may_steer=True, stall_s=STALL_S)
            self._live.join(self._viewers[name])
            return
        viewer = self._viewers.get(name)
        if viewer is None:
            return
        if message == {"do": "leave"}:
            self._live.leave(self._viewers.pop(name))
            return
        try:
            self._live.do(viewer, read_command(message))
        except RefusedError as error:
            viewer.tell({"kind": "refused", "message": str(error)})

    def _tell_view(self, name: str, message: dict[str, Any] | bytes) -> None:
        """Send a message to one view; called by the thread of the run."""
        if isinstance(message, bytes):
            self.send({"to": name}, [message])
            return
        self.send({"to": name, "message": message})
        if message["kind"] == "status" and not message["playing"]:
            self._keep_still()

    def _keep_still(self) -> None:
        """Let saved notebooks keep the picture of now, unless they have it already."""
        current = self.simulation._current
        if current.run is None or current.lock.locked():
            return
        seen = (current.run, self.simulation.steps)
        if seen != self._seen:
            self._seen = seen
            for handle in self._stills:
                handle.update(self._still())  # type: ignore[no-untyped-call]

    def _ipython_display_(self) -> None:
        """Show a still picture, which notebooks keep when they are saved, and the live view, which hides it."""
        if self.simulation._current.run is not None and not is_in_iframe():
            handle = display(self._still(), display_id=True)  # type: ignore[no-untyped-call]
            if handle is not None:
                self._stills = [*self._stills[-MOST_STILLS:], handle]
        data, _ = self._repr_mimebundle_() or ({}, {})
        display(data, raw=True)  # type: ignore[no-untyped-call]

    def _still(self) -> HTML:
        content = self.simulation._png(self.height) or b""
        told = html.escape(repr(self.simulation))
        source = data_uri(content, "image/png")
        return HTML(f'<img class="{self.still}" alt="{told}" title="{told}" src="{source}">')  # type: ignore[no-untyped-call]


def is_in_iframe() -> bool:
    """Tell whether the notebook shows each output by itself, so that one cannot hide another."""
    return "google.colab" in sys.modules or "VSCODE_PID" in os.environ
