"""What keeps a search from going on."""

from __future__ import annotations


class OptimizeError(Exception):
    """The search cannot be done. The message is one line: where, what, what was expected, what to do."""
