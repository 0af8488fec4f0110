#!/usr/bin/env python3
"""The command `pogoptim`, without installing the package: with the project's .venv, if this Python cannot import it."""

from __future__ import annotations

import os
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

try:
    from pogosim.pogoptim import main
except ImportError:
    python = ROOT / ".venv" / "bin" / "python"
    if not python.exists():
        sys.exit("pogoptim.py: the package pogosim is not installed: ./build.sh installs it into .venv")
    os.execv(python, [str(python), "-m", "pogosim.pogoptim", *sys.argv[1:]])

if __name__ == "__main__":
    sys.exit(main(prog="pogoptim.py"))
