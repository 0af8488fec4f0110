"""Tools that write files draw them whatever the user's environment and matplotlibrc say."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from running import ROOT, example, run

INLINE = "module://matplotlib_inline.backend_inline"  # what a notebook sets for its commands, too
COMMANDS = [
    ("picture", "data.feather", "out.png", "-q"),
    ("film", "data.feather", "-o", "out.gif", "--size", "200", "-q"),
    ("arena", "show", str(ROOT / "arenas" / "disk.csv"), "arena.png"),
    ("analyze", "arena", "-i", "data.feather", "-o", "out"),
    ("report", "data.feather", "-o", "out.html", "-q"),
    ("compare", "data.feather", "data.feather", "-o", "compared.png", "-q"),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the data file of a run."""
    folder = tmp_path_factory.mktemp("run")
    assert run(example("helloworld"), folder, {"simulation_time": 0.5}).code == 0
    return folder


def done(folder: Path, command: tuple[str, ...], **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a command in a folder."""
    return subprocess.run(
        [sys.executable, *command],
        cwd=folder,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("backend", [INLINE, "no backend"])
def test_backend_of_a_notebook_does_not_matter(folder: Path, command: tuple[str, ...], backend: str) -> None:
    result = done(folder, ("-m", "pogosim", *command), MPLBACKEND=backend)
    assert (result.returncode, result.stderr) == (0, "")


def test_tools_that_are_modules_start_from_a_notebook(folder: Path) -> None:
    options = ("data.feather", "out.png", "-q")
    result = done(folder, ("-m", "pogosim.swarm_picture", *options), MPLBACKEND=INLINE)
    assert (result.returncode, result.stderr) == (0, "")


@pytest.mark.parametrize("command", COMMANDS)
def test_texts_are_drawn_without_tex(folder: Path, command: tuple[str, ...], tmp_path: Path) -> None:
    (tmp_path / "matplotlibrc").write_text("text.usetex: True\n")
    path = os.environ["PATH"] if command[0] == "film" else "/nowhere"  # a film needs ffmpeg; the others find no latex
    result = done(folder, ("-m", "pogosim", *command), MPLCONFIGDIR=str(tmp_path), PATH=path)
    assert (result.returncode, result.stderr) == (0, "")
