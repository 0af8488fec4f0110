"""Runs done by jobs of a batch system: they are Dask workers, which join a scheduler in the process of the batch.

The package dask-jobqueue writes the scripts of the jobs, with what a site says in its jobqueue.yaml, and starts the
scheduler. What is particular to SLURM is in `slurm`, what is to PBS, Grid Engine and others in `jobqueue`.
"""

from __future__ import annotations

import contextlib
import logging
import shutil
import time
from collections.abc import Generator, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from pogosim.batch.errors import BatchError, one_line, tell
from pogosim.batch.runs.run import Outcome, Task
from pogosim.batch.runs.temporary import TemporaryFolder
from pogosim.batch.workers.cluster_jobs import (
    LOST_PER_JOB,
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
from pogosim.batch.workers.dask_backend import imported, outcomes_of
from pogosim.batch.workers.in_job import do_in_job
from pogosim.lines import counted

LEAVING_S = 3.0  # for workers, before their scheduler ends

# What each job is: simulators are processes of their own, which its threads wait for, and the batch system sees when a
# worker ends.
EVERY_JOB = {"processes": 1, "nanny": False}


class BatchSystem(Protocol):
    """A batch system, and the jobs of a batch in it. A job has the name of its worker.

    Attributes:
        name: Its name in jobqueue.yaml.
        title: Its name in messages.
        flag: The option that asks for it.
        folder: How the name of the folder for logs begins.
        most_jobs: Jobs that are asked for, at the same time.
        jobs: What is known of the jobs that have not ended, by their names.
    """

    name: str
    title: str
    flag: str
    folder: str
    most_jobs: int
    jobs: dict[str, Any]

    @property
    def has_started(self) -> bool:
        """Whether a job has started."""

    def cluster_class(self, jobqueue: Any) -> Any:
        """Return the class of dask-jobqueue.

        Raises:
            BatchError: A command of the system is missing.
        """

    def settings(self, site: Mapping[str, Any], folder: Path) -> dict[str, Any]:
        """Return the arguments of that class that say what a job is.

        Args:
            site: What jobqueue.yaml says.
            folder: Folder for logs, if the site has no other.
        """

    def cannot_start(self, error: str) -> str:
        """Return what is said when the scheduler cannot be started."""

    def begin(self, cluster: Any, distributed: Any, temporary: TemporaryFolder) -> None:
        """Take the scheduler that jobs are to join; ends jobs that an earlier, killed batch has left."""

    def submit(self) -> None:
        """Submit a job.

        Raises:
            BatchError: The system refuses it.
        """

    def submitted(self, counts: str, logs: str) -> str:
        """Return what is said of jobs that were submitted: so many, of so many cores; empty: nothing."""

    def wait_s(self, since_s: float) -> float:
        """Return how long to wait until the jobs are looked at again, when the first was submitted that long ago."""

    def ended(self, workers: Mapping[str, int]) -> dict[str, str] | None:
        """Forget the jobs that have ended; returns their numbers, each with how; empty: only its log says that.

        Args:
            workers: Runs that were given to the workers that have joined, by the names of their jobs.

        Returns:
            None: The system does not answer; it may later.
        """

    def check_hope(self, since_s: float) -> None:
        """Check that a job runs or may still start, when the first was submitted that long ago.

        Raises:
            BatchError: None will.
        """

    def report(self, since_s: float) -> None:
        """Say what the jobs do, if it is time to; the first was submitted that long ago."""

    def lost(self, number: int, last: str, how: str) -> str:
        """Return what is said when job after job has ended: their number, the last one's, and how that ended."""

    def cancel(self, jobs: Sequence[str]) -> None:
        """Cancel some jobs, as far as they are still there."""

    def cancel_all(self) -> None:
        """Cancel all jobs of the batch."""


class QueuedWorkers:
    """Jobs of a batch system that do runs, and the scheduler that they join.

    Jobs that are lost are replaced, and their runs are done again. Logs stay if something went wrong.
    """

    def __init__(self, system: BatchSystem, keep_idle: bool = False) -> None:
        self.system = system
        self.keep_idle = keep_idle
        self.client: Any = None
        self.cluster: Any = None
        self.folder: Path | None = None
        self.keeps_logs = False
        self.cores, self.logs = 1, ""
        self.wanted = 0  # jobs that are kept alive
        self.lost_in_vain = 0  # jobs that have ended since a run was finished
        self.started_s = self.next_look_s = 0.0

    def do(self, tasks: Sequence[Task]) -> Generator[Outcome, None, None]:
        """Do runs.

        Raises:
            BatchError: A package or a command is missing, or the batch system refuses the jobs; later: no job starts,
                or all are lost.
        """
        if tasks and self.folder is None:
            self.start(tasks[0])
        if tasks:
            useful = jobs_for(len(tasks), self.system.most_jobs, self.cores)
            self.wanted = max(self.wanted, useful)
            self.submit(useful)
        return self.outcomes(tasks)

    def start(self, task: Task) -> None:
        """Start the scheduler.

        Raises:
            BatchError: A package or a command is missing, or a setting is wrong.
        """
        system, temporary = self.system, task.settings.temporary
        dask, distributed = imported(system.flag, "slurm")
        cluster_class = system.cluster_class(imported_jobqueue(system.flag))
        self.folder = own_folder(temporary.path / f"{system.folder}_{temporary.batch}")
        self.keeps_logs = temporary.is_kept
        settings = {**system.settings(site_settings(dask, system.name), self.folder), **EVERY_JOB}
        settings["scheduler_options"] = scheduler_options(task.retries, settings.get("scheduler_options"))
        self.cores, self.logs = settings["cores"], settings["log_directory"]
        try:
            settings["security"] = with_keys(distributed.Security, self.folder)
            self.cluster = cluster_class(silence_logs=logging.CRITICAL, **settings)
            system.begin(self.cluster, distributed, temporary)
            self.client = distributed.Client(self.cluster)
        except (OSError, ValueError, RuntimeError, TypeError) as error:
            raise BatchError(f"{system.flag}: {system.cannot_start(one_line(error))}") from None
        self.started_s = time.monotonic()

    def submit(self, useful: int) -> None:
        """Submit jobs until there are so many.

        Raises:
            BatchError: The batch system refuses them.
        """
        number = useful - len(self.system.jobs)
        for _ in range(number):
            self.system.submit()
        counts = f"{counted(number, 'job')} of {counted(self.cores, 'core')}"
        if number > 0 and (said := self.system.submitted(counts, self.logs)):
            tell(f"{self.system.title}: {said}")

    def outcomes(self, tasks: Sequence[Task]) -> Generator[Outcome, None, None]:
        """Yield the outcomes of runs, and look after the jobs meanwhile."""
        left = len(tasks)
        if not tasks:
            return
        ended = outcomes_of(tasks, self.client, lambda: self.poll(left), do_in_job)
        try:
            with contextlib.closing(ended) as outcomes:
                for outcome in outcomes:
                    left -= 1
                    self.lost_in_vain = 0
                    self.keeps_logs |= bool(outcome.problem)
                    yield outcome
        except BatchError:
            self.keeps_logs |= self.system.has_started
            raise

    def poll(self, left: int) -> None:
        """Replace jobs that were lost, and cancel those that have nothing to do any more.

        Args:
            left: Runs that are not finished.

        Raises:
            BatchError: No job will start, or job after job is lost.
        """
        now_s = time.monotonic()
        if left and now_s >= self.next_look_s:
            since_s = now_s - self.started_s
            self.next_look_s = now_s + self.system.wait_s(since_s)
            self.look(left, since_s)
        if not self.keep_idle:
            busy = runs_of_workers(self.cluster)
            self.system.cancel(idle(list(self.system.jobs), busy, self.cores, left))

    def look(self, left: int, since_s: float) -> None:
        """Look at the jobs, when the first was submitted that long ago; see `poll`."""
        gone = self.system.ended(runs_of_workers(self.cluster))
        if gone is None:
            return
        for job, how in gone.items():
            self.lost_in_vain += 1
            self.keeps_logs |= not how
            shown = f" ({how})" if how else ""
            tell(f"{self.system.title}: job {job} has ended before the batch{shown}; its runs are done again")
            if self.lost_in_vain >= LOST_PER_JOB * self.wanted:
                raise BatchError(self.system.lost(self.lost_in_vain, job, how))
        self.system.check_hope(since_s)
        self.submit(jobs_for(left, self.wanted, self.cores))
        self.system.report(since_s)

    def close(self) -> None:
        """End the jobs and the scheduler, and forget the keys."""
        if self.client is not None:
            with contextlib.suppress(Exception):
                self.client.close(timeout=5)
        if self.cluster is not None:
            self.system.cancel_all()
            end_s = time.monotonic() + LEAVING_S
            while self.cluster.scheduler.workers and time.monotonic() < end_s:
                time.sleep(0.05)  # a scheduler that ends while its workers do disturbs them
            with contextlib.suppress(Exception):
                self.cluster.close(timeout=5)
        if self.folder is not None:
            forget_keys(self.folder)
            if not self.keeps_logs:
                shutil.rmtree(self.folder, ignore_errors=True)
