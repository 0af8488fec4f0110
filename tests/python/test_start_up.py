"""What a start reads: nothing that the run does not need."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from running import ROOT, build_folder, example, write_scene


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """A configuration of three robots."""
    return write_scene(tmp_path, {"arena_file": str(ROOT / "arenas" / "disk.csv")})


@pytest.mark.skipif(sys.platform != "linux", reason="only its dynamic linker tells what it loads")
@pytest.mark.parametrize("has_rows", [False, True])
def test_only_a_run_with_rows_loads_arrow(scene: Path, has_rows: bool) -> None:
    command = [str(example("hanabi")), "-c", str(scene), "-g", "--set", f"enable_data_logging={str(has_rows).lower()}"]
    environment = {**os.environ, "LD_DEBUG": "files", "LD_DEBUG_OUTPUT": "linker"}
    subprocess.run(command, env=environment, check=True, capture_output=True, cwd=scene.parent)
    (log,) = scene.parent.glob("linker.*")
    loaded = log.read_text(encoding="utf-8", errors="replace")
    assert "libpogosim" in loaded
    assert ("libarrow" in loaded) == has_rows
    assert ("libpogosim_tables" in loaded) == has_rows


@pytest.mark.skipif(sys.platform != "linux", reason="its dynamic linker takes another library")
def test_a_missing_module_of_tables_is_told_and_needed_for_rows_alone(scene: Path, tmp_path: Path) -> None:
    alone = tmp_path / "alone"
    alone.mkdir()
    for library in (build_folder() / "src").glob("libpogosim.so*"):
        (alone / library.name).write_bytes(library.read_bytes())
    for has_rows, code in ((False, 0), (True, 2)):
        run = subprocess.run(
            [example("hanabi"), "-c", scene, "-g", "-q", "--set", f"enable_data_logging={str(has_rows).lower()}"],
            env={**os.environ, "LD_LIBRARY_PATH": str(alone)},
            capture_output=True,
            text=True,
            cwd=scene.parent,
        )
        assert run.returncode == code, run.stderr
        assert ("cannot write the data file 'data.feather' (data_filename): the module" in run.stderr) == has_rows
