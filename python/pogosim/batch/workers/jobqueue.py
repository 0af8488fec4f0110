"""Jobs of PBS, Grid Engine and others, which dask-jobqueue submits; see `pogosim.batch.workers.queued_workers`."""

from __future__ import annotations

import contextlib
import shutil
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from pogosim.batch.errors import BatchError, one_line, tell
from pogosim.batch.runs.temporary import TemporaryFolder
from pogosim.batch.workers.jobqueue_options import CLUSTERS, QueuedJobs
from pogosim.batch.workers.slurm_options import CORES, MEMORY_PER_CORE_GB

REMIND_S = 60.0


class JobqueueSystem:
    """A batch system that dask-jobqueue knows. That a job has ended is seen when its worker had joined, and leaves."""

    folder = "jobs"

    def __init__(self, request: QueuedJobs) -> None:
        self.request = request
        self.name = self.title = request.system
        self.flag = f"--jobqueue {request.system}"
        self.most_jobs = request.jobs
        self.jobs: dict[str, Any] = {}  # of dask-jobqueue
        self.joined: set[str] = set()  # names of the workers that have
        self.cluster: Any = None
        self.count = 0  # of all jobs that were submitted
        self.logs = ""
        self.told_s = time.monotonic()

    @property
    def has_started(self) -> bool:
        """Whether a job has joined."""
        return bool(self.joined)

    def cluster_class(self, jobqueue: Any) -> Any:
        """Return the class of dask-jobqueue; raises BatchError if the command is missing that submits jobs."""
        found = getattr(jobqueue, CLUSTERS[self.name])
        if shutil.which(command := found.job_cls.submit_command.split()[0]) is None:
            raise BatchError(f"{self.flag}: there is no command '{command}'; run it where you submit jobs")
        return found

    def settings(self, site: Mapping[str, Any], folder: Path) -> dict[str, Any]:
        """Return what a job is."""
        given = {**{key.replace("-", "_"): value for key, value in site.items()}, **dict(self.request.settings)}
        cores = given.get("cores", CORES)
        settings = {
            "memory": f"{MEMORY_PER_CORE_GB * cores}GB",
            "log_directory": str(folder),
            **given,
            "cores": cores,
            "worker_extra_args": [*(given.get("worker_extra_args") or []), "--preload", "pogosim.batch.workers.in_job"],
        }
        self.logs = settings["log_directory"]
        return settings

    def cannot_start(self, error: str) -> str:
        """Return what is said of wrong settings."""
        return f"{error}; settings are those of --jobqueue-set, and of {self.name} in jobqueue.yaml"

    def begin(self, cluster: Any, distributed: Any, temporary: TemporaryFolder) -> None:  # noqa: ARG002
        """Take the scheduler, and note from now on which workers join it."""
        self.cluster = cluster
        cluster.scheduler.add_plugin(noting_joined(distributed, self.joined), name="pogosim-joined")
        self.told_s = time.monotonic()

    def submit(self) -> None:
        """Submit a job; raises BatchError if it is refused."""
        name, made, scheduler = str(self.count), self.cluster.new_spec, self.cluster.scheduler
        job = made["cls"](scheduler.contact_address or scheduler.address, name, **made["options"])
        try:
            self.cluster.sync(job.start)
        except (OSError, ValueError, RuntimeError) as error:
            raise BatchError(f"{self.flag}: the job is refused: {words_of(error)}") from None
        self.jobs[name] = job
        self.count += 1

    def submitted(self, counts: str, logs: str) -> str:
        """Return what is said of jobs that were submitted."""
        return f"submitted {counts}; logs: {logs}"

    def wait_s(self, since_s: float) -> float:  # noqa: ARG002
        """Return 0: the scheduler, which is in this process, knows all."""
        return 0.0

    def ended(self, workers: Mapping[str, int]) -> dict[str, str]:
        """Forget the jobs whose workers have joined and left."""
        gone = [name for name in self.jobs if name in self.joined and name not in workers]
        numbers = {str(self.jobs[name].job_id): "" for name in gone}
        self.cancel(gone)
        return numbers

    def check_hope(self, since_s: float) -> None:
        """Do nothing: whether jobs that have not joined wait or have ended, only the batch system knows."""

    def report(self, since_s: float) -> None:
        """Say every minute how many jobs have not joined."""
        now_s = time.monotonic()
        waiting = [job.job_id for name, job in self.jobs.items() if name not in self.joined]
        if waiting and now_s - self.told_s >= REMIND_S:
            self.told_s = now_s
            which = (
                "no job has" if len(waiting) == len(self.jobs) else f"{len(waiting)} of {len(self.jobs)} jobs have not"
            )
            tell(
                f"{self.title}: {which} joined the batch yet, for {since_s / 60:.0f} min (the first: {waiting[0]}); "
                f"jobs that start and cannot reach this machine say so in their logs: {self.logs}"
            )

    def lost(self, number: int, last: str, how: str) -> str:  # noqa: ARG002
        """Return what is said when job after job has ended."""
        return (
            f"{self.flag}: {number} jobs have ended since a run was finished; if runs need longer, or more memory, ask "
            f"for it by --jobqueue-set; logs: {self.logs}"
        )

    def cancel(self, jobs: Sequence[str]) -> None:
        """Cancel some jobs, as far as they are still there."""
        for name in jobs:
            job = self.jobs.pop(name)
            with contextlib.suppress(Exception):
                self.cluster.sync(job.close)

    def cancel_all(self) -> None:
        """Cancel all jobs."""
        self.cancel(list(self.jobs))


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
