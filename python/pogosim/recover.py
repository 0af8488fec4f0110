"""Make a complete Feather file of a data file whose run was killed.

    pogosim-recover data.feather                    # in its place
    pogosim-recover data.feather -o rescued.feather

While a run goes on, its data file holds all rows but those of the last seconds, and no footer, which readers of Feather
files look for. The rows that are there are kept, and the metadata, with an entry "recovered" that says what happened.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Union

import pyarrow as pa
import pyarrow.compute as pc
from pyarrow import ipc

PathLike = Union[str, "Path"]

# An Arrow file begins with this; behind it stands a stream of record batches.
MAGIC = b"ARROW1\0\0"

# Metadata of files that the simulator writes: of unfinished ones, and of all.
INCOMPLETE = b"incomplete"
OURS = (INCOMPLETE, b"program_version", b"configuration")
RECOVERED = b"recovered"


class RecoverError(Exception):
    """The file cannot be recovered; says why."""


@dataclass(frozen=True)
class Unfinished:
    """What can be read of a file without its footer."""

    table: pa.Table
    says_so: bool  # its metadata say that it is incomplete

    @property
    def up_to(self) -> str:
        """How far the rows go: "37 rows, up to t = 1.5 s"."""
        rows = f"{self.table.num_rows} row{'' if self.table.num_rows == 1 else 's'}"
        if self.table.num_rows == 0 or "time" not in self.table.column_names:
            return rows
        return f"{rows}, up to t = {pc.max(self.table['time']).as_py():g} s"


def is_complete(path: Path) -> bool:
    """Tell whether Feather readers can open the file."""
    try:
        with ipc.open_file(path):
            return True
    except pa.ArrowInvalid:
        return False


def read_unfinished(path: PathLike) -> Unfinished:
    """Read a data file whose run has not ended, or was killed, up to the first batch of rows that is cut off.

    Args:
        path: File that the simulator began to write.

    Returns:
        Its rows and metadata.

    Raises:
        FileNotFoundError: There is no such file.
        RecoverError: The file is none of the simulator's, or ends before its first row could.
    """
    with Path(path).open("rb") as file:
        if file.read(len(MAGIC)) != MAGIC:
            raise RecoverError(f"{path} is not a data file of the simulator")
        try:
            reader = ipc.open_stream(file)
        except (pa.ArrowInvalid, OSError) as error:
            raise RecoverError(f"{path} was cut off before its first row") from error
        metadata = reader.schema.metadata or {}
        if not any(key in metadata for key in OURS):
            raise RecoverError(f"{path} is not a data file of the simulator: its metadata have no configuration")
        batches = []
        try:
            for batch in reader:
                batch.validate(full=True)
                batches.append(batch)
        except (pa.ArrowInvalid, OSError):
            pass  # the batch that was being written
        return Unfinished(pa.Table.from_batches(batches, reader.schema), INCOMPLETE in metadata)


def is_being_written(path: Path) -> bool:
    """Tell whether a run has the file locked. False where there are no locks."""
    try:
        import fcntl
    except ImportError:
        return False
    with path.open("rb") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        except OSError:
            return False
    return False


def recovered_schema(unfinished: Unfinished) -> pa.Schema:
    """Schema of the recovered file: its metadata say what happened."""
    schema = unfinished.table.schema
    metadata = {key: value for key, value in (schema.metadata or {}).items() if key != INCOMPLETE}
    metadata[RECOVERED] = (
        f"The run did not end by itself; these are the rows that were saved: {unfinished.up_to}.".encode()
    )
    return schema.with_metadata(metadata)


def recover(path: PathLike, output: PathLike | None = None) -> Unfinished:
    """Make a complete Feather file of an unfinished data file.

    Args:
        path: Data file of a run that was killed.
        output: Where to write; None: in place of `path`. Nothing there is touched before all is written.

    Returns:
        What was read, and is now complete.

    Raises:
        RecoverError: The file needs no recovery, belongs to a run that goes on, or is none of the simulator's.
        OSError: A file cannot be read or written; `path` is as it was.
    """
    source = Path(path)
    target = source.resolve() if output is None else Path(output)
    unfinished = read_unfinished(source)
    if is_complete(source):
        raise RecoverError(f"{source} is complete: there is nothing to recover")
    if target.exists() and is_being_written(target):
        raise RecoverError(f"a run is still writing {target}; name another file with -o")
    table = unfinished.table.replace_schema_metadata(recovered_schema(unfinished).metadata).combine_chunks()
    with tempfile.NamedTemporaryFile(dir=target.parent, prefix=f"{target.name}.", delete=False) as file:
        scratch = Path(file.name)
        try:
            options = ipc.IpcWriteOptions(compression="zstd")
            with ipc.new_file(file, table.schema, options=options) as writer:
                writer.write_table(table)
            file.flush()
            if target.exists():
                scratch.chmod(target.stat().st_mode & 0o777)
            else:
                scratch.chmod(source.stat().st_mode & 0o777)
            scratch.replace(target)
        except BaseException:
            scratch.unlink(missing_ok=True)
            raise
    return unfinished


def main(arguments: list[str] | None = None) -> int:
    """Run the command. Returns its exit code: 0 done, 2 nothing could be done."""
    parser = argparse.ArgumentParser(
        prog="pogosim-recover", description="Makes a complete Feather file of a data file whose run was killed."
    )
    parser.add_argument("file", help="data file of the run")
    parser.add_argument("-o", "--output", help="file to write; without it, the data file is replaced")
    options = parser.parse_args(arguments)
    try:
        unfinished = recover(options.file, options.output)
    except (RecoverError, OSError) as error:
        print(f"pogosim-recover: {error}", file=sys.stderr)
        return 2
    print(f"{options.output or options.file}: {unfinished.up_to}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
