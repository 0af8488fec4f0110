"""Runs joined into one file: rows of one run after the other, with constant columns, whatever order the runs ended in.

Rows go through in pieces of at most 65536, so that memory does not grow with the number or length of the runs.
"""

from __future__ import annotations

import contextlib
import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from pogosim.batch.errors import BatchError, cannot, is_whole, one_line
from pogosim.batch.result_files.parts import PLAIN, Format, Part
from pogosim.batch.result_files.result_metadata import COMBINATIONS, MANIFEST, Earlier, manifest, metadata_of, summary
from pogosim.batch.runs.run_data import ROWS_PER_BATCH, batches_of, told_as_damaged
from pogosim.outputs import OutputError, lock, real_output
from pogosim.recover import RecoverError, check_metadata_beside, check_replaceable
from pogosim.run_columns import tells_runs_apart
from pogosim.table_formats import FEATHER, format_of
from pogosim.tables import TableWriter, table_writer, write_metadata_beside
from pogosim.times import as_float64
from pogosim.yaml_1_2 import dump_yaml, plain


def check_columns(schema: pa.Schema, columns: Sequence[str], program: str, layout: Format = PLAIN) -> None:
    """Check that no column of the program would be taken for one that tells runs apart.

    Raises:
        BatchError: There is one of such a name.
    """
    for name in schema.names:
        if name in layout.run_columns:
            raise BatchError(
                f"{program} writes a column '{name}', and a batch adds one of that name; rename the program's"
            )
        if name in columns:
            raise BatchError(
                f"{program} writes a column '{name}', and result_new_columns adds one of that name; rename one of them"
            )
        if tells_runs_apart(name):
            raise BatchError(
                f"{program} writes a column '{name}', and columns of that name tell runs apart; rename the program's"
            )


def column_type(values: Sequence[Any]) -> pa.DataType:
    """Return the type of a column with these values: bool, int64, float64, or string if they are of several kinds."""
    kinds = {type(plain(value)) for value in values if value is not None}
    if kinds == {bool}:
        return pa.bool_()
    if kinds == {int} and all(abs(value) < 2**63 for value in values if value is not None):
        return pa.int64()
    if kinds and kinds <= {int, float} and all(abs(value) <= sys.float_info.max for value in values if is_whole(value)):
        return pa.float64()
    return pa.string()


def as_type(value: Any, kind: pa.DataType) -> Any:
    """Return a value for a column of a type."""
    if value is None:
        return None
    if pa.types.is_string(kind) and not isinstance(value, str):
        return dump_yaml(value, is_flow=True).strip()
    return float(value) if pa.types.is_floating(kind) else value


def joint_schema(schemas: Sequence[pa.Schema]) -> pa.Schema:
    """Return all columns of several files, in order of appearance.

    Raises:
        BatchError: A column has types that do not fit together.
    """
    distinct = list(dict.fromkeys(schema.remove_metadata() for schema in schemas))
    try:
        return pa.unify_schemas(distinct, promote_options="permissive")
    except pa.ArrowException as error:
        raise BatchError(f"runs have columns that do not fit together: {one_line(error)}") from None


def constant_column(value: Any, kind: pa.DataType, count: int) -> pa.Array:
    """Return a column with one value in all rows; pa.scalar() would import pandas, which takes as long as 100 runs."""
    if value is None:
        return pa.nulls(count, kind)
    if pa.types.is_string(kind):
        text = value.encode()
        ends = np.arange(count + 1, dtype=np.int32) * np.int32(len(text))
        return pa.Array.from_buffers(kind, count, [None, pa.py_buffer(ends), pa.py_buffer(text * count)])
    if pa.types.is_boolean(kind):
        values = np.packbits(np.full(count, value), bitorder="little")
    elif kind == pa.int64():
        values = np.full(count, value, dtype=np.int64)
    elif kind == pa.float64():
        values = np.full(count, value, dtype=np.float64)
    else:
        return pa.repeat(pa.scalar(value, kind), count)
    return pa.Array.from_buffers(kind, count, [None, pa.py_buffer(values)])


def with_columns(batch: pa.RecordBatch, schema: pa.Schema, constants: dict[str, Any]) -> pa.RecordBatch:
    """Return rows with all columns of a schema: constant ones, and null where the run has no such column."""
    own = {name: batch.column(i) for i, name in enumerate(batch.schema.names)}
    columns = []
    for field in schema:
        if field.name in constants:
            columns.append(constant_column(constants[field.name], field.type, batch.num_rows))
        elif field.name in own:
            column = own[field.name]
            is_old_time = field.name == "time" and column.type == pa.float32() and field.type == pa.float64()
            if is_old_time:
                columns.append(pa.array(as_float64(column.to_numpy(zero_copy_only=False))))
            else:
                columns.append(column if column.type == field.type else column.cast(field.type))
        else:
            columns.append(pa.nulls(batch.num_rows, field.type))
    return pa.RecordBatch.from_arrays(columns, schema=schema)


class Pieces:
    """Writes rows in batches of a fixed size, so that the bytes depend on the rows alone."""

    def __init__(self, writer: TableWriter) -> None:
        self.writer = writer
        self.waiting: list[pa.RecordBatch] = []
        self.rows = 0

    def add(self, batch: pa.RecordBatch) -> None:
        """Add rows."""
        self.waiting.append(batch)
        self.rows += batch.num_rows
        if self.rows >= ROWS_PER_BATCH:
            self.write(ROWS_PER_BATCH)

    def write(self, count: int) -> None:
        """Write the first rows."""
        table = pa.Table.from_batches(self.waiting)
        self.writer.write_table(table.slice(0, count).combine_chunks())
        rest = table.slice(count)
        # A copy of the rest, so that what is written can be forgotten.
        self.waiting = rest.combine_chunks().to_batches() if rest.num_rows else []
        self.rows = rest.num_rows

    def finish(self) -> None:
        """Write what remains."""
        if self.rows:
            self.write(self.rows)


def with_added(own: pa.Schema, added: Sequence[tuple[str, pa.DataType]]) -> pa.Schema:
    """Return the columns of runs, followed by those that a batch adds; earlier results have those already."""
    kinds = [pa.schema([column]) for column in added]
    known = [pa.schema([own.field(name)]) for name, _ in added if name in own.names]
    kept = pa.schema([field for field in own if field.name not in dict(added)])
    return joint_schema([kept, *kinds, *known])


def check_output(path: str) -> Path:
    """Return the real path of a file of results; its folder is made.

    Raises:
        BatchError: It cannot be written, or there is a file that is no data file.
    """
    folder = Path(path).parent
    try:
        folder.mkdir(parents=True, exist_ok=True)
        real = real_output(path)
        check_metadata_beside(real)
        if real.exists() and real.stat().st_size > 0:
            check_replaceable(real)
        with tempfile.TemporaryFile(dir=real.parent):
            pass  # rather now than after all runs
    except OSError as error:
        raise cannot("write", path, error) from None
    except OutputError as error:
        raise BatchError(str(error)) from None
    except RecoverError as error:
        if not real.exists():
            raise BatchError(str(error)) from None
        raise BatchError(
            f"{path} is there and is no data file of the simulator; it will not be overwritten: choose another output"
        ) from None
    return real


@contextlib.contextmanager
def replacement(path: Path) -> Iterator[Any]:
    """Open a file beside another one, which takes its place when all is written, and goes away if it cannot be.

    Raises:
        BatchError: Another batch is writing it.
    """
    scratch = path.with_name(f".{path.name}.pogobatch-new")
    with scratch.open("ab") as file:
        if not lock(file):
            raise BatchError(f"{path} is being written by another batch; wait for it, or choose another folder")
        if not (scratch.exists() and os.path.samestat(scratch.stat(), os.fstat(file.fileno()))):
            raise BatchError(f"{path} has just been written by another batch; choose another folder")
        try:
            file.truncate(0)
            yield file
            file.flush()
            os.fsync(file.fileno())
            scratch.replace(path)
        except BaseException:
            scratch.unlink(missing_ok=True)
            raise


def write_results(
    path: str, parts: Sequence[Part], text: str, layout: Format = PLAIN, earlier: Earlier | None = None
) -> None:
    """Join runs into one file.

    Args:
        path: File of results, in the format that its name says. It appears complete or not at all; a data file that is
            there is replaced.
        parts: Combinations, each with its finished runs; at least one run in all.
        text: Configuration with all options, for the metadata.
        layout: What the file has beside the rows.
        earlier: Results whose rows come first, those that are there.

    Raises:
        BatchError: A file cannot be read or written, or columns do not fit together.
    """
    real = check_output(path)
    try:
        before = [] if earlier is None else [earlier.schema]
        own = joint_schema([*before, *(run.schema for part in parts for run in part.runs)])
        names = list(dict.fromkeys(name for part in parts for name in part.columns))
        types = {name: column_type([part.columns.get(name) for part in parts]) for name in names}
        added = [*((name, pa.int64()) for name in layout.run_columns), *types.items()]
        schema = with_added(own, added)
        metadata = metadata_of(parts, text, earlier)
        entries = [*(earlier.combinations if earlier else []), *summary(parts)]
        metadata[COMBINATIONS] = dump_yaml(entries).encode()
        if layout.with_manifest:
            metadata[MANIFEST] = manifest(parts, earlier)
        schema = schema.with_metadata(metadata)
        with replacement(real) as file:
            kind = format_of(real) or FEATHER
            with contextlib.closing(table_writer(file, kind, schema)) as writer:
                pieces = Pieces(writer)
                for batch in batches_of(earlier.path) if earlier else ():
                    pieces.add(with_columns(batch, schema, {}))
                for part in parts:
                    constants = {name: as_type(part.columns.get(name), schema.field(name).type) for name in names}
                    for run in part.runs:
                        which = {name: run.column(name) for name in layout.run_columns}
                        for batch in batches_of(run.path):
                            with told_as_damaged(run.path):
                                rows_with_all = with_columns(batch, schema, {**constants, **which})
                            pieces.add(rows_with_all)
                pieces.finish()
            write_metadata_beside(real, kind, schema)
    except OSError as error:
        raise cannot("write", path, error) from None
