"""The firmware of what a user names: a firmware, a project's folder, or a C or C++ file."""

from __future__ import annotations

import contextlib
import shutil
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from pogosim.errors import ToolError
from pogosim.firmware import is_firmware
from pogosim.firmware.profile.sources import folders_of
from pogosim.installation import Installation
from pogosim.projects import run_make
from pogosim.system_packages import FOR_ROBOTS, how_to_install

TRIPLE = "riscv64-unknown-elf"
ROBOT_COMPILERS = {".c": f"{TRIPLE}-gcc", ".cpp": f"{TRIPLE}-g++"}
FIRMWARE = Path("build", "emu", "firmware.elf")  # in a project
OF_TEMPLATE = ("Makefile", "robot.mk")
HEADERS = {".h", ".hpp"}


class FirmwareError(ToolError):
    """There is no firmware, and none can be made; says what to do."""


@dataclass(frozen=True)
class Program:
    """A firmware, and the folders in which its source files may be."""

    firmware: Path
    folders: tuple[Path, ...]


@contextlib.contextmanager
def firmware_of(what: Path, pogosim: Installation, *, is_quiet: bool = False) -> Iterator[Program]:
    """Make the firmware of a project or a source file, or take one that is there.

    Args:
        what: A firmware, the folder of a project, or a .c or .cpp file, whose firmware is removed at the end.
        pogosim: The simulator.
        is_quiet: Whether what make says is shown only if it fails.

    Raises:
        FirmwareError: It is none of these, or the robots' compiler is missing.
        ProjectError: It cannot be built; make has said why.
        OSError: It cannot be read, or the temporary project cannot be written.
    """
    if what.is_dir():
        yield Program(made_in(what, what, pogosim, is_quiet=is_quiet), (what,))
    elif not what.exists():
        raise FirmwareError(f"there is no firmware, project, source file or profile {what}")
    elif what.suffix in ROBOT_COMPILERS:
        with temporary_project(what, pogosim) as folder:
            yield Program(made_in(folder, what, pogosim, is_quiet=is_quiet), (what.parent,))
    elif is_firmware(what):
        yield Program(what, tuple(folders_of(what)))
    else:
        raise FirmwareError(
            f"{what} is no firmware of a robot (ELF file for RISC-V); expected one, as make emu builds it, the folder "
            "of a project, a .c or .cpp file, or a profile (.json)"
        )


def made_in(folder: Path, what: Path, pogosim: Installation, *, is_quiet: bool = False) -> Path:
    """Run `make emu` in a project; returns its firmware.

    Args:
        folder: The project.
        what: What the user calls it.
        pogosim: The simulator.
        is_quiet: Whether what make says is shown only if it fails.

    Raises:
        FirmwareError: The robots' compiler is missing, or it is no project that makes firmware.
        ProjectError: It cannot be built; make has said why.
    """
    makefile = folder / "Makefile"
    if not makefile.is_file():
        raise FirmwareError(f"{what} is not a project: it has no Makefile (pogosim new NAME makes a project)")
    if "emu:" not in makefile.read_text(encoding="utf-8", errors="replace"):
        raise FirmwareError(
            f"{makefile} cannot make firmware for emulated robots: it has no target emu; take Makefile and robot.mk of "
            f"{pogosim.template}"
        )
    check_compiler(folder)
    run_make(folder, "emu", pogosim, what, is_quiet=is_quiet)
    firmware = folder / FIRMWARE
    if not firmware.is_file():
        raise FirmwareError(f"make emu in {what} has not made {FIRMWARE}; is BUILD_DIR set?")
    return firmware


def check_compiler(folder: Path) -> None:
    """Check that the robots' compiler is installed.

    Raises:
        FirmwareError: It is missing.
    """
    compiler = ROBOT_COMPILERS[".cpp" if any(folder.glob("*.cpp")) else ".c"]
    if shutil.which(compiler) is None:
        raise FirmwareError(f"the compiler for robots, {compiler}, is not installed ({how_to_install(FOR_ROBOTS)})")


@contextlib.contextmanager
def temporary_project(source: Path, pogosim: Installation) -> Iterator[Path]:
    """Make a project of a source file and the headers beside it, as links; it is removed at the end."""
    with tempfile.TemporaryDirectory(prefix="pogosim-firmware-") as parent:
        folder = Path(parent, "program")
        folder.mkdir()
        for name in OF_TEMPLATE:
            shutil.copyfile(pogosim.template / name, folder / name)
        headers = [path for path in source.parent.iterdir() if path.suffix in HEADERS]
        for path in (source, *headers):
            (folder / path.name).symlink_to(path.resolve())
        yield folder
