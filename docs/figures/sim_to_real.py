"""The way from a film to firmware: runs the commands of docs/sim_to_real.md and keeps what they print.

.venv/bin/python docs/figures/all.py sim_to_real
"""

from __future__ import annotations

import hashlib
import re
import subprocess
import sys
from pathlib import Path

from pictures import DOCS, ROOT, Picture
from quotes import Quote

PAGE = "sim_to_real.md"
NAMES = ("sim_to_real.png", *(f"{PAGE}: {name}" for name in ("measured", "training", "report", "load", "brains")))
MARK = "---- commands"


def said(folder: Path) -> list[list[str]]:
    """Run the page's commands in a folder. Returns the lines that each block of commands prints."""
    commands = re.findall(r"^```sh\n(.*?)^```$", (DOCS / PAGE).read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    for name in (".venv", "arenas", "docs"):
        (folder / name).symlink_to(ROOT / name)
    own = folder / "bin"  # this Python and its commands, before those of the page
    own.mkdir()
    for name, module in (("python", ""), ("pogosim", "-m pogosim")):
        (own / name).write_text(f'#!/bin/sh\nexec "{sys.executable}" {module} "$@"\n')
        (own / name).chmod(0o755)
    script = "".join(f"echo '{MARK}'\n{block}" for block in commands).replace("$PWD/.venv/bin:", f"{own}:")
    command = ["bash", "-euo", "pipefail", "-c", script]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{PAGE}: a command failed: {done.stdout}{done.stderr}")
    return [part.strip("\n").splitlines() for part in done.stdout.split(f"{MARK}\n")[1:]]


def learnt(lines: list[str]) -> Quote:
    """Return lines that depend on the last bits of NumPy: they are compared on this machine alone."""
    return Quote(tuple(lines), data=hashlib.sha256("\n".join(lines).encode()).hexdigest()[:16])


def draw(folder: Path) -> dict[str, Picture | Quote]:
    """Go the way."""
    _, measured, training, report, built, brains = said(folder)
    lines = measured[next(i for i, line in enumerate(measured) if line.startswith("objects:")) :]
    lines = [line for line in lines if "damping" not in line and line and not line.startswith("written")]
    start = next(i for i, line in enumerate(built) if line.startswith("firmware.elf: "))
    load = built[start : built.index("", start)] + [line for line in built if line.startswith("equal for")]
    return {
        NAMES[0]: Picture((folder / "seeker" / "brains.png").read_bytes(), "paths of five brains", is_exact=False),
        NAMES[1]: Quote(tuple(lines)),
        **{name: learnt(found) for name, found in zip(NAMES[2:], (training, report, load, brains), strict=True)},
    }
