"""Commands run in this process, as their users call them but without the seconds that imports take each time."""

from __future__ import annotations

import contextlib
import io
import os
from collections.abc import Callable, Sequence
from pathlib import Path

from pogosim.command.main import main
from running import Run


def called(folder: Path, command: Callable[[Sequence[str]], int], *arguments: str) -> Run:
    """Call the `main` of a command in a folder."""
    output, errors = io.StringIO(), io.StringIO()
    before = Path.cwd()
    os.chdir(folder)
    try:
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
            code = command(arguments)
    except SystemExit as end:  # of argparse
        code = end.code if isinstance(end.code, int) else 1
    finally:
        os.chdir(before)
    return Run(code, output.getvalue(), errors.getvalue(), folder)


def pogosim(folder: Path, *arguments: str) -> Run:
    """Call `pogosim` in a folder."""
    return called(folder, main, *arguments)


def refusal(result: Run) -> str:
    """Return the one line that says what is wrong."""
    assert (result.code, result.output) == (2, ""), result.text
    (line,) = result.errors.splitlines()
    return line
