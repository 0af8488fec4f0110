"""What a Dask worker in a job of a batch system does; it loads this module when it starts."""

from __future__ import annotations

import importlib
import os
import threading
import time
from typing import Any

from pogosim.batch.runs.attempts import do_run
from pogosim.batch.runs.run import Outcome, Task
from pogosim.batch.runs.simulators import StoppedError, simulators

SIGNALLED_S = 2.0
CLOSING_S = 15.0


def dask_setup(worker: Any) -> None:
    """Watch over the end of the worker.

    When it gets SIGTERM at the moment in which its scheduler ends, each keeps the other from closing it, and it would
    ask for the scheduler again and again.
    """
    threading.Thread(target=end_when_closing, args=(worker,), name="watching over the end", daemon=True).start()


def end_when_closing(worker: Any) -> None:
    """End the process if the worker has been closing for long."""
    closing_s = 0.0
    while closing_s < CLOSING_S:
        time.sleep(1.0)
        closing_s = closing_s + 1.0 if worker.status.name in ("closing", "closed", "failed") else 0.0
    simulators.stop()
    os._exit(1)


def dask_teardown(worker: Any) -> None:  # noqa: ARG001
    """End simulators with the worker: it would wait for them when the batch was killed."""
    simulators.stop()
    simulators.close()


def do_in_job(task: Task) -> Outcome:
    """Do a run in a job. Batch systems end a job by signals to all its processes: then the run has not failed."""
    distributed: Any = importlib.import_module("distributed")
    try:
        outcome = do_run(task)
    except StoppedError:
        raise distributed.Reschedule from None
    if outcome.problem:
        time.sleep(SIGNALLED_S)
        if distributed.get_worker().status.name != "running":
            raise distributed.Reschedule
    return outcome
