"""Looks at a run as few bytes: 16-bit codes, and of those only what has changed.

A frame, little-endian:

    bytes 0-1    1: kind of the message
    bytes 2-3    number of the column whose values follow, from 1; 0: none
    bytes 4-7    number of the frame, which the viewer sends back when it has shown it
    bytes 8-15   simulated time, s, a double
    then         four tables: poses (objects, 3), LEDs (objects, 2), parts (parts, 2), column (objects, 2)

A table has a bit for each row, the lowest bit of a byte first: whether the row differs from what the viewer has. Then
come the differences of these rows, modulo 65536, one column of the table after the other: the low bytes of all, then
the high bytes, which are mostly equal. Before its first frame a viewer has zeros. Codes of poses go from 0 at one end
of the box to 65534 at the other, of headings from -pi to pi; 65535 stands for no value. LEDs and values of the column
are the high and the low half of 32 bits.

The light on the floor is a message of its own: two bytes 2, 0, then a byte for each cell.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from pogosim.film.packing import quantised
from pogosim.shapes import Floats
from pogosim.watch.looking import Look

FRAME, LIGHT = 1, 2
HEADER = struct.Struct("<HHId")

Codes = npt.NDArray[np.uint16]


def halves(values: npt.NDArray[np.uint32]) -> Codes:
    """Return the high and the low half of 32 bits. Shape (n,) to (n, 2)."""
    return np.stack([values >> 16, values & 0xFFFF], axis=-1).astype(np.uint16)


def codes_of_places(places_mm: npt.NDArray[np.float32], low: Floats, high: Floats) -> list[Codes]:
    """Return the codes of x and of y in a box, of places of shape (n, 2 or more)."""
    return [quantised(places_mm[:, axis].astype(float), float(low[axis]), float(high[axis])) for axis in range(2)]


def tables_of(look: Look, low: Floats, high: Floats, column: str | None) -> list[Codes]:
    """Return the tables of a look in a box, with the values of one column; None: of none."""
    headings = quantised(look.poses[:, 2].astype(float), -np.pi, np.pi)
    values = look.columns.get(column) if column else None
    no_values = np.zeros((0, 2), np.uint16)
    return [
        np.stack([*codes_of_places(look.poses, low, high), headings], axis=-1),
        halves(look.leds),
        np.stack(codes_of_places(look.parts_mm, low, high), axis=-1),
        no_values if values is None else halves(np.ascontiguousarray(values, np.float32).view(np.uint32)),
    ]


def changes(codes: Codes, before: Codes) -> bytes:
    """Return the rows of a table that differ, see above."""
    difference = codes - before
    is_changed = difference.any(axis=1)
    changed = difference[is_changed].T
    low, high = ((changed >> shift).astype(np.uint8) for shift in (0, 8))
    columns = b"".join(part for pair in zip(low, high, strict=True) for part in (pair[0].tobytes(), pair[1].tobytes()))
    return np.packbits(is_changed, bitorder="little").tobytes() + columns


@dataclass
class FrameWriter:
    """Writes frames for one viewer, to which all of them go, in their order."""

    low: Floats  # corners of the box in which poses are told, mm
    high: Floats
    number: int = 0
    known: list[Codes] = field(default_factory=list)  # what the viewer has
    column_number: int = 0  # of the last frame

    def frame(self, look: Look, column: str | None = None, column_number: int = 0) -> bytes:
        """Return the next frame; `column_number`: of the column, from 1."""
        tables = tables_of(look, self.low, self.high, column)
        column_number = column_number if len(tables[3]) else 0
        before = self.known or [np.zeros_like(table) for table in tables]
        if column_number != self.column_number:
            before[3] = np.zeros_like(tables[3])
        self.number += 1
        self.known, self.column_number = tables, column_number
        head = HEADER.pack(FRAME, column_number, self.number, look.time_s)
        return head + b"".join(changes(table, own) for table, own in zip(tables, before, strict=True))


def light_message(levels: npt.NDArray[np.uint8]) -> bytes:
    """Return the message of the light on the floor."""
    return bytes((LIGHT, 0)) + levels.tobytes()
