"""Runs done by Dask: on this machine, or by the workers of a scheduler, which share a file system with the batch."""

from __future__ import annotations

import asyncio
import contextlib
import importlib
import logging
from collections.abc import Generator, Sequence
from typing import Any

from pogosim.batch.errors import BatchError, one_line
from pogosim.batch.run import Outcome, Task, do_run

CONNECT_S = 5
INSTALL = "install it: pip install 'pogosim[dask]'"


def connected(workers: int, scheduler: str | None) -> tuple[Any, Any]:
    """Return a client, and the cluster that was started for it, if one was.

    Raises:
        BatchError: Dask is not installed, or there is no scheduler.
    """
    try:
        settings: Any = importlib.import_module("dask")
        # Read when distributed is imported.
        settings.config.set({"logging": dict.fromkeys(("distributed", "distributed.client", "tornado"), "critical")})
        distributed: Any = importlib.import_module("distributed")
    except ImportError:
        raise BatchError(f"--backend dask needs the Python package 'distributed'; {INSTALL}") from None
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


def dask(tasks: Sequence[Task], workers: int, scheduler: str | None) -> Generator[Outcome, None, None]:
    """Do runs with Dask. A run whose worker was killed is done again by another one.

    Raises:
        BatchError: Dask is not installed, or there is no scheduler; or, later, the scheduler has gone.
    """
    client, cluster = connected(workers, scheduler)
    return outcomes_of(tasks, client, cluster)


def outcomes_of(tasks: Sequence[Task], client: Any, cluster: Any) -> Generator[Outcome, None, None]:
    """Yield the outcomes of runs that a client of Dask has done."""
    futures: list[Any] = []
    try:
        as_completed: Any = importlib.import_module("distributed").as_completed
        futures = [client.submit(do_run, task, key=f"pogosim-{task.batch}-{task.key}", pure=False) for task in tasks]
        left = {future.key: task for future, task in zip(futures, tasks, strict=True)}
        for future in as_completed(futures, raise_errors=False):
            task = left.pop(future.key)
            if future.status == "finished":
                yield future.result()
            elif future.status == "error":
                yield Outcome(task.key, f"its worker failed: {one_line(repr(future.exception()))}")
            else:
                raise BatchError(
                    "the Dask scheduler ended before the batch; finished runs are kept: start it "
                    "again, then give the same command again"
                )
    finally:
        with contextlib.suppress(Exception):
            client.cancel(futures, force=True)
        with contextlib.suppress(Exception):
            client.close(timeout=5)
        if cluster is not None:
            with contextlib.suppress(Exception):
                cluster.close(timeout=5)
