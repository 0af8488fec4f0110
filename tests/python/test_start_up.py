"""What a start reads: nothing that the run does not need."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from pogosim.simple_yaml import simple_yaml
from pogosim.yaml_1_2 import dump_yaml
from running import ROOT, build_folder, example, write_scene

HANABI = ROOT / "examples" / "hanabi" / "hanabi.so"
LARGE_PACKAGES = ("yaml", "elftools", "pandas", "pyarrow", "tempfile", "importlib.metadata")


@pytest.fixture(autouse=True)
def _installation(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("POGOSIM_DIR", str(ROOT))


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


# ---- Python


def test_a_run_in_python_imports_no_large_package(scene: Path) -> None:
    code = f"""if True:
        import sys, pogosim
        settings = {{"simulation_time": 1.5, "objects.robots.nb": 2, "initial_formation": "random"}}
        with pogosim.Simulation({str(HANABI)!r}, {str(scene)!r}, seed=1, set=settings) as simulation:
            simulation.run()
            simulation.reset(2)
        print([name for name in {LARGE_PACKAGES!r} if name in sys.modules])
    """
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == "[]\n"


SIMPLE_VALUES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(),
    st.text(alphabet="aAeEyYnNoOfFsS01_/.+-~:# "),
    st.sampled_from(["yes", "On", "NULL", "~", "1e3", "0x1F", ".nan", "=", "<<", "o...", "disk", "arenas/disk.csv"]),
)


@given(SIMPLE_VALUES)
def test_simple_values_are_written_as_pyyaml_writes_them(value: Any) -> None:
    text = simple_yaml(value)
    assert text is None or text == dump_yaml(value, is_flow=True).strip()


@pytest.mark.parametrize(
    "value", [None, True, 50, 0.25, -3.0, "disk", "arenas/disk.csv", "/tmp/rows.feather", "two_words"]
)
def test_usual_values_need_no_pyyaml(value: Any) -> None:
    assert simple_yaml(value) is not None


def test_texts_that_end_in_dots_keep_them() -> None:
    for text in ("o...", "...", "a b..."):
        assert yaml.safe_load(dump_yaml(text)) == text
