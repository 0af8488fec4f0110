"""Tables in the formats that the simulator writes: Feather (Arrow IPC), Parquet, and CSV with metadata beside it."""

from __future__ import annotations

import contextlib
import csv
import functools
import warnings
from pathlib import Path
from typing import IO, Any, Protocol

import pyarrow as pa
import pyarrow.csv as arrow_csv
import yaml
from pyarrow import ipc

from pogosim.outputs import PARTIAL
from pogosim.table_formats import BEGIN, BESIDE, CSV, PARQUET, format_in, is_our_metadata, metadata_path

# In the metadata of a CSV file: the names of its columns, and their types in the same order.
NAMES = "column_names"
TYPES = "column_types"
NO_VALUE = ["", "NA"]  # how other programs write an empty cell, also in quotes


# ---- reading ----


def read_other(path: Path) -> pa.Table | None:
    """Read a Parquet or CSV file, with its metadata and types; None for other files.

    Raises:
        OSError, pyarrow.ArrowException, ValueError: It cannot be read, or is damaged.
    """
    kind = format_in(path)
    if kind == PARQUET:
        import pyarrow.parquet as pq  # takes a while

        with path.open("rb") as file:
            table = pq.read_table(file)
        table.validate(full=True)
        return table
    return read_csv(path) if kind == CSV else None


def metadata_beside(table: Path) -> dict[str, Any]:
    """Return the metadata of a CSV file; empty, with a warning (RuntimeWarning), if they are not there."""
    path = metadata_path(table)
    if not is_our_metadata(path):
        warnings.warn(
            f"{table} has no metadata: there is no {Path(path).name} of a run beside it, so configuration, arena and "
            "types of columns are unknown",
            RuntimeWarning,
            stacklevel=7,
        )
        return {}
    try:
        metadata = yaml.load(path.read_text(encoding="utf-8"), Loader=yaml.BaseLoader)
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise ValueError(f"{path} is damaged: {error}") from error
    return metadata if isinstance(metadata, dict) else {}


def read_csv(path: Path) -> pa.Table:
    """Read a CSV file that the simulator wrote, perhaps changed by another program since, or any other one.

    Columns of the simulator have their types, wherever they are; others those that pandas finds.
    """
    metadata = metadata_beside(path)
    with path.open(newline="", encoding="utf-8-sig", errors="replace") as file:
        header = next(csv.reader(file), [])
    types = known_types(header, metadata.pop(NAMES, None), metadata.pop(TYPES, []))
    try:
        table = read_cells(path, {name: as_read(kind) for name, kind in types.items()})
    except pa.ArrowInvalid:  # or it is damaged, which is found again
        text = read_cells(path, dict.fromkeys(types, pa.string()))
        table = with_columns(text, {name: converted(text.column(name), name, as_read(types[name])) for name in types})
    special = {name: kind for name, kind in types.items() if kind in ("halffloat", "binary")}
    table = with_columns(table, {name: exact(table.column(name), kind) for name, kind in special.items()})
    if types and (others := [place for place, name in enumerate(header) if name not in types]):
        table = with_inferred(table, path, others)
    return table.replace_schema_metadata({str(key): str(value) for key, value in metadata.items()})


def known_types(header: list[str], names: list[str] | None, types: list[str]) -> dict[str, str]:
    """Return the types of the columns in a header that metadata tell, by name.

    Those of older files have no names: they are in the order of the columns.

    Raises:
        ValueError: The header has none of the columns.
    """
    known = header if names is None else names
    if len(known) != len(types):
        return {}
    if known and not set(known) & set(header):
        raise ValueError(f"its first line names no column of the run, such as '{known[0]}'; separate cells by commas")
    return {name: kind for name, kind in zip(known, types, strict=True) if header.count(name) == 1}


def read_cells(path: Path, types: dict[str, pa.DataType]) -> pa.Table:
    """Read the cells of a CSV file; columns without a type have the one that fits."""
    options = arrow_csv.ConvertOptions(
        column_types=types, null_values=[""], strings_can_be_null=True, quoted_strings_can_be_null=False
    )
    parsing = arrow_csv.ParseOptions(newlines_in_values=True)
    return arrow_csv.read_csv(path, convert_options=options, parse_options=parsing)


def with_columns(table: pa.Table, columns: dict[str, pa.ChunkedArray]) -> pa.Table:
    """Return a table with other columns in place of those of the same names."""
    for name, column in columns.items():
        table = table.set_column(table.column_names.index(name), name, column)
    return table


def with_inferred(table: pa.Table, path: Path, places: list[int]) -> pa.Table:
    """Return a table with some columns as pandas reads them, also their names: that of an index is "Unnamed: 0"."""
    import pandas as pd  # takes a while

    found = pa.Table.from_pandas(pd.read_csv(path, usecols=places), preserve_index=False)
    for place, name, column in zip(places, found.column_names, found.columns, strict=True):
        table = table.set_column(place, name, column)
    return table


def converted(text: pa.ChunkedArray, name: str, kind: pa.DataType) -> pa.ChunkedArray:
    """Convert cells to a type. Integers that pandas has written with a point are those, others are kept as they are.

    Raises:
        ValueError: They do not fit; names the first one.
    """
    import pyarrow.compute as pc  # takes a while

    if not pa.types.is_string(kind):
        text = pc.if_else(pc.is_in(text, pa.array(NO_VALUE)), None, text)
    real, whole = pa.float64(), pa.int64()
    ways = [[kind], [whole], [real, kind], [real, whole], [real]] if pa.types.is_integer(kind) else [[kind]]
    for way in ways:
        with contextlib.suppress(pa.ArrowInvalid):
            return functools.reduce(pa.ChunkedArray.cast, way, text)
    row, cell = next((row, cell) for row, cell in enumerate(text, 1) if not fits(cell, ways[-1][0]))
    raise ValueError(f"row {row}, column '{name}': expected {kind}, found '{cell}'")


def fits(cell: pa.Scalar, kind: pa.DataType) -> bool:
    """Tell whether a cell can be converted."""
    try:
        cell.cast(kind)
    except pa.ArrowInvalid:
        return False
    return True


def as_read(kind: str) -> pa.DataType:
    """Return the type with which a column is read from text; it is converted afterwards."""
    return pa.type_for_alias({"halffloat": "float", "binary": "string"}.get(kind, kind))


def exact(column: pa.ChunkedArray, kind: str) -> pa.Array:
    """Return a column that was read with another type in its own."""
    return column.cast(pa.float16()) if kind == "halffloat" else from_hexadecimal(column)


def from_hexadecimal(column: pa.ChunkedArray) -> pa.Array:
    """Convert hexadecimal numbers to bytes."""
    return pa.array([None if text is None else bytes.fromhex(text) for text in column.to_pylist()], pa.binary())


# ---- writing ----


class TableWriter(Protocol):
    """Writes tables of one schema one after the other."""

    def write_table(self, table: pa.Table) -> None:
        """Write rows."""

    def close(self) -> None:
        """Complete the file."""


class TextWriter:
    """Writes CSV: numbers with the fewest digits that keep them, empty cells for null, bytes as hexadecimal."""

    def __init__(self, file: IO[bytes], schema: pa.Schema) -> None:
        text = [pa.field(own.name, pa.string()) if pa.types.is_binary(own.type) else own for own in schema]
        self.schema = pa.schema(text)
        self.writer = arrow_csv.CSVWriter(file, self.schema)

    def write_table(self, table: pa.Table) -> None:
        """Write rows."""
        columns = [in_hexadecimal(column) if pa.types.is_binary(column.type) else column for column in table.columns]
        self.writer.write_table(pa.Table.from_arrays(columns, schema=self.schema))

    def close(self) -> None:
        """Complete the file."""
        self.writer.close()


def in_hexadecimal(column: pa.ChunkedArray) -> pa.Array:
    """Convert bytes to hexadecimal numbers."""
    return pa.array([None if cell is None else cell.hex() for cell in column.to_pylist()], pa.string())


def table_writer(file: IO[bytes], kind: str, schema: pa.Schema) -> TableWriter:
    """Return a writer of tables in a format to an open file; it writes the same bytes as the simulator."""
    if kind == PARQUET:
        import pyarrow.parquet as pq  # takes a while

        writer: TableWriter = pq.ParquetWriter(file, schema, compression="zstd")
        return writer
    if kind == CSV:
        return TextWriter(file, schema)
    arrow: TableWriter = ipc.new_file(file, schema, options=ipc.IpcWriteOptions(compression="zstd"))
    return arrow


def write_metadata_beside(table: Path, kind: str, schema: pa.Schema) -> None:
    """Write the metadata of a CSV table to the file beside it, before the table is moved to its final name."""
    if kind != CSV:
        return
    text = BEGIN + "\n"
    for key, value in (schema.metadata or {}).items():
        text += f"{key.decode('utf-8', 'replace')}: {block(value.decode('utf-8', 'replace'))}"
    text += f"{NAMES}: [{', '.join(map(quoted, schema.names))}]\n"
    text += f"{TYPES}: [{', '.join(str(kind) for kind in schema.types)}]\n"
    path = Path(f"{table}{BESIDE}")
    partial = Path(f"{path}{PARTIAL}")
    partial.write_text(text, encoding="utf-8")
    partial.replace(path)


def quoted(name: str) -> str:
    """Return a name in quotation marks, in one line of YAML."""
    return '"' + "".join(f"\\x{ord(c):02x}" if c < " " or c in '"\\\x7f' else c for c in name) + '"'


def block(text: str) -> str:
    """Return a text as a literal block of YAML."""
    lines = text.removesuffix("\n").split("\n") if text else []
    body = "".join(f"  {line}\n" if line else "\n" for line in lines)
    return ("|2+\n" if text.endswith("\n") else "|2-\n") + body
