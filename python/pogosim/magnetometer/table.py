"""Tables of readings at known headings."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pogosim.calibration.reading import Warn
from pogosim.calibration.tracks import Floats
from pogosim.errors import CalibrationError
from pogosim.lines import counted
from pogosim.magnetometer.csv_text import CsvLine, number_in, read_lines

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
    """Read a table of readings, by the rules of a run with `source: csv`.

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
    lines = read_lines(path)
    if not lines:
        raise CalibrationError(f"{path} is empty; {EXPECTED}")
    if all(not math.isnan(number_in(name)) for name in without_empty_end(lines[0].fields)):
        places = places_without_header(lines[0].fields, path)
    else:
        places = places_in_header(lines.pop(0).fields, path, warn)
    rows = numbers(lines, places, path, warn)
    angles = rows[:, 0]
    known = unit or unit_of(angles)
    angle_rad = angles * (2.0 * math.pi / TURN[known])
    return ReadingTable(-angle_rad if is_y_up else angle_rad, rows[:, 1:], str(path))


def without_empty_end(fields: Sequence[str]) -> Sequence[str]:
    """Return fields without empty ones at their end, where a line ends with a delimiter."""
    return fields[: max((place for place, text in enumerate(fields, 1) if text), default=0)]


def shortened(cells: Iterable[object]) -> str:
    """Return cells of a table for a message, without the end of a long line."""
    text = ", ".join(map(str, cells))
    return text if len(text) <= SHOWN else f"{text[:SHOWN]} ..."


def places_without_header(fields: Sequence[str], path: Path) -> list[int]:
    """Return the places of angle, x, y and z in a table whose first line is one of numbers."""
    found = len(without_empty_end(fields))
    if found != len(SYNONYMS):
        raise CalibrationError(f"{path} has {counted(found, 'column')} and no header; {EXPECTED}")
    return list(range(found))


def places_in_header(names: Sequence[str], path: Path, warn: Warn) -> list[int]:
    """Return the places of angle, x, y and z."""
    plain = [name.lower() for name in names]
    found = {wanted: next((name for name in synonyms if name in plain), None) for wanted, synonyms in SYNONYMS.items()}
    if missing := [SYNONYMS[wanted][0] for wanted, name in found.items() if name is None]:
        raise CalibrationError(f"{path} has no column {', '.join(missing)}; {EXPECTED}, found {shortened(names)}")
    for name in found.values():
        if plain.count(str(name)) > 1:
            warn(f"{path}: the column '{name}' stands there several times; the first one is read")
    return [plain.index(str(name)) for name in found.values()]


def numbers(lines: Sequence[CsvLine], places: Sequence[int], path: Path, warn: Warn) -> Floats:
    """Return angle, x, y and z of all rows; those that no sensor can have measured are left out, with a warning.

    Fields behind those that are needed do not matter, as in a run.
    """
    rows = np.full((len(lines), len(places)), np.nan)
    for row, (_, fields) in zip(rows, lines, strict=True):
        row[:] = [number_in(fields[place]) if place < len(fields) else math.nan for place in places]
    is_possible = (np.abs(rows[:, 0]) <= LARGEST_ANGLE) & ((rows[:, 1:] >= COUNTS[0]) & (rows[:, 1:] <= COUNTS[1])).all(
        1
    )
    if is_possible.all() and len(rows):
        return rows
    found = ""
    left_out = np.flatnonzero(~is_possible)
    if len(left_out):
        number, fields = lines[int(left_out[0])]
        advice = "; write 0.5 for 0,5" if any(map(DECIMAL_COMMA.fullmatch, fields)) else ""
        found = f"the first one, in line {number}, is {shortened(fields)}{advice}"
    if len(left_out) == len(rows):
        raise CalibrationError(
            f"{path} has no row of four numbers, an angle and readings of 16 bits{found and f': {found}'}; {EXPECTED}"
        )
    warn(
        f"{path}: {len(left_out)} of {len(rows)} rows are not four numbers, an angle and readings of 16 bits, and are "
        f"left out; {found}"
    )
    kept: Floats = rows[is_possible]
    return kept


def unit_of(angles: Floats) -> str:
    """Return the unit of angles that should cover a turn."""
    return "radians" if float(np.abs(angles).max()) <= EXCESS * TURN["radians"] else "degrees"
