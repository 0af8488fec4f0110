"""Resources to request from SLURM, and the command-line options for them."""

from __future__ import annotations

import argparse
import re
from dataclasses import dataclass
from typing import ClassVar

from pogosim.batch.errors import BatchError

JOBS = 8
CORES = 1
MEMORY_PER_CORE_GB = 2
TIME = "01:00:00"
TIME_FORM = re.compile(r"(\d+-\d{1,2}|\d+)(:[0-5]?\d){0,2}")
MEMORY_FORM = re.compile(r"([1-9]\d*)([KMGT]?)")


@dataclass(frozen=True)
class SlurmJobs:
    """What to ask SLURM for. None: what the site's jobqueue.yaml says, or else a default.

    Args:
        jobs: Jobs at the same time.
        cores: Cores per job, each of which does one run at a time (1).
        memory: Memory per job, as for sbatch --mem: "500M", "4G" (2G per core).
        time: Time limit of a job, as for sbatch --time: "04:00:00", "2-12" (1 h).
        partition: Partition.
        account: Account.
        options: More options of sbatch: "qos=long".
        wait_min: How long to wait for the first job to start, in minutes; None: as long as it takes.

    Raises:
        BatchError: One of them has a wrong form.
    """

    system: ClassVar[str] = "slurm"
    flag: ClassVar[str] = "--slurm"
    jobs: int = JOBS
    cores: int | None = None
    memory: str | None = None
    time: str | None = None
    partition: str | None = None
    account: str | None = None
    options: tuple[str, ...] = ()
    wait_min: float | None = None

    def __post_init__(self) -> None:
        for name, number in (("jobs", self.jobs), ("cores", self.cores)):
            if number is not None and number < 1:
                raise BatchError(f"--slurm-{name}: expected a whole number of at least 1; found {number}")
        if self.time is not None and not TIME_FORM.fullmatch(self.time):
            raise BatchError(
                f"--slurm-time: expected minutes, hours:minutes:seconds or days-hours, such as 04:00:00; found "
                f"'{self.time}'"
            )
        if self.memory is not None and not MEMORY_FORM.fullmatch(self.memory):
            raise BatchError(f"--slurm-memory: expected a number with K, M, G or T, such as 4G; found '{self.memory}'")
        texts = [("option", option) for option in self.options]
        for name, text in [*texts, ("partition", self.partition), ("account", self.account)]:
            if text is not None and (not text.strip() or "\n" in text):
                raise BatchError(f"--slurm-{name}: expected one line of text; found {text!r}")


def add_slurm_options(options: argparse.ArgumentParser) -> None:
    """Add what is asked of SLURM; each entry that is not given is that of the site's jobqueue.yaml."""
    group = options.add_argument_group(
        "SLURM",
        "Jobs of SLURM do the runs. What is not given is taken from the site's jobqueue.yaml, see docs/batches.md.",
    )
    add = group.add_argument
    add("--slurm", action="store_true", help="let jobs of SLURM do the runs")
    add("--slurm-jobs", type=int, metavar="N", help=f"jobs at the same time, at most ({JOBS})")
    add("--slurm-cores", type=int, metavar="N", help=f"cores per job: runs at the same time in it ({CORES})")
    add("--slurm-memory", metavar="SIZE", help=f"memory per job, such as 4G ({MEMORY_PER_CORE_GB}G per core)")
    add("--slurm-time", metavar="TIME", help=f"time limit of a job, such as 04:00:00 or 2-12 for 2.5 days ({TIME})")
    add("--slurm-partition", metavar="NAME", help="partition, or queue (the cluster's default)")
    add("--slurm-account", metavar="NAME", help="account that pays (your default)")
    add(
        "--slurm-option",
        metavar="OPTION",
        action="append",
        help="another option of sbatch, such as qos=long or constraint=skylake; may be given several times",
    )
    add("--slurm-wait", type=float, metavar="MINUTES", help="give up if no job has started by then (wait)")


def slurm_jobs(arguments: argparse.Namespace) -> SlurmJobs | None:
    """Return what is asked of SLURM, if it is to do the runs.

    Raises:
        BatchError: Options for SLURM are given without --slurm, or have a wrong form.
    """
    names = ("jobs", "cores", "memory", "time", "partition", "account", "option", "wait")
    given = {name: value for name in names if (value := getattr(arguments, f"slurm_{name}")) is not None}
    if not arguments.slurm:
        if given:
            raise BatchError(f"--slurm-{next(iter(given))} goes with --slurm")
        return None
    options = tuple(given.pop("option", ()))
    return SlurmJobs(options=options, wait_min=given.pop("wait", None), **given)
