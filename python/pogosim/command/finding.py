"""What `pogosim doctor` says of one thing."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Finding:
    """What was found about one thing that users want to do."""

    purpose: str
    is_fine: bool
    found: str
    advice: str = ""
