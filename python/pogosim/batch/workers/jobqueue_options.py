"""Jobs of other batch systems than SLURM, and the command-line options for them."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar

import yaml

from pogosim.batch.errors import BatchError
from pogosim.batch.workers.slurm_options import SlurmJobs, slurm_jobs

JOBS = 8
# The classes of dask-jobqueue, by the names that jobqueue.yaml has for them.
CLUSTERS = {
    "pbs": "PBSCluster",
    "sge": "SGECluster",
    "lsf": "LSFCluster",
    "oar": "OARCluster",
    "moab": "MoabCluster",
    "htcondor": "HTCondorCluster",
}
OURS = ("processes", "nanny", "security", "silence_logs")
TYPES: tuple[tuple[str, type, str], ...] = (
    ("scheduler_options", dict, "a map, such as {port: 8786}"),
    ("worker_extra_args", list, "a list of texts"),
    ("job_extra_directives", list, "a list of texts"),
)


@dataclass(frozen=True)
class QueuedJobs:
    """What to ask a batch system for.

    Args:
        system: Name of the batch system, one of CLUSTERS.
        jobs: Jobs at the same time, at most.
        settings: Arguments of the class of dask-jobqueue: queue, walltime, cores, memory, ...; those that are not
            given are those of the site's jobqueue.yaml.

    Raises:
        BatchError: One of them has a wrong form.
    """

    flag: ClassVar[str] = "--jobqueue"
    system: str
    jobs: int = JOBS
    settings: tuple[tuple[str, Any], ...] = ()

    def __post_init__(self) -> None:
        if self.system == "slurm":
            raise BatchError("--jobqueue slurm: SLURM has options of its own; use --slurm")
        if self.system not in CLUSTERS:
            raise BatchError(f"--jobqueue: expected one of {', '.join(CLUSTERS)}; found '{self.system}'")
        if self.jobs < 1:
            raise BatchError(f"--jobqueue-jobs: expected a whole number of at least 1; found {self.jobs}")
        for key, _ in self.settings:
            if key in OURS:
                raise BatchError(f"--jobqueue-set {key}: batches set it themselves; remove it")
        for key, kind, what in TYPES:
            value = dict(self.settings).get(key, kind())
            if not isinstance(value, kind):
                raise BatchError(f"--jobqueue-set {key}: expected {what}; found {value!r}")
        cores = self.cores
        if cores is not None and (not isinstance(cores, int) or isinstance(cores, bool) or cores < 1):
            raise BatchError(f"--jobqueue-set cores: expected a whole number of at least 1; found {cores!r}")

    @property
    def cores(self) -> int | None:
        """Cores per job, each of which does one run at a time; None: what jobqueue.yaml says, or else 1."""
        return dict(self.settings).get("cores")


def add_jobqueue_options(options: argparse.ArgumentParser) -> None:
    """Add what is asked of a batch system other than SLURM."""
    add = options.add_argument_group(
        "Other batch systems",
        "Jobs of PBS, Grid Engine and others do the runs, by dask-jobqueue; see docs/batches.md.",
    ).add_argument
    add("--jobqueue", metavar="SYSTEM", help=f"let jobs of this batch system do the runs: {', '.join(CLUSTERS)}")
    add("--jobqueue-jobs", type=int, metavar="N", help=f"jobs at the same time, at most ({JOBS})")
    add(
        "--jobqueue-set",
        metavar="KEY=VALUE",
        action="append",
        help="a setting of the jobs, such as queue=short, walltime=04:00:00, cores=8 or memory=16GB (those of the "
        "site's jobqueue.yaml); may be given several times",
    )


def asked_jobs(arguments: argparse.Namespace) -> SlurmJobs | QueuedJobs | None:
    """Return the jobs that are to do the runs, if any.

    Raises:
        BatchError: Options do not go together, or have a wrong form.
    """
    of_slurm, queued = slurm_jobs(arguments), queued_jobs(arguments)
    if of_slurm is not None and queued is not None:
        raise BatchError("--slurm and --jobqueue: one of them does the runs; give the other one up")
    return of_slurm or queued


def queued_jobs(arguments: argparse.Namespace) -> QueuedJobs | None:
    """Return what is asked of a batch system, if one is to do the runs.

    Raises:
        BatchError: Options are given without --jobqueue, or have a wrong form.
    """
    given = {"jobs": arguments.jobqueue_jobs, "set": arguments.jobqueue_set}
    if arguments.jobqueue is None:
        for name, value in given.items():
            if value is not None:
                raise BatchError(f"--jobqueue-{name} goes with --jobqueue SYSTEM")
        return None
    settings = tuple(setting(text) for text in arguments.jobqueue_set or ())
    jobs = JOBS if arguments.jobqueue_jobs is None else arguments.jobqueue_jobs
    return QueuedJobs(arguments.jobqueue, jobs, settings)


def setting(text: str) -> tuple[str, Any]:
    """Return the key and the value of "key=value". Numbers and lists are those of YAML; times stay as they are.

    Raises:
        BatchError: It has another form.
    """
    key, equals, value = text.partition("=")
    if not equals or not key.strip() or not value.strip() or "\n" in text:
        raise BatchError(f"--jobqueue-set: expected KEY=VALUE, such as queue=short; found {text!r}")
    try:
        # A walltime such as 10:30:00 would be a number to the base of 60.
        read = value if ":" in value else yaml.safe_load(value)
    except yaml.YAMLError as error:
        raise BatchError(f"--jobqueue-set {text}: the value is no YAML ({str(error).splitlines()[0]})") from None
    if read is None:
        raise BatchError(f"--jobqueue-set {text}: expected a value, found nothing; remove it for that of jobqueue.yaml")
    return key.strip().replace("-", "_"), read
