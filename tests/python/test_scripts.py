"""Benchmarks and scripts say in argparse's words what is wrong with their arguments, and which package is missing."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from running import ROOT

BENCHMARKS = sorted(path for path in (ROOT / "bench").glob("*.py") if path.name != "options.py")
FIGURES = [ROOT / "docs" / "figures" / f"{name}.py" for name in ("all", "first_program", "tune", "validate")]
SCRIPTS = [ROOT / "scripts" / f"{name}.py" for name in ("count_tests", "draw_arenas", "make_wheel")]
TRAIN = ROOT / "examples" / "learning" / "train.py"
LEARN = ROOT / "examples" / "policy" / "learn.py"
ALL = [*BENCHMARKS, *FIGURES, *SCRIPTS, TRAIN, LEARN]

PACKAGES = "cma,gymnasium,matplotlib,numpy,pandas,pogosim,yaml"
# Runs a script in a Python in which some packages are not installed.
WITHOUT = """
import runpy, sys
from pathlib import Path
for name in sys.argv[1].split(","):
    sys.modules[name] = None
script = sys.argv[2]
sys.argv = [script, "--help"]
sys.path.insert(0, str(Path(script).parent))
runpy.run_path(script, run_name="__main__")
"""


def ended(*command: str | Path, folder: Path) -> tuple[int, list[str]]:
    """Run a script; returns its exit code and the lines of its errors."""
    done = subprocess.run(
        [sys.executable, *command], cwd=folder, capture_output=True, text=True, check=False, timeout=120
    )
    return done.returncode, done.stderr.splitlines()


@pytest.mark.parametrize("script", ALL, ids=lambda path: path.stem)
def test_wrong_argument_is_told_by_the_usage_and_one_line(script: Path, tmp_path: Path) -> None:
    code, lines = ended(script, "--nonsense", folder=tmp_path)
    assert code == 2
    assert lines[0].startswith(f"usage: {script.name} ")
    assert lines[-1].startswith(f"{script.name}: error: ")
    assert "Traceback" not in "\n".join(lines)


@pytest.mark.parametrize(
    ("script", "arguments"),
    [
        ("batch_runs", ["--runs", "0"]),
        ("batch_runs", ["--workers", "x"]),
        ("batch_runs", ["--seconds", "-1"]),
        ("batch_runs", ["-o", __file__]),
        ("learning", ["--robots", "0"]),
        ("learning", ["--threads", "0"]),
        ("compare_engines", ["--robots", "-1"]),
        ("compare_engines", ["--time-step", "nan"]),
        ("compare_engines", ["no_such_arena"]),
        ("compare_shapes", ["--seeds", "0"]),
        ("own_variables", ["many"]),
        ("reception_profile", ["--seeds", "0"]),
        ("reception_profile", ["--time", "inf"]),
        ("start_up", ["0"]),
        ("table", ["--robots", "0"]),
        ("table", ["-o", __file__]),
    ],
)
def test_number_that_is_no_use_is_refused(script: str, arguments: list[str], tmp_path: Path) -> None:
    code, lines = ended(ROOT / "bench" / f"{script}.py", *arguments, folder=tmp_path)
    assert code == 2
    assert lines[-1].startswith(f"{script}.py: error: ")
    assert "Traceback" not in "\n".join(lines)


@pytest.mark.parametrize("script", [*BENCHMARKS, *FIGURES, TRAIN, LEARN], ids=lambda path: path.stem)
def test_missing_package_is_one_line_with_the_remedy(script: Path, tmp_path: Path) -> None:
    code, lines = ended("-c", WITHOUT, PACKAGES, script, folder=tmp_path)
    needs_none = script.stem in ("analyses", "films", "own_variables")
    assert code == (0 if needs_none else 2)
    assert len(lines) == (0 if needs_none else 1)
    assert needs_none or (lines[0].startswith(f"{script.name}: ") and ".venv/bin/python" in lines[0])


def test_report_of_tests_that_cannot_be_read_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "bad.xml").write_text("<a>")
    for name in ("none.xml", "bad.xml"):
        code, lines = ended(ROOT / "scripts" / "count_tests.py", name, folder=tmp_path)
        assert code == 2
        assert lines[-1].startswith(f"count_tests.py: error: {name} cannot be read: ")
