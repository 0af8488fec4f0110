"""One viewer of a run: what it has been told, and how much of it is still under way."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

from pogosim.shapes import Floats
from pogosim.watch.frames import NO_COLUMN, Column, FrameWriter
from pogosim.watch.looking import Look

MOST_UNDER_WAY = 6  # frames that were sent and not shown yet

Send = Callable[[dict[str, Any] | bytes], None]


class Viewer:
    """What the thread of a run knows of a viewer.

    A viewer that is slow gets fewer frames: each says what has changed since the one before it that was sent.

    Attributes:
        may_steer: Whether it may change the run.
        selected: Index of the object whose values it wants; -1: none.
        columns: Those whose values it wants with each frame, for colours and for a heat map.
    """

    def __init__(self, send: Send, *, may_steer: bool, stall_s: float = math.inf) -> None:
        """Make a viewer.

        Args:
            send: Sends a message, soon and without waiting; called by the thread of the run.
            may_steer: See above.
            stall_s: How long to wait for a viewer that does not report its frames, before it gets another one, s.
        """
        self._send = send
        self._stall_s = stall_s
        self._writer: FrameWriter | None = None
        self._shown = 0
        self._sent_at_s = 0.0
        self._late: Look | None = None  # the newest one, which was not sent
        self._told: dict[str, Any] = {}
        self.may_steer = may_steer
        self.selected = -1
        self.columns: tuple[Column, Column] = (NO_COLUMN, NO_COLUMN)

    def begin(self, head: dict[str, Any], low: Floats, high: Floats) -> None:
        """Start with a run, perhaps another one than before. `low`, `high`: corners of the box of poses, mm."""
        self._writer = FrameWriter(low, high)
        self._shown, self._late, self._told = 0, None, {}
        self.selected, self.columns = -1, (NO_COLUMN, NO_COLUMN)
        self.tell({"kind": "head", "head": head})

    def tell(self, message: dict[str, Any] | bytes) -> None:
        """Send a message."""
        self._send(message)

    def tell_new(self, message: dict[str, Any]) -> None:
        """Send a message unless the last one of its kind said the same."""
        if self._told.get(message["kind"]) != message:
            self._told[message["kind"]] = message
            self._send(message)

    def was_shown(self, frame: int) -> None:
        """Take note of the last frame that the viewer has shown."""
        if self._writer is not None:
            self._shown = max(self._shown, min(frame, self._writer.number))

    def show(self, look: Look) -> None:
        """Send a look, or keep it until the viewer has caught up."""
        if self._writer is None:
            return
        now = time.perf_counter()
        is_behind = self._writer.number - self._shown >= MOST_UNDER_WAY
        if is_behind and now - self._sent_at_s < self._stall_s:
            self._late = look
            return
        self._late, self._sent_at_s = None, now
        self._send(self._writer.frame(look, self.columns))

    def show_late(self) -> None:
        """Send the look that was kept, if the viewer has caught up."""
        if self._late is not None:
            self.show(self._late)
