"""gdb without a terminal."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import pytest
from project import CLEAN
from running import ROOT

PRINTERS = ROOT / "tools" / "gdb" / "pogosim_gdb.py"


def debug(command: Sequence[str | Path], lines: Sequence[str], folder: Path) -> str:
    """Start gdb on a command, have it carry out these lines, and return all that was printed."""
    script = folder / "commands.gdb"
    script.write_text("\n".join(["set pagination off", "set confirm off", *lines, "kill", ""]))
    ended = subprocess.run(
        ["gdb", "-nx", "-q", "-batch", "-x", str(script), "--args", *map(str, command)],
        cwd=folder,
        env=CLEAN | {"HOME": str(folder)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        stdin=subprocess.DEVNULL,
        text=True,
        timeout=120,
        check=False,
    )
    return ended.stdout


@cache
def gdb_works() -> bool:
    """Tell whether gdb is installed and may look at other processes, which some containers forbid."""
    if not shutil.which("gdb"):
        return False
    command = ["gdb", "-nx", "-batch", "-ex", "run", "/bin/true"]
    return "exited normally" in subprocess.run(command, capture_output=True, text=True, check=False).stdout


# Continuous integration has what is needed: there, a gdb that does not work is a failure.
needs_gdb = pytest.mark.skipif(
    not os.environ.get("CI") and not gdb_works(), reason="gdb is missing or may not look at processes"
)
