"""Where the simulator is that programs are compiled with: in this package, or in the source tree around it."""

from __future__ import annotations

import os
import re
import shlex
from dataclasses import dataclass
from pathlib import Path

import pogosim
from pogosim.errors import ToolError

PACKAGE = Path(pogosim.__file__).resolve().parent
# Where pogosim.mk is: in a source tree, a build, a package or an installation. As in the Makefile of projects.
SETTINGS = (
    "build/release/pogosim.mk",
    "build/debug/pogosim.mk",
    "pogosim.mk",
    "lib/pkgconfig/pogosim.mk",
    "lib64/pkgconfig/pogosim.mk",
    "lib/*/pkgconfig/pogosim.mk",
)


class InstallationError(ToolError):
    """There is no simulator; says what to do."""


@dataclass(frozen=True)
class Installation:
    """A simulator, as an installation has it or as a source tree has built it.

    Attributes:
        folder: What the Makefile of a project calls POGOSIM_DIR.
        original: What make reads first in projects that were written for the original simulator.
        version: Version of the simulator, such as "0.11.0".
        library: Folder of the library.
        template: Folder of the project template.
        shared_state: The tool that finds variables shared by mistake; it may be missing.
        without_program: What runs configurations that need no program, and firmware.
        compiler_flags: Flags to compile and link a program in one command, for the end of the command line.
    """

    folder: Path
    original: Path
    version: str
    library: Path
    template: Path
    shared_state: Path
    without_program: Path
    compiler_flags: tuple[str, ...]


def read_settings(file: Path) -> dict[str, list[str]]:
    """Return the variables of a pogosim.mk by name, split into words as a shell would."""
    here = shlex.quote(os.path.realpath(file.parent))
    lines = re.findall(r"^(\w+) [:?]= (.*)$", file.read_text(encoding="utf-8", errors="replace"), re.MULTILINE)
    return {name: shlex.split(value.replace("${pcfiledir}", here)) for name, value in lines}


def installation_in(folder: Path) -> Installation | None:
    """Return the simulator in a folder; None if there is none.

    Raises:
        InstallationError: There is one of another version.
    """
    file = next((path for pattern in SETTINGS for path in sorted(folder.glob(pattern)) if path.is_file()), None)
    if file is None:
        return None
    try:
        settings = read_settings(file)
        library, template, shared_state, without_program = (
            Path(os.path.normpath(settings[name][0]))
            for name in ("POGOSIM_LIBRARY_DIR", "POGOSIM_TEMPLATE_DIR", "SHARED_STATE_TOOL", "WITHOUT_PROGRAM_TOOL")
        )
        flags = (*settings["POGOSIM_CFLAGS"], *settings["POGOSIM_SDK_CFLAGS"], *settings["POGOSIM_LIBS"])
        original = file.with_name("pogosim-original.mk")
        version = settings["POGOSIM_VERSION"][0]
        return Installation(folder, original, version, library, template, shared_state, without_program, flags)
    except (KeyError, IndexError, ValueError):
        raise InstallationError(f"{file} is of another version, or damaged: build that Pogosim again") from None


def find_installation() -> Installation:
    """Return the simulator to use: of the environment variable POGOSIM_DIR, this package, or the tree around it.

    Raises:
        InstallationError: There is none.
    """
    chosen = os.environ.get("POGOSIM_DIR")
    if chosen:
        found = installation_in(Path(os.path.realpath(chosen)))
        if found is None:
            raise InstallationError(f"there is no simulator in POGOSIM_DIR={chosen}: build it, or unset POGOSIM_DIR")
        return found
    tree = PACKAGE.parent.parent
    found = installation_in(PACKAGE / "simulator") or installation_in(tree)
    if found is None:
        if (tree / "build.sh").is_file():
            raise InstallationError(f"the simulator in {tree} is not built: run ./build.sh there")
        raise InstallationError(
            f"the package in {PACKAGE} has no simulator in it: install its wheel again, or build a checkout "
            "(pogobot-simulator; the pogosim of PyPI is another program)"
        )
    return found
