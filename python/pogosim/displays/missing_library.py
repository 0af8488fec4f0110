"""The module of the window cannot be loaded: SDL is missing, or another library that it needs."""

from __future__ import annotations

from pogosim.displays.seen import Diagnosis, Seen


def library_is_missing(seen: Seen) -> Diagnosis | None:
    """SDL, or what it needs."""
    if not seen.opening.load_error:
        return None
    return seen.opening.load_error, "apt install libsdl2-2.0-0"
