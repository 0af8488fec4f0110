"""Copies of the data file of a run, in the format that their name says."""

from __future__ import annotations

import contextlib
import shutil
from pathlib import Path

from pogosim.lines import printable
from pogosim.outputs import OutputError, leads_to, partial_output, real_output, told
from pogosim.simulation.errors import ConfigurationError, given
from pogosim.table_formats import BESIDE, CSV, EXPECTED, format_of, is_our_metadata, metadata_path


def write_copy(data_file: Path, path: Path) -> None:
    """Write the rows and metadata of a data file to another file; bytes stay as they are if the format does.

    Raises:
        ConfigurationError: The name says no format, is that of the data file itself, or the copy cannot be written.
    """
    kind = format_of(path)
    if kind is None:
        raise given.refused("file", EXPECTED, str(path))
    if leads_to(path, data_file):
        raise ConfigurationError(f"file: {printable(path)} is the data file itself; choose another name")
    try:
        to_device = path.is_char_device()  # as /dev/null
        real = path if to_device else real_output(path)
        beside = metadata_path(path)
        if kind == CSV and beside.exists() and not is_our_metadata(beside):
            raise OutputError(f"{beside} is no file of the simulator and is not overwritten; choose another name")
        with contextlib.nullcontext(real) if to_device else partial_output(real) as partial:
            if kind != format_of(data_file):
                convert(data_file, kind, partial, real)
                return
            shutil.copyfile(data_file, partial)
            if kind == CSV:
                with partial_output(Path(f"{real}{BESIDE}")) as metadata:
                    shutil.copyfile(metadata_path(data_file), metadata)
    except (OutputError, OSError) as error:
        reason = told(error, path) if isinstance(error, OSError) else str(error)
        raise ConfigurationError(printable(f"file: the rows cannot be written: {reason}")) from None


def convert(data_file: Path, kind: str, partial: Path, real: Path) -> None:
    """Write a data file in another format to `partial`, which becomes `real`, and its metadata beside `real`."""
    # They import pyarrow and pandas, which takes most of a second.
    from pogosim.tables import table_writer, write_metadata_beside
    from pogosim.utils import read_table

    table = read_table(data_file)
    with partial.open("wb") as file, contextlib.closing(table_writer(file, kind, table.schema)) as writer:
        writer.write_table(table)
    write_metadata_beside(real, kind, table.schema)
