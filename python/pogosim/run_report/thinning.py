"""Fewer records of a long run, so that the page of its replay stays small."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pogosim.picture.swarm import OBJECT, Recording

# Values that a replay holds: objects times records times (three for a pose, and one for each column). A value takes up
# to two bytes, a third more as text, and less where neighbours in time are alike: 3 MB at most.
MOST_VALUES = 1_200_000
OF_A_POSE = 3


@dataclass(frozen=True)
class Thinned:
    """A run with every `stride`-th record, and the last one."""

    recording: Recording
    stride: int
    records: int  # that are left
    all_records: int

    @property
    def told(self) -> str:
        """What is said of it: "every 4th of 2001 records"; empty if none was left out."""
        if self.records == self.all_records:
            return ""
        return f"every {ordinal(self.stride)} of {self.all_records} records, and the last one"


def ordinal(number: int) -> str:
    """Return "2nd", "3rd", "11th"."""
    ending = "th" if number % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{ending}"


def thinned(recording: Recording, most_values: int = MOST_VALUES) -> Thinned:
    """Leave out records of a run in even steps, until it has at most so many values; two records always stay."""
    rows, dots = recording.last.rows, recording.last.dots
    times_s = recording.times_s
    of_dots = dots.groupby([OBJECT, "subpart_id"], dropna=False).ngroups if len(dots) else 0
    columns = max(len(rows.columns) - OF_A_POSE, 1)
    values = rows[OBJECT].nunique() * (OF_A_POSE + columns) + of_dots * OF_A_POSE
    most = max(most_values // max(values, 1), 2)
    stride = max(-(-(len(times_s) - 1) // (most - 1)), 1)
    kept_s = np.unique(np.append(times_s[::stride], times_s[-1]))
    if len(kept_s) == len(times_s):
        return Thinned(recording, 1, len(times_s), len(times_s))
    last = replace(
        recording.last,
        rows=rows[rows["time"].isin(kept_s)].reset_index(drop=True),
        dots=dots[dots["time"].isin(kept_s)].reset_index(drop=True),
    )
    return Thinned(replace(recording, last=last), stride, len(kept_s), len(times_s))
