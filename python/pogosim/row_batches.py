"""The rows of a data file piece by piece, so that only a part of it is in memory at a time.

A piece is a batch of rows of a Feather file, or a row group of a Parquet file; a large one is several pieces.

    for number, piece in RowFile(Path("result.feather")).read(["time", "x"]):
        print(number, piece.num_rows)
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import pyarrow as pa
from pyarrow import ipc

from pogosim.damaged_files import damage_told
from pogosim.errors import DamagedFileError
from pogosim.table_formats import CSV, PARQUET, format_in
from pogosim.utils import read_table

if TYPE_CHECKING:
    from pyarrow.parquet import ParquetFile

# Rows of a piece, at most.
PIECE = 65536


class Piece(NamedTuple):
    """Which rows of a file a piece has."""

    batch: int  # or row group
    begin: int  # its first row there
    length: int


class RowFile:
    """A complete Feather or Parquet file.

    Attributes:
        path: The file.
        schema: Its columns and metadata.
    """

    def __init__(self, path: Path) -> None:
        """Open a file, for what it says of its rows.

        Raises:
            OSError: It cannot be read.
            DamagedFileError: It is damaged, or none of these.
        """
        self.path = path
        self.is_parquet = format_in(path) == PARQUET
        with self.opened() as file, damage_told(path):
            self.schema: pa.Schema = parquet_in(file).schema_arrow if self.is_parquet else ipc.open_file(file).schema
            list(self.schema.names)  # of damaged bytes, they may be no text

    def opened(self) -> pa.OSFile:
        """Open the file to read it.

        Raises:
            OSError: It cannot be read.
        """
        return pa.OSFile(os.fsencode(self.path))

    @cached_property
    def pieces(self) -> list[Piece]:
        """All pieces, in the order of the file.

        Raises:
            OSError: It cannot be read.
            DamagedFileError: It is damaged.
        """
        with self.opened() as file, damage_told(self.path):
            if self.is_parquet:
                groups = parquet_in(file).metadata
                sizes = [groups.row_group(number).num_rows for number in range(groups.num_row_groups)]
            else:
                reader = ipc.open_file(file, options=ipc.IpcReadOptions(included_fields=[0]))
                sizes = [reader.get_batch(number).num_rows for number in range(reader.num_record_batches)]
        return [
            Piece(batch, begin, min(PIECE, size - begin))
            for batch, size in enumerate(sizes)
            for begin in range(0, size, PIECE)
        ]

    @property
    def count(self) -> int:
        """Number of rows."""
        return sum(piece.length for piece in self.pieces)

    def read(
        self, columns: Sequence[str] | None = None, pieces: Iterable[int] | None = None
    ) -> Iterator[tuple[int, pa.Table]]:
        """Yield pieces with their numbers.

        Args:
            columns: Names of those to read, each once in the file; None: all.
            pieces: Their numbers; None: all.

        Raises:
            OSError: The file cannot be read.
            DamagedFileError: It is damaged.
        """
        with self.opened() as file:
            read_batch = self.reader(file, columns)
            last, rows = -1, None
            for number in range(len(self.pieces)) if pieces is None else pieces:
                piece = self.pieces[number]
                if piece.batch != last:
                    rows = None  # before there are two
                    with damage_told(self.path):
                        last, rows = piece.batch, read_batch(piece.batch)
                        rows.validate(full=True)  # or damaged places of texts lead out of memory
                assert rows is not None
                yield number, rows.slice(piece.begin, piece.length)

    def reader(self, file: pa.OSFile, columns: Sequence[str] | None) -> Callable[[int], pa.Table]:
        """Return a function that reads a batch or a row group with these columns."""
        with damage_told(self.path):
            if self.is_parquet:
                parquet, names = parquet_in(file), None if columns is None else list(columns)
                return lambda number: parquet.read_row_group(number, columns=names)
            places = None if columns is None else [self.schema.get_field_index(name) for name in columns]
            reader = ipc.open_file(file, options=ipc.IpcReadOptions(included_fields=places))
            return lambda number: pa.Table.from_batches([reader.get_batch(number)])


def parquet_in(file: pa.OSFile) -> ParquetFile:
    """Open a Parquet file."""
    import pyarrow.parquet as pq  # takes a while

    return pq.ParquetFile(file)


@dataclass(frozen=True)
class RowBatches:
    """Columns, metadata and rows of a data file."""

    schema: pa.Schema
    batches: Iterator[pa.RecordBatch]  # in the order of the file; each can be had once, and may say that it is damaged


def row_batches(path: Path) -> RowBatches:
    """Open a data file of any kind. Rows of CSV files and of unfinished ones are read at once.

    Raises:
        OSError: It cannot be read.
        DamagedFileError: It is damaged, or no data file.
    """
    if path.is_file() and format_in(path) != CSV:
        with contextlib.suppress(DamagedFileError):  # or it is unfinished
            file = RowFile(path)
            return RowBatches(file.schema, (batch for _, piece in file.read() for batch in piece.to_batches()))
    table = read_table(path)
    return RowBatches(table.schema, iter(table.to_batches(PIECE)))
