"""The options of `pogobatch`, with and without a subcommand, and the runner that they ask for."""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from typing import TYPE_CHECKING, NoReturn

from pogosim.arguments import is_text
from pogosim.batch.configurations.seeds import seeds_between
from pogosim.batch.errors import BatchError, NoProgramError, at_least, cannot
from pogosim.batch.workers.jobqueue_options import add_jobqueue_options, asked_jobs
from pogosim.batch.workers.slurm_options import add_slurm_options
from pogosim.lines import say_error

if TYPE_CHECKING:
    from collections.abc import Sequence

    from pogosim.batch.runner import PogobotBatchRunner

DONE = 0
NO_SUCH_OUTPUT = 1
WRONG = 2
RUNS_FAILED = 3
INTERRUPTED = 130

RUN_USAGE = "-c CONFIG -S PROGRAM [-r RUNS] [-t TEMP] [-o FOLDER]"


class Parser(argparse.ArgumentParser):
    """Ends with one line about what is wrong, and one about the usage.

    Attributes:
        required: What the usage line shows.
        missing: Exit code if an option is missing that is required.
    """

    required = RUN_USAGE
    missing = WRONG

    def error(self, message: str) -> NoReturn:
        """Print what is wrong and exit."""
        usage = f"Usage: {self.prog} {self.required}; -h lists all options"
        say_error(f"{self.prog}: {message}", usage)
        sys.exit(self.missing if "required" in message else WRONG)


def add_choice_options(options: argparse.ArgumentParser) -> None:
    """Add what says which runs there are, and where results go."""
    add = options.add_argument
    add("-c", "--config", required=True, help="configuration with options (YAML)")
    seeds = options.add_mutually_exclusive_group()
    seeds.add_argument("-r", "--runs", type=int, metavar="N", help="runs per combination, with the seeds 0, 1, ... (1)")
    seeds.add_argument("--seeds", metavar="A:B", help="the seeds A, A + 1, ..., B, in place of --runs")
    seeds.add_argument("--seed", type=int, metavar="N", help="one run per combination, with this seed")
    add("-o", "--output-dir", metavar="FOLDER", default=".", help="folder of the results (.)")
    add("--only-output", metavar="NAME", default="", help="do only combinations whose results have this name or path")
    add("--json", action="store_true", help="print what was done as JSON, and all else on standard error")


ISOLATED = "make a process for each run; else, one process does many runs if the program allows it"


def add_run_options(options: argparse.ArgumentParser) -> None:
    """Add what says how runs are done."""
    add = options.add_argument
    add("-t", "--temp-base", metavar="FOLDER", default="tmp", help="folder for temporary files (tmp)")
    add("-R", "--retries", type=int, default=5, help="how many times a failed run is repeated (%(default)s)")
    add_retry_options(options)
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
    add_jobqueue_options(options)
    add("--keep-temp", action="store_true", help="keep the folders of single runs")
    add("--isolated", action="store_true", help=ISOLATED)
    add_saving_option(options)
    add("--gui", action="store_true", help="let each run open its window")
    add("--progress", action="store_true", help="say how many runs are done, also where there is no terminal")
    add("-v", "--verbose", action="store_true", help="also say tasks, rows, and which runs failed")


SAVE_EVERY_S = 60.0


def add_saving_option(options: argparse._ActionsContainer) -> None:
    """Add what says whether runs that were ended go on."""
    options.add_argument(
        "--save-states",
        type=float,
        nargs="?",
        const=SAVE_EVERY_S,
        metavar="SECONDS",
        help="save the state of each run this often, in wall-clock time (60 s), and when it is ended: the same command "
        "goes on from there",
    )


def add_retry_options(options: argparse.ArgumentParser) -> None:
    """Add what says with which seed a failed run is repeated; None: neither is given."""
    retry = options.add_mutually_exclusive_group()
    retry.add_argument(
        "--retry-new-seed", action="store_true", default=None, help="repeat a failed run with another seed"
    )
    retry.add_argument(
        "--retry-same-seed",
        action="store_false",
        dest="retry_new_seed",
        help="repeat a failed run with the same seed",
    )


# What the simulator says.
OF_SIMULATOR = "Error: "
NEEDS_PROGRAM = "needs a program, and none is given"
NEEDS_HOST = "there is no host on the command line"

PROGRAM_HELP = "program compiled for Pogosim; needed if a category has none of its own (brain: a firmware or a script)"


def check_names(arguments: argparse.Namespace) -> None:
    """Check names of files and folders, which stand in configurations and messages.

    Raises:
        BatchError: One of them is no text, or has several lines.
    """
    for name in ("config", "simulator_binary", "temp_base", "output_dir", "only_output", "objective"):
        value = getattr(arguments, name, None) or ""
        if not is_text(value) or "\n" in value:
            flag = f"--{name.replace('_', '-')}"
            raise BatchError(f"{flag}: the name {value!a} has a line break or bytes that are not UTF-8; rename it")


def give_program(arguments: argparse.Namespace) -> None:
    """If no program is named and no category needs one, name what runs configurations without a program.

    The simulator decides, for what a single run takes of the options. All else that it finds wrong is told by the runs.

    Raises:
        NoProgramError: A category needs a program.
        BatchError: A category needs another process to drive it, or the configuration cannot be read.
        InstallationError: There is no simulator.
    """
    if arguments.simulator_binary is not None:
        return
    from pogosim.batch.configurations.configuration import Configuration
    from pogosim.extensions import MODELS_VARIABLE, models_path
    from pogosim.installation import find_installation

    Configuration(arguments.config).of_one_run()  # says what is wrong with options
    without_program = str(find_installation().without_program)
    try:
        check = subprocess.run(
            [without_program, "--check-config", f"--config={arguments.config}"],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            check=False,
            text=True,
            errors="replace",
            env=os.environ | {MODELS_VARIABLE: models_path(lambda _: None)},  # the runs warn
        )
    except OSError as error:
        raise cannot("start", without_program, error) from None
    for line in check.stderr.splitlines():
        if line.startswith(OF_SIMULATOR) and NEEDS_PROGRAM in line:
            problem = line.removeprefix(OF_SIMULATOR)
            raise NoProgramError(f"the following arguments are required: -S/--simulator-binary; {problem}")
        if line.startswith(OF_SIMULATOR) and NEEDS_HOST in line:
            raise BatchError(line.removeprefix(OF_SIMULATOR))
    arguments.simulator_binary = without_program


def asked_seeds(arguments: argparse.Namespace) -> Sequence[int] | str | None:
    """Return the seeds that --seed or --seeds ask for, or, if there is no --runs either, the configuration.

    Raises:
        BatchError: They are wrong.
    """
    from pogosim.batch.runner import CONFIGURED

    if arguments.seeds is not None:
        return seeds_between(arguments.seeds, "--seeds")
    if arguments.seed is not None:
        return [arguments.seed]
    return CONFIGURED if arguments.runs is None else None


def runner_of(arguments: argparse.Namespace, is_campaign: bool) -> PogobotBatchRunner:
    """Return the batch that options ask for.

    Args:
        arguments: Those of `add_choice_options` and of `add_run_options`.
        is_campaign: Results have the seeds, and failed runs are repeated with others if not asked for otherwise.

    Raises:
        BatchError: They are wrong.
    """
    check_names(arguments)
    from pogosim.batch.runner import PogobotBatchRunner  # takes a while

    workers = arguments.workers
    if is_campaign and workers is not None:
        workers = at_least(0, workers, "--jobs") or None
    return PogobotBatchRunner(
        arguments.config,
        arguments.runs,
        "." if arguments.simulator_binary is None else arguments.simulator_binary,  # a plan or a list needs none
        arguments.temp_base,
        arguments.output_dir,
        backend=arguments.backend,
        keep_temp=arguments.keep_temp,
        verbose=arguments.verbose,
        retries=arguments.retries,
        gui=arguments.gui,
        only_output=arguments.only_output,
        seed_from=arguments.seed_from,
        workers=workers,
        scheduler=arguments.scheduler,
        jobs=asked_jobs(arguments),
        seeds=asked_seeds(arguments),
        retry_new_seed=is_campaign if arguments.retry_new_seed is None else arguments.retry_new_seed,
        with_seeds=is_campaign,
        progress=arguments.progress,
        isolated=arguments.isolated,
        save_states=arguments.save_states,
    )
