"""What a Dask worker in a job of a batch system does; it loads this module when it starts."""

from __future__ import annotations

import importlib
import time
from typing import Any

from pogosim.batch.attempts import do_run
from pogosim.batch.run import Outcome, Task
from pogosim.batch.simulators import StoppedError, simulators

SIGNALLED_S = 2.0


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
