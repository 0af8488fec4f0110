"""The runs of a data file whose rows stay on the disk, and are read some save times at a time.

The file is cut into pieces, its batches of rows (at most 65536 of each at once). One scan finds the runs, their robots
and save times, and which rows of which pieces are whose:

    piece 0 | run 0, 0 s to 41 s                       |
    piece 1 | run 0, 41 s to 80 s | run 1, 0 s to 3 s  |

Then `StoredRun.blocks` reads the pieces of a run one after the other; rows of a time that is in two of them are joined.

    for run in runs_of(Path("result.feather")):
        for times, block in run.blocks(times_of(run.present)):
            print(block.time_s, block.position_mm.shape)
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import pandas as pd
import pyarrow as pa

from pogosim.analysis.progress import rows_read
from pogosim.analysis.trajectories import (
    OBJECT,
    Run,
    Trajectories,
    arena_and_sizes,
    category_names,
    check_cells,
    headings_in,
    label_columns,
    need_numbers,
    of_categories,
    robots_in,
    with_arenas_told_apart,
    with_objects,
)
from pogosim.far_away import is_far, warn_of_far
from pogosim.row_batches import RowFile
from pogosim.run_columns import may_be_one_run
from pogosim.table_formats import CSV, format_in
from pogosim.table_metadata import are_of_runs, metadata_of
from pogosim.utils import parsed_metadata, positions_within, scaled, warn_of_no_metadata
from pogosim.varied import OBJECTS

Key = tuple[Any, ...]

POSITION = ("time", "x", "y")


class ReadAsAWhole(Exception):  # noqa: N818 -- it is no error
    """The rows of the file have to be read as a whole: they are in another order, or there is something else."""


# ---- the file ----


def row_file(path: Path) -> RowFile:
    """Open a file whose rows can stay in it.

    Raises:
        ReadAsAWhole: It is none.
        OSError: It cannot be read.
        DamagedFileError: It is damaged, or not complete.
    """
    if not path.is_file() or format_in(path) == CSV:  # a pipe would wait
        raise ReadAsAWhole
    return RowFile(path)


# ---- which rows ----


class Own(NamedTuple):
    """The rows of a run in a piece."""

    piece: int
    begin: int  # of its rows in the piece
    end: int
    is_all: bool  # every row between them
    first: int  # number of their first and last time
    last: int


@dataclass(frozen=True)
class Selection:
    """Which rows of a file are whose."""

    rows: RowFile
    columns: tuple[str, ...]  # those that say it
    labels: tuple[str, ...]  # those that tell runs apart; none: there is one
    categories: frozenset[str] | None  # of the robots; None: all
    metadata: Mapping[str, Any] = field(repr=False)

    def objects(self, piece: pa.Table) -> pd.DataFrame:
        """Return the rows of the robots in a piece. Their index is their place in the piece."""
        rows = with_objects(piece.to_pandas(), self.metadata)
        return rows if self.categories is None else rows[of_categories(rows, self.categories)]

    def runs(self, rows: pd.DataFrame) -> Iterator[tuple[Key, pd.DataFrame]]:
        """Sort rows by run."""
        if not self.labels:
            yield (), rows
            return
        for values, own in rows.groupby(list(self.labels), sort=False, dropna=False, observed=True):
            yield key_of(values), own


def key_of(values: Any) -> Key:
    """Return labels as a key: null is None, whatever its type."""
    return tuple(None if pd.isna(value) else value for value in values)


def with_position(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the rows that have a time and a position."""
    found: pd.DataFrame = rows[np.isfinite(rows["time"]) & np.isfinite(rows["x"]) & np.isfinite(rows["y"])]
    return found


@dataclass(frozen=True)
class StoredRun(Run):
    """A run whose rows are in a file. T times, N robots. What it has is that of `Trajectories`."""

    counts: npt.NDArray[np.int64]  # (T,), how many robots there are
    selection: Selection
    key: Key
    own: tuple[Own, ...]  # in the order of the file

    @property
    def column_names(self) -> list[str]:
        """Names of the columns of the file."""
        return list(self.selection.rows.schema.names)

    @property
    def present(self) -> npt.NDArray[np.int64]:
        """How many robots have a position at each time, shape (T,)."""
        return self.counts

    def read_blocks(self, times: Iterable[slice], columns: Sequence[str] = ()) -> Iterator[tuple[slice, Trajectories]]:
        """Yield the robots at some save times after the other, see `Run.blocks`."""
        waiting: list[pd.DataFrame] = []
        pieces = None
        known = -1  # the last time of which rows have been read
        for span in times:
            if pieces is None:
                later = [own for own in self.own if own.last >= span.start]
                pieces = self.read(later, columns)
            for last, rows in pieces if known < span.stop else ():
                waiting.append(rows)
                known = last
                if known >= span.stop:
                    break
            begin, end = self.time_s[[span.start, span.stop - 1]]
            rows = waiting[0] if len(waiting) == 1 else pd.concat(waiting)
            time = rows["time"].to_numpy()
            low, high = np.searchsorted(time, begin, side="left"), np.searchsorted(time, end, side="right")
            waiting = [rows.iloc[high:]]
            yield span, self.arranged(span, rows.iloc[low:high])

    def read(self, own: Sequence[Own], columns: Sequence[str]) -> Iterator[tuple[int, pd.DataFrame]]:
        """Yield the rows of this run in some pieces, sorted by time, with the number of the last time in each.

        They have the columns time, x, y, angle (NaN without), `robot`, the number of the robot, and others asked for.
        """
        rows = self.selection.rows
        names = set(rows.schema.names)
        poses = [name for name in (*POSITION, "angle") if name in names]
        ids_are_enough = "robot_id" in names and len(np.unique(self.robot_id)) == len(self.robot_id)
        is_simple = ids_are_enough and all(one.is_all for one in own)
        who = ["robot_id"] if is_simple else [name for name in self.selection.columns if name not in poses]
        wanted = list(dict.fromkeys([*poses, *who, *columns]))
        by_number = {one.piece: one for one in own}
        for number, piece in rows.read(wanted, by_number):
            part = by_number[number]
            piece = piece.slice(part.begin, part.end - part.begin)
            if is_simple:
                found = piece.to_pandas()
            else:
                found = next(rows for key, rows in self.selection.runs(self.kept(piece)) if key == self.key)
            found = found.assign(robot=self.numbers(found), time=found["time"].astype(float))
            yield part.last, found.reindex(columns=[*POSITION, "angle", "robot", *columns])

    def kept(self, piece: pa.Table) -> pd.DataFrame:
        """Return the rows of the robots of a piece that have a position."""
        rows = self.selection.objects(piece)
        return with_position(rows[~is_far(rows)])

    def numbers(self, rows: pd.DataFrame) -> npt.NDArray[np.int64]:
        """Return the number of the robot of each row."""
        if len(np.unique(self.robot_id)) == len(self.robot_id):
            order = np.argsort(self.robot_id)
            return np.asarray(order[np.searchsorted(self.robot_id, rows["robot_id"].to_numpy(), sorter=order)])
        robots = pd.MultiIndex.from_arrays([self.category, self.robot_id])
        return np.asarray(robots.get_indexer(pd.MultiIndex.from_frame(rows[list(OBJECT)].astype({OBJECT[0]: object}))))

    def arranged(self, span: slice, rows: pd.DataFrame) -> Trajectories:
        """Arrange the rows of some save times."""
        times = self.time_s[span]
        at_time, robot = np.searchsorted(times, rows["time"].to_numpy()), rows["robot"].to_numpy()
        shape = (len(times), len(self.robot_id))
        row = np.full(shape, -1, dtype=np.int64)
        row[at_time, robot] = np.arange(len(rows))
        position = np.full((*shape, 2), np.nan)
        position[at_time, robot] = rows[["x", "y"]].to_numpy(dtype=float)
        heading = np.full(shape, np.nan)
        heading[at_time, robot] = headings_in(rows)
        has_angle = "angle" in self.column_names
        return Trajectories(
            labels=self.labels,
            arena=self.arena,
            time_s=times,
            category=self.category,
            robot_id=self.robot_id,
            position_mm=position,
            heading_rad=heading,
            row=row,
            rows=rows.drop(columns=["robot"] if has_angle else ["robot", "angle"]),
            sizes=self.sizes,
        )


# ---- the scan ----


class Found:
    """What has been found of a run so far."""

    def __init__(self) -> None:
        self.times: list[npt.NDArray[np.float64]] = [np.empty(0)]
        self.counts: list[npt.NDArray[np.int64]] = [np.empty(0, dtype=np.int64)]
        self.length = 0  # number of times
        self.last_s = -np.inf
        self.at_last: pd.DataFrame | None = None  # the robots at the last time
        self.robots: pd.DataFrame | None = None  # all
        self.own: list[Own] = []

    def add(self, piece: int, rows: pd.DataFrame) -> None:
        """Add the rows that the run has in the next piece.

        Raises:
            ReadAsAWhole: They are not in the order of time, or a robot has two rows at a time.
        """
        time, robots = rows["time"].to_numpy(dtype=float), rows[list(OBJECT)]
        if time[0] < self.last_s or (np.diff(time) < 0.0).any():
            raise ReadAsAWhole
        times, first, count = np.unique(time, return_index=True, return_counts=True)
        goes_on = int(times[0] == self.last_s)  # the first time is the last one of the piece before
        at_first, at_last = robots.iloc[: count[0]], robots.iloc[first[-1] :]
        if goes_on:
            at_first = pd.concat([own for own in (self.at_last, at_first) if own is not None])
            at_last = at_first if len(times) == 1 else at_last
            self.counts[-1][-1] += count[0]
        if at_first.duplicated().any() or robots.assign(time=time).duplicated().any():
            raise ReadAsAWhole
        self.times.append(times[goes_on:])
        if len(times) > goes_on:
            self.counts.append(count[goes_on:])
        first_time = self.length - goes_on
        self.length += len(times) - goes_on
        self.last_s, self.at_last = times[-1], at_last
        every = robots.drop_duplicates()
        self.robots = every if self.robots is None else pd.concat([self.robots, every]).drop_duplicates()
        begin, end = int(rows.index[0]), int(rows.index[-1]) + 1
        self.own.append(Own(piece, begin, end, end - begin == len(rows), first_time, self.length - 1))


def runs_of(path: Path, category: str | None = None, expect: Callable[[int], None] | None = None) -> list[StoredRun]:
    """Find the runs of a file, as `trajectories_of` does with all its rows, and warn as it does.

    Args:
        path: Complete Feather or Parquet file. The rows of each run are in the order of time.
        category: See `trajectories_of`.
        expect: Called with the number of rows that will be read.

    Raises:
        ReadAsAWhole: It is another file, or has something that only `trajectories_of` knows what to do with; it says
            all that is wrong with files.
        OSError: It cannot be read.
        DamagedFileError: It is damaged, or not complete.
    """
    file = row_file(path)
    if expect is not None:
        expect(file.count)
    metadata = parsed_metadata(file.schema)
    if not are_of_runs(metadata_of(file.schema)):
        warn_of_no_metadata(path)
    selection = selection_of(file, metadata, category)
    names = selection.labels
    found: dict[Key, Found] = {}
    labels: pd.DataFrame | None = None
    polygons: Any = metadata.get("arena_polygons")
    has_outlines = isinstance(polygons, list) and bool(polygons) and all(map(len, polygons))
    inside, robots, far = np.zeros(3, dtype=np.int64), 0, 0
    for number, piece in file.read(selection.columns):
        if has_outlines:
            inside += positions_within(polygons, piece.select(["x", "y"]).to_pandas())
        rows = selection.objects(piece)
        need_numbers(rows, [name for name in (*POSITION, "angle") if name in rows])
        is_too_far = is_far(rows)
        robots, far = robots + len(rows), far + int(np.count_nonzero(is_too_far))
        rows = with_position(rows[~is_too_far])
        if names and len(rows):
            own = rows[list(names)].drop_duplicates()
            labels = own if labels is None else pd.concat([labels, own]).drop_duplicates()
        for key, of_run in selection.runs(rows) if len(rows) else ():
            found.setdefault(key, Found()).add(number, of_run)
        rows_read(piece.num_rows)
    if not found:
        raise ReadAsAWhole
    warn_of_far(far, robots)
    if has_outlines:
        metadata["arena_polygons"] = scaled(polygons, inside)
    each = [{"run": 0}]
    if labels is not None:
        groups: Any = labels.groupby(list(names), sort=True, dropna=False, observed=True)
        each = [dict(zip(names, values, strict=True)) for values, _ in groups]
    runs = [run_of(own, found[key_of(own[name] for name in names)], selection, metadata) for own in each]
    return with_arenas_told_apart(runs)


def run_of(labels: dict[str, Any], found: Found, selection: Selection, metadata: Mapping[str, Any]) -> StoredRun:
    """Return a run of which everything has been found.

    Raises:
        AnalysisError: Nearly each row has a time of its own.
    """
    assert found.robots is not None
    category, robot_id = robots_in(found.robots)
    counts = np.concatenate(found.counts)
    check_cells(len(counts), len(robot_id), int(counts.sum()))
    arena, sizes = arena_and_sizes(labels, category, metadata)
    return StoredRun(
        labels=labels,
        arena=arena,
        time_s=np.concatenate(found.times),
        category=category,
        robot_id=robot_id,
        sizes=sizes,
        counts=counts,
        selection=selection,
        key=key_of(labels[name] for name in selection.labels),
        own=tuple(found.own),
    )


def selection_of(file: RowFile, metadata: Mapping[str, Any], category: str | None) -> Selection:
    """Return which rows are to be taken.

    Raises:
        ReadAsAWhole: That cannot be said without all rows, or there is something wrong.
    """
    names = list(file.schema.names)
    empty = pd.DataFrame(columns=names)
    labels = [] if may_be_one_run(metadata) or "files" in metadata else label_columns(empty, metadata)
    varied = [name for name in names if name.startswith(f"{OBJECTS}.")] if "robot_category" not in names else []
    columns = [name for name in dict.fromkeys([*POSITION, *OBJECT, "subpart_id", *labels]) if name in names]
    twice = [name for name in [*columns, "angle"] if names.count(name) > 1]
    kinds = [file.schema.field(name).type for name in columns if name not in twice]
    is_strange = any(pa.types.is_dictionary(kind) or pa.types.is_nested(kind) for kind in kinds)
    # What the program of a single run calls like a label, and what pandas says of columns, needs all rows.
    has_own_labels = may_be_one_run(metadata) and bool(label_columns(empty, metadata))
    is_of_pandas = b"pandas" in (file.schema.metadata or {})
    is_of_several = "files" in metadata
    needs_all = [twice, varied, is_strange, has_own_labels, is_of_pandas, is_of_several]
    if any(needs_all) or not set(POSITION) <= set(names):
        raise ReadAsAWhole
    of_objects = [name for name in (*OBJECT, "subpart_id") if name in names] or ["time"]
    every = Selection(file, tuple(columns), tuple(labels), None, metadata)
    there: set[str] = set()
    for _, piece in file.read(of_objects):
        there |= set(every.objects(piece)["robot_category"].astype(str).unique())
    chosen = category_names(there, metadata, category)
    categories = None if chosen is None or there <= chosen else frozenset(chosen)
    return Selection(file, tuple(columns), tuple(labels), categories, metadata)
