"""The log of a run: what its simulator has printed, as far as a batch passes it on."""

from __future__ import annotations

import contextlib
import os
import re
from pathlib import Path

from pogosim.lines import printable

LOG = "log.txt"
CONFIGURATION = "test.yaml"
EFFECTIVE = "pogobatch_effective.yaml"  # its name in the folder of a single task
OWN = "<configuration>"  # in messages of a run: its own configuration, a temporary file
LOG_LINES = 10
WHEN = re.compile(r"^\[[^\]]*\] (?=\[)")  # the date of a line in the log
MAX_WARNINGS = 1000  # of one run
LONGEST_LINE = 10_000  # bytes of a line that are read at once


def tail(path: Path) -> str:
    """Return the last lines of a log."""
    try:
        with path.open("rb") as file:
            file.seek(0, os.SEEK_END)
            file.seek(max(0, file.tell() - 20_000))
            lines = file.read().decode(errors="replace").splitlines()
    except OSError:
        return ""
    return "\n".join(without_folder(line, path.parent) for line in lines[-LOG_LINES:])


def with_last_line(problem: str, log: str) -> str:
    """Return why a run failed, with the last line of its log, without the date."""
    last = next((line for line in reversed(log.splitlines()) if line.strip()), "")
    return f"{problem}: {WHEN.sub('', last)}" if last else problem


def without_folder(line: str, folder: Path) -> str:
    """Return a line of a log with its control characters shown, and the run's own configuration as OWN."""
    for name in (CONFIGURATION, EFFECTIVE):
        line = line.replace(str(folder / name), OWN)
    return printable(line)


def warnings_in(folder: Path) -> str:
    """Return the warnings in the log of a run, each once, without dates."""
    with contextlib.suppress(OSError):
        return "\n".join(warnings_in_log(folder / LOG))
    return ""


def warnings_in_log(path: Path) -> list[str]:
    """Return the warnings in a file of what a run has printed, each once, without dates.

    Raises:
        OSError: It cannot be read.
    """
    found: dict[str, None] = {}
    with path.open("rb") as file:
        while len(found) < MAX_WARNINGS and (line := file.readline(LONGEST_LINE)):
            _, mark, text = line.decode(errors="replace").rstrip("\r\n").partition("[warning] ")
            if mark:
                found[without_folder(text, path.parent)] = None
    return list(found)
