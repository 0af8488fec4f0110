"""Tables of tracked robots: CSV files of any tracker, or the data file of a run."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd

from pogosim.calibration.trackmate import MARK, encoding_of, spots
from pogosim.errors import CalibrationError
from pogosim.object_categories import UnknownCategoriesError, with_categories
from pogosim.run_columns import RUN, is_one_run
from pogosim.table_formats import is_binary, is_our_metadata, metadata_path
from pogosim.table_metadata import NoMetadataWarning, are_of_runs
from pogosim.utils import load_dataframe

SYNONYMS = {
    "time": ("time", "t", "timestamp", "seconds", "sec", "ms"),
    "frame": ("frame", "frame_number", "frame_id", "frames", "image"),
    "id": ("id", "robot_id", "robot", "track_id", "track", "tag", "tag_id", "marker", "marker_id", "particle", "agent"),
    "x": ("x", "pos_x", "x_pos", "position_x", "center_x", "cx"),
    "y": ("y", "pos_y", "y_pos", "position_y", "center_y", "cy"),
    "angle": ("angle", "theta", "heading", "orientation", "yaw", "phi", "direction", "deg", "rad"),
}
UNITS = ("mm", "cm", "m", "px", "rad", "deg", "s", "ms")
WITH_UNIT = re.compile(rf"^(.+?)\s*(?:_|\(|\[|\s)\s*({'|'.join(UNITS)}|pixels?|degrees?|radians?)\s*[)\]]?$")
LONG_UNITS = {"pixel": "px", "pixels": "px", "degree": "deg", "degrees": "deg", "radian": "rad", "radians": "rad"}
# Columns of the simulator that make tracks; others in its files are the program's.
OF_DATA_FILES = ("time", "robot_id", "x", "y", "angle")
EXPECTED = "expected the columns time (or frame), id, x, y and angle"

Warn = Callable[[str], None]


@dataclass(frozen=True)
class TrackTable:
    """Rows of a tracker.

    Attributes:
        rows: Columns time (or frame), id, x, y (finite) and, if the tracker has it, angle, in the units of the file.
        units: Unit that the file itself says, by column.
        source: Name of the file, for messages.
    """

    rows: pd.DataFrame
    source: str
    units: dict[str, str] = field(default_factory=dict)


def column_of(name: str) -> tuple[str, str] | None:
    """Return what a column of this name holds, and its unit ("" if the name does not say); None if it is not needed."""
    plain = str(name).strip().lower()
    found = WITH_UNIT.match(plain)
    for stem, unit in ((plain, ""), (found[1], LONG_UNITS.get(found[2], found[2])) if found else ("", "")):
        for meaning, synonyms in SYNONYMS.items():
            if stem.replace(" ", "_") in synonyms:
                return meaning, (stem if stem in UNITS else unit)
    return None


def read_track_table(path: Path, category: str, warn: Warn) -> TrackTable:
    """Read tracks, in whatever units they are.

    Args:
        path: CSV file, or data file of a run.
        category: Category of a run, the category of objects to take.
        warn: Called with each thing that is doubtful.

    Raises:
        CalibrationError: It is no such file, or a column is missing.
        OSError: It cannot be read.
    """
    if path.exists() and not path.is_file():
        raise CalibrationError(f"{path} is not a file; expected a CSV file of tracks, or the data file of a run")
    if is_binary(path) or is_our_metadata(metadata_path(path)):
        return numbers_only(read_run(path, category, warn), warn)
    try:
        encoding = encoding_of(path)
        sep = separator(path, encoding)
        table = pd.read_csv(path, comment="#", encoding=encoding, index_col=False, low_memory=False, sep=sep)
    except pd.errors.EmptyDataError:
        raise CalibrationError(f"{path} is empty; {EXPECTED}") from None
    except (ValueError, pd.errors.ParserWarning) as error:
        raise CalibrationError(f"{path} is not a CSV file of tracks: {' '.join(str(error).split())}") from None
    return numbers_only(named(table, path), warn)


def separator(path: Path, encoding: str) -> str:
    """Return what separates the columns of a CSV file: the most frequent of comma, semicolon and tab in its header."""
    with path.open(encoding=encoding) as file:
        header = next((line for line in file if line.strip() and not line.startswith("#")), "")
    return max(",;\t", key=header.count)


def read_run(path: Path, category: str, warn: Warn) -> TrackTable:
    """Read the robots of a category from the data file of a run."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", RuntimeWarning)
        warnings.simplefilter("ignore", NoMetadataWarning)  # tracks are all that is read
        try:
            table, metadata = load_dataframe(path)
        except ValueError as error:
            raise CalibrationError(str(error)) from None
    for warning in caught:
        warn(str(warning.message))
    if are_of_runs(metadata):  # others hold nothing but tracks
        try:
            table = with_categories(table, metadata)
        except UnknownCategoriesError as error:
            raise CalibrationError(f"{path}: {error}") from None
    if "robot_category" in table:
        kept = table[table["robot_category"] == category]
        if kept.empty and len(table):
            found = ", ".join(sorted(set(table["robot_category"].astype(str))))
            raise CalibrationError(f"{path} has no robots of the category {category}; found {found} (--category NAME)")
        table = kept
    if RUN in table and table[RUN].nunique() > 1 and not is_one_run(table, metadata):
        warn(f"{path} has {table[RUN].nunique()} runs; the first one is used")
        table = table[table[RUN] == table[RUN].iloc[0]]
    if "robot_category" not in table:
        return named(table, path)
    read = named(table[[name for name in OF_DATA_FILES if name in table]], path)
    return TrackTable(read.rows, read.source, {"time": "s", "x": "mm", "y": "mm", "angle": "rad"})


def named(table: pd.DataFrame, path: Path) -> TrackTable:
    """Return the columns that are needed, by their usual names; of several synonyms, the first one."""
    columns: dict[str, pd.Series] = {}
    units: dict[str, str] = {}
    there = ", ".join(map(str, table.columns))
    if MARK in table:
        table, units = spots(table)
    for name in table.columns:
        found = column_of(str(name))
        if found and found[0] not in columns:
            columns[found[0]] = table[name]
            units |= {found[0]: found[1]} if found[1] else {}
    missing = [name for name in ("id", "x", "y") if name not in columns]
    missing += [] if {"time", "frame"} & set(columns) else ["time"]
    if missing:
        other = "; of TrackMate, export the table of spots" if "TRACK_ID" in there and MARK not in there else ""
        raise CalibrationError(f"{path} has no column {', '.join(missing)}; {EXPECTED}, found {there}{other}")
    return TrackTable(pd.DataFrame(columns), str(path), units)


def numbers_only(table: TrackTable, warn: Warn) -> TrackTable:
    """Make numbers of all columns except the id; leave out rows without a time, a place or a name.

    Raises:
        CalibrationError: A cell holds something else, or nothing is left.
    """
    rows = table.rows.copy()
    for name in rows.columns.drop("id"):
        converted = pd.to_numeric(rows[name], errors="coerce").astype(float)
        wrong = np.flatnonzero((converted.isna() & rows[name].notna()).to_numpy())
        if len(wrong):
            value = rows[name].iloc[wrong[0]]
            raise CalibrationError(f"{table.source}, row {wrong[0] + 1}: {name} is {value!r}; expected a number")
        rows[name] = converted.replace([np.inf, -np.inf], np.nan)
    if "angle" in rows and rows["angle"].isna().all():
        rows = rows.drop(columns="angle")
    complete = rows.dropna(subset=[name for name in rows.columns if name != "angle"]).reset_index(drop=True)
    if complete.empty:
        raise CalibrationError(f"{table.source} has no row with a time, an id and a position; {EXPECTED}")
    if left_out := len(rows) - len(complete):
        warn(f"{table.source}: {left_out} of {len(rows)} rows without a time, an id or a position are left out")
    return TrackTable(complete, table.source, table.units)
