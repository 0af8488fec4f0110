"""The module of the window cannot be loaded: SDL is missing, or another library that it needs."""

from __future__ import annotations

import re
import shlex
import sys

from pogosim.displays.seen import Diagnosis, Seen

# How to install the SDL that an error of the loader names. Wheels take that of a Python package, which has other names.
INSTALLING = {
    r"libSDL2-2\.0\.so\.\d": "apt install libsdl2-2.0-0",
    r"libSDL2[-.\w]*\.dylib": "brew install sdl2",
    r"libSDL2-2\.0\.so(?!\.)|SDL2\.framework": shlex.join([sys.executable, "-m", "pip", "install", "pysdl2-dll"]),
}
OF_ANOTHER_LIBRARY = "install the library that is named here, or Pogosim again"


def library_is_missing(seen: Seen) -> Diagnosis | None:
    """SDL, or what it needs."""
    if not seen.opening.load_error:
        return None
    found = seen.opening.load_error.splitlines()[0]  # macOS lists all places where it has looked below
    advice = (command for name, command in INSTALLING.items() if re.search(name, found))
    return found, next(advice, OF_ANOTHER_LIBRARY)
