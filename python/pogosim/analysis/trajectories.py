"""The rows of a data file as arrays: one `Trajectories` for each run, with its robots at all save times.

rows, _ = load_dataframe("result.feather")
for run in trajectories_of(rows):
    print(run.labels, run.position_mm.shape)  # times, robots, (x, y)
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, cast

import numpy as np
import numpy.typing as npt
import pandas as pd

from pogosim.analysis.arena import Arena, Floats
from pogosim.analysis.robot_sizes import Sizes, sizes_of
from pogosim.arguments import Arguments
from pogosim.batch.paths import get_by_dotted_path
from pogosim.errors import AnalysisError
from pogosim.far_away import is_near
from pogosim.object_categories import UnknownCategoriesError, with_categories
from pogosim.object_facts import OBJECTS, entries_of
from pogosim.periodic import steps_of
from pogosim.run_columns import is_one_run, named_columns
from pogosim.utils import polygons_of

# With more cells per row, times and robots do not belong together.
MAX_CELLS_PER_ROW = 1000

given = Arguments(AnalysisError)

OBJECT = ("robot_category", "robot_id")


@dataclass(frozen=True)
class Trajectories:
    """The robots of one run at all its save times. T times, N robots."""

    labels: dict[str, Any]  # what tells the run from others: run, arena_file, columns of combinations
    arena: Arena
    time_s: Floats  # (T,), increasing
    category: npt.NDArray[np.object_]  # (N,)
    robot_id: npt.NDArray[np.int64]  # (N,)
    position_mm: Floats  # (T, N, 2), NaN where the file has none
    heading_rad: Floats  # (T, N), NaN where the file has none
    row: npt.NDArray[np.int64]  # (T, N), position of the row in `rows`, -1 where there is none
    rows: pd.DataFrame  # all that the file has on this run
    sizes: Sizes  # radius, reach and top speed of each robot

    @cached_property
    def is_there(self) -> npt.NDArray[np.bool_]:
        """Which robots have a position at which times, shape (T, N)."""
        return np.asarray(np.isfinite(self.position_mm).all(axis=2))

    @property
    def radius_mm(self) -> float:
        """Radius of a robot; of the first category, with a warning (DifferentRobotsWarning), if they differ."""
        return self.sizes.one("radius_mm")

    @property
    def reach_mm(self) -> float:
        """Greatest distance between the centres of neighbours, communication_radius + 2 radius; as `radius_mm`."""
        return self.sizes.one("reach_mm")

    @cached_property
    def path_mm(self) -> Floats:
        """Positions without jumps at periodic borders, shape (T, N, 2), see `unwrapped`."""
        return unwrapped_path(self)

    def reach(self, reach_mm: float | None) -> float:
        """Return the greatest distance of neighbours: the given one, or that of the run.

        Raises:
            AnalysisError: It is no distance.
        """
        if reach_mm is None:
            return self.reach_mm
        reach = given.number("reach_mm", reach_mm, "a distance in mm")
        if not reach >= 0.0:
            raise given.refused("reach_mm", "a distance in mm", reach_mm)
        return reach

    def column(self, name: str) -> npt.NDArray[Any]:
        """Values of a column of the file, shape (T, N). Null, or NaN for numbers, where there is no row.

        Raises:
            AnalysisError: There is no such column.
        """
        need_columns(self.rows, [name])
        values = self.rows[name].to_numpy()
        is_number = pd.api.types.is_numeric_dtype(self.rows[name]) and not pd.api.types.is_bool_dtype(self.rows[name])
        values = values.astype(float) if is_number else values.astype(object)
        return np.where(self.row >= 0, values[self.row], np.array(np.nan if is_number else None))

    def snapshots(self) -> Iterator[tuple[float, Floats, npt.NDArray[np.bool_]]]:
        """Yield each time in s, the positions (n, 2) of the robots that are there, and which those are, shape (N,)."""
        for time, positions, is_there in zip(self.time_s, self.position_mm, self.is_there, strict=True):
            yield float(time), positions[is_there], is_there


def trajectories_of(
    rows: pd.DataFrame, metadata: Mapping[str, Any] | None = None, category: str | None = None
) -> list[Trajectories]:
    """Arrange the rows of a data file by run, time and robot.

    Runs are told apart by the column `run`, and by the columns with which a batch names its combinations. Rows with
    positions farther than 10 km away are left out, with a warning (RuntimeWarning).

    Args:
        rows: As of `pogosim.utils.load_dataframe`; at least the columns time, x and y (s, mm).
        metadata: Metadata of the file; `rows.attrs` if None. Size and range of robots, the arena and its borders are
            from there. Without them: 26.5 mm, 80 mm, no walls.
        category: Objects to take. None: `robots`, if there are any; otherwise all that run a program; or else all.

    Returns:
        The runs, in the order of their labels; at least one.

    Raises:
        AnalysisError: A column is missing, there is no position, or the runs cannot be told apart.
    """
    if not isinstance(rows, pd.DataFrame):
        raise given.refused("rows", "a dataframe, as of load_dataframe", rows)
    if category is not None:
        category = given.text("category", category)
    metadata = cast(Mapping[str, Any], rows.attrs) if metadata is None else metadata
    if not isinstance(metadata, Mapping):
        raise given.refused("metadata", "a map, as of load_dataframe", metadata)
    need_columns(rows, ["time", "x", "y"])
    need_numbers(rows, ["time", "x", "y", "angle"])
    rows = of_category(with_objects(rows, metadata), metadata, category)
    rows = rows[is_near(rows)]
    rows = rows[np.isfinite(rows["time"]) & np.isfinite(rows["x"]) & np.isfinite(rows["y"])]
    if rows.empty:
        raise AnalysisError("it has no row with a time and a position")
    names = label_columns(rows, metadata)
    if is_one_run(rows, metadata):
        same = {name: rows[name].iloc[0] for name in names if rows[name].nunique(dropna=False) == 1}
        return [run_of(rows, {"run": 0} | same, metadata)]
    if not names:
        return [run_of(rows, {"run": 0}, metadata)]
    runs = [
        run_of(own, dict(zip(names, values, strict=True)), metadata)
        for values, own in rows.groupby(names, sort=True, dropna=False, observed=True)
    ]
    return with_arenas_told_apart(runs)


def with_arenas_told_apart(runs: Sequence[Trajectories]) -> list[Trajectories]:
    """Return the runs, arenas of one name but different outlines with a number: disk, disk_2, ..."""
    outlines: dict[str, list[bytes]] = {}
    named = []
    for run in runs:
        outline = b"".join(np.round(polygon, 3).tobytes() for polygon in run.arena.polygons)
        known = outlines.setdefault(run.arena.name, [])
        if outline not in known:
            known.append(outline)
        number = 1 + known.index(outline)
        name = run.arena.name if number == 1 else f"{run.arena.name}_{number}"
        named.append(replace(run, arena=replace(run.arena, name=name)))
    return named


def need_columns(rows: pd.DataFrame, names: Sequence[str]) -> None:
    """Raise AnalysisError unless the rows have these columns, once each."""
    missing = [name for name in names if name not in rows]
    if missing:
        there = ", ".join(map(str, rows.columns))
        raise AnalysisError(f"it has no column {', '.join(missing)}; it has {there or 'no columns'}")
    twice = [name for name in names if list(rows.columns).count(name) > 1]
    if twice:
        raise AnalysisError(f"it has several columns {', '.join(twice)}")


def need_numbers(rows: pd.DataFrame, names: Sequence[str]) -> None:
    """Raise AnalysisError if one of these columns is there and does not hold numbers."""
    for name in names:
        if name in rows and (not pd.api.types.is_numeric_dtype(rows[name]) or pd.api.types.is_bool_dtype(rows[name])):
            raise AnalysisError(f"its column {name} holds {rows[name].dtype}, not numbers")


def with_objects(rows: pd.DataFrame, metadata: Mapping[str, Any]) -> pd.DataFrame:
    """Add what tells objects apart where the file does not have it, and leave out parts of membranes.

    Raises:
        AnalysisError: There are several categories of objects, and nothing says which ones are the robots.
    """
    if "subpart_id" in rows:
        rows = rows[~(rows["subpart_id"] >= 0)]
    try:
        rows = with_categories(rows, metadata)
    except UnknownCategoriesError as error:
        raise AnalysisError(str(error)) from None
    return rows if "robot_id" in rows else rows.assign(robot_id=0)


def of_category(rows: pd.DataFrame, metadata: Mapping[str, Any], category: str | None) -> pd.DataFrame:
    """Take the rows of a category; see `trajectories_of` for None."""
    names = rows["robot_category"].astype(str)
    there = sorted(names.unique())
    if category is not None:
        if category not in there:
            raise AnalysisError(f"it has no rows of the category '{category}'; it has {', '.join(there) or 'none'}")
        return rows[names == category]
    if "robots" in there:
        return rows[names == "robots"]
    active = [own.category for own in entries_of(metadata) if own.is_robot and own.category in there]
    return rows[names.isin(active)] if active else rows


def label_columns(rows: pd.DataFrame, metadata: Mapping[str, Any]) -> list[str]:
    """Return the columns that tell runs apart: run, arena_file, those of combinations, paths of settings, and seed."""
    configuration = metadata.get("configuration")
    names = ["run", "arena_file", *(named_columns(metadata) or [])]
    entries = configuration if isinstance(configuration, dict) else {}
    maps = {"objects", "parameters", *(key for key, value in entries.items() if isinstance(value, dict))}
    names += [name for name in rows.columns if str(name).partition(".")[0] in maps and "." in str(name)]
    names += [name for entry in combinations_of(metadata) for name in entry.get("columns", {})]
    names = [name for name in dict.fromkeys(map(str, names)) if name in rows]
    # Runs of several batches may have the same number, and only their seeds differ.
    may_differ = "files" in metadata and "seed" in rows and bool(names)
    if may_differ and (rows.groupby(names, dropna=False, observed=True)["seed"].nunique(dropna=False) > 1).any():
        names.insert(1, "seed")
    return names


def combinations_of(metadata: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return what a batch says about its combinations; empty for other files."""
    combinations = metadata.get("combinations")
    if not isinstance(combinations, list):
        return []
    return [entry for entry in combinations if isinstance(entry, dict) and isinstance(entry.get("columns", {}), dict)]


def run_of(rows: pd.DataFrame, labels: dict[str, Any], metadata: Mapping[str, Any]) -> Trajectories:
    """Arrange the rows of one run.

    Raises:
        AnalysisError: A robot has two rows at one time, or nearly each row has a time of its own.
    """
    times, at_time = np.unique(rows["time"].to_numpy(dtype=float), return_inverse=True)
    objects = rows.groupby(list(OBJECT), sort=True, dropna=False, observed=True)
    robot = objects.ngroup().to_numpy()
    robots = rows[list(OBJECT)].iloc[np.unique(robot, return_index=True)[1]]
    shape = (len(times), len(robots))
    if shape[0] * shape[1] > MAX_CELLS_PER_ROW * (len(rows) + 1000):
        raise AnalysisError(f"its {len(rows)} rows have {shape[0]} times for {shape[1]} robots, hardly any in common")
    row = np.full(shape, -1, dtype=np.int64)
    row[at_time, robot] = np.arange(len(rows))
    if np.count_nonzero(row >= 0) < len(rows):
        twice = rows[rows.duplicated(["time", *OBJECT])].iloc[0]
        raise AnalysisError(
            f"it has several rows of {twice['robot_category']} {twice['robot_id']} at {twice['time']:g} s, in "
            f"{', '.join(f'{name} {value}' for name, value in labels.items())}: give runs different numbers in the "
            "column run"
        )
    position = np.full((*shape, 2), np.nan)
    position[at_time, robot] = rows[["x", "y"]].to_numpy(dtype=float)
    heading = np.full(shape, np.nan)
    if "angle" in rows:
        heading[at_time, robot] = rows["angle"].to_numpy(dtype=float)

    def setting(path: str) -> Any:
        return setting_of(path, labels, metadata)

    return Trajectories(
        labels=labels,
        arena=arena_of(labels, metadata, setting),
        time_s=times,
        category=robots["robot_category"].to_numpy(dtype=object),
        robot_id=robots["robot_id"].to_numpy(),
        position_mm=position,
        heading_rad=heading,
        row=row,
        rows=rows,
        sizes=sizes_of(robots["robot_category"].to_numpy(dtype=object), setting, metadata.get(OBJECTS)),
    )


def setting_of(path: str, labels: Mapping[str, Any], metadata: Mapping[str, Any]) -> Any:
    """Return the value of a configuration entry in a run, from its labels or the configuration; None if in neither."""
    if path in labels:
        return labels[path]
    for name in ("resolved_configuration", "configuration"):
        configuration = metadata.get(name)
        with contextlib.suppress(KeyError):
            found = get_by_dotted_path(configuration, path)
            if found is not None and not isinstance(found, dict):  # of a batch: the options
                return found
    return None


def arena_of(labels: Mapping[str, Any], metadata: Mapping[str, Any], setting: Callable[[str], Any]) -> Arena:
    """Return the arena of a run; without polygons where the file does not say."""
    polygons = metadata.get("arena_polygons")
    for entry in combinations_of(metadata):
        if "arena_polygons" in entry and all(labels.get(name) == value for name, value in entry["columns"].items()):
            polygons = entry["arena_polygons"]
    outlines = usable(polygons)
    return Arena(
        name=Path(str(setting("arena_file") or "arena")).stem,
        polygons=outlines,
        is_periodic=bool(outlines) and str(setting("boundary_condition")).lower() == "periodic",
    )


def usable(polygons: Any) -> list[Floats]:
    """Return outlines as arrays; none if they are no polygons, or the outer wall has no width or height."""
    try:
        arrays = [np.asarray(polygon, dtype=float) for polygon in polygons or []]
    except (TypeError, ValueError):
        try:
            arrays = polygons_of(polygons)
        except (TypeError, KeyError, ValueError):
            return []
    good = [array for array in arrays if array.ndim == 2 and array.shape[1] == 2 and len(array) > 2]
    good = [array for array in good if np.isfinite(array).all()]
    return good if good and (np.ptp(good[0], axis=0) > 0).all() else []


def unwrapped(run: Trajectories) -> Floats:
    """Undo the jumps of robots that leave a periodic arena on one side and come back on the other.

    Each step is the shortest of all its images, so robots must move less than half the arena between two save times.
    Where a robot has no position, the step to its next one counts.

    Returns:
        Positions, shape (T, N, 2), mm; the first one of each robot is in the arena. Those of the file if its arena has
        walls.

    Warns:
        AmbiguousStepsWarning: Robots are so fast that another image may be the true one.
    """
    return run.path_mm


def unwrapped_path(run: Trajectories) -> Floats:
    """Compute what `unwrapped` returns."""
    if not run.arena.is_periodic:
        return run.position_mm
    last = np.where(run.is_there, np.arange(len(run.time_s))[:, None], 0)
    np.maximum.accumulate(last, axis=0, out=last)  # the time of the last position up to now
    filled = np.take_along_axis(run.position_mm, last[:, :, None], axis=0)
    duration = np.where(run.is_there[1:], run.time_s[1:, None] - run.time_s[last[:-1]], np.nan)
    steps = steps_of(np.diff(filled, axis=0), duration, run.arena.period_mm, run.sizes.top_speed_mm_s)
    first = np.take_along_axis(run.position_mm, np.argmax(run.is_there, axis=0)[None, :, None], axis=0)
    path = first + np.concatenate([np.zeros_like(first), np.cumsum(np.nan_to_num(steps), axis=0)])
    return np.where(run.is_there[:, :, None], path, np.nan)
