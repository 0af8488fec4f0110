"""Numbers as reports show them."""

from __future__ import annotations

from pogosim.firmware.profile.raw import Profile

KIB = 1024


def percent(share: float) -> str:
    """Return a share, 0 to 1 or more, as a percentage: "31 %", "3.1 %", "< 0.1 %"."""
    value = 100 * share
    if value >= 9.95 or value == 0:
        return f"{value:.0f} %"
    return f"{value:.1f} %" if value >= 0.095 else "< 0.1 %"


def plain(value: float) -> str:
    """Return a number of 0 or more: whole from 100 on, with at most one decimal from 10 on, and two below."""
    if value >= 99.95:
        return f"{value:.0f}"
    text = f"{value:.1f}" if value >= 9.995 else f"{value:.2f}"
    return text.rstrip("0").rstrip(".")


def bytes_shown(count: float) -> str:
    """Return an amount of memory: "712 bytes", "12.7 KiB"."""
    if count < KIB:
        return f"{count:.0f} byte{'' if count == 1 else 's'}"
    return f"{count / KIB:.1f} KiB"


def ticks_per_second(profile: Profile) -> str:
    """Return how often a tick begins: "60 ticks per second"."""
    return f"{profile.loop_hz:g} ticks per second"
