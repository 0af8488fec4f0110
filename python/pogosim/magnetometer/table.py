"""Tables of readings at known headings."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from pogosim.calibration.reading import Warn, separator
from pogosim.calibration.tracks import Floats
from pogosim.errors import CalibrationError

AXES = ("x", "y", "z")
SYNONYMS = {
    "angle": ("angle", "heading", "theta", "orientation", "yaw"),
    "x": ("mag_x", "magn_x", "mx", "x"),
    "y": ("mag_y", "magn_y", "my", "y"),
    "z": ("mag_z", "magn_z", "mz", "z"),
}
DECIMAL_COMMA = re.compile(r"[-+]?[0-9]+,[0-9]+")
EXPECTED = "expected the columns angle, mag_x, mag_y and mag_z"
TURN = {"degrees": 360.0, "radians": 2.0 * math.pi}
MOST_COLUMNS = 1000
LARGEST_ANGLE = 1e6  # in either unit, as in the simulator
COUNTS = (-32768.0, 32767.0)  # of a sensor with 16 bits
SHOWN = 200  # characters of a line of the table in a message
EXCESS = 1.02  # of the largest angle over a turn in radians, beyond which angles must be degrees


@dataclass(frozen=True)
class ReadingTable:
    """Readings of a robot that was turned.

    Attributes:
        angle_rad: Heading of the robot, clockwise seen from above (y down). Shape (rows,).
        reading: Readings of x, y and z, counts. Shape (rows, 3).
        source: Name of the file, for messages.
    """

    angle_rad: Floats
    reading: Floats
    source: str


def read_reading_table(path: Path, unit: str | None, is_y_up: bool, warn: Warn) -> ReadingTable:
    """Read a table of readings.

    Args:
        path: CSV file with a header, or with four columns of numbers: angle, x, y, z.
        unit: "degrees" or "radians"; None: recognised by the largest angle.
        is_y_up: Angles are counter-clockwise.
        warn: Called with each thing that is doubtful.

    Raises:
        CalibrationError: It is no such file, or a column is missing.
        OSError: It cannot be read.
    """
    if path.exists() and not path.is_file():
        raise CalibrationError(f"{path} is not a file; {EXPECTED}")
    rows = numbers(named(read_csv(path), path), path, warn)
    angles = rows["angle"].to_numpy(float)
    known = unit or unit_of(angles)
    angle_rad = angles * (2.0 * math.pi / TURN[known])
    return ReadingTable(-angle_rad if is_y_up else angle_rad, rows[list(AXES)].to_numpy(float), str(path))


def read_csv(path: Path) -> pd.DataFrame:
    """Read a CSV file as text; columns without a header have numbers for names."""
    try:
        sep = separator(path, "utf-8-sig")
        check_columns(path, sep)
        table = pd.read_csv(
            path, comment="#", encoding="utf-8-sig", index_col=False, sep=sep, dtype=str, skipinitialspace=True
        )
        if all(is_number(str(name)) for name in table.columns):
            table = pd.read_csv(path, comment="#", encoding="utf-8-sig", sep=sep, dtype=str, header=None)
    except pd.errors.EmptyDataError:
        raise CalibrationError(f"{path} is empty; {EXPECTED}") from None
    except (ValueError, pd.errors.ParserWarning) as error:
        raise CalibrationError(f"{path} is not a CSV file of readings: {' '.join(str(error).split())}") from None
    return table


def check_columns(path: Path, sep: str) -> None:
    """Raise CalibrationError for a file with very many columns, which would take long to read."""
    with path.open(encoding="utf-8-sig") as file:
        columns = 1 + max((line.count(sep) for line in file if not line.startswith("#")), default=0)
    if columns > MOST_COLUMNS:
        raise CalibrationError(f"{path} has a line of {columns} columns; {EXPECTED}")


def shortened(cells: Iterable[object]) -> str:
    """Return cells of a table for a message, without the end of a long line."""
    text = ", ".join(map(str, cells))
    return text if len(text) <= SHOWN else f"{text[:SHOWN]} ..."


def is_number(text: str) -> bool:
    """Tell whether a text is a number."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def named(table: pd.DataFrame, path: Path) -> pd.DataFrame:
    """Return the columns angle, x, y and z."""
    if all(isinstance(name, int) for name in table.columns):
        if table.shape[1] != len(SYNONYMS):
            raise CalibrationError(f"{path} has {table.shape[1]} columns and no header; {EXPECTED}")
        return table.set_axis(list(SYNONYMS), axis="columns")
    by_name = {str(name).strip().lower(): name for name in table.columns}
    found = {wanted: first_of(synonyms, by_name) for wanted, synonyms in SYNONYMS.items()}
    missing = [SYNONYMS[wanted][0] for wanted, name in found.items() if name is None]
    if missing:
        there = shortened(table.columns)
        raise CalibrationError(f"{path} has no column {', '.join(missing)}; {EXPECTED}, found {there}")
    return pd.DataFrame({wanted: table[by_name[str(name)]] for wanted, name in found.items()})


def first_of(synonyms: Sequence[str], names: dict[str, str]) -> str | None:
    """Return the first synonym that is a name."""
    return next((name for name in synonyms if name in names), None)


def numbers(rows: pd.DataFrame, path: Path, warn: Warn) -> pd.DataFrame:
    """Make numbers of all cells; rows that no sensor can have measured are left out, with a warning."""
    converted = rows.apply(pd.to_numeric, errors="coerce").astype(float)
    converted["angle"] = converted["angle"].where(converted["angle"].between(-LARGEST_ANGLE, LARGEST_ANGLE))
    for axis in AXES:
        converted[axis] = converted[axis].where(converted[axis].between(*COUNTS))
    complete = converted.dropna()
    if left_out := len(rows) - len(complete):
        first = int(np.flatnonzero(converted.isna().any(axis="columns").to_numpy())[0])
        cells = rows.iloc[first].tolist()
        has_comma = any(DECIMAL_COMMA.fullmatch(str(cell).strip()) for cell in cells)
        found = f"the first one is {shortened(cells)}{'; write 0.5 for 0,5' if has_comma else ''}"
        if complete.empty:
            raise CalibrationError(
                f"{path} has no row of four numbers, an angle and readings of 16 bits: {found}; {EXPECTED}"
            )
        warn(
            f"{path}: {left_out} of {len(rows)} rows are not four numbers, an angle and readings of 16 bits, and are "
            f"left out; {found}"
        )
    if complete.empty:
        raise CalibrationError(f"{path} has no row of four numbers, an angle and readings of 16 bits; {EXPECTED}")
    kept: pd.DataFrame = complete.reset_index(drop=True)
    return kept


def unit_of(angles: Floats) -> str:
    """Return the unit of angles that should cover a turn."""
    return "radians" if float(np.abs(angles).max()) <= EXCESS * TURN["radians"] else "degrees"
