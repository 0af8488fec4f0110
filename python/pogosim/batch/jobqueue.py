"""Runs done by jobs of PBS, Grid Engine and others, whose submission dask-jobqueue knows.

Jobs are Dask workers, which join a scheduler in the process of the batch, see `pogosim.batch.cluster_jobs`.
"""

from __future__ import annotations

import contextlib
import logging
import shutil
import time
from collections.abc import Generator, Sequence
from pathlib import Path
from typing import Any

from pogosim.batch.cluster_jobs import (
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
from pogosim.batch.dask_backend import imported, outcomes_of
from pogosim.batch.errors import BatchError, one_line, tell
from pogosim.batch.in_job import do_in_job
from pogosim.batch.jobqueue_options import CLUSTERS, QueuedJobs
from pogosim.batch.run import Outcome, Task
from pogosim.batch.slurm_options import CORES, MEMORY_PER_CORE_GB
from pogosim.lines import counted

REMIND_S = 60.0
LEAVING_S = 3.0


class QueuedWorkers:
    """Jobs of a batch system that do runs, and the scheduler that they join.

    Jobs that have joined and are lost are replaced, and their runs are done again. Logs stay if something went wrong.
    """

    def __init__(self, request: QueuedJobs, keep_idle: bool) -> None:
        self.request = request
        self.keep_idle = keep_idle
        self.flag = f"--jobqueue {request.system}"
        self.client: Any = None
        self.cluster: Any = None
        self.folder: Path | None = None
        self.keeps_logs = False
        self.cores, self.logs = CORES, ""
        self.jobs: dict[str, Any] = {}  # by the name of the worker
        self.joined: set[str] = set()  # names of the workers that have
        self.submitted = self.most_jobs = 0
        self.lost_in_vain = 0  # jobs lost since a run was finished
        self.told_s = self.started_s = 0.0

    def do(self, tasks: Sequence[Task]) -> Generator[Outcome, None, None]:
        """Do runs.

        Raises:
            BatchError: A package or a command is missing, or the batch system refuses the jobs; later: all are lost.
        """
        if tasks and self.client is None:
            self.start(tasks[0])
        if tasks:
            self.submit(jobs_for(len(tasks), self.request.jobs, self.cores) - len(self.jobs))
        return self.outcomes(tasks)

    def start(self, task: Task) -> None:
        """Start the scheduler.

        Raises:
            BatchError: A package or a command is missing, or a setting is wrong.
        """
        dask, distributed = imported(self.flag, "slurm")
        cluster_class = getattr(imported_jobqueue(self.flag), CLUSTERS[self.request.system])
        if shutil.which(command := cluster_class.job_cls.submit_command.split()[0]) is None:
            raise BatchError(f"{self.flag}: there is no command '{command}'; run it where you submit jobs")
        self.folder = own_folder(task.settings.temporary.path / f"jobs_{task.settings.temporary.batch}")
        self.keeps_logs = task.settings.temporary.is_kept
        settings = self.settings(site_settings(dask, self.request.system), task.retries)
        self.cores, self.logs = settings["cores"], settings["log_directory"]
        try:
            settings["security"] = with_keys(distributed.Security, self.folder)
            self.cluster = cluster_class(silence_logs=logging.CRITICAL, **settings)
            self.cluster.scheduler.add_plugin(noting_joined(distributed, self.joined), name="pogosim-joined")
            self.client = distributed.Client(self.cluster)
        except (OSError, ValueError, RuntimeError, TypeError) as error:
            raise BatchError(
                f"{self.flag}: {one_line(error)}; settings are those of --jobqueue-set, and of "
                f"{self.request.system} in jobqueue.yaml"
            ) from None
        self.started_s = self.told_s = time.monotonic()

    def settings(self, site: dict[str, Any], retries: int) -> dict[str, Any]:
        """Return the arguments of the class of dask-jobqueue."""
        given = {**{key.replace("-", "_"): value for key, value in site.items()}, **dict(self.request.settings)}
        cores = given.get("cores", CORES)
        return {
            "memory": f"{MEMORY_PER_CORE_GB * cores}GB",
            "log_directory": str(self.folder),
            **given,
            "cores": cores,
            "processes": 1,  # simulators are processes of their own, which its threads wait for
            "nanny": False,  # the batch system sees when a worker ends
            "scheduler_options": scheduler_options(retries, given.get("scheduler_options")),
            "worker_extra_args": [*(given.get("worker_extra_args") or []), "--preload", "pogosim.batch.in_job"],
        }

    def submit(self, number: int) -> None:
        """Submit some jobs.

        Raises:
            BatchError: The batch system refuses them.
        """
        scheduler = self.cluster.scheduler
        address = scheduler.contact_address or scheduler.address
        for _ in range(number):
            name = str(self.submitted)
            made = self.cluster.new_spec
            job = made["cls"](address, name, **made["options"])
            try:
                self.cluster.sync(job.start)
            except (OSError, ValueError, RuntimeError) as error:
                raise BatchError(f"{self.flag}: the job is refused: {words_of(error)}") from None
            self.jobs[name] = job
            self.submitted += 1
            self.most_jobs = max(self.most_jobs, len(self.jobs))
        if number > 0:
            counts = f"{counted(number, 'job')} of {counted(self.cores, 'core')}"
            tell(f"{self.request.system}: submitted {counts}; logs: {self.logs}")

    def outcomes(self, tasks: Sequence[Task]) -> Generator[Outcome, None, None]:
        """Yield the outcomes of runs, and look after the jobs meanwhile."""
        left = len(tasks)
        if not tasks:
            return
        ended = outcomes_of(tasks, self.client, lambda: self.poll(left), do_in_job)
        with contextlib.closing(ended) as outcomes:
            for outcome in outcomes:
                left -= 1
                self.lost_in_vain = 0
                self.keeps_logs |= bool(outcome.problem)
                yield outcome

    def poll(self, left: int) -> None:
        """Replace jobs that have been lost, and say so if some have not joined for long.

        Args:
            left: Runs that are not finished.

        Raises:
            BatchError: Job after job is lost.
        """
        workers = runs_of_workers(self.cluster)
        if not self.keep_idle:
            for name in idle(self.jobs, workers, self.cores, left):
                self.cancel(self.jobs.pop(name))
        lost = [name for name in self.jobs if name in self.joined and name not in workers]
        for name in lost:
            job = self.jobs.pop(name)
            self.lost_in_vain += 1
            self.keeps_logs = True
            tell(f"{self.request.system}: job {job.job_id} has ended before the batch; its runs are done again")
            self.cancel(job)
        if self.lost_in_vain >= LOST_PER_JOB * self.most_jobs:
            raise BatchError(
                f"{self.flag}: {self.lost_in_vain} jobs have ended since a run was finished; if runs need longer, or "
                f"more memory, ask for it by --jobqueue-set; logs: {self.logs}"
            )
        if lost:
            self.submit(jobs_for(left, self.request.jobs, self.cores) - len(self.jobs))
        self.remind()

    def remind(self) -> None:
        """Say every minute how many jobs have not joined; whether they wait or have ended, only the system knows."""
        now = time.monotonic()
        waiting = [job.job_id for name, job in self.jobs.items() if name not in self.joined]
        if waiting and now - self.told_s >= REMIND_S:
            self.told_s = now
            which = (
                "no job has" if len(waiting) == len(self.jobs) else f"{len(waiting)} of {len(self.jobs)} jobs have not"
            )
            tell(
                f"{self.request.system}: {which} joined the batch yet, for {(now - self.started_s) / 60:.0f} min "
                f"(the first: {waiting[0]}); jobs that start and cannot reach this machine say so in their logs: "
                f"{self.logs}"
            )

    def cancel(self, job: Any) -> None:
        """Cancel a job, if it is still there."""
        with contextlib.suppress(Exception):
            self.cluster.sync(job.close)

    def close(self) -> None:
        """End the jobs and the scheduler, and forget the keys."""
        if self.client is not None:
            with contextlib.suppress(Exception):
                self.client.close(timeout=5)
        for job in self.jobs.values():
            self.cancel(job)
        end_s = time.monotonic() + LEAVING_S
        while self.cluster is not None and self.cluster.scheduler.workers and time.monotonic() < end_s:
            time.sleep(0.05)  # a scheduler that ends while its workers do disturbs them
        if self.cluster is not None:
            with contextlib.suppress(Exception):
                self.cluster.close(timeout=5)
        if self.folder is not None:
            forget_keys(self.folder)
            if not self.keeps_logs:
                shutil.rmtree(self.folder, ignore_errors=True)


def noting_joined(distributed: Any, joined: set[str]) -> Any:
    """Return a plugin of a scheduler that notes the names of workers when they join: some are lost soon afterwards."""

    class Noting(distributed.SchedulerPlugin):  # type: ignore[misc]
        def add_worker(self, scheduler: Any, worker: str) -> None:
            joined.add(str(scheduler.workers[worker].name))

    return Noting()


def words_of(error: Exception) -> str:
    """Return what a command of a batch system has said, in one line: dask-jobqueue quotes it."""
    said = str(error).partition("stderr:\n")[2].strip() or str(error)
    return one_line("; ".join(line for line in said.splitlines() if line.strip()))
