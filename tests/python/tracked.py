"""The project's own files."""

from __future__ import annotations

import subprocess
from pathlib import Path

from running import ROOT

SKIPPED = {"build", ".venv", ".git"}


def tracked(*endings: str) -> list[Path]:
    """Return the project's files with these endings; all files without any."""
    names = subprocess.run(
        ["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False, timeout=60
    ).stdout
    files = [ROOT / name for name in names.splitlines()] or list(ROOT.rglob("*"))  # an archive has no .git
    return [
        file
        for file in files
        if (not endings or file.suffix in endings)
        and file.is_file()
        and not SKIPPED & set(file.relative_to(ROOT).parts)
    ]
