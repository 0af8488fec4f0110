"""What a calibration writes, and where."""

from __future__ import annotations

import os
import shutil
from collections.abc import Sequence
from pathlib import Path

from pogosim.command.new import make_project
from pogosim.installation import find_installation
from pogosim.lines import say
from pogosim.outputs import OutputError, leads_to, partial_output, real_output

PROTOCOL = Path(__file__).with_name("protocol.c")
RESULT, LINES, PICTURE = "calibration.json", "calibration.yaml", "calibration.png"


def write_protocol(path: Path) -> None:
    """Write the program to run on the robots, or a project with it if the name is that of no C file.

    Raises:
        InstallationError, OSError, OutputError, ProjectError: It cannot be written.
    """
    if path.suffix != ".c":
        make_project(path, find_installation())
        shutil.copyfile(PROTOCOL, path / "main.c")
        world = path / "conf" / "test.yaml"
        text, _, _ = world.read_text(encoding="utf-8").partition("\n# Variables of the program")
        world.write_text(text, encoding="utf-8")  # the protocol reads no parameters
        say(f"made: {path}, a project whose main.c is the program of the protocol")
        return
    real = real_output(path)
    if real.exists():
        raise OutputError(f"{path} exists already; choose another name")
    with partial_output(real) as partial:
        shutil.copyfile(PROTOCOL, partial)
    say(f"written: {path}")


def check_outputs(folder: Path, inputs: Sequence[Path]) -> None:
    """Make the folder of results; raises OutputError or OSError if they cannot be written there."""
    if folder.exists() and not folder.is_dir():
        raise OutputError(f"{folder} is not a folder; choose another one with -o")
    folder.mkdir(parents=True, exist_ok=True)
    for name in (RESULT, LINES, PICTURE):
        real_output(folder / name)
        if any(leads_to(folder / name, path) for path in inputs):
            raise OutputError(f"{folder / name} is an input, which would be lost; choose another folder with -o")
    if not os.access(folder, os.W_OK):
        raise OutputError(f"{folder} cannot be written; choose another folder with -o")
