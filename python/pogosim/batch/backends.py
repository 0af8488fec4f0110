"""Where runs are done: one after the other, in parallel on this machine, or by Dask.

A backend yields the outcomes of runs in the order in which they end. When it is closed before, it ends what is running.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed

from pogosim.batch.dask_backend import dask
from pogosim.batch.run import Outcome, Task, do_run, simulators

Outcomes = Generator[Outcome, None, None]
Backend = Callable[[Sequence[Task], int, "str | None"], Outcomes]


def processors() -> int:
    """Return the number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def sequential(tasks: Sequence[Task], workers: int, scheduler: str | None) -> Outcomes:  # noqa: ARG001
    """Do runs one after the other."""
    return by_threads(tasks, workers=1, threads=1)


def parallel(tasks: Sequence[Task], workers: int, scheduler: str | None) -> Outcomes:  # noqa: ARG001
    """Do runs in parallel. Each is a process of its own, which a thread waits for.

    Some more threads prepare and clean up while all the simulators run that may.
    """
    return by_threads(tasks, workers, threads=workers + workers // 8 + 1)


def by_threads(tasks: Sequence[Task], workers: int, threads: int) -> Outcomes:
    """Do runs in threads, with at most `workers` simulators at the same time."""
    simulators.begin(workers)
    pool = ThreadPoolExecutor(max(1, min(threads, len(tasks))))
    is_done = False
    try:
        futures = [pool.submit(do_run, task) for task in tasks]
        for future in as_completed(futures):
            yield future.result()
        is_done = True
    finally:
        if not is_done:
            simulators.stop()
        pool.shutdown(wait=True, cancel_futures=True)


BACKENDS: dict[str, Backend] = {"multiprocessing": parallel, "sequential": sequential, "dask": dask, "ray": dask}
