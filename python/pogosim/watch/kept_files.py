"""Data files of earlier runs, which a run that is watched does not replace: `run.feather` becomes `run.1.feather`."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path

from pogosim.outputs import lock
from pogosim.table_formats import metadata_path


def keep(path: Path) -> Path | None:
    """Rename a data file, and metadata beside it, so that another run can have its name.

    Args:
        path: The file; a link stays, and what it leads to is renamed.

    Returns:
        Its new name; None: there is none with contents, or another run writes it.

    Raises:
        OSError: It cannot be renamed.
    """
    real = path.resolve()
    if not real.is_file() or real.stat().st_size == 0:
        return None
    with real.open("rb") as file:
        if not lock(file):
            return None
        free = next(own for own in numbered(real) if not own.exists() and not metadata_path(own).exists())
        real.rename(free)
        if metadata_path(real).is_file():
            metadata_path(real).rename(metadata_path(free))
    return free


def numbered(path: Path) -> Iterator[Path]:
    """Yield the names that a file may get, in their order."""
    for number in itertools.count(1):
        yield path.with_name(f"{path.stem}.{number}{path.suffix}")
