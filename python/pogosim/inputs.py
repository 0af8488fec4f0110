"""What the tools look at before they import what reads data, so that a wrong name is told at once."""

from __future__ import annotations

import glob
from collections.abc import Iterable
from pathlib import Path


def check_readable(names: Iterable[str]) -> None:
    """Open files; those of a pattern are looked for later.

    Raises:
        OSError: One cannot be read.
    """
    for name in names:
        if not glob.has_magic(name) or Path(name).exists():
            with Path(name).open("rb"):
                pass
