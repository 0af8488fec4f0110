"""Symptoms of displays, by their sections in docs/displays.md."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from pogosim.displays.hints import (
    draws_indirectly,
    draws_without_graphics_card,
    is_far_away,
    lacks_a_runtime_folder,
)
from pogosim.displays.missing_library import library_is_missing, library_of_x_is_missing
from pogosim.displays.no_display import (
    has_no_display,
    is_batch_without_display,
    is_container_without_display,
    is_ssh_without_forwarding,
    is_wsl_1,
    lacks_wslg,
)
from pogosim.displays.seen import Diagnosis, Seen
from pogosim.displays.unreachable import (
    does_not_answer,
    draws_nowhere,
    fails_otherwise,
    has_an_old_setting_of_wsl,
    has_another_driver,
    has_no_compositor,
    is_container_without_sockets,
    is_refused,
    is_stale,
    lacks_opengl,
    lost_the_socket_of_wslg,
)

PAGE = "docs/displays.md"
Look = Callable[[Seen], "Diagnosis | None"]

# Why no window opens: the first one that applies is the reason, so what is special stands before what is general.
WITHOUT_DISPLAY: tuple[tuple[str, Look], ...] = (
    ("sdl-is-missing", library_is_missing),
    ("on-a-cluster", is_batch_without_display),
    ("over-ssh", is_ssh_without_forwarding),
    ("in-a-container", is_container_without_display),
    ("wsl-1", is_wsl_1),
    ("wsl-2-without-wslg", lacks_wslg),
    ("no-display", has_no_display),
)
AT_DISPLAY: tuple[tuple[str, Look], ...] = (
    ("sdl-is-missing", library_is_missing),
    ("it-does-not-answer", does_not_answer),
    ("nothing-is-shown", draws_nowhere),
    ("wslg-has-lost-its-socket", lost_the_socket_of_wslg),
    ("an-x-server-in-windows", has_an_old_setting_of_wsl),
    ("in-a-container", is_container_without_sockets),
    ("nothing-answers", is_stale),
    ("libraries-of-x-are-missing", library_of_x_is_missing),
    ("the-connection-is-refused", is_refused),
    ("no-opengl", lacks_opengl),
    ("xdg_runtime_dir", lacks_a_runtime_folder),
    ("nothing-answers", has_no_compositor),
    ("another-driver", has_another_driver),
    ("something-else", fails_otherwise),
)
# What is worth knowing besides.
HINTS: tuple[tuple[str, Look], ...] = (
    ("xdg_runtime_dir", lacks_a_runtime_folder),
    ("libgl_always_indirect", draws_indirectly),
    ("drawn-by-the-processor", draws_without_graphics_card),
    ("slow-over-ssh", is_far_away),
)


@dataclass(frozen=True)
class Symptom:
    """What was found, what to do, and the section of the page that explains it."""

    section: str
    found: str
    advice: str

    @property
    def advice_with_link(self) -> str:
        """The advice, with its place in the page."""
        return f"{self.advice}; see {PAGE}#{self.section}"


def symptoms_of(looks: tuple[tuple[str, Look], ...], seen: Seen) -> Iterator[Symptom]:
    """Return those symptoms of a table that there are, in its order."""
    for section, look in looks:
        if (diagnosis := look(seen)) is not None:
            yield Symptom(section, *diagnosis)


def reason_of(seen: Seen) -> Symptom | None:
    """Return why no window opens; None if one does."""
    if seen.is_open:
        return None
    return next(symptoms_of(AT_DISPLAY if seen.here.is_display_named else WITHOUT_DISPLAY, seen))


def hints_of(seen: Seen, reason: Symptom | None) -> list[Symptom]:
    """Return what is worth knowing besides the reason."""
    return [hint for hint in symptoms_of(HINTS, seen) if reason is None or hint.section != reason.section]
