"""No variable names a display: what that means in WSL, over ssh, in a container, in a batch job."""

from __future__ import annotations

from pogosim.displays.seen import Diagnosis, Seen

UNSET = "no display: neither DISPLAY nor WAYLAND_DISPLAY is set"


def is_batch_without_display(seen: Seen) -> Diagnosis | None:
    """A node of a cluster."""
    if not seen.here.is_batch_job:
        return None
    return f"{UNSET} (in a batch job)", "run with -g, and draw frames or a film; pogosim watch shows it live"


def is_container_without_display(seen: Seen) -> Diagnosis | None:
    """A container that was not given the display of its host."""
    if not seen.here.container:
        return None
    found = f"{UNSET} (in a container of {seen.here.container})"
    return found, "run with -g, or start the container with the host's display"


def is_ssh_without_forwarding(seen: Seen) -> Diagnosis | None:
    """A login without -X."""
    if not seen.here.is_over_ssh:
        return None
    return f"{UNSET} (over ssh)", "connect with ssh -X, or run with -g; pogosim watch needs no display"


def is_wsl_1(seen: Seen) -> Diagnosis | None:
    """The old WSL has no display of its own."""
    if seen.here.wsl != 1:
        return None
    return f"{UNSET} (WSL 1)", "in Windows: wsl --set-version NAME 2; or an X server there and DISPLAY=localhost:0"


def lacks_wslg(seen: Seen) -> Diagnosis | None:
    """WSL 2 without WSLg, or with it but without its variables."""
    if seen.here.wsl != 2:
        return None
    if seen.here.has_wslg:
        return f"{UNSET}, though WSLg is there", "export DISPLAY=:0 WAYLAND_DISPLAY=wayland-0, or open a new shell"
    return f"{UNSET} (WSL 2 without WSLg)", "in Windows: wsl --update, then wsl --shutdown, and open a new shell"


def has_no_display(seen: Seen) -> Diagnosis:  # noqa: ARG001
    """A machine without a screen."""
    return UNSET, "run with -g, or connect with ssh -X; films need no display"
