"""Values of a configuration, as the simulator takes them."""

from __future__ import annotations

from typing import Any


def number(value: Any, default: float) -> float:
    """Return a configuration's value as a number; `default` if it is none."""
    try:
        return float(value)
    except (TypeError, ValueError):
        return default
