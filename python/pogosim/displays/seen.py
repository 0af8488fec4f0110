"""What is known of a display, and what follows from it."""

from __future__ import annotations

from dataclasses import dataclass

from pogosim.displays.opening import Opening
from pogosim.displays.surroundings import Surroundings
from pogosim.displays.x_server import Answer

# What was found, and what to do about it.
Diagnosis = tuple[str, str]


@dataclass(frozen=True)
class Seen:
    """Everything that is known.

    Attributes:
        here: The machine and the session.
        opening: What came of opening a window; where no display is named, of loading its module only.
        x_server: What came of a connection to DISPLAY; None if that is not set.
    """

    here: Surroundings
    opening: Opening
    x_server: Answer | None = None

    @property
    def is_open(self) -> bool:
        """Whether a window opened."""
        return self.opening.is_open

    def takes(self, driver: str) -> bool:
        """Tell whether SDL may use a driver."""
        chosen = self.here.value("SDL_VIDEODRIVER")
        return not chosen or driver in chosen.split(",")

    def x_fails_with(self, *answers: Answer) -> bool:
        """Tell, if no window opened, whether X was to be used and a connection to DISPLAY had one of these answers."""
        return self.x_server in answers and self.takes("x11")

    def lines(self) -> list[str]:
        """Return the lines that libraries have printed."""
        return [line.strip() for line in self.opening.said.splitlines() if line.strip()]
