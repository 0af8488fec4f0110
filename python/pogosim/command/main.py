"""The command `pogosim`: finds the subcommand and leaves the rest of the command line to it."""

from __future__ import annotations

import functools
import os
import signal
import sys
from collections.abc import Callable, Sequence

from pogosim.arguments import shown
from pogosim.command.parser import complain, warn
from pogosim.errors import ToolError
from pogosim.extensions import ExtensionError, Own, Table, takes
from pogosim.interrupting import interrupt
from pogosim.lines import printable_lines, say, say_error
from pogosim.nearest_name import listed, unknown
from pogosim.outputs import told

ENDED_BY_TEXT = 1  # as of any program in Python that calls sys.exit("text")
WRONG_USAGE = 2
GREATEST_CODE = 255  # the system cuts others to this range
INTERRUPTED = 130
NO_READER = 141  # as a shell says of a program that SIGPIPE has ended


COMMANDS = Table(
    "pogosim.commands",
    "command",
    "a function main(arguments, prog) that returns the exit code",
    lambda found: callable(found) and takes(found, [], "prog"),
    {
        "new": Own("pogosim.command.new:main", "make a project: a program, a configuration and a Makefile"),
        "run": Own("pogosim.command.run:main", "compile a project or a source file, and run it"),
        "watch": Own("pogosim.command.watch:main", "run a program, and show it live in browsers"),
        "profile": Own("pogosim.command.profile:main", "tell where the cycles of a tick go, on emulated robots"),
        "compare-brains": Own(
            "pogosim.command.compare_brains:main", "find where a program in C and its firmware begin to differ"
        ),
        "export-policy": Own("pogosim.command.export_policy:main", "make C for robots of a small neural network"),
        "batch": Own("pogosim.batch.command_line:main", "run a program many times, with every combination of options"),
        "optimize": Own(
            "pogosim.optimize.command:main", "search for the parameters that make an objective as large as possible"
        ),
        "analyze": Own("pogosim.reports.command:main", "compute what robots did: tables and figures of a data file"),
        "picture": Own("pogosim.picture.command:main", "draw the trajectories of a run"),
        "film": Own("pogosim.film.command:main", "make a film of a run, or a page to replay it in a browser"),
        "report": Own("pogosim.run_report.command:main", "write a page on a run or a batch: replay, figures, numbers"),
        "compare": Own("pogosim.comparison.command:main", "tell where two runs or two batches differ"),
        "recover": Own("pogosim.command.recover:main", "make a complete data file of a run that was killed"),
        "join": Own("pogosim.command.join:main", "make one data file of a run that went on from saved states"),
        "flash": Own("pogosim.command.flash:main", "look into archives of robots' flash memory, and make them"),
        "arena": Own("pogosim.geometry.command:main", "draw, check, scale and convert arenas"),
        "calibrate": Own(
            "pogosim.calibration.command:main", "fit the motion of simulated robots to tracks of real ones"
        ),
        "fit-comm": Own("pogosim.communication.fit_command:main", "fit a law of reception to measurements"),
        "best-psend": Own("pogosim.communication.sending:main", "compute how often robots should send"),
        "doctor": Own("pogosim.command.doctor:main", "say what works on this machine, and what is missing for what"),
        "docs": Own("pogosim.command.docs:main", "show a page of the documentation, such as those that messages name"),
        "path": Own("pogosim.command.path:main", "print the folder of the simulator, POGOSIM_DIR of Makefiles"),
    },
    is_shared=False,  # commands start at once
)


def usage() -> list[str]:
    """Return what `pogosim --help` prints."""
    return [
        "Usage: pogosim COMMAND [OPTIONS]",
        "",
        "Simulates swarms of Pogobots.",
        "",
        "Commands:",
        *listed(COMMANDS.listed(functools.partial(warn, "pogosim"))),
        "",
        "Options:",
        "  -h, --help     print this help; pogosim COMMAND --help: that of a command",
        "  -V, --version  print the version, and what the library was built of and with; --json: for programs",
    ]


def unknown_command(name: str) -> str:
    """Return what is said of a name that is no subcommand."""
    if name.startswith("-"):
        return f"pogosim: there is no option {name} before the command; pogosim --help lists all commands"
    return f"pogosim: {unknown('command', name, COMMANDS.names(), 'pogosim --help lists all commands')}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line. Returns the exit code, which is 2 for wrong usage."""
    name, *rest = list(sys.argv[1:] if arguments is None else arguments) or [""]
    prog = f"pogosim {name}" if name in COMMANDS.own else "pogosim"
    return ended(prog, lambda: run(name, rest))


def pogosim_command() -> int:
    """Run the command `pogosim`."""
    return process("pogosim", main)


def pogobatch() -> int:
    """Run the command `pogobatch`, which is `pogosim batch`."""
    return process("pogobatch", lambda: call("batch", sys.argv[1:], "pogobatch"))


def pogoptim() -> int:
    """Run the command `pogoptim`, which is `pogosim optimize`."""
    return process("pogoptim", lambda: call("optimize", sys.argv[1:], "pogoptim"))


def recover() -> int:
    """Run the command `pogosim-recover`, which is `pogosim recover`."""
    return process("pogosim-recover", lambda: call("recover", sys.argv[1:], "pogosim-recover"))


def ended(prog: str, command: Callable[[], int]) -> int:
    """Run a command to its end, whatever it is: also by Ctrl-C while its modules are imported."""
    try:
        return command()
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:  # pogosim doctor | head -3
        return NO_READER
    except OSError as error:
        return complain(prog, f"cannot go on: {error.strerror or error}")


def process(prog: str, command: Callable[[], int]) -> int:
    """Run a command that is all of this process: what signals do to it is told once, and not after its end.

    It draws to files, unless a window is asked for, whatever backend of matplotlib the environment names: a notebook's
    cannot be imported here.
    """
    if "--show" not in sys.argv:
        os.environ["MPLBACKEND"] = "agg"
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) == signal.SIG_DFL:
            signal.signal(number, interrupt)
    return last(ended(prog, lambda: last(command())))


def last(code: int) -> int:
    """Return the exit code of a process whose work is done; signals do not spoil it while Python puts things away."""
    for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
        signal.signal(number, signal.SIG_IGN)
    return code


def run(name: str, arguments: Sequence[str]) -> int:
    """Run a subcommand, or an option in its place; returns the exit code."""
    if name in ("-h", "--help", "help"):
        say(*usage())
        return 0
    if name in ("-V", "--version"):
        from pogosim.command import version

        return version.main(arguments)
    if not name:
        say_error(*usage())
        return WRONG_USAGE
    try:
        if COMMANDS.find(name) is None:
            say_error(unknown_command(name))
            return WRONG_USAGE
        return call(name, arguments, f"pogosim {name}")
    except ExtensionError as error:
        return complain("pogosim", error)


def call(name: str, arguments: Sequence[str], prog: str) -> int:
    """Import a subcommand, and run it under a name; returns the exit code."""
    if not isinstance(COMMANDS.find(name), Own):
        return call_other(name, arguments, prog)
    code: int | None = COMMANDS.load(name)(arguments, prog)
    return code or 0


def call_other(name: str, arguments: Sequence[str], prog: str) -> int:
    """Run a subcommand of another package. What it raises is told in one line; returns the exit code."""
    command = COMMANDS.load(name)
    try:
        with COMMANDS.calling(name, may_exit=True):
            try:
                code = command(arguments, prog)
            except SystemExit as end:
                code = end.code
                if not isinstance(code, int | None):
                    complain(prog, code)
                    return ENDED_BY_TEXT
            if not isinstance(code, int | None) or not 0 <= (code or 0) <= GREATEST_CODE:
                expected = f"expected a number from 0 to {GREATEST_CODE} or nothing"
                raise TypeError(f"exit code {shown(code)}, {expected}")
            return code or 0
    except BrokenPipeError:
        raise
    except ToolError as error:
        say_error(*printable_lines(f"{prog}: {error}").split("\n"))
        return error.exit_code
    except OSError as error:
        return complain(prog, told(error, "the output"))


if __name__ == "__main__":
    sys.exit(pogosim_command())
