"""`pogosim path`: where the simulator is, for Makefiles and CMake."""

from __future__ import annotations

import functools
from collections.abc import Sequence

from pogosim.command.parser import Parser, complain, warn
from pogosim.extensions import models_path
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
    parser.add_argument(
        "--models",
        action="store_true",
        help="print the folders of robot models, also those of other packages, for programs that are started without "
        "pogosim run: export POGOSIM_PATH=$(pogosim path --models)",
    )
    options = parser.parse_args(arguments)
    if options.models:
        say(models_path(functools.partial(warn, prog)))
        return 0
    try:
        found = find_installation()
        say(str(found.original if options.original else found.folder))
    except InstallationError as error:
        return complain(prog, error)
    return 0
