"""Benchmarks and scripts say what is wrong with their arguments, and which package is missing."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from running import ROOT

BENCHMARKS = sorted(path for path in (ROOT / "bench").glob("*.py") if path.name != "options.py")
FIGURES = [ROOT / "docs" / "figures" / f"{name}.py" for name in ("all", "first_program", "tune", "validate")]
SCRIPTS = [ROOT / "scripts" / f"{name}.py" for name in ("count_tests", "draw_arenas", "make_wheel")]
SCRIPTS += [ROOT / "scripts" / "cross" / f"{name}.py" for name in ("check_mach_o", "dependencies", "old_libraries")]
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


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("build.sh debug", "'debug': expected nothing, Release or Debug"),
        ("demo.sh all", "'all': expected no arguments"),
        ("test.sh --fast", "unknown argument '--fast', expected --quick, --style or --tidy"),
        ("test.sh --quick --style", "--quick and --style: expected one of them"),
        ("scripts/site.sh folder", "'folder': expected no arguments"),
        ("scripts/check_macos.sh m1", "unknown kind of Macs 'm1', expected arm64 or x86_64"),
        (
            "scripts/make_wheel.sh --for windows",
            "--for: unknown machine 'windows', expected linux-x86_64, linux-aarch64, ",
        ),
        ("scripts/make_wheel.sh --for", "--for: expected a machine after it: linux-x86_64, linux-aarch64, "),
        ("scripts/make_wheel.sh --to windows", "unknown option '--to', expected --for or --here"),
        ("scripts/make_wheel.sh wheels --here", "'--here' after the folder 'wheels', expected the folder last"),
        (".ci/publish v1.2.3", "expected vVERSION and the folder of the wheels, found 1"),
        ("tests/containers/run.sh", "expected one argument, the wheel, found 0"),
        ("tests/wheel/bare_machine.sh", "expected a wheel, or a wheel and a distribution, found 0"),
        ("tests/wheel/first_steps.sh", "expected one argument, the wheel, found 0"),
        ("tests/wheel/first_steps.sh no.whl", "there is no file 'no.whl'"),
        ("tests/slurm/one_node.sh", "no command, expected one and its arguments"),
    ],
)
def test_wrong_argument_of_a_shell_script_is_one_line(words: str, message: str, tmp_path: Path) -> None:
    script, *arguments = words.split()
    command = [str(ROOT / script), *arguments]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=60)
    assert (done.returncode, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"{Path(script).name}: {message}")


@pytest.mark.parametrize("script", ["build.sh", "demo.sh", "test.sh", "scripts/site.sh", "scripts/make_wheel.sh"])
def test_help_of_a_shell_script_is_printed(script: str, tmp_path: Path) -> None:
    done = subprocess.run(
        [ROOT / script, "--help"], cwd=tmp_path, capture_output=True, text=True, check=True, timeout=60
    )
    assert done.stderr == ""
    assert done.stdout.startswith(f"Usage: {'' if '/' in script else './'}{script}")


def test_wheel_of_uncommitted_changes_is_warned_of(tmp_path: Path) -> None:
    (tmp_path / "scripts").mkdir()
    shutil.copy(ROOT / "scripts" / "make_wheel.sh", tmp_path / "scripts")
    (tmp_path / "scripts" / "bootstrap.sh").write_text(
        "install_packages() { :; }\nmake_wheel_environment() { :; }\nsay() { :; }\nfail() { exit 1; }\n"
    )
    (python := tmp_path / "build" / "wheel-environment" / "bin" / "python").parent.mkdir(parents=True)
    python.symlink_to(shutil.which("true") or "")

    def errors() -> str:
        command = [tmp_path / "scripts" / "make_wheel.sh"]
        return subprocess.run(command, capture_output=True, text=True, check=True, timeout=60).stderr

    assert errors() == ""  # sources of an archive
    identity = ["-c", "user.name=Tester", "-c", "user.email=tester@example.org"]
    for words in (["init", "--quiet"], ["add", "scripts"], [*identity, "commit", "--quiet", "--message", "first"]):
        subprocess.run(["git", "-C", str(tmp_path), *words], check=True)
    assert errors() == ""
    with (tmp_path / "scripts" / "bootstrap.sh").open("a") as file:
        file.write("\n")
    assert errors().startswith("make_wheel.sh: warning: this checkout has uncommitted changes: ")


def test_report_of_tests_that_cannot_be_read_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "bad.xml").write_text("<a>")
    for name in ("none.xml", "bad.xml"):
        code, lines = ended(ROOT / "scripts" / "count_tests.py", name, folder=tmp_path)
        assert code == 2
        assert lines[-1].startswith(f"count_tests.py: error: {name} cannot be read: ")
