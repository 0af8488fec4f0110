"""Whether a window opens here: it is tried."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from pogosim.displays.open_window import NOWHERE

SCRIPT = Path(__file__).with_name("open_window.py")
LONGEST_S = 20.0  # that a run waits for its window


@dataclass(frozen=True)
class Opening:
    """What came of it.

    Attributes:
        load_error: Why the module of the window cannot be loaded; "" if it can.
        driver: SDL's way to the display: x11, wayland, cocoa; offscreen and others draw nowhere. "" if it has none.
        error: SDL's reason, if no window opened.
        said: What libraries have printed on the way.
        x_libraries_missing: Libraries of X that SDL would load, and that are not there; looked for if no window opened.
        has_answered: False if it took longer than a run waits.
    """

    load_error: str = ""
    driver: str = ""
    error: str = ""
    said: str = ""
    has_answered: bool = True
    x_libraries_missing: tuple[str, ...] = ()

    @property
    def is_open(self) -> bool:
        """Whether a window opened on a display."""
        return bool(self.driver) and not self.error and self.driver not in NOWHERE


def try_window(module: Path, environment: Mapping[str, str], longest_s: float = LONGEST_S) -> Opening:
    """Open a window, which is hidden, and close it again."""
    return tried([str(module)], environment, longest_s)


def try_module(module: Path, environment: Mapping[str, str]) -> Opening:
    """Load the module of the window only, where no display is named."""
    return tried([str(module), "--load-only"], environment, LONGEST_S)


def tried(arguments: Sequence[str], environment: Mapping[str, str], longest_s: float) -> Opening:
    """Run open_window.py."""
    try:
        done = subprocess.run(
            [sys.executable, SCRIPT, *arguments],
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
    missing = tuple(found.get("missing", "").split())
    return Opening(found.get("load", ""), found.get("driver", ""), found.get("error", ""), said, True, missing)


def end_of(done: subprocess.CompletedProcess[str]) -> str:
    """Return how a process ended that has printed nothing."""
    if done.returncode < 0:
        return f"a library crashed while it opened the window ({signal.Signals(-done.returncode).name})"
    lines = done.stderr.strip().splitlines()
    return lines[0] if lines else f"exit code {done.returncode}"
