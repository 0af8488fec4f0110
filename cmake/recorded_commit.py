"""Records the commit in source distributions, for scikit-build-core (see pyproject.toml, dynamic-metadata)."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
FILE = ROOT / "cmake" / "sdist_commit.txt"


class RecordedCommit:
    """Has cmake/commit.cmake write sdist_commit.txt, which it reads where there is no repository. Adds no metadata."""

    def build_state(self, state: str) -> None:
        """Write the file if a source distribution is made of a checkout."""
        if state != "sdist" or not (ROOT / ".git").exists():
            return
        FILE.unlink(missing_ok=True)  # of an earlier one
        command = ["cmake", f"-DFOLDER={ROOT}", f"-DFILE={FILE}", "-P", str(ROOT / "cmake" / "commit.cmake")]
        subprocess.run(command, check=True)

    def dynamic_metadata(self, settings: Mapping[str, Any], project: Mapping[str, Any]) -> dict[str, Any]:  # noqa: ARG002
        """Return entries to add to [project]: none."""
        return {}
