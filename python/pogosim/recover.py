"""Make a complete file of a data file whose run was killed, in the format that its name says.

    pogosim-recover data.feather                    # in its place
    pogosim-recover data.feather -o rescued.feather

While a run goes on, its data file holds all rows but those of the last seconds, and no footer, which readers of Feather
files look for. The rows that are there are kept, and the metadata, with an entry "recovered" that says what happened.
"""

from __future__ import annotations

import contextlib
import math
import os
import shutil
import sys
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import pyarrow as pa
import pyarrow.compute as pc
from pyarrow import ipc

from pogosim.errors import ToolError
from pogosim.outputs import PathLike, leads_to, lock, real_output
from pogosim.table_formats import CSV, EXPECTED, FEATHER, PARQUET, format_in, format_of, is_our_metadata, metadata_path
from pogosim.tables import table_writer, write_metadata_beside

# An Arrow file begins with this; behind it stands a stream of record batches.
MAGIC = b"ARROW1\0\0"
END = b"ARROW1"  # behind the footer

# Metadata of files that the simulator writes: of unfinished ones, and of all.
INCOMPLETE = b"incomplete"
OURS = (INCOMPLETE, b"program_version", b"configuration")
RECOVERED = b"recovered"


# What reading damaged bytes can raise: lengths in them may ask for any amount of memory, names may be no UTF-8.
DAMAGED = (pa.ArrowException, OSError, MemoryError, ValueError, OverflowError)


class RecoverError(ToolError):
    """The file cannot be recovered; says why."""


class NoRowsError(RecoverError):
    """The run was killed before its first row could be written."""


@dataclass(frozen=True)
class Unfinished:
    """What can be read of a file without its footer."""

    table: pa.Table
    says_so: bool  # its metadata say that it is incomplete

    @property
    def up_to(self) -> str:
        """How far the rows go: "37 rows, up to t = 1.5 s"."""
        return rows_up_to(self.table.num_rows, self.last_time_s)

    @property
    def last_time_s(self) -> float | None:
        """The largest time; None where there is none, or not one column of times."""
        return last_time_s(self.table)


def rows_up_to(rows: int, time_s: float | None) -> str:
    """Return how far rows go: "37 rows, up to t = 1.5 s"."""
    count = f"{rows} row{'' if rows == 1 else 's'}"
    return count if time_s is None else f"{count}, up to t = {time_s:.9g} s"


def last_time_s(table: pa.Table) -> float | None:
    """Return the largest time in rows; None where there is none, or not one column of times."""
    columns = table.schema.get_all_field_indices("time")
    if len(columns) != 1 or table.schema.field(columns[0]).type not in (pa.float32(), pa.float64()):
        return None
    time_s = pc.max(table.column(columns[0])).as_py()
    return time_s if time_s is not None and math.isfinite(time_s) else None


def reraise_system_error(error: BaseException) -> None:
    """Raise what the system says about a file; what Arrow says about its content has no number."""
    if isinstance(error, OSError) and error.errno is not None:
        raise error


def is_complete(path: Path, to_the_last_row: bool = False) -> bool:
    """Tell whether Feather readers can open the file: it has its footer; or also whether all its rows can be read."""
    with path.open("rb") as file:
        try:
            with ipc.open_file(file) as reader:
                for i in range(reader.num_record_batches if to_the_last_row else 0):
                    reader.get_batch(i).validate(full=True)
        except DAMAGED as error:
            reraise_system_error(error)
            return False
        return True


def open_rows(path: PathLike, file: IO[bytes]) -> ipc.RecordBatchStreamReader:
    """Open the rows of a data file of the simulator, complete or not.

    Raises:
        NoRowsError: The file ends before its first row could.
        RecoverError: It is none of the simulator's, or damaged before its first row.
    """
    if file.read(len(MAGIC)) != MAGIC:
        raise RecoverError(f"{path} is not a data file of the simulator")
    try:
        reader = ipc.open_stream(file)
    except DAMAGED as error:
        reraise_system_error(error)
        if ends_in_schema(file):
            raise NoRowsError(f"{path} is truncated before its first row") from error
        raise RecoverError(f"{path} is damaged before its first row; copy it again, or repeat its run") from error
    metadata = reader.schema.metadata or {}
    if not any(key in metadata for key in OURS):
        raise RecoverError(f"{path} is not a data file of the simulator: its metadata have no configuration")
    return reader


def ends_in_schema(file: IO[bytes]) -> bool:
    """Tell whether a file ends within the message that says what columns it has, which comes before all rows."""
    size = file.seek(0, os.SEEK_END)
    file.seek(max(0, size - len(END)))
    has_footer = file.read() == END
    file.seek(len(MAGIC))
    prefix = file.read(8)  # four bytes 0xff, and how many bytes follow
    return not has_footer and (len(prefix) < 8 or file.tell() + int.from_bytes(prefix[4:], "little") > size)


def with_readable_names(schema: pa.Schema) -> pa.Schema:
    """Rename columns whose names are not valid UTF-8 because of damage to column_0, column_1, ... by position."""

    def readable(place: int) -> pa.Field:
        field = schema.field(place)
        try:
            return pa.field(field.name, field.type, field.nullable, field.metadata)
        except UnicodeDecodeError:
            return pa.field(f"column_{place}", field.type, field.nullable, field.metadata)

    return pa.schema([readable(place) for place in range(len(schema))], schema.metadata)


def check_is_file(path: Path) -> None:
    """Raise RecoverError for anything but a regular file; opening a pipe, for example, would wait for a writer."""
    if path.exists() and not path.is_file():
        raise RecoverError(f"{path} is not a file")


def read_unfinished(path: PathLike) -> Unfinished:
    """Read a data file whose run has not ended, or was killed, up to the first damaged batch of rows.

    Args:
        path: File that the simulator began to write.

    Returns:
        Its rows and metadata.

    Raises:
        FileNotFoundError: There is no such file.
        RecoverError: The file is none of the simulator's, damaged before its first row, or ends before that could.
    """
    check_is_file(Path(path))
    with Path(path).open("rb") as file:
        reader = open_rows(path, file)
        schema = with_readable_names(reader.schema)
        batches = []
        try:
            for batch in reader:
                batch.validate(full=True)
                batches.append(batch.rename_columns(schema.names))
        except DAMAGED as error:  # the batch that was being written
            reraise_system_error(error)
        return Unfinished(pa.Table.from_batches(batches, schema), INCOMPLETE in (schema.metadata or {}))


@contextlib.contextmanager
def locked(path: Path) -> Iterator[None]:
    """Keep runs from writing a file meanwhile, where there are locks.

    Raises:
        RecoverError: A run is writing it.
    """
    with path.open("rb") as file:
        if not lock(file):
            raise RecoverError(f"{path} is in use by a run; choose another file with -o")
        yield


def recovered_schema(unfinished: Unfinished) -> pa.Schema:
    """Schema of the recovered file: its metadata say what happened."""
    schema = unfinished.table.schema
    metadata = {key: value for key, value in (schema.metadata or {}).items() if key != INCOMPLETE}
    metadata[RECOVERED] = (
        f"The run did not end by itself; these are the rows that were saved: {unfinished.up_to}.".encode()
    )
    return schema.with_metadata(metadata)


def check_replaceable(target: Path) -> None:
    """Raise RecoverError for a file that the simulator did not write, and that must not be overwritten."""
    if is_ours_in_other_format(target):
        return
    with target.open("rb") as file:
        try:
            open_rows(target, file)
        except RecoverError as error:
            raise RecoverError(f"{error}; it will not be overwritten: choose another file with -o") from None


def check_metadata_beside(target: Path) -> None:
    """Raise RecoverError if the place of the metadata of a CSV file is taken."""
    beside = metadata_path(target)
    if format_of(target) == CSV and beside.exists() and not is_our_metadata(beside):
        raise RecoverError(f"{beside} is no file of the simulator; it will not be overwritten: choose another output")


def is_ours_in_other_format(path: Path) -> bool:
    """Tell whether a file is a complete table of the simulator in another format than Feather."""
    kind = format_in(path)
    if kind == CSV:
        return is_our_metadata(metadata_path(path))
    if kind == PARQUET:
        import pyarrow.parquet as pq  # takes a while

        try:
            metadata = pq.read_schema(path).metadata or {}
        except DAMAGED:
            return False
        return any(key in metadata for key in OURS)
    return False


def recover(path: PathLike, output: PathLike | None = None) -> Unfinished:
    """Make a complete file of an unfinished data file, in the format that the name of the output says.

    Args:
        path: Data file of a run that was killed.
        output: Where to write; None: in place of `path`. Nothing there is touched before all is written. Symbolic and
            hard links stay links. A file that is there must be a data file of the simulator.

    Returns:
        What was read, and is now complete.

    Raises:
        RecoverError: The file needs no recovery, belongs to a run that goes on, or is none of the simulator's.
        OutputError: The output is not a file, or has no folder.
        OSError: A file cannot be read or written; `path` is as it was.
    """
    source = Path(path)
    check_is_file(source)
    in_place = output is None or leads_to(output, source)
    target = real_output(source if output is None else output)
    if format_of(target) is None:
        raise RecoverError(f"{target}: its format is unknown; expected {EXPECTED}")
    if source.exists() and is_ours_in_other_format(source):
        raise RecoverError(f"{source} is already complete; nothing to recover")
    check_metadata_beside(target)
    exists = target.exists()
    if exists and not in_place:
        check_replaceable(target)
    with locked(target) if exists else contextlib.nullcontext():
        unfinished = read_unfinished(source)
        if is_complete(source):
            if is_complete(source, to_the_last_row=True):
                raise RecoverError(f"{source} is already complete; nothing to recover")
            if in_place:
                raise RecoverError(
                    f"{source} is damaged; to save the rows before the damage, choose another file with -o"
                )
        write_recovered(unfinished, target, target.stat() if exists else source.stat())
    return unfinished


def write_recovered(unfinished: Unfinished, target: Path, like: os.stat_result) -> None:
    """Write the complete file, with the permissions in `like`, and put it in its place when all is written."""
    table = unfinished.table.replace_schema_metadata(recovered_schema(unfinished).metadata).combine_chunks()
    write_complete([table], table.schema, target, like)


def write_complete(tables: Iterable[pa.Table], schema: pa.Schema, target: Path, like: os.stat_result) -> None:
    """Write rows to a file in the format of its name, with the permissions in `like`, in its place when all is there.

    Raises:
        RecoverError: What is there already cannot be overwritten; says where the rows are.
        OSError: They cannot be written.
    """
    with tempfile.NamedTemporaryFile(dir=target.parent, prefix=".pogosim-recover-", delete=False) as file:
        scratch = Path(file.name)
        try:
            kind = format_of(target) or FEATHER
            with contextlib.closing(table_writer(file, kind, schema)) as writer:
                for table in tables:
                    writer.write_table(table)
            file.flush()
            os.fsync(file.fileno())
            write_metadata_beside(target, kind, schema)
            if must_be_written_in_place(target, scratch):
                copy_over(scratch, target)
                scratch.unlink()
            else:
                scratch.chmod(like.st_mode & 0o777)
                scratch.replace(target)
        except RecoverError:
            raise
        except BaseException:
            scratch.unlink(missing_ok=True)
            raise


def must_be_written_in_place(target: Path, scratch: Path) -> bool:
    """Tell whether a file in the place of another would not be the same: of another owner, or not under all names."""
    if not target.exists():
        return False
    there, here = target.stat(), scratch.stat()
    return there.st_nlink > 1 or (there.st_uid, there.st_gid) != (here.st_uid, here.st_gid)


def copy_over(scratch: Path, target: Path) -> None:
    """Write the bytes of a file over those of another one. When that fails, the first is what there is.

    Raises:
        RecoverError: It fails; says where the rows are.
    """
    try:
        with scratch.open("rb") as source, target.open("r+b") as file:
            shutil.copyfileobj(source, file)
            file.truncate()
            file.flush()
            os.fsync(file.fileno())
    except OSError as error:
        raise RecoverError(f"{target} cannot be overwritten: {error.strerror}. All rows are in {scratch}") from error


if __name__ == "__main__":
    from pogosim.command.recover import main

    sys.exit(main())
