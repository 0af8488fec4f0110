"""The presets of CMake, which ./build.sh and ./test.sh use as well, configure what they are named after."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from project import CLEAN
from running import ROOT

PRESETS: dict[str, list[dict[str, Any]]] = json.loads((ROOT / "CMakePresets.json").read_text())
# What compiles a file of the simulator, by preset: a part of the command, and what must not be in it.
COMMANDS = {
    "release": ("-O3", "-fsanitize"),
    "debug": ("-g", "-O"),
    "clang": ("clang++", "-fsanitize"),
    "asan": ("-fsanitize=address,undefined", "-fsanitize=thread"),
    "tsan": ("-fsanitize=thread", "-fsanitize=address"),
    "lto": ("-flto", "-fno-lto"),
}


def names(kind: str) -> set[str]:
    """Names of the presets of one kind, without those that others only inherit from."""
    return {preset["name"] for preset in PRESETS[kind] if not preset.get("hidden", False)}


def configure(folder: Path, preset: str, *options: str) -> subprocess.CompletedProcess[str]:
    """Run `configure` of scripts/bootstrap.sh."""
    script = '. scripts/bootstrap.sh; configure "$@"'
    command = ["bash", "-euo", "pipefail", "-c", script, "configure", str(folder), preset, *options]
    return subprocess.run(command, cwd=ROOT, env=CLEAN, capture_output=True, text=True, timeout=300, check=False)


def test_what_can_be_configured_can_be_built_and_tested() -> None:
    assert names("configurePresets") == names("buildPresets") == set(COMMANDS)
    assert names("testPresets") == set(COMMANDS) - {"lto"}
    for kind in ("buildPresets", "testPresets"):
        for preset in PRESETS[kind]:
            assert preset.get("hidden", False) or preset["configurePreset"] == preset["name"]


@pytest.mark.parametrize("preset", sorted(COMMANDS))
def test_preset_compiles_as_its_name_says(preset: str, tmp_path: Path) -> None:
    if preset in {"clang", "asan", "tsan"} and not shutil.which("clang++"):
        pytest.skip("clang is not installed")
    done = configure(tmp_path / "build", preset)
    assert (done.returncode, done.stderr) == (0, "")
    entries = json.loads((tmp_path / "build" / "compile_commands.json").read_text())
    (command,) = [entry["command"] for entry in entries if entry["file"].endswith("src/physics/box2d_engine.cpp")]
    present, absent = COMMANDS[preset]
    assert present in command
    assert absent not in command
    examples = [entry for entry in entries if "/examples/vicsek/" in entry["file"]]
    assert bool(examples) == (preset in {"release", "debug"})


def test_options_of_a_command_are_stronger_than_the_preset(tmp_path: Path) -> None:
    off = ["-DPOGOSIM_BUILD_TESTS=OFF", "-DPOGOSIM_BUILD_BENCH=OFF", "-DPOGOSIM_BUILD_EXAMPLES=OFF"]
    assert configure(tmp_path / "build", "Release", *off).returncode == 0
    entries = json.loads((tmp_path / "build" / "compile_commands.json").read_text())
    assert {Path(entry["file"]).relative_to(ROOT).parts[0] for entry in entries} <= {"src", "tools"}
    assert configure(tmp_path / "build", "release").returncode == 0  # and the preset's come back
    entries = json.loads((tmp_path / "build" / "compile_commands.json").read_text())
    assert "tests" in {Path(entry["file"]).relative_to(ROOT).parts[0] for entry in entries}


@pytest.mark.parametrize("value", ["ON", "adress", "memory"])
def test_unknown_sanitizer_is_refused(value: str, tmp_path: Path) -> None:
    done = configure(tmp_path / "build", "release", f"-DPOGOSIM_SANITIZE={value}")
    assert done.returncode == 1
    assert f'POGOSIM_SANITIZE is "{value}"; expected one of OFF, address' in " ".join(done.stderr.split())


def test_unknown_preset_is_refused_with_its_name(tmp_path: Path) -> None:
    done = configure(tmp_path / "build", "relaese")
    assert done.returncode == 1
    assert "No such preset in" in done.stderr
    assert '"relaese"' in done.stderr
