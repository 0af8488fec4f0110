"""`pogosim path`: where the simulator is, for Makefiles and CMake."""

from __future__ import annotations

from collections.abc import Sequence

from pogosim.command.parser import Parser, complain
from pogosim.installation import InstallationError, find_installation
from pogosim.lines import say


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim path") -> int:
    """Run the command. Returns its exit code: 0 done, 2 there is no simulator."""
    Parser(
        prog=prog,
        description="Prints the folder of the simulator: with its headers and library, or the source tree. It is the "
        "POGOSIM_DIR of a project's Makefile and, if Pogosim was installed by pip, the CMAKE_PREFIX_PATH of CMake.",
    ).parse_args(arguments)
    try:
        say(str(find_installation().folder))
    except InstallationError as error:
        return complain(prog, error)
    return 0
