"""What `pogosim doctor` says of the window: whether one opens here, and if not, why."""

from __future__ import annotations

from pogosim.command.finding import Finding
from pogosim.displays.opening import try_module, try_window
from pogosim.displays.seen import Seen
from pogosim.displays.surroundings import Surroundings
from pogosim.displays.symptoms import hints_of, reason_of
from pogosim.displays.x_server import answer_of
from pogosim.installation import Installation


def check_window(found: Installation) -> list[Finding]:
    """Open a window as a run does."""
    modules = sorted(found.library.glob("libpogosim_view-v*"))
    if not modules:
        return [Finding("Window", False, f"there is no libpogosim_view in {found.library}", "install Pogosim again")]
    here = Surroundings()
    attempt = try_window if here.is_display_named else try_module  # what the module needs may be missing, too
    server = answer_of(here) if here.value("DISPLAY") else None
    return findings_of(Seen(here, attempt(modules[0], here.environment), server))


def findings_of(seen: Seen) -> list[Finding]:
    """Return what is known as lines: whether a window opens, then what is worth knowing besides."""
    reason = reason_of(seen)
    if reason is not None:
        first = Finding("Window", False, reason.found, reason.advice_with_link)
    else:
        where = seen.here.described()
        first = Finding("Window", True, f"opens, by {seen.opening.driver}{f' ({where})' if where else ''}")
    return [first, *(Finding("Display", True, hint.found, hint.advice_with_link) for hint in hints_of(seen, reason))]
