"""Firmware made of C text, and runs of it on emulated processors."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from pathlib import Path

from project import TEMPLATE, made
from robot_sdk import TRIPLE, need
from running import ROOT, Run, Settings, build_folder, run

OF_ROBOTS = "objects.robots.brain"

PROGRAM = """#include "pogobase.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
typedef struct {{
    uint32_t count;
    int16_t level;
    float share;
    bool is_even;
    char word[8];
    struct {{ uint8_t id; double value; }} items[2];
}} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)
{globals}
void user_init(void) {{
    {init}
}}
void user_step(void) {{
    mydata->count++;
    {step}
}}
int main(void) {{
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}}
"""


def text(step: str = "", init: str = "", globals_: str = "") -> str:
    """Return a program with this code in its user_step and user_init, and before them."""
    return PROGRAM.format(step=step, init=init, globals=globals_)


def add_pogosim(folder: Path) -> Path:
    """Give a project Pogosim's tree, which need not be built, as a link."""
    (folder / "pogosim").mkdir()
    (folder / "pogosim" / "include").symlink_to(ROOT / "include")
    (folder / "pogosim" / "src").symlink_to(ROOT / "src")
    return folder


def project_of(folder: Path, *sources: Path) -> Path:
    """Make a project of these C and C++ files and headers."""
    folder.mkdir(parents=True)
    for file in (TEMPLATE / "Makefile", TEMPLATE / "robot.mk", *sources):
        shutil.copy(file, folder)
    return add_pogosim(folder)


def firmware_in(project: Path, *arguments: str) -> Path:
    """Build the firmware of a project."""
    need(f"{TRIPLE}-gcc")
    made(project, "emu", *arguments)
    return project / "build" / "emu" / "firmware.elf"


def firmware_of(folder: Path, text: str, name: str = "main.c") -> Path:
    """Build the firmware of a program's text in a new project folder."""
    folder.mkdir(parents=True, exist_ok=True)
    source = folder / name
    source.write_text(text)
    return firmware_in(project_of(folder / "project", source))


def without_program() -> Path:
    """Return what runs configurations that need no program."""
    return build_folder() / "src" / "pogosim-without-program"


def run_firmware(
    firmware: Path,
    folder: Path,
    settings: Settings | None = None,
    arguments: Sequence[str] = (),
    brain: str = OF_ROBOTS,
) -> Run:
    """Run a firmware on the robots of scene.yaml, some keys (dotted paths) of which are changed."""
    return run(without_program(), folder, {brain: str(firmware), **(settings or {})}, arguments)
