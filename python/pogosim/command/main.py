"""The command `pogosim`: finds the subcommand and leaves the rest of the command line to it."""

from __future__ import annotations

import importlib
import os
import signal
import sys
from collections.abc import Callable, Sequence
from typing import NamedTuple

import pogosim
from pogosim.command.parser import complain
from pogosim.lines import say, say_error
from pogosim.nearest_name import nearest_name

WRONG_USAGE = 2
INTERRUPTED = 130
NO_READER = 141  # as a shell says of a program that SIGPIPE has ended


class Subcommand(NamedTuple):
    """A subcommand; its module has `main(arguments, prog) -> exit code`, and is imported when it is called."""

    module: str
    summary: str


SUBCOMMANDS = {
    "new": Subcommand("pogosim.command.new", "make a project: a program, a configuration and a Makefile"),
    "run": Subcommand("pogosim.command.run", "compile a project or a source file, and run it"),
    "batch": Subcommand("pogosim.batch.command_line", "run a program many times, with every combination of options"),
    "optimize": Subcommand(
        "pogosim.optimize.command", "search for the parameters that make an objective as large as possible"
    ),
    "analyze": Subcommand("pogosim.reports.command", "compute what robots did: tables and figures of a data file"),
    "picture": Subcommand("pogosim.picture.command", "draw the trajectories of a run"),
    "film": Subcommand("pogosim.film.command", "make a film of a run, or a page to replay it in a browser"),
    "recover": Subcommand("pogosim.command.recover", "make a complete data file of a run that was killed"),
    "flash": Subcommand("pogosim.command.flash", "look into archives of robots' flash memory, and make them"),
    "arena": Subcommand("pogosim.geometry.command", "draw, check, scale and convert arenas"),
    "calibrate": Subcommand("pogosim.calibration.command", "fit the motion of simulated robots to tracks of real ones"),
    "fit-comm": Subcommand("pogosim.communication.fit_command", "fit a law of reception to measurements"),
    "best-psend": Subcommand("pogosim.communication.sending_command", "compute how often robots should send"),
    "doctor": Subcommand("pogosim.command.doctor", "say what works on this machine, and what is missing for what"),
    "path": Subcommand("pogosim.command.path", "print the folder of the simulator, POGOSIM_DIR of Makefiles"),
}


def usage() -> list[str]:
    """Return what `pogosim --help` prints."""
    width = max(map(len, SUBCOMMANDS))
    listed = [f"  {name:{width}}  {command.summary}" for name, command in SUBCOMMANDS.items()]
    return [
        "Usage: pogosim COMMAND [OPTIONS]",
        "",
        "Simulates swarms of Pogobots.",
        "",
        "Commands:",
        *listed,
        "",
        "Options:",
        "  -h, --help     print this help; pogosim COMMAND --help: that of a command",
        "  -V, --version  print the version",
    ]


def unknown(name: str) -> str:
    """Return what is said of a name that is no subcommand."""
    if name.startswith("-"):
        return f"pogosim: there is no option {name} before the command; pogosim --help lists all commands"
    near = nearest_name(name, SUBCOMMANDS)
    question = f"; did you mean '{near}'?" if near else "; pogosim --help lists all commands"
    return f"pogosim: there is no command '{name}'{question}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line. Returns the exit code, which is 2 for wrong usage."""
    name, *rest = list(sys.argv[1:] if arguments is None else arguments) or [""]
    prog = f"pogosim {name}" if name in SUBCOMMANDS else "pogosim"
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
        say(f"pogosim {pogosim.__version__}")
        return 0
    if not name:
        say_error(*usage())
        return WRONG_USAGE
    if name not in SUBCOMMANDS:
        say_error(unknown(name))
        return WRONG_USAGE
    return call(name, arguments, f"pogosim {name}")


def call(name: str, arguments: Sequence[str], prog: str) -> int:
    """Import a subcommand, and run it under a name; returns the exit code."""
    code: int = importlib.import_module(SUBCOMMANDS[name].module).main(arguments, prog)
    return code


if __name__ == "__main__":
    sys.exit(pogosim_command())
