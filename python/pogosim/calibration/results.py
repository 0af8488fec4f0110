"""What a calibration writes, and where."""

from __future__ import annotations

import shutil
from pathlib import Path

from pogosim.command.new import make_project
from pogosim.installation import find_installation
from pogosim.lines import say
from pogosim.outputs import OutputError, partial_output, real_output

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
