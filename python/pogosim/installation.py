"""Where the simulator is that programs are compiled with: in this package, or in the source tree around it."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from pathlib import Path

import pogosim

PACKAGE = Path(pogosim.__file__).resolve().parent
# Where pogosim.mk is: in a package or an installation, and in a source tree.
SETTINGS = ("lib/pkgconfig/pogosim.mk", "build/release/pogosim.mk", "build/debug/pogosim.mk", "pogosim.mk")

# What pogosim.mk says, in the order of `Installation`.
VARIABLES = (
    "POGOSIM_VERSION",
    "POGOSIM_INCLUDE_DIR",
    "POGOSIM_LIBRARY_DIR",
    "POGOSIM_INTERFACE_DIR",
    "POGOSIM_TEMPLATE_DIR",
    "SHARED_STATE_TOOL",
)


class InstallationError(Exception):
    """There is no simulator; says what to do."""


@dataclass(frozen=True)
class Installation:
    """A simulator, as an installation has it or as a source tree has built it.

    Attributes:
        folder: What the Makefile of a project calls POGOSIM_DIR.
        version: Version of the simulator, such as "0.11.0".
        include: Folder of the headers.
        library: Folder of the library.
        interface: Folder of the C files that are compiled for robots.
        template: Folder of the project template.
        shared_state: The tool that finds variables shared by mistake; it may be missing.
    """

    folder: Path
    version: str
    include: Path
    library: Path
    interface: Path
    template: Path
    shared_state: Path

    @property
    def compiler_flags(self) -> list[str]:
        """Flags to compile and link a program in one command."""
        return [f"-I{self.include}", f"-L{self.library}", f"-Wl,-rpath,{self.library}"]


def read_settings(file: Path) -> dict[str, str]:
    """Return the variables of a pogosim.mk, by name."""
    here = str(file.resolve().parent)
    lines = re.findall(r"^(\w+) [:?]= (.*)$", file.read_text(encoding="utf-8"), re.MULTILINE)
    return {name: value.replace("\\ ", " ").replace("${pcfiledir}", here) for name, value in lines}


def installation_in(folder: Path) -> Installation | None:
    """Return the simulator in a folder; None if there is none.

    Raises:
        InstallationError: There is one of another version.
    """
    file = next((folder / name for name in SETTINGS if (folder / name).is_file()), None)
    if file is None:
        return None
    settings = read_settings(file)
    try:
        version, *paths = (settings[name] for name in VARIABLES)
    except KeyError as error:
        raise InstallationError(f"{file} has no {error}: it is of another version; build that Pogosim again") from None
    return Installation(folder, version, *(Path(os.path.normpath(path)) for path in paths))


def find_installation() -> Installation:
    """Return the simulator to use: of the environment variable POGOSIM_DIR, this package, or the tree around it.

    Raises:
        InstallationError: There is none.
    """
    chosen = os.environ.get("POGOSIM_DIR")
    if chosen:
        found = installation_in(Path(chosen).resolve())
        if found is None:
            raise InstallationError(f"there is no simulator in POGOSIM_DIR={chosen}: build it, or unset POGOSIM_DIR")
        return found
    tree = PACKAGE.parent.parent
    found = installation_in(PACKAGE / "simulator") or installation_in(tree)
    if found is None:
        if (tree / "build.sh").is_file():
            raise InstallationError(f"the simulator in {tree} is not built: run ./build.sh there")
        raise InstallationError(
            f"the package in {PACKAGE} has no simulator in it: install it again (pip install pogosim)"
        )
    return found
