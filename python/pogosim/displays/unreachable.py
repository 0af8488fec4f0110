"""A display is named, and no window opens on it."""

from __future__ import annotations

import re

from pogosim.displays.open_window import NOWHERE
from pogosim.displays.seen import Diagnosis, Seen
from pogosim.displays.x_server import Answer, numbered


def draws_nowhere(seen: Seen) -> Diagnosis | None:
    """A setting for machines without a screen is left."""
    drivers = seen.here.value("SDL_VIDEODRIVER")
    if seen.opening.driver not in NOWHERE or not drivers:
        return None
    return f"SDL_VIDEODRIVER={drivers} draws into memory, not on a screen", "unset SDL_VIDEODRIVER"


def does_not_answer(seen: Seen) -> Diagnosis | None:
    """A connection that hangs."""
    if seen.opening.has_answered:
        return None
    return "the display does not answer", "log in again, or restart its X server; run with -g meanwhile"


def lost_the_socket_of_wslg(seen: Seen) -> Diagnosis | None:
    """WSLg puts a socket into /tmp, where something has removed it."""
    socket = seen.here.x_socket(0)
    kept = seen.here.root / "mnt" / "wslg" / ".X11-unix" / "X0"
    if not seen.x_fails_with(Answer.NOTHING) or socket.exists() or not kept.exists():
        return None
    advice = "sudo mkdir -p /tmp/.X11-unix && sudo ln -sf /mnt/wslg/.X11-unix/X0 /tmp/.X11-unix/"
    return "WSLg is there, but /tmp/.X11-unix/X0 is gone", advice


def has_an_old_setting_of_wsl(seen: Seen) -> Diagnosis | None:
    """DISPLAY still leads to an X server in Windows that does not run, or that a firewall hides."""
    display = seen.here.value("DISPLAY")
    host = (numbered(display) or ("", 0))[0]
    if not seen.x_fails_with(Answer.NOTHING) or not seen.here.wsl or not host:
        return None
    if seen.here.has_wslg:
        advice = "export DISPLAY=:0 for WSLg, and remove the line in ~/.bashrc that sets another one"
    else:
        advice = "start that X server, and let the firewall of Windows take its connections"
    return f"nothing answers at DISPLAY={display}, an X server in Windows", advice


def is_container_without_sockets(seen: Seen) -> Diagnosis | None:
    """DISPLAY is passed to a container, but not what it names."""
    display = seen.here.value("DISPLAY")
    address = numbered(display)
    if not seen.x_fails_with(Answer.NOTHING) or not seen.here.container or address is None:
        return None
    if address[0] or seen.here.x_socket(address[1]).exists():
        return None
    found = f"DISPLAY={display} is set, but its socket is not in this container"
    return found, "start the container with -v /tmp/.X11-unix:/tmp/.X11-unix"


def is_stale(seen: Seen) -> Diagnosis | None:
    """DISPLAY has outlived its display, or is wrong."""
    display = seen.here.value("DISPLAY")
    if not seen.x_fails_with(Answer.NOTHING, Answer.NO_NAME):
        return None
    if seen.x_server is Answer.NO_NAME:
        return (
            f"DISPLAY={display} is no name of a display",
            "log in again, or unset DISPLAY; names are :0, localhost:10.0",
        )
    again = "log in again with ssh -X" if seen.here.is_over_ssh else "unset DISPLAY, or set it to that of your desktop"
    return f"nothing answers at DISPLAY={display}", f"{again}; in tmux and screen, set it to that of the new login"


def is_refused(seen: Seen) -> Diagnosis | None:
    """The server wants a key, or another one."""
    if not seen.x_fails_with(Answer.CONNECTS):
        return None
    lines = [line for line in seen.lines() if re.search("(?i)authoriz|cookie|rejected|client", line)]
    reason = f": {lines[0]}" if lines else ""
    if seen.here.is_display_forwarded:
        advice = "not as another user (sudo, su): log in again with ssh -X"
    else:
        advice = "set XAUTHORITY to the file of its keys, often ~/.Xauthority of its user"
    return f"DISPLAY={seen.here.value('DISPLAY')} refuses the connection{reason}", advice


def lacks_opengl(seen: Seen) -> Diagnosis | None:
    """On Wayland, SDL draws with OpenGL."""
    lines = [line for line in seen.lines() if re.search("libGL|libEGL|MESA-LOADER|MESA: error", line)]
    has_no_egl = "EGL" in seen.opening.error or "GL" in seen.opening.error.split()
    if not lines and not has_no_egl:
        return None
    found = lines[0] if lines else seen.opening.error
    return f"no OpenGL: {found}", f"{seen.here.how_to_install('OpenGL')}, or SDL_VIDEODRIVER=x11, which needs none"


def has_no_compositor(seen: Seen) -> Diagnosis | None:
    """WAYLAND_DISPLAY has outlived its desktop, and there is no X."""
    name = seen.here.value("WAYLAND_DISPLAY")
    if seen.opening.driver == "wayland" or not name or not seen.takes("wayland"):
        return None
    return f"nothing answers at WAYLAND_DISPLAY={name}", "log in to the desktop again, or run with -g"


def has_another_driver(seen: Seen) -> Diagnosis | None:
    """SDL_VIDEODRIVER names a kind of display that is not there, while another one may be."""
    drivers = seen.here.value("SDL_VIDEODRIVER")
    if not drivers or not seen.opening.error.endswith("not available"):
        return None
    return f"SDL_VIDEODRIVER={drivers}: {seen.opening.error}", "unset SDL_VIDEODRIVER, and SDL takes what is there"


def fails_otherwise(seen: Seen) -> Diagnosis:
    """What SDL says."""
    return f"no window opens: {seen.opening.error or seen.opening.driver}", "run with -g"
