"""Where the rows of two data files begin to differ. They are read in batches: files may be larger than the memory."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pyarrow as pa
import pyarrow.compute as pc

from pogosim.row_batches import row_batches

Bools = npt.NDArray[np.bool_]

PLACE = ("run", "time", "robot_category", "robot_id", "subpart_id")  # columns that say of what a row is


@dataclass
class ColumnDifference:
    """How a column that both files have differs."""

    name: str
    rows: int = 0  # in how many rows
    first_row: int = -1  # from 0 on
    largest: float | None = None  # difference of numbers; None: they are none, or one is missing or not finite


@dataclass(frozen=True)
class FirstDifference:
    """The first row in which anything differs."""

    row: int  # from 0 on
    place: dict[str, Any]  # time, robot and run of the row in the first file
    values: dict[str, tuple[Any, Any]]  # by column, in the order of the first file


@dataclass
class RowsCompared:
    """What two files have in common, row by row."""

    rows: tuple[int, int]
    only_in: tuple[list[str], list[str]]  # columns that only one of them has
    types: dict[str, tuple[str, str]]  # of columns whose types differ
    columns: list[ColumnDifference] = field(default_factory=list)  # that differ
    first: FirstDifference | None = None

    @property
    def is_equal(self) -> bool:
        """Whether both have the same columns with the same values; types may differ."""
        return self.rows[0] == self.rows[1] and not any(self.only_in) and self.first is None


def compare_rows(a: Path, b: Path, tolerance: float = 0.0) -> RowsCompared:
    """Compare two files row by row, in the order of each.

    Missing values equal missing ones, and not-a-numbers each other. Numbers of 32 bits and of 64 bits are compared as
    numbers of 32 bits.

    Args:
        a: Data file.
        b: Data file.
        tolerance: Numbers with a fraction differ if they are farther apart than this, times 1 + their size.

    Raises:
        OSError, ValueError: One cannot be read.
    """
    one, other = row_batches(a), row_batches(b)
    pairs, only_in = common_columns(one.schema, other.schema)
    types = {
        name: (str(one.schema.field(i).type), str(other.schema.field(j).type))
        for name, i, j in pairs
        if not alike(one.schema.field(i).type, other.schema.field(j).type)
    }
    found = {name: ColumnDifference(name) for name, _, _ in pairs}
    first: FirstDifference | None = None
    readers = Reader(one.batches), Reader(other.batches)
    for start, left, right in side_by_side(*readers):
        unequal = {name: differing(left.column(i), right.column(j), tolerance) for name, i, j in pairs}
        for name, i, j in pairs:
            note(found[name], unequal[name], start, left.column(i), right.column(j))
        rows = [int(np.argmax(own)) for own in unequal.values() if own.any()]
        if first is None and rows:
            first = first_difference(min(rows), start, pairs, unequal, left, right)
    different = [own for own in found.values() if own.rows]
    return RowsCompared((readers[0].finish(), readers[1].finish()), only_in, types, different, first)


def common_columns(a: pa.Schema, b: pa.Schema) -> tuple[list[tuple[str, int, int]], tuple[list[str], list[str]]]:
    """Return columns that both have, with their places in each, and names of those that only one has.

    Where several columns have one name, the first ones belong together, and so on.
    """
    keys_a, keys_b = keys_of(a), keys_of(b)
    pairs = [(shown(key), place, keys_b[key]) for key, place in keys_a.items() if key in keys_b]
    return pairs, (
        [shown(key) for key in keys_a if key not in keys_b],
        [shown(key) for key in keys_b if key not in keys_a],
    )


def keys_of(schema: pa.Schema) -> dict[tuple[str, int], int]:
    """Return the places of columns by their name, and how many columns of that name are before."""
    keys: dict[tuple[str, int], int] = {}
    for place, name in enumerate(schema.names):
        keys[name, schema.names[:place].count(name)] = place
    return keys


def shown(key: tuple[str, int]) -> str:
    """Return the name of a column."""
    return key[0] if key[1] == 0 else f"{key[0]} ({key[1] + 1})"


class Reader:
    """Reads the batches of a file one after the other, and counts rows."""

    def __init__(self, batches: Iterator[pa.RecordBatch]) -> None:
        self.batches = batches
        self.rows = 0  # of all batches that were read
        self.now: pa.RecordBatch | None = None  # what is left of the last one

    def fill(self) -> bool:
        """Read on if nothing is left; tell whether there are rows."""
        while self.now is None or self.now.num_rows == 0:
            if (batch := next(self.batches, None)) is None:
                return False
            self.now = batch
            self.rows += batch.num_rows
        return True

    def take(self, count: int) -> pa.RecordBatch:
        """Return so many of the rows that are left."""
        assert self.now is not None
        taken = self.now.slice(0, count)
        self.now = self.now.slice(count)
        return taken

    def finish(self) -> int:
        """Count the other rows; returns how many the file has."""
        self.rows += sum(batch.num_rows for batch in self.batches)
        return self.rows


def side_by_side(a: Reader, b: Reader) -> Iterator[tuple[int, pa.RecordBatch, pa.RecordBatch]]:
    """Yield the number of a row, and as many rows from there on of both, up to the end of one of them."""
    start = 0
    while a.fill() and b.fill():
        assert a.now is not None
        assert b.now is not None
        count = min(a.now.num_rows, b.now.num_rows)
        yield start, a.take(count), b.take(count)
        start += count


def alike(a: pa.DataType, b: pa.DataType) -> bool:
    """Tell whether types differ at most in how names are stored."""
    return a == b or (is_text(a) and is_text(b))


def is_text(kind: pa.DataType) -> bool:
    """Tell whether values are names."""
    if pa.types.is_dictionary(kind):
        kind = kind.value_type
    return bool(pa.types.is_string(kind) or pa.types.is_large_string(kind) or pa.types.is_string_view(kind))


def is_number(kind: pa.DataType) -> bool:
    """Tell whether values are numbers."""
    return bool(pa.types.is_integer(kind) or pa.types.is_floating(kind))


def decoded(values: pa.Array) -> pa.Array:
    """Return values as they are without a dictionary, names as one type."""
    if pa.types.is_dictionary(values.type):
        values = values.dictionary_decode()
    return values.cast(pa.large_string()) if is_text(values.type) else values


def differing(a: pa.Array, b: pa.Array, tolerance: float) -> Bools:
    """Tell which of n pairs of values differ. Shape (n,)."""
    a, b = decoded(a), decoded(b)
    missing_a, missing_b = (np.asarray(own.is_null().to_numpy(zero_copy_only=False)) for own in (a, b))
    one_missing, both = missing_a != missing_b, ~missing_a & ~missing_b
    if is_number(a.type) and is_number(b.type):
        unequal = numbers_differ(a, b, tolerance)
    elif a.type == b.type and not pa.types.is_nested(a.type):
        unequal = np.asarray(pc.fill_null(pc.not_equal(a, b), False).to_numpy(zero_copy_only=False))
    else:
        unequal = np.array([x != y for x, y in zip(a.to_pylist(), b.to_pylist(), strict=True)], dtype=bool)
    return np.asarray(one_missing | (both & unequal))


def numbers_differ(a: pa.Array, b: pa.Array, tolerance: float) -> Bools:
    """Tell which numbers differ; what is said where one is missing has no meaning."""
    x, y = of_numpy(a), of_numpy(b)
    if x.dtype.kind == y.dtype.kind == "f" and x.dtype != y.dtype:
        narrow = min(x.dtype, y.dtype, key=lambda kind: kind.itemsize)
        with np.errstate(over="ignore"):
            x, y = x.astype(narrow), y.astype(narrow)
    with np.errstate(invalid="ignore", over="ignore"):
        unequal = (x != y) & ~((x != x) & (y != y))
        if tolerance > 0.0 and "f" in (x.dtype.kind, y.dtype.kind):
            x, y = x.astype(float), y.astype(float)
            near = np.abs(x - y) <= tolerance * (1.0 + np.maximum(np.abs(x), np.abs(y)))
            unequal &= ~(near & np.isfinite(x) & np.isfinite(y))
    return np.asarray(unequal)


def of_numpy(values: pa.Array) -> npt.NDArray[Any]:
    """Return numbers as an array of their own type, 0 where there is none."""
    if values.null_count:
        zeros = pa.array(np.zeros(len(values)), pa.float64()).cast(values.type)
        values = pc.if_else(values.is_valid(), values, zeros)
    return np.asarray(values.to_numpy(zero_copy_only=False))


def note(found: ColumnDifference, unequal: Bools, start: int, a: pa.Array, b: pa.Array) -> None:
    """Add the differences of some rows to those of a column."""
    if not unequal.any():
        return
    if found.rows == 0:
        found.first_row = start + int(np.argmax(unequal))
    found.rows += int(np.count_nonzero(unequal))
    a, b = decoded(a), decoded(b)
    if not (is_number(a.type) and is_number(b.type)):
        return
    both = unequal & np.asarray(pc.and_(a.is_valid(), b.is_valid()).to_numpy(zero_copy_only=False))
    x, y = of_numpy(a).astype(float), of_numpy(b).astype(float)
    with np.errstate(invalid="ignore", over="ignore"):
        apart = np.abs(x - y)[both]
    apart = apart[np.isfinite(apart)]
    if len(apart):
        found.largest = max(float(apart.max()), found.largest or 0.0)


def first_difference(
    row: int,
    start: int,
    pairs: list[tuple[str, int, int]],
    unequal: dict[str, Bools],
    a: pa.RecordBatch,
    b: pa.RecordBatch,
) -> FirstDifference:
    """Return what differs in a row of a batch."""
    place = {name: value_in(a.column(i), row) for name, i, _ in pairs if name in PLACE}
    ordered = {name: place[name] for name in PLACE if name in place}
    values = {
        name: (value_in(a.column(i), row), value_in(b.column(j), row)) for name, i, j in pairs if unequal[name][row]
    }
    return FirstDifference(start + row, ordered, values)


def value_in(column: pa.Array, row: int) -> Any:
    """Return a value of a column; numbers of 32 bits with as few digits as tell them apart."""
    value = column[row].as_py()
    return float(str(np.float32(value))) if value is not None and column.type == pa.float32() else value
