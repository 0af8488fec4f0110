"""The objects of a run at any time, also between the times of its data file."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from pogosim.errors import PictureError
from pogosim.periodic import minimum_image
from pogosim.picture.swarm import Recording
from pogosim.scene import bounds
from pogosim.shapes import Floats
from pogosim.times import slack_s

MAX_CELLS = 200_000_000  # objects times times

Rows = npt.NDArray[np.int32]
Bools = npt.NDArray[np.bool_]


@dataclass
class Timeline:
    """The last known state of each of n objects at each of the t times of a file. Lengths in mm, angles in rad."""

    times_s: Floats  # shape (t,), ascending
    rows: pd.DataFrame  # finite poses, ordered by time
    known: Rows  # shape (t, n): the last row of an object by then; -1 before its first
    objects: pd.DataFrame  # n rows: those that each object has first
    low_mm: Floats  # the box of the arena: least x and y
    high_mm: Floats
    is_periodic: bool

    def index_at(self, time_s: float) -> int:
        """Number of the last time of the file at or before a time; 0 before the first."""
        return max(int(np.searchsorted(self.times_s, time_s + slack_s(time_s), side="right")) - 1, 0)

    def column(self, name: str) -> tuple[npt.NDArray[Any], Bools]:
        """Values of a column at all times, shape (t, n), and where there are any."""
        values = self.rows[name].to_numpy()
        return values[np.maximum(self.known, 0)], self.known >= 0

    def at(self, time_s: float) -> pd.DataFrame:
        """Rows of all objects that there are at a time.

        Positions and angles between two times of the file are on the straight and shortest way; in a periodic arena
        that may lead across the border. Other columns keep their values until the next time. An object without a row
        at a time stays where it was.

        Args:
            time_s: In s; before the first and after the last time of the file, the state is that of those.

        Returns:
            One row for each object that has had a row by then, with the columns of the file.
        """
        now, place, heading = self.poses_at(time_s)
        rows: pd.DataFrame = self.rows.iloc[now]
        return rows.assign(x=place[:, 0], y=place[:, 1], angle=heading)

    def poses_at(self, time_s: float) -> tuple[Rows, Floats, Floats]:
        """Return what at() does as arrays: numbers of the m rows, their positions, shape (m, 2), and angles."""
        index = self.index_at(time_s)
        now = self.known[index]
        there = now >= 0
        now = now[there]
        place, heading = self.position[now], self.angle[now]
        if index + 1 == len(self.times_s):
            return now, place, heading
        start_s, end_s = self.times_s[index : index + 2]
        share = float(np.clip((time_s - start_s) / (end_s - start_s), 0.0, 1.0))
        following = self.known[index + 1][there]
        turn = np.remainder(self.angle[following] - heading + np.pi, 2.0 * np.pi) - np.pi
        place = between(place, self.position[following], share, self.high_mm - self.low_mm, self.is_periodic)
        if self.is_periodic:
            outside = (place < self.low_mm) | (place > self.high_mm)
            place = np.where(outside, self.low_mm + (place - self.low_mm) % (self.high_mm - self.low_mm), place)
        return now, place, heading + share * np.nan_to_num(turn)

    def velocities_at(self, time_s: float) -> Floats:
        """Return how the m objects of poses_at() have moved since the record before, shape (m, 2), mm/s.

        In the first record, how they move until the next one; zero where there is only one.
        """
        index = self.index_at(time_s)
        there = self.known[index] >= 0
        if len(self.times_s) < 2:
            return np.zeros((int(there.sum()), 2))
        last = max(index, 1)
        start, end = self.known[last - 1][there], self.known[last][there]
        start = np.where(start >= 0, start, end)  # those that came with this record
        place = self.position[start]
        way = between(place, self.position[end], 1.0, self.high_mm - self.low_mm, self.is_periodic) - place
        return np.asarray(way / (self.times_s[last] - self.times_s[last - 1]))

    @cached_property
    def position(self) -> Floats:
        """Positions of all rows, shape (rows, 2), mm."""
        return np.asarray(self.rows[["x", "y"]].to_numpy(dtype=float))

    @cached_property
    def angle(self) -> Floats:
        """Angles of all rows, shape (rows,), rad; NaN where there is none."""
        return np.asarray(self.rows["angle"].to_numpy(dtype=float))


def between(start: Floats, end: Floats, share: float, size: Floats, is_periodic: bool) -> Floats:
    """Places on the way from n starts to n ends, shape (n, 2), mm.

    Steps of more than half the arena are no way that a robot has gone: in a periodic arena they lead across the
    border, and elsewhere it stays at its start.
    """
    step = minimum_image(end - start, size if is_periodic else None)
    if not is_periodic:
        near = np.all(np.abs(step) <= size / 2.0, axis=1, keepdims=True)
        step = np.where(near, step, 0.0)
    return np.asarray(start + share * step)


def timeline_of(
    recording: Recording, rows: pd.DataFrame, keys: list[str], from_s: float | None = None, to_s: float | None = None
) -> Timeline:
    """Arrange rows by object and time.

    Args:
        recording: The run they belong to.
        rows: Finite poses, ordered by time; not empty.
        keys: Columns that tell objects apart.
        from_s: The last time of the file at or before this one is the first to be kept; None: all are.
        to_s: The first at or after this one is the last; None: all.

    Raises:
        PictureError: There are too many objects and times for the memory.
    """
    rows = rows.reset_index(drop=True)
    times_s, time_index = np.unique(rows["time"].to_numpy(dtype=float), return_inverse=True)
    group = rows.groupby(keys, sort=True, dropna=False)
    number = group.ngroup().to_numpy()
    count = int(number.max()) + 1
    if count * len(times_s) > MAX_CELLS:
        raise PictureError(
            f"it has {count} objects at {len(times_s)} times, more than fit into memory; record less often, or fewer"
        )
    known = np.full((len(times_s), count), -1, dtype=np.int32)
    known[time_index, number] = np.arange(len(rows), dtype=np.int32)
    known = np.maximum.accumulate(known, axis=0)  # later rows have higher numbers
    first = np.unique(number, return_index=True)[1]
    low, high = bounds(recording.last.polygons)
    whole = Timeline(times_s, rows, known, rows.iloc[first], low, high, recording.last.is_periodic)
    start = 0 if from_s is None else whole.index_at(from_s)
    end = len(times_s) - 1 if to_s is None else whole.index_at(to_s)
    if to_s is not None and times_s[end] < to_s - slack_s(to_s):
        end = min(end + 1, len(times_s) - 1)
    whole.times_s, whole.known = times_s[start : end + 1], known[start : end + 1]
    return whole
