"""Opens a hidden window, as a run does, and prints what came of it: python3 open_window.py MODULE [--load-only].

A process of its own, since Xlib ends the one that it cannot serve, and a driver may crash it.
"""

from __future__ import annotations

import ctypes
import json
import sys

VIDEO = 0x20
HIDDEN = 0x8
SIZE_PX = 64
PLACE_PX = 0
# What SDL takes when it reaches no display. A console would lose its text to a window, so none is opened there.
NOWHERE = ("offscreen", "dummy", "evdev", "KMSDRM", "directfb")
# What SDL loads when it takes X, on Linux.
OF_X = (
    "libX11.so.6",
    "libXext.so.6",
    "libXcursor.so.1",
    "libXi.so.6",
    "libXfixes.so.3",
    "libXrandr.so.2",
    "libXss.so.1",
)


def opened(module: str, is_loaded_only: bool) -> dict[str, str]:
    """Return how far it came: "load" or "error" are what went wrong, "driver" is SDL's."""
    try:
        sdl = ctypes.CDLL(module)  # with the libraries that it needs
    except OSError as error:
        return {"load": str(error)}
    if is_loaded_only:
        return {}
    sdl.SDL_GetError.restype = ctypes.c_char_p
    sdl.SDL_GetCurrentVideoDriver.restype = ctypes.c_char_p
    sdl.SDL_CreateWindow.restype = ctypes.c_void_p
    sdl.SDL_GetWindowSurface.restype = ctypes.c_void_p
    sdl.SDL_GetWindowSurface.argtypes = [ctypes.c_void_p]
    if sdl.SDL_InitSubSystem(VIDEO) != 0:
        return {"error": sdl.SDL_GetError().decode(errors="replace")}
    driver = sdl.SDL_GetCurrentVideoDriver().decode(errors="replace")
    if driver in NOWHERE:
        return {"driver": driver}
    window = sdl.SDL_CreateWindow(b"Pogosim", PLACE_PX, PLACE_PX, SIZE_PX, SIZE_PX, HIDDEN)
    # X draws without OpenGL, so a window is enough there.
    if not window or (driver == "wayland" and not sdl.SDL_GetWindowSurface(window)):
        return {"driver": driver, "error": sdl.SDL_GetError().decode(errors="replace") or "SDL gives no reason"}
    return {"driver": driver}


def missing_libraries() -> str:
    """Return which libraries of X cannot be loaded, separated by spaces."""
    return " ".join(name for name in OF_X if sys.platform == "linux" and not is_loadable(name))


def is_loadable(library: str) -> bool:
    """Tell whether the system has a library."""
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


if __name__ == "__main__":
    found = opened(sys.argv[1], "--load-only" in sys.argv[2:])
    if "error" in found or found.get("driver") in NOWHERE:
        found["missing"] = missing_libraries()
    json.dump(found, sys.stdout)
