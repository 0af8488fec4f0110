"""The subcommands of `pogobatch`: what they do, and their options."""

from __future__ import annotations

import argparse
import contextlib
import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, NamedTuple

from pogosim.batch.ending import Report, RunsFailedError
from pogosim.batch.errors import BatchError, tell
from pogosim.batch.run_options import (
    PROGRAM_HELP,
    Parser,
    add_choice_options,
    add_run_options,
    add_saving_option,
    check_names,
    give_program,
    runner_of,
)
from pogosim.batch.runs.identity import find_program
from pogosim.lines import counted, say
from pogosim.nearest_name import listed, unknown

if TYPE_CHECKING:
    from pogosim.batch.runner import PogobotBatchRunner

LINES = 1000  # printed at a time


class Subcommand(NamedTuple):
    """A subcommand.

    Attributes:
        summary: What it is for.
        usage: Options that its usage line shows.
        add_options: Adds its options.
        do: Does it, and returns what it has done.
    """

    summary: str
    usage: str
    add_options: Callable[[Parser], None]
    do: Callable[[argparse.Namespace], Report]


# ---- plan ----


def add_plan_options(options: Parser) -> None:
    """Add the options of `plan`: those of `run`, so that one word makes a plan of a batch, and its own."""
    add_campaign_options(options)
    options.add_argument("--show-tasks", action="store_true", help="list all runs")


def plan(arguments: argparse.Namespace) -> Report:
    """Say which runs a batch would do."""
    if arguments.simulator_binary is not None:
        find_program(arguments.simulator_binary)
    runner = runner_of(arguments, is_campaign=True)
    runs = PlannedRuns(runner)
    outputs = list(dict.fromkeys(output for _, output in runs.selected))
    combinations = len(runs.selected)
    tell(f"{counted(combinations, 'combination')} x {counted(runner.runs, 'seed')}: {counted(len(runs), 'run')}")
    if arguments.part is not None:
        number, parts = part_of(arguments.part)
        runs.which = runs.which[number::parts]
        tell(f"Part {number} of {parts}: {counted(len(runs), 'run')}")
    for output in outputs:
        tell(f" - {output}")
    if arguments.show_tasks:
        lines = (line_of(task) for task in runs)
        with contextlib.suppress(OSError):  # the reader has gone
            while some := list(itertools.islice(lines, LINES)):
                say(*some)
    return {
        "config": arguments.config,
        "combinations": combinations,
        "seeds": runner.seeds,
        "task_count": len(runs),
        "outputs": outputs,
        "tasks": runs,
    }


def line_of(task: Mapping[str, Any]) -> str:
    """Return what `--show-tasks` says of a run."""
    choices = "".join(f", {key}: {value}" for key, value in task["batch_choices"].items())
    return f"run {task['logical_run']} of {task['output']}, seed {task['seed']}{choices}"


class PlannedRuns:
    """The runs of a batch, each made when it is asked for: there may be millions.

    Attributes:
        selected: The combinations, each with its file of results.
        which: Numbers of the runs that are meant, of all those of the batch.

    Raises:
        BatchError: The batch cannot be done.
    """

    def __init__(self, runner: PogobotBatchRunner) -> None:
        from pogosim.varied import varied_parameters

        self.runner = runner
        self.selected = runner.checked_selection()
        self.which = range(len(self.selected) * runner.runs)
        self.varied = varied_parameters([entries for entries, _ in self.selected])
        for entries, _ in self.selected:
            runner.compute_seed(entries, 0)  # to find errors before anything is printed

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self.which)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        """Yield what JSON says of each."""
        from pogosim.batch.configurations.option_words import chosen_in
        from pogosim.batch.result_files.manifests import for_json

        for number, some in itertools.groupby(self.which, lambda task: task // self.runner.runs):
            entries, output = self.selected[number]
            choices = for_json(chosen_in(self.varied, number))
            for task in some:
                run = task % self.runner.runs
                yield {
                    "combination_ordinal": number,
                    "logical_run": run,
                    "seed": self.runner.compute_seed(entries, run),
                    "output": output,
                    "batch_choices": choices,
                }


# ---- task ----


def add_task_options(options: Parser) -> None:
    """Add the options of `task`."""
    add = options.add_argument
    add("-c", "--config", required=True, help="configuration (YAML); options have their default_option")
    add("-S", "--simulator-binary", metavar="PROGRAM", help=PROGRAM_HELP)
    add("--seed", type=int, required=True, metavar="N", help="seed of the run")
    add("-o", "--output-dir", metavar="FOLDER", required=True, help="folder of the run")
    add("--run-index", type=int, default=0, metavar="N", help="its number, for the column run (%(default)s)")
    add("--retry-attempt", type=int, default=0, metavar="N", help="which attempt this is (%(default)s)")
    add_saving_option(options)
    add("--gui", action="store_true", help="let the run open its window")
    add("--force", action="store_true", help="replace another run that is in the folder")
    add("--json", action="store_true", help="print what was done as JSON, and all else on standard error")
    add("-v", "--verbose", action="store_true", help="say more")


def task(arguments: argparse.Namespace) -> Report:
    """Do one run in a folder of its own."""
    check_names(arguments)
    give_program(arguments)
    from pogosim.batch.single_task import TaskError, execute_task  # takes a while

    try:
        artifact = execute_task(
            arguments.config,
            arguments.simulator_binary,
            seed=arguments.seed,
            output_dir=arguments.output_dir,
            run_index=arguments.run_index,
            retry_attempt=arguments.retry_attempt,
            gui=arguments.gui,
            force=arguments.force,
            save_states=arguments.save_states,
        )
    except TaskError as error:
        report = {"config": arguments.config, "seed": arguments.seed}
        raise RunsFailedError(str(error), report, is_said=False) from None
    tell(f"Done: {artifact.data}")
    return {"config": arguments.config, "output_dir": str(artifact.folder), **artifact.manifest}


# ---- run ----


def add_campaign_options(options: Parser) -> None:
    """Add the options of `run`."""
    add = options.add_argument
    add("-S", "--simulator-binary", metavar="PROGRAM", help=PROGRAM_HELP)
    add(
        *("-j", "--jobs", "--workers"),
        dest="workers",
        type=int,
        default=0,
        metavar="N",
        help="runs at the same time; 0: one per processor (%(default)s)",
    )
    add_choice_options(options)
    add_run_options(options)
    add(
        "--part",
        metavar="N/M",
        help="do every M-th run only, from number N = 0, ..., M - 1 on, for an array of jobs; their folders stay in "
        "--temp-base, for pogobatch merge",
    )


def part_of(text: str) -> tuple[int, int]:
    """Return the number of a part, and how many there are.

    Raises:
        BatchError: The text does not say it.
    """
    number, _, parts = text.partition("/")
    if not (text.isascii() and number.isdecimal() and parts.isdecimal() and int(number) < int(parts)):
        raise BatchError(f"--part: expected N/M with N from 0 to M - 1, such as 0/40 to 39/40; found '{text}'")
    return int(number), int(parts)


def run_part(arguments: argparse.Namespace) -> Report:
    """Do a part of a batch."""
    number, parts = part_of(arguments.part)
    arguments.keep_temp = True
    runner = runner_of(arguments, is_campaign=True)
    count = runner.run_part(number, parts)
    report = {"config": arguments.config, "part": number, "parts": parts, "task_count": count}
    if runner.failures:
        message = f"{len(runner.failures)} of {counted(count, 'run')} failed; the same call does only them"
        raise RunsFailedError(message, report)
    tell(
        f"Part {number} of {parts}: {counted(count, 'run')} done, in {runner.temporary.path}. When all parts are: "
        "pogobatch merge FOLDERS -o RESULTS -c CONFIG"
    )
    return report


def run(arguments: argparse.Namespace) -> Report:
    """Do a batch whose results say the seeds, and which writes a manifest."""
    check_names(arguments)
    give_program(arguments)
    if arguments.part is not None:
        return run_part(arguments)
    runner = runner_of(arguments, is_campaign=True)
    from pogosim.batch.campaign import LocalCampaignError, entries_of, run_campaign

    try:
        manifest = run_campaign(runner).manifest_path
    except LocalCampaignError as error:
        tell_outputs(runner.generated)
        report = {**entries_of(runner), "manifest": str(error.result.manifest_path)}
        raise RunsFailedError(str(error), report) from None
    tell_outputs(runner.generated)
    return {**entries_of(runner), "manifest": str(manifest)}


def tell_outputs(outputs: Sequence[str]) -> None:
    """Say which files of results a batch has written."""
    if outputs:
        tell("Batch run completed. Generated output files:")
    else:
        tell("Batch run ended without an output file.")
    for output in outputs:
        tell(f" - {output}")


# ---- merge ----


def add_merge_options(options: Parser) -> None:
    """Add the options of `merge`."""
    add = options.add_argument
    add("inputs", nargs="+", metavar="FOLDER", help="folders with runs, at any depth, or files pogobatch_task.json")
    add("-o", "--output-dir", metavar="FOLDER", default=".", help="folder of the results (.)")
    add("-c", "--config", help="configuration with options that the runs are of, for the metadata of the results")
    add("--append", action="store_true", help="add to results that are there, in place of replacing them")
    add("--json", action="store_true", help="print what was done as JSON, and all else on standard error")
    add("-v", "--verbose", action="store_true", help="say more")


def merge(arguments: argparse.Namespace) -> Report:
    """Join runs that were done one by one."""
    check_names(arguments)
    from pogosim.batch.merging import discover_task_artifacts, merge_runs

    artifacts = discover_task_artifacts(arguments.inputs)
    outputs, missing = merge_runs(artifacts, arguments.output_dir, arguments.config, arguments.append)
    tell(f"{counted(len(artifacts), 'run')} merged. Generated output files:")
    for output in outputs:
        tell(f" - {output}")
    return {
        "inputs": arguments.inputs,
        "task_count": len(artifacts),
        "outputs": outputs,
        "missing": [asdict(run) for run in missing.first],
        "missing_count": missing.count,
    }


# ---- cluster ----


def add_cluster_options(options: Parser) -> None:
    """Take whatever follows `cluster`."""
    options.add_argument("rest", nargs=argparse.REMAINDER, help=argparse.SUPPRESS)


def cluster(arguments: argparse.Namespace) -> Report:  # noqa: ARG001
    """Say what does runs on several machines here.

    Raises:
        BatchError: Always.
    """
    raise BatchError(
        "cluster: the scheduler Rundra is not used here; for several machines, use pogobatch run --slurm (jobs of "
        "SLURM) or pogobatch run --scheduler tcp://... (workers of Dask)"
    )


SUBCOMMANDS = {
    "plan": Subcommand("say which runs a batch would do", "-c CONFIG [--seeds A:B]", add_plan_options, plan),
    "run": Subcommand(
        "do a batch; results have the columns seed and retry_attempt",
        "-c CONFIG -S PROGRAM [--seeds A:B] [-o FOLDER]",
        add_campaign_options,
        run,
    ),
    "task": Subcommand(
        "do one run, in a folder of its own", "-c CONFIG -S PROGRAM --seed N -o FOLDER", add_task_options, task
    ),
    "merge": Subcommand(
        "join runs that were done one by one", "FOLDER... [-o FOLDER] [-c CONFIG]", add_merge_options, merge
    ),
    "cluster": Subcommand("says what to use in its place", "", add_cluster_options, cluster),
}


def subparser(name: str, prog: str) -> Parser:
    """Return the parser of the options of a subcommand."""
    own = SUBCOMMANDS[name]
    options = Parser(prog=prog, description=f"{own.summary[0].upper()}{own.summary[1:]}.", allow_abbrev=False)
    options.required = own.usage
    own.add_options(options)
    return options


def overview(prog: str) -> list[str]:
    """Return what `pogobatch help` prints."""
    summaries = {name: own.summary for name, own in SUBCOMMANDS.items()}
    summaries["help"] = f"print this help; {prog} help SUBCOMMAND: that of a subcommand"
    return [
        f"Usage: {prog} SUBCOMMAND [OPTIONS], or {prog} -c CONFIG -S PROGRAM [OPTIONS]",
        "",
        "Subcommands:",
        *listed(summaries),
        "",
        f"Without a subcommand, {prog} does a batch whose results have the column run alone; {prog} --help.",
    ]


def unknown_subcommand(name: str, prog: str) -> str:
    """Return what is said of a word that is no subcommand."""
    return f"{prog}: {unknown('subcommand', name, [*SUBCOMMANDS, 'help'], f'see {prog} help')}"
