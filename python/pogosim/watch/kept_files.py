"""Data files of earlier runs, which a run that is watched does not replace: `run.feather` becomes `run.1.feather`."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Iterator
from pathlib import Path

from pogosim.lines import printable
from pogosim.outputs import lock
from pogosim.simulation.errors import ConfigurationError
from pogosim.table_formats import metadata_path
from pogosim.watch.terminal import print_out


def keep(path: Path) -> Path | None:
    """Rename a data file, and metadata beside it, so that another run can have its name.

    Args:
        path: The file; a link stays, and what it leads to is renamed.

    Returns:
        Its new name; None: there is none with contents, or another run writes it.

    Raises:
        ConfigurationError: It cannot be renamed.
    """
    real = path.resolve()
    try:
        if not real.is_file() or real.stat().st_size == 0:
            return None
        with real.open("rb") as file:
            if not lock(file):
                return None
            free = next(own for own in numbered(real) if not own.exists() and not metadata_path(own).exists())
            real.rename(free)
            if metadata_path(real).is_file():
                metadata_path(real).rename(metadata_path(free))
    except OSError as error:
        raise ConfigurationError(f"'{printable(path)}' cannot be kept: {error.strerror}") from None
    return free


def tell_of_kept(path: Path, name: Path | None) -> None:
    """Say what the data file of an earlier run is called now."""
    if name is not None:
        print_out(f"{printable(path)} of an earlier run is {name.name} now.")


def keep_for_reset(path: Path) -> None:
    """Keep the data file of a run that has ended; errors as of keep()."""
    tell_of_kept(path, keep(path))


@contextlib.contextmanager
def kept_for_run(path: Path, is_written: bool) -> Iterator[None]:
    """Keep a data file that a run would replace; it has its name back if there is no run. Errors as of keep()."""
    name = keep(path) if is_written else None
    try:
        yield
    except BaseException:
        if name is not None:
            name.rename(path.resolve())
        raise
    tell_of_kept(path, name)


def numbered(path: Path) -> Iterator[Path]:
    """Yield the names that a file may get, in their order."""
    for number in itertools.count(1):
        yield path.with_name(f"{path.stem}.{number}{path.suffix}")
