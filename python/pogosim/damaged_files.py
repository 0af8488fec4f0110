"""What is said of data files that are damaged: in all tools, one line that names the file and says what to do."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

from pogosim.errors import DamagedFileError
from pogosim.recover import DAMAGED, RecoverError, is_complete, read_unfinished, reraise_system_error
from pogosim.table_formats import FEATHER, format_in


@contextlib.contextmanager
def damage_told(path: Path) -> Iterator[None]:
    """Raise DamagedFileError for what a block finds wrong in the bytes of a file.

    Raises:
        DamagedFileError: They are damaged, or those of no data file.
        OSError: The file cannot be read.
    """
    try:
        yield
    except DamagedFileError:
        raise
    except DAMAGED as error:
        reraise_system_error(error)
        raise damage(path, error) from error


def damage(path: Path, reason: BaseException) -> DamagedFileError:
    """Return the error for a file whose rows cannot be read: what is wrong, and what to do.

    Args:
        path: The file.
        reason: What reading it has raised.

    Raises:
        OSError: It cannot be read.
    """
    if isinstance(reason, MemoryError):
        return DamagedFileError(f"{path} cannot be read: there is not enough memory for its rows, or it is damaged")
    why = " ".join(str(reason).split()).removesuffix(".") or type(reason).__name__
    if format_in(path) != FEATHER:
        return DamagedFileError(f"{path} is damaged, or no data file: {why}; copy it again, or repeat its run")
    try:
        unfinished = read_unfinished(path)
    except RecoverError:
        return DamagedFileError(f"{path} is not a complete Feather file: {why}; copy it again, or repeat its run")
    if not is_complete(path):
        return DamagedFileError(
            f"{path} is not a complete Feather file: it is truncated; to recover it: pogosim-recover {path}"
        )
    return DamagedFileError(
        f"{path} is damaged: {why}; to save its first rows ({unfinished.up_to}): "
        f"pogosim-recover {path} -o another_file.feather"
    )
