"""What is worth knowing of a display, also if a window opens on it."""

from __future__ import annotations

import os
from pathlib import Path

from pogosim.displays.seen import Diagnosis, Seen


def lacks_a_runtime_folder(seen: Seen) -> Diagnosis | None:
    """Wayland's socket is in a folder that is the user's own."""
    if not seen.here.value("WAYLAND_DISPLAY") or seen.here.value("WAYLAND_DISPLAY").startswith("/"):
        return None
    name = seen.here.value("XDG_RUNTIME_DIR")
    problem = wrong_folder(Path(name), seen.here.user) if name else "not set"
    if not problem:
        return None
    own = f"/run/user/{seen.here.user}"
    if seen.here.has_wslg and (seen.here.root / "mnt/wslg/runtime-dir").is_dir():
        own = "/mnt/wslg/runtime-dir"
    advice = f"export XDG_RUNTIME_DIR={own}, or use X: unset WAYLAND_DISPLAY"
    return f"XDG_RUNTIME_DIR{f'={name}' if name else ''} is {problem}, and Wayland needs it", advice


def wrong_folder(folder: Path, user: int) -> str:
    """Say what is wrong with a folder for the sockets of a user; "" if nothing is."""
    if not folder.is_dir():
        return "no folder"
    if folder.stat().st_uid != user:
        return f"the folder of user {folder.stat().st_uid}, not yours"
    return "" if os.access(folder, os.W_OK | os.X_OK) else "not writable"


def draws_indirectly(seen: Seen) -> Diagnosis | None:
    """A setting for old X servers, with which most programs draw black."""
    if seen.here.value("LIBGL_ALWAYS_INDIRECT") in ("", "0"):
        return None
    return "LIBGL_ALWAYS_INDIRECT is set, with which OpenGL fails on most displays", "unset LIBGL_ALWAYS_INDIRECT"


def draws_without_graphics_card(seen: Seen) -> Diagnosis | None:
    """OpenGL by the processor."""
    names = {"LIBGL_ALWAYS_SOFTWARE": "", "GALLIUM_DRIVER": "pipe", "SDL_RENDER_DRIVER": "software"}
    chosen = [
        f"{name}={seen.here.value(name)}" for name, part in names.items() if is_chosen(seen.here.value(name), part)
    ]
    if not chosen:
        return None
    return f"{', '.join(chosen)}: the processor draws", "nothing on X, where it always does; slower on Wayland"


def is_chosen(value: str, part: str) -> bool:
    """Tell whether a variable is set to something with a part in it."""
    return value not in ("", "0", "false") and part in value


def is_far_away(seen: Seen) -> Diagnosis | None:
    """Every picture crosses a network."""
    if not seen.is_open or not seen.here.is_display_forwarded:
        return None
    return "each picture crosses the network (ssh)", "slow lines: ssh -C, a small window, or pogosim watch"
