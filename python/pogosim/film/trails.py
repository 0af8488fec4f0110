"""Where the objects of a recorded run have been by a time, in a few hundred points each."""

from __future__ import annotations

from typing import Protocol

import numpy as np
import numpy.typing as npt

from pogosim.film.painter import Numbers, Trails
from pogosim.film.timeline import Timeline
from pogosim.periodic import minimum_image

POINTS = 512  # of a trail in the window, at least so far apart:
SPACING_MM = 2.0


class Trail(Protocol):
    """Gives trails up to a time of the file."""

    def until(self, time_s: float) -> Trails:
        """Return the trails that end with the last record at or before a time, s."""


class TrailOfSeconds:
    """The last seconds of each object's way."""

    def __init__(self, line: Timeline, rgb: Numbers, tail_s: float) -> None:
        """Prepare.

        Args:
            line: The run.
            rgb: Colour of each row of `line`.
            tail_s: Length of the trails, s.
        """
        self.line, self.rgb, self.tail_s = line, rgb, tail_s
        period_s = float(np.median(np.diff(line.times_s))) if len(line.times_s) > 1 else tail_s
        steps = min(tail_s / period_s, float(len(line.times_s)))
        stride = max(int(np.ceil(steps / (POINTS - 2))), 1)
        self.records = np.arange(0, len(line.times_s), stride)  # the same at each time: a trail keeps its shape
        self.fading = int(np.ceil(steps / stride)) + 1
        self.places = np.ascontiguousarray(line.position, dtype=np.float32)

    def until(self, time_s: float) -> Trails:
        """See Trail."""
        line = self.line
        first = np.searchsorted(self.records, np.searchsorted(line.times_s, time_s - self.tail_s))
        last = np.searchsorted(self.records, line.index_at(time_s), side="right")
        known = np.ascontiguousarray(line.known[self.records[first:last]].T)  # shape (objects, records)
        there = known >= 0
        rows = known[there]
        return Trails(self.places[rows], self.rgb[rows], there.sum(axis=1).astype(np.uint32), self.fading)


class TrailOfPlaces:
    """The last places of each object that are far enough from each other, as in the window."""

    def __init__(self, line: Timeline, rgb: Numbers) -> None:
        """Prepare; arguments as of TrailOfSeconds."""
        self.line = line
        kept = kept_rows(line)
        self.passed = np.zeros((len(line.times_s) + 1, line.known.shape[1]), dtype=np.int32)
        np.cumsum(kept, axis=0, out=self.passed[1:])
        rows = line.known.T[kept.T]  # object by object
        self.places = np.ascontiguousarray(line.position[rows], dtype=np.float32)
        self.rgb = rgb[rows]
        self.start = np.concatenate([[0], np.cumsum(self.passed[-1])[:-1]])

    def until(self, time_s: float) -> Trails:
        """See Trail."""
        end = self.passed[self.line.index_at(time_s) + 1]
        counts = np.minimum(end, POINTS)
        first = np.repeat(self.start + end - counts - np.cumsum(counts) + counts, counts)
        points = first + np.arange(len(first))
        return Trails(self.places[points], self.rgb[points], counts.astype(np.uint32), POINTS)


def kept_rows(line: Timeline) -> npt.NDArray[np.bool_]:
    """Tell at which times each object leaves a point: where it is far enough from the one before. Shape (t, n)."""
    size = line.high_mm - line.low_mm if line.is_periodic else None
    kept = np.zeros(line.known.shape, dtype=bool)
    last = np.full((line.known.shape[1], 2), np.nan)
    for here, own in zip(line.known, kept, strict=True):
        place = line.position[np.maximum(here, 0)]
        moved = minimum_image(place - last, size)
        own[:] = (here >= 0) & ~(np.hypot(*moved.T) < SPACING_MM)
        last[own] = place[own]
    return kept
