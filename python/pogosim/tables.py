"""Tables in the formats that the simulator writes: Feather (Arrow IPC), Parquet, and CSV with metadata beside it."""

from __future__ import annotations

import csv
import warnings
from pathlib import Path
from typing import IO, Any, Protocol

import pyarrow as pa
import pyarrow.csv as arrow_csv
import yaml
from pyarrow import ipc

from pogosim.outputs import PARTIAL
from pogosim.table_formats import BEGIN, BESIDE, CSV, PARQUET, format_in, is_our_metadata, metadata_path

TYPES = "column_types"


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
            return pq.read_table(file)
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
    """Read a CSV file that the simulator wrote, or any other one."""
    metadata = metadata_beside(path)
    types = metadata.pop(TYPES, [])
    with path.open(newline="", encoding="utf-8", errors="replace") as file:
        names = next(csv.reader(file), [])
    known = dict(zip(names, types, strict=False))
    options = arrow_csv.ConvertOptions(
        column_types={name: as_read(kind) for name, kind in known.items()},
        null_values=[""],
        strings_can_be_null=True,
        quoted_strings_can_be_null=False,
    )
    parsing = arrow_csv.ParseOptions(newlines_in_values=True)
    table = arrow_csv.read_csv(path, convert_options=options, parse_options=parsing)
    for place, name in enumerate(table.column_names):
        if known.get(name) in ("halffloat", "binary"):
            column = table.column(place)
            exact = column.cast(pa.float16()) if known[name] == "halffloat" else from_hexadecimal(column)
            table = table.set_column(place, name, exact)
    return table.replace_schema_metadata({str(key): str(value) for key, value in metadata.items()})


def as_read(kind: str) -> pa.DataType:
    """Return the type with which a column is read from text; it is converted afterwards."""
    return pa.type_for_alias({"halffloat": "float", "binary": "string"}.get(kind, kind))


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
    text += f"{TYPES}: [{', '.join(str(kind) for kind in schema.types)}]\n"
    path = Path(f"{table}{BESIDE}")
    partial = Path(f"{path}{PARTIAL}")
    partial.write_text(text, encoding="utf-8")
    partial.replace(path)


def block(text: str) -> str:
    """Return a text as a literal block of YAML."""
    lines = text.removesuffix("\n").split("\n") if text else []
    body = "".join(f"  {line}\n" if line else "\n" for line in lines)
    return ("|2+\n" if text.endswith("\n") else "|2-\n") + body
