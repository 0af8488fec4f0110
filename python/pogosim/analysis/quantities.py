"""The main numbers of a run over time: displacement, speed, neighbours, order, and the columns of the program.

from pogosim.analysis.quantities import quantities_of
from pogosim.analysis.trajectories import trajectories_of

for run in trajectories_of(rows):
    for quantity in quantities_of(run):
        print(quantity.name, quantity.mean, quantity.final)
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from pogosim.analysis.arena import Floats
from pogosim.analysis.averages import mean_and_variance
from pogosim.analysis.directions import directions_of_motion
from pogosim.analysis.displacement import squared_displacement
from pogosim.analysis.motion import speed
from pogosim.analysis.neighbourhood import degrees
from pogosim.analysis.order import polar_order
from pogosim.analysis.trajectories import Trajectories
from pogosim.run_columns import RETRY, tells_runs_apart
from pogosim.usable_numbers import usable

# Columns that the simulator writes, and that are no quantities of their own.
OF_THE_SIMULATOR = (
    *("time", "robot_category", "robot_id", "subpart_id", "x", "y", "angle"),
    *("led_rgb", "pogobot_ticks"),
)
COLUMN = "column "  # before the names of columns, which may be those of other quantities


@dataclass(frozen=True)
class Quantity:
    """A number of a run at each of its T times; NaN where it has none."""

    name: str
    unit: str  # empty: a number without one, or not known
    over_time: Floats  # (T,), of the swarm: usually the mean over its robots
    low: Floats | None = None  # (T,), lower quartile of the robots; None: it is not a mean over robots
    high: Floats | None = None  # (T,), upper quartile

    @property
    def label(self) -> str:
        """What an axis says."""
        return f"{self.name} ({self.unit})" if self.unit else self.name

    @property
    def mean(self) -> float:
        """Mean over time; NaN without any value."""
        known = self.over_time[np.isfinite(self.over_time)]
        return float(known.mean()) if len(known) else float("nan")

    @property
    def final(self) -> float:
        """Value at the last time that has one; NaN without any."""
        known = self.over_time[np.isfinite(self.over_time)]
        return float(known[-1]) if len(known) else float("nan")


def quantities_of(run: Trajectories) -> Iterator[Quantity]:
    """Yield what a run is summarised by, one by one.

    The quantities are: `displacement`, the distance from a robot's first position, without jumps at periodic borders
    (mm); `speed` since the previous row (mm/s); `neighbours`, robots within reach; all three as means over robots.
    `polar order` of the directions of motion, 0 to 1. And for each column of the program that holds numbers or truth
    values, `column NAME`: the mean over robots, for truth values the share of true ones. Columns without a usable
    value are left out.
    """
    yield of_robots("displacement", "mm", np.sqrt(squared_displacement(run)))
    yield of_robots("speed", "mm/s", speed(run))
    degree = np.where(run.is_there, degrees(run), np.nan)
    yield of_robots("neighbours", "", degree)
    yield Quantity("polar order", "", polar_order(directions_of_motion(run)))
    for name in program_columns(run):
        values = numbers_in(run.rows[name])
        if values is None:
            continue
        per_robot = np.where(run.row >= 0, values[run.row], np.nan)
        if np.isfinite(per_robot).any():
            yield of_robots(COLUMN + name, "", per_robot)


def of_robots(name: str, unit: str, values: Floats) -> Quantity:
    """Return the mean over robots and their quartiles, of values of shape (T, N); what is not finite is left out."""
    values = np.where(np.isfinite(values), values, np.nan)
    low, high = quartiles(values)
    return Quantity(name, unit, mean_and_variance(values, axis=1)[0], low, high)


def quartiles(values: Floats) -> tuple[Floats, Floats]:
    """Return lower and upper quartile of each row, by linear interpolation; NaN is left out. Shape (T, N) to (T,)."""
    ordered = np.sort(values, axis=1)  # NaN last
    count = np.isfinite(values).sum(axis=1)
    row = np.arange(len(values))

    def quantile(share: float) -> Floats:
        place = share * np.maximum(count - 1, 0)
        below = np.floor(place).astype(np.int64)
        above = np.minimum(below + 1, np.maximum(count - 1, 0))
        part = place - below
        return np.asarray((1.0 - part) * ordered[row, below] + part * ordered[row, above])

    return quantile(0.25), quantile(0.75)


def program_columns(run: Trajectories) -> list[str]:
    """Return the names of the columns that a program wrote, each once there."""
    names = [name for name in run.rows.columns if isinstance(name, str)]
    return [
        name
        for name in names
        if name not in OF_THE_SIMULATOR
        and not tells_runs_apart(name)
        and name not in run.labels
        and name != RETRY
        and names.count(name) == 1
    ]


def numbers_in(values: pd.Series[Any]) -> npt.NDArray[np.float64] | None:
    """Return a column of numbers or truth values as usable numbers, else NaN; None of other columns."""
    types = pd.api.types
    is_truth = types.is_bool_dtype(values) or pd.api.types.infer_dtype(values, skipna=True) == "boolean"
    if is_truth:
        return np.asarray(values.astype("boolean").to_numpy(dtype=float, na_value=np.nan))
    if types.is_integer_dtype(values) or types.is_float_dtype(values):
        return usable(values)
    return None
