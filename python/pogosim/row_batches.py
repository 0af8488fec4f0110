"""The rows of a data file in batches, so that only a part of it is in memory at a time."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pyarrow as pa
from pyarrow import ipc

from pogosim.recover import DAMAGED, reraise_system_error
from pogosim.table_formats import FEATHER, PARQUET, format_in
from pogosim.utils import read_table

ROWS = 65536  # of a batch, where the format leaves the choice


@dataclass(frozen=True)
class RowBatches:
    """An open data file."""

    path: Path
    schema: pa.Schema
    batches: Iterator[pa.RecordBatch]  # in the order of the file; each can be had once


@contextlib.contextmanager
def row_batches(path: Path) -> Iterator[RowBatches]:
    """Open a data file, until the end of the block. Files that have no batches (CSV, unfinished ones) are read at once.

    Raises:
        OSError: It cannot be read.
        ValueError: It is damaged, or no data file; of a batch that is damaged, when it is asked for.
    """
    with contextlib.ExitStack() as stack:
        yield in_batches(path, stack) or of_table(path)


def in_batches(path: Path, stack: contextlib.ExitStack) -> RowBatches | None:
    """Open a complete Feather or Parquet file; None for others."""
    if not path.is_file():
        return None  # what is wrong is said by what reads tables
    kind = format_in(path)
    try:
        if kind == PARQUET:
            import pyarrow.parquet as pq  # takes a while

            parquet = stack.enter_context(pq.ParquetFile(path))
            return RowBatches(path, parquet.schema_arrow, readable(path, parquet.iter_batches(ROWS)))
        if kind == FEATHER:
            reader = stack.enter_context(ipc.open_file(stack.enter_context(path.open("rb"))))
            own = (reader.get_batch(number) for number in range(reader.num_record_batches))
            return RowBatches(path, reader.schema, readable(path, own))
    except DAMAGED as error:
        reraise_system_error(error)
    return None


def readable(path: Path, batches: Iterator[pa.RecordBatch]) -> Iterator[pa.RecordBatch]:
    """Yield batches; what Arrow says of a damaged one names the file."""
    try:
        yield from batches
    except DAMAGED as error:
        reraise_system_error(error)
        raise ValueError(f"{path} is damaged: its rows cannot be read: {error}") from error


def of_table(path: Path) -> RowBatches:
    """Read a file at once."""
    table = read_table(path)
    return RowBatches(path, table.schema, iter(table.to_batches(ROWS)))
