"""Help, version and wrong usage do not wait for what computes and draws: no large package is imported for them."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from pogosim.command.main import COMMANDS
from pogosim.reports.command import ANALYSES

HEAVY = (
    *("pandas", "numpy", "scipy", "matplotlib", "pyarrow", "shapely", "svgelements", "elftools", "tqdm"),
    *("dask", "distributed", "cma", "ribs", "optuna"),
)
ARENA_ACTIONS = ("show", "scale", "from-svg", "to-svg")
# Calls commands one after the other in one process, and prints what each has imported.
CHILD = """
import contextlib, io, json, sys
from pogosim.command.main import main
heavy, commands = json.loads(sys.argv[1])
found = []
for command in commands:
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as said:
        try:
            code = main(command)
        except SystemExit as end:
            code = end.code or 0
    found.append([code, said.getvalue(), [name for name in heavy if name in sys.modules]])
print(json.dumps(found))
"""


def said_and_imported(folder: Path, commands: list[list[str]]) -> list[tuple[int, str, list[str]]]:
    """Run commands; returns of each its exit code, its errors, and which large packages have been imported so far."""
    call = [sys.executable, "-c", CHILD, json.dumps([HEAVY, commands])]
    done = subprocess.run(call, cwd=folder, check=True, capture_output=True, text=True, timeout=120)
    return [(code, errors, imported) for code, errors, imported in json.loads(done.stdout)]


def all_commands() -> list[list[str]]:
    """Return all commands that have options of their own."""
    names = [[name] for name in COMMANDS.own]
    return [*names, *(["analyze", name] for name in ANALYSES.own), *(["arena", name] for name in ARENA_ACTIONS)]


def test_help_and_version_import_no_large_package(tmp_path: Path) -> None:
    commands = [[], ["--help"], ["--version"], *([*command, "--help"] for command in all_commands())]
    commands += [["batch", "--version"], ["optimize", "--version"]]
    for command, (code, errors, imported) in zip(commands, said_and_imported(tmp_path, commands), strict=True):
        assert (command, code, imported) == (command, 0 if command else 2, [])
        assert errors == "" or not command


def test_wrong_usage_imports_no_large_package(tmp_path: Path) -> None:
    (tmp_path / "data.feather").write_bytes(b"")
    (tmp_path / "c.yaml").write_text("a: 1\n")
    commands = [
        *([*command, "--nonsense"] for command in all_commands() if command != ["run"]),
        *([name] for name in ("optimize", "batch", "analyze", "picture", "film", "recover", "arena", "best-psend")),
        *([name, "none.feather", "out.png"] for name in ("picture", "calibrate")),
        ["film", "none.feather", "-o", "out.html"],
        ["picture", "data.feather", "out.exe"],
        ["film", "data.feather", "-o", "out.exe"],
        ["picture", "data.feather", "out.png", "--dpi", "0"],
        ["calibrate", "none.csv", "-c", "c.yaml"],
        *(["analyze", name, "-i", "none.feather"] for name in ANALYSES.own),
        ["optimize", "-c", "c.yaml", "-S", "none", "--max-evals", "0"],
        ["optimize", "-c", "c.yaml", "-S", "none", "--optimizer", "luck"],
        ["optimize", "-c", "none.yaml", "-S", "none"],
        ["batch", "-c", "c.yaml", "-S", "none", "--runs", "x"],
    ]
    for command, (code, errors, imported) in zip(commands, said_and_imported(tmp_path, commands), strict=True):
        expected = 1 if command[0] == "batch" and "-c" not in command else 2
        assert (command, code, imported) == (command, expected, []), errors
        assert errors.strip() != ""


@pytest.mark.parametrize("options", [["--help"], ["--version"], ["--nonsense"]])
def test_the_script_of_pogoptim_imports_no_large_package(options: list[str]) -> None:
    script = Path(__file__).resolve().parents[2] / "scripts" / "pogosim" / "pogoptim.py"
    command = [sys.executable, "-X", "importtime", str(script), *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60, env=os.environ)
    assert done.returncode == (2 if options == ["--nonsense"] else 0)
    assert "pogosim.optimize.command" in done.stderr
    imported = {line.rpartition("|")[2].strip().partition(".")[0] for line in done.stderr.splitlines()}
    assert imported & set(HEAVY) == set()


def test_batch_begins_without_packages_that_compute_or_draw() -> None:
    code = "import sys, pogosim.batch.runner, pogosim.batch.command_line; print(sorted(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True, timeout=60)
    heavy = [name for name in HEAVY if name not in ("numpy", "pyarrow", "tqdm") and f"'{name}'" in done.stdout]
    assert heavy == []
