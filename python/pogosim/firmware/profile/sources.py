"""The text of source lines, where their files can be found: in the project of the firmware."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

PROJECT_ABOVE = 3  # a firmware is in build/emu/ of its project


class Sources:
    """Files of the program, which are read once."""

    def __init__(self, folders: Sequence[Path]) -> None:
        """Look for files in some folders, in this order."""
        self.folders = tuple(folders)
        self.lines_of: dict[str, list[str]] = {}

    def text(self, file: str, number: int) -> str:
        """Return a line without the blanks around it; "" if it cannot be found. The first one is 1."""
        if file not in self.lines_of:
            self.lines_of[file] = self.read(file)
        lines = self.lines_of[file]
        return lines[number - 1].strip() if 0 < number <= len(lines) else ""

    def read(self, file: str) -> list[str]:
        """Return the lines of the first file of this name; none if there is no such file."""
        names = (Path(file), *(folder / file for folder in self.folders if not Path(file).is_absolute()))
        beside = (folder / Path(file).name for folder in self.folders)
        for path in (*(name for name in names if name.is_absolute()), *beside):
            try:
                return path.read_text(encoding="utf-8", errors="replace").splitlines()
            except (OSError, ValueError):
                continue
        return []


def folders_of(firmware: Path) -> list[Path]:
    """Return the folders in which the sources of a firmware may be: its own, and those around it."""
    return list(firmware.absolute().parents)[:PROJECT_ABOVE]


def shown_place(file: str, number: int) -> str:
    """Return a line's place as reports show it, "main.c:84"."""
    return f"{Path(file).name}:{number}"
