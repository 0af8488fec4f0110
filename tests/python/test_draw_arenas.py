"""The arenas that come with the simulator are what their script draws."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from running import ROOT


def test_script_draws_the_same_arenas_again_to_the_byte(tmp_path: Path) -> None:
    folder = tmp_path / "arenas"
    subprocess.run([sys.executable, ROOT / "scripts" / "draw_arenas.py", "--output", folder], check=True)
    drawn = {path.name: path.read_bytes() for path in folder.iterdir()}
    kept = {path.name: path.read_bytes() for path in (ROOT / "arenas").iterdir()}
    assert sorted(drawn) == sorted(kept)
    assert [name for name in drawn if drawn[name] != kept[name]] == []
