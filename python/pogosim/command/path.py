"""`pogosim path`: where the simulator is, for Makefiles and CMake."""

from __future__ import annotations

from collections.abc import Sequence

from pogosim.command.parser import Parser, complain
from pogosim.installation import InstallationError, find_installation
from pogosim.lines import say


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim path") -> int:
    """Run the command. Returns its exit code: 0 done, 2 there is no simulator."""
    parser = Parser(
        prog=prog,
        description="Prints the folder of the simulator: with its headers and library, or the source tree. It is the "
        "POGOSIM_DIR of a project's Makefile and, if Pogosim was installed by pip, the CMAKE_PREFIX_PATH of CMake.",
    )
    parser.add_argument(
        "--original",
        action="store_true",
        help="print the file with which Makefiles written for the original simulator build with this one: "
        "export MAKEFILES=$(pogosim path --original)",
    )
    options = parser.parse_args(arguments)
    try:
        found = find_installation()
        say(str(found.original if options.original else found.folder))
    except InstallationError as error:
        return complain(prog, error)
    return 0
