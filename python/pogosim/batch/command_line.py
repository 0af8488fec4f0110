"""The command `pogobatch`."""

from __future__ import annotations

import argparse
import logging
import signal
import sys
from collections.abc import Sequence
from types import FrameType
from typing import NoReturn

import pogosim
from pogosim.batch.errors import BatchError, NothingSelectedError, is_text, reason, tell
from pogosim.batch.slurm_options import add_slurm_options, slurm_jobs
from pogosim.lines import LineFormatter, say_error

DONE = 0
NO_SUCH_OUTPUT = 1
WRONG = 2
RUNS_FAILED = 3
INTERRUPTED = 130

EPILOG = """Finished runs of a batch that was interrupted are kept in the folder for temporary files: the same command
continues it. Exit codes: 0 all runs are done; 1 --config or --simulator-binary is missing, or no combination has the
output of --only-output; 2 usage, configuration or file error; 3 runs failed; 130 interrupted."""

log = logging.getLogger("pogobatch")


class Parser(argparse.ArgumentParser):
    """Ends with one line about what is wrong, and one about the usage."""

    def error(self, message: str) -> NoReturn:
        """Print what is wrong and exit: 1 if required options are missing, otherwise 2."""
        is_missing = "required" in message
        usage = f"Usage: {self.prog} -c CONFIG -S PROGRAM [-r RUNS] [-t TEMP] [-o FOLDER]; -h lists all options"
        say_error(f"{self.prog}: {message}", usage)
        sys.exit(NO_SUCH_OUTPUT if is_missing else WRONG)


def parser(prog: str) -> Parser:
    """Return the parser of the command line; `prog` is the name of the command."""
    options = Parser(
        prog=prog,
        description="Runs a program with every combination of the options in a configuration, several times each, "
        "and joins the data files.",
        epilog=EPILOG,
        allow_abbrev=False,
    )
    add = options.add_argument
    add("-c", "--config", required=True, help="configuration with options (YAML)")
    add("-S", "--simulator-binary", metavar="PROGRAM", help="program compiled for Pogosim")
    add("-r", "--runs", type=int, default=1, help="runs per combination (%(default)s)")
    add("-t", "--temp-base", metavar="FOLDER", default="tmp", help="folder for temporary files (tmp)")
    add("-o", "--output-dir", metavar="FOLDER", default=".", help="folder of the results (.)")
    add("-j", "--workers", type=int, metavar="N", help="runs at the same time (one per processor)")
    add("-R", "--retries", type=int, default=5, help="how many times a failed run is repeated (%(default)s)")
    add(
        "--seed-from",
        metavar="run|config",
        default="run",
        help="the seed of a run is its number, 0, 1, ... (run), or "
        "derived from the configuration's seed and the number (config)",
    )
    add("--backend", default="multiprocessing", help="multiprocessing (default), sequential or dask")
    add("--scheduler", metavar="tcp://...", help="let the workers of this Dask scheduler do the runs")
    add_slurm_options(options)
    add("--only-output", metavar="NAME", default="", help="do only combinations whose results have this name or path")
    add("--list-outputs", action="store_true", help="print the paths of all results, and exit")
    add("--keep-temp", action="store_true", help="keep the folders of single runs")
    add("--gui", action="store_true", help="let each run open its window")
    add("-v", "--verbose", action="store_true", help="also say tasks, rows, and which runs failed")
    add("-V", "--version", action="version", version=f"{prog} {pogosim.__version__}")
    return options


def interrupt(number: int, frame: FrameType | None) -> NoReturn:  # noqa: ARG001
    """End the batch as Ctrl-C does."""
    raise KeyboardInterrupt


def catch_signals() -> None:
    """Let the signals with which batch systems and terminals end a program end it in good order."""
    for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, interrupt)


def start_logging(verbose: bool, prog: str) -> None:
    """Print messages on standard error."""
    handler = logging.StreamHandler()
    handler.setFormatter(LineFormatter(f"{prog}: %(message)s"))
    log.handlers = [handler]
    log.propagate = False
    log.setLevel(logging.DEBUG if verbose else logging.INFO)


def check_names(arguments: argparse.Namespace) -> None:
    """Check names of files and folders, which stand in configurations and messages.

    Raises:
        BatchError: One of them is no text, or has several lines.
    """
    names = {
        "--config": arguments.config,
        "--simulator-binary": arguments.simulator_binary or "",
        "--temp-base": arguments.temp_base,
        "--output-dir": arguments.output_dir,
        "--only-output": arguments.only_output,
    }
    for option, name in names.items():
        if not is_text(name) or "\n" in name:
            raise BatchError(f"{option}: the name {name!a} has a line break or bytes that are not UTF-8; rename it")


def run_batch(arguments: argparse.Namespace) -> int:
    """Do what the command line says; returns the exit code.

    Raises:
        BatchError: It cannot be done.
    """
    check_names(arguments)
    from pogosim.batch.runner import PogobotBatchRunner  # takes a while

    runner = PogobotBatchRunner(
        arguments.config,
        arguments.runs,
        arguments.simulator_binary or "",
        arguments.temp_base,
        arguments.output_dir,
        backend=arguments.backend,
        keep_temp=arguments.keep_temp,
        verbose=arguments.verbose,
        retries=arguments.retries,
        gui=arguments.gui,
        only_output=arguments.only_output,
        seed_from=arguments.seed_from,
        workers=arguments.workers,
        scheduler=arguments.scheduler,
        slurm_jobs=slurm_jobs(arguments),
    )
    if arguments.list_outputs:
        for output in runner.list_outputs():
            tell(output)
        return DONE
    runner.run_all()
    if runner.generated:
        tell("Batch run completed. Generated output files:")
    else:
        tell("Batch run ended without an output file.")
    for output in runner.generated:
        tell(f" - {output}")
    return RUNS_FAILED if runner.failures else DONE


def main(arguments: Sequence[str] | None = None, prog: str = "pogobatch") -> int:
    """Run the command. Returns its exit code, see its help."""
    options = parser(prog)
    parsed = options.parse_args(arguments)
    if not parsed.simulator_binary and not parsed.list_outputs:
        options.error("the following arguments are required: -S/--simulator-binary")
    start_logging(parsed.verbose, prog)
    catch_signals()
    try:
        return run_batch(parsed)
    except NothingSelectedError as error:
        log.error("%s", error)
        return NO_SUCH_OUTPUT
    except BatchError as error:
        log.error("%s", error)
    except OSError as error:
        log.error("%s: %s", error.filename or parsed.temp_base, reason(error))
    except RuntimeError as error:
        if "start new thread" not in str(error):
            raise
        log.error("no thread can be started: the limit of memory or of processes (ulimit -v, ulimit -u) is too low")
    except MemoryError:
        log.error("not enough memory for this many combinations and runs; make several batches")
    except KeyboardInterrupt:
        log.error("interrupted; finished runs are kept in %s: the same command continues", parsed.temp_base)
        return INTERRUPTED
    return WRONG
