"""Looks at a run as few bytes: 16-bit codes, and of those only what has changed.

A frame, little-endian:

    bytes 0-1    1: kind of the message
    bytes 2-5    numbers of the two columns whose values follow, two bytes each, from 1; 0: none
    bytes 6-9    number of the frame, which the viewer sends back when it has shown it
    bytes 10-17  simulated time, s, a double
    then         tables: poses (objects, 3), LEDs (objects, 2), parts (parts, 2), each column that is not 0 (objects, 2)

A table has a bit for each row, the lowest bit of a byte first: whether the row differs from what the viewer has. Then
come the differences of these rows, modulo 65536, one column of the table after the other: the low bytes of all, then
the high bytes, which are mostly equal. Before its first frame a viewer has zeros, and so it has for a column whose
number is not that of the frame before. Codes of poses go from 0 at one end of the box to 65534 at the other, of
headings from -pi to pi; 65535 stands for no value. LEDs and values of columns are the high and the low half of 32
bits.

The light on the floor is a message of its own: two bytes 2, 0, then a byte for each cell.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from pogosim.film.packing import quantised
from pogosim.shapes import Floats
from pogosim.watch.looking import Look

FRAME, LIGHT = 1, 2
HEADER = struct.Struct("<HHHId")
Column = tuple[str, int]  # a name and a number, from 1; ("", 0): none
NO_COLUMN: Column = ("", 0)

Codes = npt.NDArray[np.uint16]


def halves(values: npt.NDArray[np.uint32]) -> Codes:
    """Return the high and the low half of 32 bits. Shape (n,) to (n, 2)."""
    return np.stack([values >> 16, values & 0xFFFF], axis=-1).astype(np.uint16)


def codes_of_places(places_mm: npt.NDArray[np.float32], low: Floats, high: Floats) -> list[Codes]:
    """Return the codes of x and of y in a box, of places of shape (n, 2 or more)."""
    return [quantised(places_mm[:, axis].astype(float), float(low[axis]), float(high[axis])) for axis in range(2)]


def tables_of(look: Look, low: Floats, high: Floats, columns: Sequence[Column]) -> list[Codes]:
    """Return the tables of a look in a box, with one of values for each column; those of none are empty."""
    headings = quantised(look.poses[:, 2].astype(float), -np.pi, np.pi)

    def values_of(name: str) -> Codes:
        values = look.columns.get(name)
        if values is None:
            return np.zeros((0, 2), np.uint16)
        return halves(np.ascontiguousarray(values, np.float32).view(np.uint32))

    return [
        np.stack([*codes_of_places(look.poses, low, high), headings], axis=-1),
        halves(look.leds),
        np.stack(codes_of_places(look.parts_mm, low, high), axis=-1),
        *(values_of(name) for name, _ in columns),
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
    column_numbers: list[int] = field(default_factory=list)  # of the last frame

    def frame(self, look: Look, columns: tuple[Column, Column] = (NO_COLUMN, NO_COLUMN)) -> bytes:
        """Return the next frame, with values of these columns."""
        tables = tables_of(look, self.low, self.high, columns)
        numbers = [number if len(table) else 0 for table, (_, number) in zip(tables[3:], columns, strict=True)]
        before = self.known or [np.zeros_like(table) for table in tables]
        for i, (number, own) in enumerate(zip(numbers, self.column_numbers or numbers, strict=True), start=3):
            if number != own:
                before[i] = np.zeros_like(tables[i])
        self.number += 1
        self.known, self.column_numbers = tables, numbers
        head = HEADER.pack(FRAME, *numbers, self.number, look.time_s)
        return head + b"".join(changes(table, own) for table, own in zip(tables, before, strict=True))


def light_message(levels: npt.NDArray[np.uint8]) -> bytes:
    """Return the message of the light on the floor."""
    return bytes((LIGHT, 0)) + levels.tobytes()
