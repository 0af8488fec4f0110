"""Runs done by SLURM: its jobs are Dask workers, which join a scheduler in the process of the batch.

The package dask-jobqueue writes the script of the jobs, with what a site says in its jobqueue.yaml, and starts the
scheduler. Connections are encrypted and authenticated with keys made for the batch, as others use the same network.
"""

from __future__ import annotations

import atexit
import contextlib
import hashlib
import logging
import shutil
from collections.abc import Generator, Sequence
from pathlib import Path
from typing import Any

from pogosim.batch.cluster_jobs import (
    forget_keys,
    idle,
    imported_jobqueue,
    jobs_for,
    own_folder,
    runs_of_workers,
    scheduler_options,
    site_settings,
    with_keys,
)
from pogosim.batch.dask_backend import imported, outcomes_of
from pogosim.batch.errors import BatchError, one_line, tell
from pogosim.batch.in_job import do_in_job
from pogosim.batch.run import Outcome, Task
from pogosim.batch.slurm_jobs import Jobs, check_commands
from pogosim.batch.slurm_options import CORES, MEMORY_PER_CORE_GB, TIME, SlurmJobs
from pogosim.lines import counted

POWERS = {"K": 1, "": 2, "M": 2, "G": 3, "T": 4}


class SlurmWorkers:
    """Jobs of SLURM that do runs, and what they belong to.

    Jobs that are lost are replaced, and their runs are done again. Logs stay if something went wrong.
    """

    def __init__(self, request: SlurmJobs, keep_idle: bool = False) -> None:
        self.request = request
        self.keep_idle = keep_idle
        self.client: Any = None
        self.cluster: Any = None
        self.jobs: Jobs | None = None
        self.first_task: Task | None = None
        self.is_well = True

    def do(self, tasks: Sequence[Task]) -> Generator[Outcome, None, None]:
        """Do runs.

        Raises:
            BatchError: A package or a command is missing, or SLURM refuses the jobs; later: no job starts, or all are
                lost.
        """
        if tasks and self.jobs is None:
            self.start(tasks)
        elif self.jobs is not None:
            self.jobs.wanted = max(self.jobs.wanted, jobs_for(len(tasks), self.request.jobs, self.jobs.cores))
        return self.outcomes(tasks)

    def start(self, tasks: Sequence[Task]) -> None:
        """Start the scheduler, and submit the jobs."""
        dask, distributed = imported("--slurm", "slurm")
        jobqueue = imported_jobqueue("--slurm")
        check_commands()
        self.first_task = tasks[0]
        self.cluster, self.jobs = started(dask, distributed, jobqueue, tasks, self.request)
        self.client = distributed.Client(self.cluster)

    def outcomes(self, tasks: Sequence[Task]) -> Generator[Outcome, None, None]:
        """Yield the outcomes of runs, and look after the jobs meanwhile."""
        jobs = self.jobs
        if not tasks or jobs is None:
            return
        left = len(tasks)

        def poll() -> None:
            jobs.poll(left)
            if not self.keep_idle:
                jobs.release(idle(jobs.states, runs_of_workers(self.cluster), jobs.cores, left))

        ended = outcomes_of(tasks, self.client, poll, do_in_job)
        try:
            with contextlib.closing(ended) as outcomes:
                for outcome in outcomes:
                    left -= 1
                    jobs.note_progress()
                    self.is_well &= not outcome.problem
                    yield outcome
        except BatchError:
            self.is_well = not jobs.has_started
            raise

    def close(self) -> None:
        """End the jobs and the scheduler."""
        if self.jobs is None or self.first_task is None:
            return
        folder = log_folder(self.first_task)
        with contextlib.suppress(Exception):
            self.client.close(timeout=5)
        close(self.cluster, self.jobs, folder)
        if self.is_well and not self.first_task.settings.temporary.is_kept:
            shutil.rmtree(folder, ignore_errors=True)


def started(dask: Any, distributed: Any, jobqueue: Any, tasks: Sequence[Task], request: SlurmJobs) -> tuple[Any, Jobs]:
    """Start the scheduler and submit the jobs.

    Raises:
        BatchError: It cannot be started, or SLURM refuses the jobs.
    """
    task = tasks[0]
    site = site_settings(dask, "slurm")
    cores = request.cores or site.get("cores") or CORES
    folder = own_folder(log_folder(task))
    settings = job_settings(request, site, cores, folder)
    settings["scheduler_options"] = scheduler_options(task.retries, site.get("scheduler-options"))
    try:
        settings["security"] = with_keys(distributed.Security, folder)
        cluster = jobqueue.SLURMCluster(silence_logs=logging.CRITICAL, **settings)
    except (OSError, ValueError, RuntimeError) as error:
        raise BatchError(f"--slurm: the Dask scheduler cannot be started: {one_line(error)}") from None
    wanted = jobs_for(len(tasks), request.jobs, cores)
    start_timeout_s = None if request.wait_min is None else 60 * request.wait_min
    jobs = Jobs(cluster.job_script(), job_name(task), wanted, cores, start_timeout_s, settings["log_directory"])
    atexit.register(jobs.cancel)  # whatever happens to the batch before its first run
    try:
        jobs.cancel()
        jobs.submit(wanted)
    except BaseException:
        close(cluster, jobs, folder)
        shutil.rmtree(folder, ignore_errors=True)
        raise
    counts = f"{counted(wanted, 'job')} of {counted(cores, 'core')}"
    tell(f"SLURM: submitted {counts}, called {job_name(task)}; logs: {settings['log_directory']}")
    return cluster, jobs


def job_settings(request: SlurmJobs, site: dict[str, Any], cores: int, folder: Path) -> dict[str, Any]:
    """Return the arguments of SLURMCluster that say what a job is."""
    settings: dict[str, Any] = {
        "cores": cores,
        "processes": 1,  # simulators are processes of their own, which its threads wait for
        "nanny": False,  # SLURM sees when a worker ends
        "queue": request.partition,
        "account": request.account,
        "walltime": request.time or site.get("walltime") or TIME,
        "log_directory": str(site.get("log-directory") or folder),
        "job_extra_directives": [*(site.get("job-extra-directives") or []), *map(directive, request.options)],
        # The worker has the name of its job.
        "worker_extra_args": [
            *(site.get("worker-extra-args") or []),
            *("--name", "$SLURM_JOB_ID", "--preload", "pogosim.batch.in_job"),
        ],
    }
    memory = request.memory or (None if "memory" in site else f"{MEMORY_PER_CORE_GB * cores}G")
    if memory is not None:
        settings.update(job_mem=memory, memory=bytes_of(memory))
    return settings


def directive(option: str) -> str:
    """Return an option of sbatch as it stands in a script: "--qos=long", also of "qos=long"."""
    return option if option.startswith("-") else f"--{option}"


def bytes_of(memory: str) -> int:
    """Return an amount of memory in bytes. A number alone means MB, as for sbatch."""
    unit = memory.lstrip("0123456789")
    return int(memory.removesuffix(unit)) * int(1024 ** POWERS[unit])


def log_folder(task: Task) -> Path:
    """Return the folder for logs of jobs."""
    return task.settings.temporary.path / f"slurm_{task.settings.temporary.batch}"


def job_name(task: Task) -> str:
    """Return the name of all jobs of a batch: the same whenever the same command is given."""
    return f"pogobatch-{hashlib.sha256(str(task.settings.temporary.done).encode()).hexdigest()[:8]}"


def close(cluster: Any, jobs: Jobs, folder: Path) -> None:
    """End the jobs, then the scheduler, and forget the keys."""
    jobs.cancel()
    atexit.unregister(jobs.cancel)
    with contextlib.suppress(Exception):
        cluster.close(timeout=5)
    forget_keys(folder)
