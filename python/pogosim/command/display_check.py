"""What `pogosim doctor` says of the window: whether one opens here, and if not, why."""

from __future__ import annotations

import platform

from pogosim.command.finding import Finding
from pogosim.displays.opening import try_module, try_window
from pogosim.displays.seen import Seen
from pogosim.displays.surroundings import Surroundings
from pogosim.displays.symptoms import hints_of, reason_of
from pogosim.displays.x_server import answer_of
from pogosim.installation import Installation

NAMES = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")


def check_window(found: Installation) -> list[Finding]:
    """Open a window as a run does."""
    modules = sorted(found.library.glob("libpogosim_view-v*"))
    if not modules:
        return [Finding("Window", False, f"there is no libpogosim_view in {found.library}", "install Pogosim again")]
    here = Surroundings()
    server = answer_of(here) if here.value("DISPLAY") else None
    if any(here.value(name) for name in NAMES) or platform.system() == "Darwin":
        return told(Seen(here, try_window(modules[0], here.environment), server))
    loaded = try_module(modules[0], here.environment)  # what it needs may be missing, too
    return told(Seen(here, loaded if loaded.load_error else None, server))


def told(seen: Seen) -> list[Finding]:
    """Return what is known as lines: whether a window opens, then what is worth knowing besides."""
    reason = reason_of(seen)
    if reason is not None:
        first = Finding("Window", False, reason.found, reason.told)
    else:
        driver = seen.opening.driver if seen.opening else ""
        where = seen.here.described()
        first = Finding("Window", True, f"opens, by {driver}{f' ({where})' if where else ''}")
    return [first, *(Finding("Display", True, hint.found, hint.told) for hint in hints_of(seen, reason))]
