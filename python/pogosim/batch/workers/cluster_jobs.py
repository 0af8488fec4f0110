"""What jobs of SLURM and of other batch systems have in common: they are Dask workers of a batch's own scheduler.

Connections are encrypted and authenticated with keys made for the batch, as others use the same network.
"""

from __future__ import annotations

import importlib
import os
import signal
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from pogosim.batch.errors import BatchError
from pogosim.extras import installing

LOSSES_PER_RUN = 5
LOST_PER_JOB = 3  # so many jobs in place of one may be lost before a run is finished
ROLES = ("scheduler", "worker", "client")


def jobs_for(runs: int, most: int, cores: int) -> int:
    """Return how many jobs are of use for so many runs, at most as many as are asked for.

    Args:
        runs: Runs to do.
        most: Jobs that are asked for.
        cores: Runs at the same time in each.
    """
    return min(most, -(-runs // cores))


def scheduler_options(retries: int, of_site: Mapping[str, Any] | None) -> dict[str, Any]:
    """Return the options of the scheduler; those of the site come first."""
    return {
        "dashboard_address": "127.0.0.1:0",
        "allowed_failures": max(retries, LOSSES_PER_RUN),
        **(of_site or {}),
    }


def runs_of_workers(cluster: Any) -> dict[str, int]:
    """Return how many runs the workers of a cluster have been given, by their names."""
    return {str(worker.name): len(worker.processing) for worker in list(cluster.scheduler.workers.values())}


def idle(jobs: Iterable[str], workers: Mapping[str, int], cores: int, left: int) -> list[str]:
    """Return the jobs that have nothing to do any more: all runs that are left are being done in others.

    Args:
        jobs: Names of jobs.
        workers: Runs that were given to the workers of jobs, by the names of the jobs.
        cores: Runs at the same time in each.
        left: Runs that are not finished.
    """
    if sum(min(assigned, cores) for assigned in workers.values()) < left:
        return []
    return [job for job in jobs if not workers.get(job)]


def imported_jobqueue(flag: str) -> Any:
    """Return the package dask_jobqueue.

    Raises:
        BatchError: It, or what its encryption needs, is not installed; says what the flag needs.
    """
    on_interrupt = signal.getsignal(signal.SIGINT)
    try:
        importlib.import_module("cryptography")
        return importlib.import_module("dask_jobqueue")
    except ImportError as error:
        package = "cryptography" if error.name == "cryptography" else "dask-jobqueue"
        raise BatchError(f"{flag} needs the Python package '{package}'; install it: {installing('slurm')}") from None
    finally:
        signal.signal(signal.SIGINT, on_interrupt)  # dask_jobqueue puts its own


def site_settings(dask: Any, system: str) -> dict[str, Any]:
    """Return what the site and the user say about a batch system in jobqueue.yaml, or in the environment."""
    entries = (dask.config.collect().get("jobqueue") or {}).get(system) or {}
    return {key.replace("_", "-"): value for key, value in entries.items() if value is not None}


def with_keys(security: Any, folder: Path) -> Any:
    """Return the security of connections with keys of this batch alone, which are files that workers read."""
    made = security.temporary().get_tls_config_for_role("worker")
    paths = {name: folder / f"tls_{name}.pem" for name in ("ca_file", "cert", "key")}
    for name, path in paths.items():
        path.unlink(missing_ok=True)
        path.touch(mode=0o600)
        path.write_text(made[name])
    pairs = {f"tls_{role}_{name}": str(paths[name]) for role in ROLES for name in ("cert", "key")}
    return security(require_encryption=True, tls_ca_file=str(paths["ca_file"]), **pairs)


def forget_keys(folder: Path) -> None:
    """Remove the keys of a batch."""
    for path in folder.glob("tls_*.pem"):
        path.unlink(missing_ok=True)


def own_folder(path: Path) -> Path:
    """Make a folder that only its owner can read."""
    path.mkdir(parents=True, exist_ok=True)
    os.chmod(path, 0o700)  # noqa: PTH101
    return path
