#!/usr/bin/env python3
"""The command `pogoptim`, without installing the package: with the project's .venv, if this Python cannot import it."""

from __future__ import annotations

import os
import sys
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# Looked for and not imported, so that help does not wait.
if find_spec("pogosim") and find_spec("pyarrow"):
    from pogosim.optimize.command import main
else:
    python = ROOT / ".venv" / "bin" / "python"
    if not python.exists():
        sys.exit("pogoptim.py: the package pogosim is not installed: ./build.sh installs it into .venv")
    os.execv(python, [str(python), "-m", "pogosim.pogoptim", *sys.argv[1:]])

if __name__ == "__main__":
    sys.exit(main(prog="pogoptim.py"))
