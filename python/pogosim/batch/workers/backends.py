"""Where runs are done: one after the other, in parallel on this machine, by Dask, or by jobs of a batch system.

A backend is opened once, and then does runs, as often as it is asked to. It yields their outcomes in the order in which
they end. When that is closed before, it ends what is running.
"""

from __future__ import annotations

import contextlib
import logging
import os
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import AbstractContextManager
from dataclasses import dataclass

from pogosim.batch.errors import BatchError, at_least
from pogosim.batch.runs.attempts import do_run
from pogosim.batch.runs.run import Outcome, Task
from pogosim.batch.runs.simulators import simulators
from pogosim.batch.workers.jobqueue_options import QueuedJobs
from pogosim.batch.workers.slurm_options import CORES, SlurmJobs

Outcomes = Generator[Outcome, None, None]
Do = Callable[[Sequence[Task]], Outcomes]

log = logging.getLogger("pogobatch")


def processors() -> int:
    """Return the number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@dataclass(frozen=True)
class Workers:
    """The backend that does runs, as chosen by options.

    Args:
        backend: "multiprocessing", "sequential" or "dask" ("ray" means dask).
        number: Runs at the same time; None: one per processor.
        scheduler: Address of a Dask scheduler (tcp://...) whose workers do the runs.
        jobs: Jobs of SLURM, or of another batch system, that do the runs.

    Raises:
        BatchError: These do not go together.
    """

    backend: str = "multiprocessing"
    number: int | None = None
    scheduler: str | None = None
    jobs: SlurmJobs | QueuedJobs | None = None

    def __post_init__(self) -> None:
        if self.backend not in BACKENDS:
            known = ", ".join(name for name in BACKENDS if name != "ray")
            raise BatchError(f"--backend: expected one of {known}; found '{self.backend}'")
        if self.scheduler is not None and self.backend == "sequential":
            raise BatchError(f"--scheduler goes with --backend dask, not with --backend {self.backend}")
        if self.jobs is not None and (
            self.backend != "multiprocessing" or self.number is not None or self.scheduler is not None
        ):
            flag = self.jobs.flag
            raise BatchError(f"{flag} goes without --backend, --scheduler and --workers; see {flag}-jobs")
        if self.number is not None:
            at_least(1, self.number, "--workers")

    @property
    def count(self) -> int:
        """Runs at the same time; of a Dask scheduler, as many as this machine would do."""
        if self.jobs is not None:
            return self.jobs.jobs * (self.jobs.cores or CORES)
        return processors() if self.number is None else self.number

    @property
    def name(self) -> str:
        """What does the runs: a batch system ("slurm", "pbs", ...), "dask" or another backend."""
        if self.jobs is not None:
            return self.jobs.system
        return "dask" if self.scheduler is not None or self.backend == "ray" else self.backend

    @property
    def at_once(self) -> int:
        """Runs at the same time, at most."""
        return 1 if self.name == "sequential" else self.count

    def opened(self, keep_idle: bool = False) -> AbstractContextManager[Do]:
        """Return what does runs until it is closed.

        Args:
            keep_idle: Keep jobs that have nothing to do, for runs that are still to come.

        Raises:
            BatchError: It cannot be had.
        """
        if self.jobs is not None:
            return by_jobs(self.jobs, keep_idle)
        if self.backend == "ray":
            log.warning("--backend ray is replaced by --backend dask")
        return BACKENDS["dask" if self.scheduler is not None else self.backend](self)


def sequential(workers: Workers) -> AbstractContextManager[Do]:  # noqa: ARG001
    """Do runs one after the other."""
    return by_threads(workers=1, threads=1)


def parallel(workers: Workers) -> AbstractContextManager[Do]:
    """Do runs in parallel. Each is a process of its own, which a thread waits for.

    Some more threads prepare and clean up while all the simulators run that may.
    """
    return by_threads(workers.count, threads=workers.count + workers.count // 8 + 1)


def by_dask(workers: Workers) -> AbstractContextManager[Do]:
    """Let Dask do runs."""
    from pogosim.batch.workers.dask_backend import dask

    return dask(workers.count, workers.scheduler)


@contextlib.contextmanager
def by_jobs(request: SlurmJobs | QueuedJobs, keep_idle: bool) -> Iterator[Do]:
    """Let jobs of a batch system do runs. They are submitted with the first runs, and end when this is closed."""
    from pogosim.batch.workers.jobqueue import JobqueueSystem
    from pogosim.batch.workers.queued_workers import QueuedWorkers
    from pogosim.batch.workers.slurm import Slurm

    system = Slurm(request) if isinstance(request, SlurmJobs) else JobqueueSystem(request)
    with contextlib.closing(QueuedWorkers(system, keep_idle)) as workers:
        yield workers.do


@contextlib.contextmanager
def by_threads(workers: int, threads: int) -> Iterator[Do]:
    """Do runs in threads, with at most `workers` simulators at the same time."""
    simulators.begin(workers)
    pool = ThreadPoolExecutor(threads)

    def do(tasks: Sequence[Task]) -> Outcomes:
        is_done = False
        try:
            futures = [pool.submit(do_run, task) for task in tasks]
            for future in as_completed(futures):
                yield future.result()
            is_done = True
        finally:
            if not is_done:
                simulators.stop()

    try:
        yield do
    except BaseException:
        simulators.stop()  # also if Ctrl-C comes before the first outcome
        raise
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
        simulators.close()


BACKENDS: dict[str, Callable[[Workers], AbstractContextManager[Do]]] = {
    "multiprocessing": parallel,
    "sequential": sequential,
    "dask": by_dask,
    "ray": by_dask,
}
