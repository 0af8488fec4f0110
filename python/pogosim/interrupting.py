"""Signals that end a command as Ctrl-C does."""

from __future__ import annotations

from types import FrameType
from typing import NoReturn


def interrupt(number: int, frame: FrameType | None) -> NoReturn:  # noqa: ARG001 -- what handlers are called with
    """End a command as Ctrl-C does: it removes what it has half written."""
    raise KeyboardInterrupt
