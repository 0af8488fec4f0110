"""What the tools look at before they import what reads data, so that a wrong name is told at once."""

from __future__ import annotations

import glob
from collections.abc import Iterable
from pathlib import Path


def check_readable(names: Iterable[str]) -> None:
    """Open files; what is none (a folder, a pipe), and files of a pattern, are looked at later.

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
