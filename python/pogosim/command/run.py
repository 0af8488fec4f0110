"""`pogosim run`: compiles a project or a source file, and runs it; also firmware, and what needs no program."""

from __future__ import annotations

import argparse
import functools
import os
import shlex
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from pogosim.command.parser import Parser, complain, warn
from pogosim.errors import ToolError
from pogosim.extensions import let_find_models
from pogosim.firmware import is_firmware
from pogosim.installation import Installation, find_installation
from pogosim.machine_code import machine_of_file, of_another_machine
from pogosim.projects import run_make
from pogosim.system_packages import how_to_install

EPILOG = """All other options are the simulator's: -c CONFIG, -g (no window), -s SEED, --set KEY=VALUE and others.
Without -c, a project is run with its conf/test.yaml. Without PROJECT, it is the project in the working folder; where
there is none, the configuration says what drives the robots (brain). Paths are relative to the working folder."""


class RunError(ToolError):
    """There is nothing to run, or it cannot be compiled; says why."""


class CompilerError(ToolError):
    """What the environment says of a compiler cannot be understood."""


class Compiler(NamedTuple):
    """A language's compiler, as make knows it."""

    variable: str  # environment variable that names another one
    usual: str
    flags: str  # environment variable with more flags
    standard: str

    def command(self) -> list[str]:
        """Return the compiler and the standard.

        Raises:
            CompilerError: A quotation mark is open in the environment variable.
        """
        return [*(words_of(self.variable) or [self.usual]), f"-std={self.standard}"]


COMPILERS = {
    ".c": Compiler("CC", "cc", "CFLAGS", "gnu11"),
    ".cpp": Compiler("CXX", "c++", "CXXFLAGS", "gnu++20"),
}


def words_of(variable: str) -> list[str]:
    """Return the words of an environment variable, as a shell would split it.

    Raises:
        CompilerError: A quotation mark is open.
    """
    try:
        return shlex.split(os.environ.get(variable, ""))
    except ValueError as error:
        raise CompilerError(f"the environment variable {variable} cannot be understood: {error}") from None


def compile_file(source: Path, pogosim: Installation) -> Path:
    """Compile a program of one file; returns the program: build/NAME beside the source.

    Raises:
        RunError: It does not compile. The compiler has said why.
        CompilerError: An environment variable cannot be understood.
    """
    program = compiled(source, source.parent / "build" / source.stem, (), pogosim)
    if pogosim.shared_state.is_file():
        subprocess.run([pogosim.shared_state, program], check=False)
    return program


def compile_shared_object(source: Path, pogosim: Installation) -> Path:
    """Compile a program of one file for `pogosim.Simulation`; returns build/NAME.so. Errors as of compile_file()."""
    return compiled(source, source.parent / "build" / f"{source.stem}.so", ("-shared", "-fPIC"), pogosim)


def compiled(source: Path, made: Path, flags: Sequence[str], pogosim: Installation) -> Path:
    """Compile a file with some flags more; returns what is made. Errors as of compile_file()."""
    made.parent.mkdir(exist_ok=True)
    compiler = COMPILERS[source.suffix]
    command = [
        *compiler.command(),
        *("-g", "-O2", "-Wall", "-Wextra", "-Wfloat-conversion"),
        *flags,
        *words_of(compiler.flags),
        os.path.join(source.parent, source.name),  # noqa: PTH118 - ./-x.c, which would be an option without ./
        *("-o", str(made)),
        *pogosim.compiler_flags,
    ]
    try:
        code = subprocess.run(command, check=False).returncode
    except FileNotFoundError:
        raise RunError(
            f"the compiler '{command[0]}' is not installed ({how_to_install('gcc', 'g++', 'make')})"
        ) from None
    if code != 0:
        raise RunError(f"{source} does not compile; see the compiler's messages above")
    return made


def make_project(folder: Path, pogosim: Installation) -> Path:
    """Run `make sim` in a project; returns its program.

    Raises:
        RunError: It is not a project.
        ProjectError: make fails, and has said why.
    """
    if not (folder / "Makefile").is_file():
        if folder == Path():  # perhaps none was meant
            raise RunError(
                "no program is named, and this folder is not a project: it has no Makefile. Name a project, a .c file, "
                "a program or a firmware first (pogosim new NAME makes a project)"
            )
        raise RunError(f"{folder} is not a project: it has no Makefile (pogosim new NAME makes a project)")
    run_make(folder, "sim", pogosim)
    return folder / Path(os.path.realpath(folder)).name


def program_of(what: Path, pogosim: Installation) -> Path:
    """Return the program of a project's folder, a source file or a program; compiles the first two.

    Raises:
        RunError: There is none.
        ProjectError: make fails, and has said why.
    """
    if what.is_dir():
        return make_project(what, pogosim)
    if not what.exists():
        raise RunError(f"there is no project, source file or program {what}")
    if what.suffix in COMPILERS:
        return compile_file(what, pogosim)
    if elsewhere := of_another_machine(what):
        raise RunError(elsewhere)
    if what.suffix == ".so":
        beside = f"; run {what.with_suffix('')}" if what.with_suffix("").is_file() else ", and no program (make sim)"
        raise RunError(f"{what} is a shared object, for Python and `pogosim watch`{beside}")
    if not os.access(what, os.X_OK):
        if machine_of_file(what):
            raise RunError(f"{what} is not executable: chmod +x {what}")
        raise RunError(f"{what} is neither a folder, a .c or .cpp file, a firmware, nor a program")
    return what


def command_of(what: Path | None, options: Sequence[str], pogosim: Installation) -> list[str]:
    """Return the command that runs a project, a source file, a program or a firmware, made before if it has to be.

    Args:
        what: None is the project in the working folder or, where there is none, what the configuration says.
        options: Options of the simulator.
        pogosim: The simulator.

    Raises:
        RunError: There is none.
        ProjectError: make fails, and has said why.
    """
    if what is not None and is_firmware(what):
        return [str(pogosim.without_program), "--firmware", str(what), *options]
    if what is None and not Path("Makefile").is_file() and has_configuration(options):
        return [str(pogosim.without_program), *options]
    folder = Path() if what is None else what
    return [str(program_of(folder, pogosim)), *configured(folder, options)]


def configured(folder: Path, options: Sequence[str]) -> list[str]:
    """Return options of the simulator with a configuration: that of a project, if it has one and they name none."""
    own = folder / "conf" / "test.yaml"
    return list(options) if has_configuration(options) or not own.is_file() else ["-c", str(own), *options]


def has_configuration(options: Sequence[str]) -> bool:
    """Tell whether the simulator's options name a configuration, or ask for something that needs none."""
    return any(
        option.startswith(("-c", "--config")) or option in ("-h", "--help", "-V", "--version") for option in options
    )


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim run") -> int:
    """Run the command. Returns 2 if there is nothing to run; otherwise, the program takes the place of this process."""
    parser = Parser(
        prog=prog,
        usage=f"{prog} [PROJECT] [OPTIONS OF THE SIMULATOR]",
        description="Compiles a project or a source file, and runs it; or runs a firmware on emulated robots.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        add_help=False,
    )
    parser.add_argument(
        "project", metavar="PROJECT", help="folder of a project, .c or .cpp file, program (.), or firmware (.elf)"
    )
    given = list(sys.argv[1:] if arguments is None else arguments)
    if given[:1] in (["-h"], ["--help"]):
        parser.print_help()
        return 0
    what = Path(given.pop(0)) if given and not given[0].startswith("-") else None
    try:
        command = command_of(what, given, find_installation())
    except ToolError as error:
        return complain(prog, error)
    except OSError as error:
        return complain(prog, f"cannot build {what or Path()}: {error.strerror}")
    let_find_models(functools.partial(warn, prog))
    sys.stdout.flush()
    try:
        os.execv(command[0], command)
    except OSError as error:
        return complain(prog, f"cannot run {command[0]}: {error.strerror}")
