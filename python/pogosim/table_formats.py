"""The formats of tables that the simulator writes: what the ending of a name says, and the first bytes of a file."""

from __future__ import annotations

import os
from pathlib import Path

from pogosim.outputs import PathLike

FEATHER, PARQUET, CSV = "feather", "parquet", "csv"
ENDINGS = {".feather": FEATHER, ".arrow": FEATHER, ".ipc": FEATHER, ".parquet": PARQUET, ".csv": CSV}
EXPECTED = "a name that ends in .feather, .arrow or .ipc (Apache Arrow), .parquet or .csv"  # as in table_format.hpp

PARQUET_MAGIC = b"PAR1"
ARROW_MAGIC = b"ARROW1"

# The metadata of d.csv are in d.csv.yaml, as src/record/metadata_beside.cpp writes it.
BESIDE = ".yaml"
BEGIN = "# Pogosim: metadata of the table beside this file"


def format_of(path: PathLike) -> str | None:
    """Return the format that the ending of a name says; Feather without an ending; None for all other endings.

    A dot before a digit begins no ending: results_0.5.
    """
    ending = Path(path).suffix.lower()
    return FEATHER if len(ending) < 2 or ending[1].isdigit() else ENDINGS.get(ending)


def format_in(path: Path) -> str:
    """Return the format of a file, by its first bytes; that of an unfinished file, whatever its name, is Feather.

    Raises:
        OSError: It cannot be read.
    """
    with path.open("rb") as file:
        begin = file.read(len(ARROW_MAGIC))
    if begin.startswith(PARQUET_MAGIC):
        return PARQUET
    return CSV if format_of(path) == CSV and not begin.startswith(ARROW_MAGIC) else FEATHER


def is_binary(path: Path) -> bool:
    """Tell whether a file is an Arrow or Parquet one: by its first bytes or, if it is damaged, the ending of its name.

    Raises:
        OSError: It cannot be read.
    """
    with path.open("rb") as file:
        begin = file.read(len(ARROW_MAGIC))
    return begin.startswith((PARQUET_MAGIC, ARROW_MAGIC)) or ENDINGS.get(path.suffix.lower(), CSV) != CSV


def metadata_path(table: Path) -> Path:
    """Return where the metadata of a CSV file are."""
    beside = Path(f"{table}{BESIDE}")
    return beside if beside.exists() else Path(f"{os.path.realpath(table)}{BESIDE}")


def is_our_metadata(path: Path) -> bool:
    """Tell whether a file holds metadata of a table of the simulator."""
    try:
        with path.open("rb") as file:
            return file.readline().rstrip(b"\n") == BEGIN.encode()
    except OSError:
        return False
