"""How many time steps a live run makes from one frame to the next."""

from __future__ import annotations

import math
import time

PERIOD_S = 1.0 / 30.0  # from frame to frame
BUSY_SHARE = 0.8  # of a period, in which steps are made
MOST_BEHIND_S = 0.25  # of real time: what is later is given up


class Pace:
    """How many steps are due, for a speed in real time."""

    def __init__(self) -> None:
        self._step_s = 1e-4  # how long a step takes
        self._due = 0.0  # steps, in parts
        self._last_s = 0.0

    def start(self) -> None:
        """Count from now on."""
        self._due, self._last_s = 0.0, time.perf_counter()

    def steps(self, speed: float, time_step_s: float) -> int:
        """Return how many steps are to be made now, within a period."""
        now = time.perf_counter()
        at_most = max(1, int(BUSY_SHARE * PERIOD_S / self._step_s))
        if math.isinf(speed):
            return at_most
        elapsed_s = min(now - self._last_s, MOST_BEHIND_S)
        self._last_s = now
        self._due = min(self._due + speed * elapsed_s / time_step_s, speed * MOST_BEHIND_S / time_step_s + 1.0)
        return min(int(self._due), at_most)

    def made(self, steps: int, took_s: float) -> None:
        """Take note of steps that were made."""
        self._due = max(0.0, self._due - steps)
        if steps:
            self._step_s = 0.7 * self._step_s + 0.3 * max(took_s / steps, 1e-7)
