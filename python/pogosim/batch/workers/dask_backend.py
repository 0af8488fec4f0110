"""Runs done by Dask: on this machine, or by the workers of a scheduler, which share a file system with the batch."""

from __future__ import annotations

import asyncio
import contextlib
import importlib
import logging
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from typing import Any

from pogosim.batch.errors import BatchError, one_line
from pogosim.batch.runs.attempts import do_run
from pogosim.batch.runs.run import Outcome, Task
from pogosim.batch.runs.simulators import simulators
from pogosim.extras import installing

CONNECT_S = 5
MOST_CANCELLED = 1000  # runs of a batch that workers gave back
POLL_S = 0.2


def imported(flag: str, extra: str) -> tuple[Any, Any]:
    """Return the packages dask and distributed, which keep silent.

    Raises:
        BatchError: They are not installed; says what the flag needs.
    """
    try:
        settings: Any = importlib.import_module("dask")
        # Read when distributed is imported.
        settings.config.set({"logging": dict.fromkeys(("distributed", "distributed.client", "tornado"), "critical")})
        distributed: Any = importlib.import_module("distributed")
    except ImportError:
        raise BatchError(f"{flag} needs the Python package 'distributed'; install it: {installing(extra)}") from None
    return settings, distributed


def connected(workers: int, scheduler: str | None) -> tuple[Any, Any]:
    """Return a client, and the cluster that was started for it, if one was.

    Raises:
        BatchError: Dask is not installed, or there is no scheduler.
    """
    settings, distributed = imported("--backend dask", "dask")
    settings.config.set({"distributed.comm.timeouts.connect": f"{CONNECT_S}s"})
    if scheduler is None:
        cluster = distributed.LocalCluster(
            n_workers=workers, threads_per_worker=1, dashboard_address="127.0.0.1:0", silence_logs=logging.CRITICAL
        )
        return distributed.Client(cluster), cluster
    try:
        return distributed.Client(scheduler, timeout=CONNECT_S), None
    except (OSError, ValueError, TimeoutError, asyncio.TimeoutError) as error:
        raise BatchError(
            f"--scheduler: no Dask scheduler answers at {scheduler} ({one_line(error)}); "
            "start one with 'dask scheduler', and pass its address, such as tcp://127.0.0.1:8786"
        ) from None


@contextlib.contextmanager
def dask(workers: int, scheduler: str | None) -> Iterator[Callable[[Sequence[Task]], Generator[Outcome, None, None]]]:
    """Let Dask do runs. A run whose worker was killed is done again by another one.

    Raises:
        BatchError: Dask is not installed, or there is no scheduler; or, later, the scheduler has gone.
    """
    client, cluster = connected(workers, scheduler)
    try:
        yield lambda tasks: outcomes_of(tasks, client)
    finally:
        with contextlib.suppress(Exception):
            # Those of a scheduler stay, and may do runs of other batches.
            client.run(close_servers if cluster is None else end_simulators)
        with contextlib.suppress(Exception):
            client.close(timeout=5)
        if cluster is not None:
            with contextlib.suppress(Exception):
                cluster.close(timeout=5)


def end_simulators() -> None:
    """End all simulators of a worker that ends."""
    simulators.stop()
    simulators.close()


def close_servers() -> None:
    """End what waits for runs in a worker."""
    simulators.close()


def outcomes_of(
    tasks: Sequence[Task],
    client: Any,
    poll: Callable[[], None] | None = None,
    do: Callable[[Task], Outcome] = do_run,
) -> Generator[Outcome, None, None]:
    """Yield the outcomes of runs that a client of Dask has done.

    Args:
        tasks: Runs to do.
        client: Client of Dask.
        poll: Called now and then meanwhile.
        do: Does a run, in a worker.
    """
    futures: list[Any] = []
    try:
        as_completed: Any = importlib.import_module("distributed").as_completed
        futures = [client.submit(do, task, key=key_of(task, 0), pure=False) for task in tasks]
        left = {future.key: task for future, task in zip(futures, tasks, strict=True)}
        completed = as_completed(futures, raise_errors=False)
        again = 0
        for future in finished(completed, poll):
            task = left.pop(future.key)
            if future.status == "finished":
                yield future.result()
            elif future.status == "error":
                yield Outcome(task.key, problem_of(future.exception()))
            elif client.status == "running" and again < MOST_CANCELLED:
                # A worker that was asked to end gives its run back as cancelled when it is slow to close.
                again += 1
                repeated = client.submit(do, task, key=key_of(task, again), pure=False)
                futures.append(repeated)
                left[repeated.key] = task
                completed.add(repeated)
            else:
                raise BatchError(
                    "the Dask scheduler ended before the batch; finished runs are kept: start it "
                    "again, then give the same command again"
                )
    finally:
        with contextlib.suppress(Exception):
            client.cancel(futures, force=True)


def problem_of(error: Exception) -> str:
    """Return what kept a worker from doing a run."""
    if type(error).__name__ == "KilledWorker":
        return "each worker that did it was killed, see their logs; it may need more time or memory"
    return f"its worker failed: {one_line(repr(error))}"


def key_of(task: Task, again: int) -> str:
    """Return the name of a run for Dask; another one for each time that it is given to workers."""
    return f"pogosim-{task.settings.temporary.batch}-{task.key}" + (f"-{again}" if again else "")


def finished(completed: Any, poll: Callable[[], None] | None) -> Iterator[Any]:
    """Yield futures as they are finished, and look at something meanwhile."""
    if poll is None:
        yield from completed
        return
    while not completed.is_empty():
        yield from completed.next_batch(block=False)
        poll()
        time.sleep(POLL_S)
