"""Whether a window opens here: it is tried."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

SCRIPT = Path(__file__).with_name("open_window.py")
LONGEST_S = 20.0  # that a run waits for its window
# What SDL takes when it reaches no display: nothing is to be seen there.
NOWHERE = ("offscreen", "dummy", "evdev", "KMSDRM", "directfb")


@dataclass(frozen=True)
class Opening:
    """What came of it.

    Attributes:
        load_error: Why the module of the window cannot be loaded; "" if it can.
        driver: SDL's way to the display: x11, wayland, cocoa; offscreen and others draw nowhere. "" if it has none.
        error: SDL's reason, if no window opened.
        said: What libraries have printed on the way.
        has_answered: False if it took longer than a run waits.
    """

    load_error: str = ""
    driver: str = ""
    error: str = ""
    said: str = ""
    has_answered: bool = True

    @property
    def is_open(self) -> bool:
        """Whether a window opened on a display."""
        return bool(self.driver) and not self.error and self.driver not in NOWHERE


def try_window(module: Path, environment: Mapping[str, str], longest_s: float = LONGEST_S) -> Opening:
    """Open a window and close it again; it is not to be seen."""
    try:
        done = subprocess.run(
            [sys.executable, SCRIPT, module],
            env=dict(environment),
            capture_output=True,
            text=True,
            errors="replace",
            timeout=longest_s,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return Opening(has_answered=False)
    said = done.stderr.strip()
    try:
        found = json.loads(done.stdout)
    except ValueError:
        return Opening(error=end_of(done), said=said)
    return Opening(found.get("load", ""), found.get("driver", ""), found.get("error", ""), said)


def end_of(done: subprocess.CompletedProcess[str]) -> str:
    """Return how a process ended that has printed nothing."""
    if done.returncode < 0:
        return f"a library crashed while it opened the window ({signal.Signals(-done.returncode).name})"
    lines = done.stderr.strip().splitlines()
    return lines[0] if lines else f"exit code {done.returncode}"
