"""`pogosim new`: a project of the template, in which `make sim` works at once."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Sequence
from pathlib import Path

from pogosim.command.parser import Parser, complain
from pogosim.errors import ToolError
from pogosim.installation import Installation, find_installation
from pogosim.lines import say

FILES = ("main.c", "conf/test.yaml", "Makefile", "robot.mk", "README.md", ".gitignore")
LINK = "pogosim"
# Names with another meaning in the Makefile or the folder.
TAKEN = {"all", "sim", "bin", "emu", "connect", "clean", "build", "conf", LINK}
FILES_OF_MAKE = {"makefile", "gnumakefile", "robot.mk", "readme.md"}


class ProjectError(ToolError):
    """The project cannot be made; says why."""


def check_name(name: str) -> None:
    """Check that make can name a program after the folder.

    Raises:
        ProjectError: It cannot.
    """
    if not re.fullmatch(r"(?![-.])[\w.+=-]+", name) or name.endswith((".c", ".cpp")):
        raise ProjectError(
            f"'{name}' cannot be the name of a project, since the program is named after it: "
            "use letters, digits and any of _ - + . =, with a letter or digit first"
        )
    if name.lower() in TAKEN | FILES_OF_MAKE:
        raise ProjectError(f"'{name}' has another meaning in a project; choose another name")


def make_project(folder: Path, pogosim: Installation) -> None:
    """Make a project in a folder that is new or empty.

    Args:
        folder: Its name is the name of the program.
        pogosim: The simulator to compile with; a link leads to it.

    Raises:
        ProjectError: The name will not do, or there is something already.
        OSError: The files cannot be written.
    """
    name = name_of(folder)
    check_name(name)
    if folder.exists() and not folder.is_dir():
        raise ProjectError(f"{folder} is a file; choose another name")
    if folder.is_dir() and any(folder.iterdir()):
        raise ProjectError(f"{folder} is there already, with files in it; choose another name")
    is_new = not folder.exists()
    try:
        for file in FILES:
            text = (pogosim.template / file).read_text(encoding="utf-8").replace("template_prj", name)
            (folder / file).parent.mkdir(parents=True, exist_ok=True)
            (folder / file).write_text(text, encoding="utf-8")
        (folder / LINK).symlink_to(pogosim.folder, target_is_directory=True)
    except OSError:
        if is_new:
            shutil.rmtree(folder, ignore_errors=True)
        raise


def name_of(folder: Path) -> str:
    """Return the name of the project in a folder, which is that of the folder."""
    return Path(os.path.realpath(folder)).name


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim new") -> int:
    """Run the command. Returns its exit code: 0 done, 2 the project cannot be made."""
    parser = Parser(prog=prog, description="Makes a project: a program, a configuration and a Makefile.")
    parser.add_argument("folder", metavar="NAME", type=Path, help="new folder; the program gets its name")
    folder: Path = parser.parse_args(arguments).folder
    try:
        make_project(folder, find_installation())
    except ToolError as error:
        return complain(prog, error)
    except OSError as error:
        return complain(prog, f"cannot make {folder}: {error.strerror}")
    say(f"Made {folder}: main.c (the program), conf/test.yaml (the world), Makefile. Next:")
    say(f"  cd {folder}", "  make sim", f"  ./{name_of(folder)} -c conf/test.yaml      # -g: without a window")
    return 0
