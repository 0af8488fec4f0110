"""The command `pogobatch`: its subcommands, and the flags that do a batch without one."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

import pogosim
from pogosim.batch.ending import Report, RunsFailedError, catch_signals, ended, start_logging
from pogosim.batch.errors import NoProgramError, tell
from pogosim.batch.run_options import (
    DONE,
    NO_SUCH_OUTPUT,
    PROGRAM_HELP,
    WRONG,
    Parser,
    add_choice_options,
    add_run_options,
    give_program,
    runner_of,
)
from pogosim.batch.runs.temporary import TemporaryFolder
from pogosim.batch.subcommands import SUBCOMMANDS, overview, subparser, tell_outputs, unknown_subcommand
from pogosim.errors import ToolError
from pogosim.lines import say, say_error

EPILOG = """Finished runs of a batch that was interrupted are kept in the folder for temporary files: the same command
continues it. Exit codes: 0 all runs are done; 1 --config or --simulator-binary is missing, or no combination has the
output of --only-output; 2 usage, configuration or file error; 3 runs failed; 130 interrupted. Subcommands: """


def parser(prog: str) -> Parser:
    """Return the parser of the command line without a subcommand; `prog` is the name of the command."""
    options = Parser(
        prog=prog,
        description="Runs a program with every combination of the options in a configuration, several times each, "
        "and joins the data files.",
        epilog=f"{EPILOG}{', '.join(SUBCOMMANDS)}, help.",
        allow_abbrev=False,
    )
    options.missing = NO_SUCH_OUTPUT
    add = options.add_argument
    add("-S", "--simulator-binary", metavar="PROGRAM", help=PROGRAM_HELP)
    add("-j", "--workers", type=int, metavar="N", help="runs at the same time (one per processor)")
    add_choice_options(options)
    add_run_options(options)
    add("--list-outputs", action="store_true", help="print the paths of all results, and exit")
    add("-V", "--version", action="version", version=f"{prog} {pogosim.__version__}")
    return options


def run_batch(arguments: argparse.Namespace) -> Report:
    """Do what the command line without a subcommand says; returns what was done.

    Raises:
        BatchError: It cannot be done.
        RunsFailedError: Runs failed.
    """
    if not arguments.list_outputs:
        give_program(arguments)
    runner = runner_of(arguments, is_campaign=False)
    if arguments.list_outputs:
        outputs = runner.list_outputs()
        for output in outputs:
            tell(output)
        return {"config": arguments.config, "outputs": outputs}
    from pogosim.batch.campaign import entries_of

    runner.run_all()
    tell_outputs(runner.generated)
    if runner.failures:
        raise RunsFailedError("runs failed", entries_of(runner))
    return entries_of(runner)


def main(arguments: Sequence[str] | None = None, prog: str = "pogobatch") -> int:
    """Run the command. Returns its exit code, see its help."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    name = words[0] if words and not words[0].startswith("-") else ""
    if name == "help":
        return help_of(words[1:], prog)
    if name and name not in SUBCOMMANDS:
        say_error(unknown_subcommand(name, prog))
        return WRONG
    if name:
        prog = f"{prog} {name}"
        parsed = subparser(name, prog).parse_args(words[1:])
        do = SUBCOMMANDS[name].do
    else:
        options = parser(prog)
        parsed = options.parse_args(words)
        if not parsed.list_outputs:
            try:
                give_program(parsed)
            except NoProgramError as error:
                options.error(str(error))
            except ToolError:
                pass  # run_batch() says it
        do = run_batch
    start_logging(getattr(parsed, "verbose", False), f"{prog}: %(message)s")
    catch_signals()
    kept = getattr(parsed, "temp_base", None)
    return ended(name or "run", lambda: do(parsed), getattr(parsed, "json", False), kept, lambda: kept_of(parsed))


def kept_of(arguments: argparse.Namespace) -> str:
    """Return what a batch has left in its folder for temporary files, in words; empty: nothing."""
    program = arguments.simulator_binary or "."
    folder = TemporaryFolder.of_batch(
        arguments.temp_base, arguments.config, arguments.output_dir, program, is_kept=True
    )
    return folder.kept()


def help_of(words: Sequence[str], prog: str) -> int:
    """Print the help of a subcommand, or of all; returns the exit code."""
    if not words:
        say(*overview(prog))
        return DONE
    if words[0] not in SUBCOMMANDS:
        say_error(unknown_subcommand(words[0], prog))
        return WRONG
    subparser(words[0], f"{prog} {words[0]}").print_help()
    return DONE
