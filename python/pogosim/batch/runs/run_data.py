"""The data file of a run, opened twice: when the run has ended, for what it says, and to be joined, for its rows."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pyarrow as pa
from pyarrow import ipc

from pogosim.batch.errors import BatchError, check_is_file, one_line
from pogosim.recover import DAMAGED, reraise_system_error
from pogosim.run_columns import RETRY, RUN, SEED
from pogosim.yaml_1_2 import WRONG_VALUES

ROWS_PER_BATCH = 65536


@dataclass(frozen=True)
class RunFile:
    """The data file of a finished run, and what it has beside its rows."""

    path: Path
    run: int
    seed: int
    retry_attempt: int  # which replacement its seed is; 0: its own seed
    schema: pa.Schema  # its columns, without metadata
    metadata: dict[bytes, bytes]
    rows: int

    def column(self, name: str) -> int:
        """Return what a column has for the run."""
        return {RUN: self.run, SEED: self.seed, RETRY: self.retry_attempt}[name]


def shared(file: RunFile) -> RunFile:
    """Return the data file of a run with what many runs have in common, such as an arena, held in memory once."""
    metadata = {known(key): known(value) for key, value in file.metadata.items()}
    return replace(file, schema=known(file.schema), metadata=metadata)


@functools.lru_cache(maxsize=1024)
def known(value: Any) -> Any:
    """Return the first of equal values."""
    return value


def read_run(path: Path, run: int, seed: int, retry_attempt: int = 0) -> RunFile:
    """Read the data file of a run, without its rows.

    Args:
        path: The file.
        run: Number of the run.
        seed: Its seed.
        retry_attempt: Which replacement that is; 0: its own seed.

    Raises:
        BatchError: It is no file, or damaged.
        OSError: It cannot be read.
    """
    with opened(path) as file:
        schema = ipc.open_file(file).schema
        list(schema.names)  # which damaged bytes need not be
        first_column = ipc.open_file(file, options=ipc.IpcReadOptions(included_fields=[0]))
        rows = sum(first_column.get_batch(i).num_rows for i in range(first_column.num_record_batches))
    return RunFile(path, run, seed, retry_attempt, schema.remove_metadata(), schema.metadata or {}, rows)


@contextlib.contextmanager
def told_as_damaged(path: Path) -> Iterator[None]:
    """Raise BatchError, with the name of a data file, for whatever a block finds wrong in it."""
    try:
        yield
    except (*DAMAGED, *WRONG_VALUES) as error:
        reraise_system_error(error)
        raise BatchError(f"{path} is damaged: {one_line(error)}; remove it, then give the same command again") from None


@contextlib.contextmanager
def opened(path: Path) -> Iterator[pa.MemoryMappedFile]:
    """Open a data file to read it.

    Raises:
        BatchError: It is no file, or what is read of it is damaged.
        OSError: It cannot be read.
    """
    check_is_file(path)
    with told_as_damaged(path), pa.memory_map(str(path)) as file:
        yield file


def batches_of(path: Path) -> Iterator[pa.RecordBatch]:
    """Yield the rows of a data file in pieces.

    Raises:
        BatchError: It is damaged.
    """
    with opened(path) as file:
        reader = ipc.open_file(file)
        for i in range(reader.num_record_batches):
            batch = reader.get_batch(i)
            batch.validate(full=True)  # or damaged places of texts lead out of memory
            for start in range(0, batch.num_rows, ROWS_PER_BATCH):
                yield batch.slice(start, ROWS_PER_BATCH)
