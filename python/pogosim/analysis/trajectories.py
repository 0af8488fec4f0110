"""The rows of a data file as arrays: one `Trajectories` for each run, with its robots at all save times.

rows, _ = load_dataframe("result.feather")
for run in trajectories_of(rows):
    print(run.labels, run.position_mm.shape)  # times, robots, (x, y)
"""

from __future__ import annotations

import contextlib
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np
import numpy.typing as npt
import pandas as pd

from pogosim.analysis.arena import Arena, Floats
from pogosim.analysis.progress import rows_read
from pogosim.analysis.robot_sizes import Sizes, sizes_of
from pogosim.arguments import Arguments
from pogosim.batch.configurations.paths import get_by_dotted_path
from pogosim.errors import AnalysisError
from pogosim.far_away import is_near
from pogosim.object_categories import UnknownCategoriesError, with_categories
from pogosim.object_facts import OBJECTS, entries_of
from pogosim.periodic import Ambiguity, minimum_image
from pogosim.run_columns import is_one_run, named_columns
from pogosim.utils import polygons_of

# With more cells per row, times and robots do not belong together.
MAX_CELLS_PER_ROW = 1000

given = Arguments(AnalysisError)

OBJECT = ("robot_category", "robot_id")

R = TypeVar("R", bound="Run")


@dataclass(frozen=True)
class Run(ABC):
    """A run: its robots at all its save times, in memory (`Trajectories`) or in a file (`StoredRun`).

    T times, N robots.
    """

    labels: dict[str, Any]  # what tells the run from others: run, arena_file, columns of combinations
    arena: Arena
    time_s: Floats  # (T,), increasing
    category: npt.NDArray[np.object_]  # (N,)
    robot_id: npt.NDArray[np.int64]  # (N,)
    sizes: Sizes  # radius, reach and top speed of each robot

    @property
    @abstractmethod
    def present(self) -> npt.NDArray[np.int64]:
        """How many robots have a position at each time, shape (T,)."""

    @property
    @abstractmethod
    def column_names(self) -> list[str]:
        """Names of the columns of the file."""

    @abstractmethod
    def read_blocks(self, times: Iterable[slice], columns: Sequence[str]) -> Iterator[tuple[slice, Trajectories]]:
        """Do what `blocks` does, without telling of it."""

    def blocks(self, times: Iterable[slice], columns: Sequence[str] = ()) -> Iterator[tuple[slice, Trajectories]]:
        """Yield the robots at some save times after the other, and tell how many rows there were.

        Args:
            times: Which ones, each later than the one before; `pogosim.analysis.snapshots.times_of` divides all times
                of a run so that the robots at those of a block fit into memory.
            columns: Columns of the file that `Trajectories.column` is asked for, apart from time, x, y and angle.

        Yields:
            The times, and all robots of the run at them.

        Raises:
            AnalysisError: There is no such column.
        """
        self.need_columns(columns)
        present = self.present
        for own, block in self.read_blocks(times, columns):
            yield own, block
            rows_read(int(present[own].sum()))

    def need_columns(self, names: Sequence[str]) -> None:
        """Raise AnalysisError unless the file has these columns, once each."""
        need_columns(pd.DataFrame(columns=self.column_names), names)

    def at(self, time: int) -> Trajectories:
        """Return the robots at one time, by its number; -1 is the last one."""
        time = range(len(self.time_s))[time]
        return next(block for _, block in self.blocks([slice(time, time + 1)]))

    def whole(self) -> Trajectories:
        """Return the robots at all times, in memory."""
        return next(block for _, block in self.blocks([slice(0, len(self.time_s))]))

    @property
    def radius_mm(self) -> float:
        """Radius of a robot; of the first category, with a warning (DifferentRobotsWarning), if they differ."""
        return self.sizes.one("radius_mm")

    @property
    def reach_mm(self) -> float:
        """Greatest distance between the centres of neighbours, communication_radius + 2 radius; as `radius_mm`."""
        return self.sizes.one("reach_mm")

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


@dataclass(frozen=True)
class Trajectories(Run):
    """A run in memory."""

    position_mm: Floats  # (T, N, 2), NaN where the file has none
    heading_rad: Floats  # (T, N), NaN where the file has none
    row: npt.NDArray[np.int64]  # (T, N), position of the row in `rows`, -1 where there is none
    rows: pd.DataFrame  # all that the file has on this run

    @property
    def present(self) -> npt.NDArray[np.int64]:
        """How many robots have a position at each time, shape (T,)."""
        return np.asarray(self.is_there.sum(axis=1))

    @property
    def column_names(self) -> list[str]:
        """Names of the columns of the file."""
        return [str(name) for name in self.rows.columns]

    def read_blocks(
        self,
        times: Iterable[slice],
        columns: Sequence[str],  # noqa: ARG002 -- all are in memory
    ) -> Iterator[tuple[slice, Trajectories]]:
        """Yield the robots at some save times after the other, see `Run.blocks`."""
        for own in times:
            yield (
                own,
                replace(
                    self,
                    time_s=self.time_s[own],
                    position_mm=self.position_mm[own],
                    heading_rad=self.heading_rad[own],
                    row=self.row[own],
                ),
            )

    def whole(self) -> Trajectories:
        """Return the run itself."""
        return self

    @cached_property
    def is_there(self) -> npt.NDArray[np.bool_]:
        """Which robots have a position at which times, shape (T, N)."""
        return np.asarray(np.isfinite(self.position_mm).all(axis=2))

    @cached_property
    def path_mm(self) -> Floats:
        """Positions without jumps at periodic borders, shape (T, N, 2), see `unwrapped`."""
        return unwrapped_path(self)

    def column(self, name: str) -> npt.NDArray[Any]:
        """Values of a column of the file, shape (T, N). Null, or NaN for numbers, where there is no row.

        Raises:
            AnalysisError: There is no such column.
        """
        need_columns(self.rows, [name])
        is_number = pd.api.types.is_numeric_dtype(self.rows[name]) and not pd.api.types.is_bool_dtype(self.rows[name])
        values = self.rows[name].to_numpy()[self.row].astype(float if is_number else object)
        return np.where(self.row >= 0, values, np.array(np.nan if is_number else None))


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


def with_arenas_told_apart(runs: Sequence[R]) -> list[R]:
    """Return the runs, arenas of one name but different outlines with a number: disk, disk_2, ..."""
    outlines: dict[str, list[bytes]] = {}
    named: list[R] = []
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
    chosen = category_names(set(rows["robot_category"].astype(str).unique()), metadata, category)
    return rows if chosen is None else rows[of_categories(rows, chosen)]


def category_names(there: Collection[str], metadata: Mapping[str, Any], category: str | None) -> set[str] | None:
    """Return the categories to take of those that there are, see `trajectories_of`; None: all.

    Raises:
        AnalysisError: The one that is wanted is not there.
    """
    if category is not None:
        if category not in there:
            names = ", ".join(sorted(there)) or "none"
            raise AnalysisError(f"it has no rows of the category '{category}'; it has {names}")
        return {category}
    if "robots" in there:
        return {"robots"}
    return {own.category for own in entries_of(metadata) if own.is_robot and own.category in there} or None


def of_categories(rows: pd.DataFrame, names: Collection[str]) -> npt.NDArray[np.bool_]:
    """Tell which rows are of these categories."""
    return np.asarray(rows["robot_category"].astype(str).isin(list(names)))


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
    robot = robot_numbers(rows)
    category, robot_id = robots_in(rows)
    shape = (len(times), len(robot_id))
    check_cells(*shape, len(rows))
    row = np.full(shape, -1, dtype=np.int64)
    row[at_time, robot] = np.arange(len(rows))
    if np.count_nonzero(row >= 0) < len(rows):
        twice = rows[rows.duplicated(["time", *OBJECT])].iloc[0]
        raise AnalysisError(
            f"it has several rows of {twice['robot_category']} {twice['robot_id']} at {twice['time']:g} s, in "
            f"{', '.join(f'{name} {value}' for name, value in labels.items())}: give runs different numbers in the "
            "column run, or name what else tells them apart (result_new_columns of a batch)"
        )
    position = np.full((*shape, 2), np.nan)
    position[at_time, robot] = rows[["x", "y"]].to_numpy(dtype=float)
    heading = np.full(shape, np.nan)
    if "angle" in rows:
        heading[at_time, robot] = headings_in(rows)
    arena, sizes = arena_and_sizes(labels, category, metadata)
    return Trajectories(
        labels=labels,
        arena=arena,
        time_s=times,
        category=category,
        robot_id=robot_id,
        position_mm=position,
        heading_rad=heading,
        row=row,
        rows=rows,
        sizes=sizes,
    )


def headings_in(rows: pd.DataFrame) -> Floats:
    """Return the headings in rows, shape (rows,), rad; NaN where there is none, or one that no robot can have."""
    heading = rows["angle"].to_numpy(dtype=float)
    return np.where(np.isfinite(heading), heading, np.nan)


def robot_numbers(rows: pd.DataFrame) -> npt.NDArray[np.int64]:
    """Return the number of the robot of each row, in the order of categories and ids, shape (rows,)."""
    return np.asarray(rows.groupby(list(OBJECT), sort=True, dropna=False, observed=True).ngroup().to_numpy())


def robots_in(rows: pd.DataFrame) -> tuple[npt.NDArray[np.object_], npt.NDArray[np.int64]]:
    """Return the category and the id of each robot, by its number, shape (N,) each."""
    robots = rows[list(OBJECT)].iloc[np.unique(robot_numbers(rows), return_index=True)[1]]
    return robots["robot_category"].to_numpy(dtype=object), robots["robot_id"].to_numpy()


def check_cells(times: int, robots: int, rows: int) -> None:
    """Raise AnalysisError if nearly each row has a time of its own."""
    if times * robots > MAX_CELLS_PER_ROW * (rows + 1000):
        raise AnalysisError(f"its {rows} rows have {times} times for {robots} robots, hardly any in common")


def arena_and_sizes(
    labels: dict[str, Any], category: npt.NDArray[np.object_], metadata: Mapping[str, Any]
) -> tuple[Arena, Sizes]:
    """Return the arena of a run, and the sizes of its robots, given their categories."""

    def setting(path: str) -> Any:
        return setting_of(path, labels, metadata)

    return arena_of(labels, metadata, setting), sizes_of(category, setting, metadata.get(OBJECTS))


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
    ((_, _, path),) = list(unwrapped_blocks(run, [slice(0, len(run.time_s))]))
    return path


def unwrapped_blocks(run: Run, times: Iterable[slice]) -> Iterator[tuple[slice, Trajectories, Floats]]:
    """Yield the robots at some save times after the other, all times of the run, and what `unwrapped` has of them.

    Args:
        run: In memory or in a file.
        times: Blocks that follow each other.
    """
    if not run.arena.is_periodic:
        for own, block in run.blocks(times):
            yield own, block, block.position_mm
        return
    robots = len(run.robot_id)
    period = run.arena.period_mm
    ambiguity = None if period is None else Ambiguity(period)
    # At the end of the last block: where robots were for the last time, when, and how far their steps have led.
    place, since, total = np.full((1, robots, 2), np.nan), np.full((1, robots), np.nan), np.zeros((1, robots, 2))
    first = np.full((robots, 2), np.nan)
    for own, block in run.blocks(times):
        position = np.concatenate([place, block.position_mm])
        there = np.concatenate([np.isfinite(place).all(axis=2), block.is_there])
        time = np.concatenate([since, np.where(block.is_there, block.time_s[:, None], np.nan)])
        last = np.where(there, np.arange(len(there))[:, None], 0)
        np.maximum.accumulate(last, axis=0, out=last)  # the time of the last position up to now
        filled = np.take_along_axis(position, last[:, :, None], axis=0)
        before = np.take_along_axis(time, last, axis=0)
        duration = np.where(block.is_there, block.time_s[:, None] - before[:-1], np.nan)
        steps = minimum_image(np.diff(filled, axis=0), period)
        if ambiguity is not None:
            ambiguity.add(steps, duration, run.sizes.top_speed_mm_s)
        begins = np.take_along_axis(block.position_mm, np.argmax(block.is_there, axis=0)[None, :, None], axis=0)[0]
        first = np.where(np.isfinite(first), first, begins)
        path = np.cumsum(np.concatenate([total, np.nan_to_num(steps)]), axis=0)
        place, since, total = filled[-1:], before[-1:], path[-1:]
        yield own, block, np.where(block.is_there[:, :, None], first + path[1:], np.nan)
    if ambiguity is not None:
        ambiguity.warn()
