"""Checks of input files before the modules that read them are imported, so that errors are reported at once."""

from __future__ import annotations

import glob
from collections.abc import Iterable
from pathlib import Path


def check_readable(names: Iterable[str]) -> None:
    """Open files, to find errors early. Folders, pipes and files of a pattern are checked later.

    Raises:
        OSError: One cannot be read.
    """
    for name in names:
        path = Path(name)
        if path.exists() and not path.is_file():
            continue  # opening a pipe would wait for a writer
        if glob.has_magic(name) and not path.exists():
            continue
        with path.open("rb"):
            pass
