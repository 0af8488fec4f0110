"""How many of something there are, in a message."""

from __future__ import annotations


def counted(number: int, what: str) -> str:
    """Return a number of things: "1 job", "2 jobs"."""
    return f"{number} {what}{'s' if number != 1 else ''}"
