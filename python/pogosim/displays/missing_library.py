"""The module of the window cannot be loaded: SDL is missing, or another library that it needs."""

from __future__ import annotations

import re
import shlex
import sys

from pogosim.displays.seen import Diagnosis, Seen
from pogosim.displays.x_server import Answer

# The SDL that an error of the loader names: the system's, or that of a Python package, which wheels take.
OF_SYSTEM = r"libSDL2-2\.0\.so\.\d|libSDL2[-.\w]*\.dylib"
OF_PYTHON = r"libSDL2-2\.0\.so(?!\.)|SDL2\.framework"
NEEDED_FOR_X = ("libX11.so.6", "libXext.so.6")  # without the others, a window opens
OF_ANOTHER_LIBRARY = "install the library that is named here, or Pogosim again"


def library_is_missing(seen: Seen) -> Diagnosis | None:
    """SDL, or what it needs."""
    if not seen.opening.load_error:
        return None
    found = seen.opening.load_error.splitlines()[0]  # macOS lists all places where it has looked below
    if re.search(OF_SYSTEM, found):
        return found, seen.here.how_to_install("SDL 2")
    if re.search(OF_PYTHON, found):
        return found, shlex.join([sys.executable, "-m", "pip", "install", "pysdl2-dll"])
    return found, OF_ANOTHER_LIBRARY


def library_of_x_is_missing(seen: Seen) -> Diagnosis | None:
    """SDL loads the libraries of X when it opens a window, and says nothing of one that is missing."""
    lacking = seen.opening.x_libraries_missing
    if not seen.x_fails_with(Answer.CONNECTS) or not any(name in lacking for name in NEEDED_FOR_X):
        return None
    return f"no {', no '.join(lacking)}, which SDL needs for X", seen.here.how_to_install(*lacking)
