"""Projects of robots' programs: what make builds in their folders."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from pogosim.errors import ToolError
from pogosim.installation import Installation
from pogosim.lines import printable_lines, say_error
from pogosim.system_packages import how_to_install


class ProjectError(ToolError):
    """A project cannot be built; says why."""


def run_make(
    folder: Path, target: str, pogosim: Installation, name: Path | None = None, *, is_quiet: bool = False
) -> None:
    """Run make in a project, with this simulator unless the project or the environment names another one.

    Args:
        folder: The project.
        target: What to make.
        pogosim: The simulator.
        name: What the user calls the project; None: its folder.
        is_quiet: Whether what make says is shown only if it fails.

    Raises:
        ProjectError: It fails. make has said why.
    """
    command = ["make", "--silent", "--no-print-directory", "-C", str(folder), target]
    has_own = (folder / "pogosim").exists() or "POGOSIM_DIR" in os.environ
    environment = os.environ | ({} if has_own else {"POGOSIM_DIR": str(pogosim.folder)})
    for variable in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL"):
        environment.pop(variable, None)
    try:
        if is_quiet:
            done = subprocess.run(
                command, check=False, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
            )
        else:
            done = subprocess.run(command, check=False, env=environment, stdout=sys.stderr)
    except FileNotFoundError:
        raise ProjectError(f"make is not installed ({how_to_install('make')})") from None
    if done.returncode != 0:
        if is_quiet:
            say_error(*printable_lines(done.stdout.decode(errors="replace")).split("\n"))
        raise ProjectError(f"{name or folder} cannot be built; see the messages above")
