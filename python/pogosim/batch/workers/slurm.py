"""SLURM, and the jobs of a batch in it; see `pogosim.batch.workers.queued_workers`.

dask-jobqueue writes the script; sbatch, squeue and scancel are called here: they say which jobs wait, and why.
"""

from __future__ import annotations

import atexit
import contextlib
import getpass
import hashlib
import re
import shutil
import subprocess
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from pogosim.batch.errors import BatchError, one_line, tell
from pogosim.batch.runs.run_log import tail
from pogosim.batch.runs.temporary import TemporaryFolder
from pogosim.batch.workers.slurm_options import CORES, MEMORY_PER_CORE_GB, TIME, SlurmJobs
from pogosim.lines import counted

COMMANDS = ("sbatch", "squeue", "scancel")
POWERS = {"K": 1, "": 2, "M": 2, "G": 3, "T": 4}
ENDED = re.compile("BOOT_FAIL|CANCELLED|COMPLETED|DEADLINE|FAILED|NODE_FAIL|OUT_OF_MEMORY|PREEMPTED|REVOKED|TIMEOUT")
# Reasons for which a job waits until it, or the site's limits, are changed.
BLOCKING_REASONS = re.compile(
    r"(Partition(Config|NodeLimit|TimeLimit)|BadConstraints|DependencyNeverSatisfied|MaxMemPerLimit"
    r"|Invalid(Account|QOS)|(Account|QOS)NotAllowed|(Assoc|QOS)(Max|Min)\w+PerJob\w*)$"
)
REMIND_S = 60.0
SHORTEST_POLL_S, LONGEST_POLL_S = 2.0, 30.0  # squeue burdens the controller of the whole cluster


class Slurm:
    """SLURM. All jobs of a batch have the same script, and a name that no other jobs of the user have."""

    name = folder = "slurm"
    title = "SLURM"
    flag = "--slurm"

    def __init__(self, request: SlurmJobs) -> None:
        self.request = request
        self.most_jobs = request.jobs
        self.start_timeout_s = None if request.wait_min is None else 60 * request.wait_min
        self.jobs: dict[str, tuple[str, str]] = {}  # by their numbers: state, and reason why it waits
        self.has_started = False
        self.script = ""
        self.job_name = ""
        self.logs = Path()
        self.is_announced = False
        self.told, self.told_s = "", time.monotonic()

    def cluster_class(self, jobqueue: Any) -> Any:
        """Return the class of dask-jobqueue; raises BatchError if a command is missing."""
        for command in COMMANDS:
            if shutil.which(command) is None:
                raise BatchError(f"--slurm: there is no command '{command}'; run it where you submit jobs with sbatch")
        return jobqueue.SLURMCluster

    def settings(self, site: Mapping[str, Any], folder: Path) -> dict[str, Any]:
        """Return what a job is."""
        request = self.request
        cores = request.cores or site.get("cores") or CORES
        self.logs = Path(site.get("log-directory") or folder)
        settings: dict[str, Any] = {
            "cores": cores,
            "queue": request.partition,
            "account": request.account,
            "walltime": request.time or site.get("walltime") or TIME,
            "log_directory": str(self.logs),
            "job_extra_directives": [*(site.get("job-extra-directives") or []), *map(directive, request.options)],
            "scheduler_options": site.get("scheduler-options"),
            # The worker has the name of its job.
            "worker_extra_args": [
                *(site.get("worker-extra-args") or []),
                *("--name", "$SLURM_JOB_ID", "--preload", "pogosim.batch.workers.in_job"),
            ],
        }
        memory = request.memory or (None if "memory" in site else f"{MEMORY_PER_CORE_GB * cores}G")
        if memory is not None:
            settings.update(job_mem=memory, memory=bytes_of(memory))
        return settings

    def cannot_start(self, error: str) -> str:
        """Return what is said when the scheduler cannot be started."""
        return f"the Dask scheduler cannot be started: {error}"

    def begin(self, cluster: Any, distributed: Any, temporary: TemporaryFolder) -> None:  # noqa: ARG002
        """Take the script of the jobs, and cancel those that a killed batch with the same name has left."""
        self.job_name = job_name(temporary)
        self.script = cluster.job_script()
        atexit.register(self.cancel_all)  # whatever happens to the batch before its first run
        self.cancel_jobs()

    def submit(self) -> None:
        """Submit a job; raises BatchError if it is refused."""
        done = ask(["sbatch", "--parsable", f"--job-name={self.job_name}"], self.script)
        job = done.stdout.strip().partition(";")[0]
        if done.returncode != 0 or not job.isdigit():
            raise BatchError(f"sbatch refuses the job: {words_of(done.stderr) or words_of(done.stdout)}")
        self.jobs[job] = ("PENDING", "None")

    def submitted(self, counts: str, logs: str) -> str:
        """Return what is said of the first jobs; of others, `report` says it."""
        is_first, self.is_announced = not self.is_announced, True
        return f"submitted {counts}, called {self.job_name}; logs: {logs}" if is_first else ""

    def wait_s(self, since_s: float) -> float:
        """Return how long to wait until squeue is asked again."""
        return min(LONGEST_POLL_S, max(SHORTEST_POLL_S, 0.1 * since_s))

    def ended(self, workers: Mapping[str, int]) -> dict[str, str] | None:  # noqa: ARG002
        """Note what the jobs do, and forget those that have ended; None: the controller does not answer."""
        listed = self.listed()
        if listed is None:
            return None
        gone = {}
        for job in list(self.jobs):
            state, reason = listed.get(job, ("forgotten by SLURM", ""))
            if ENDED.match(state) or job not in listed:
                del self.jobs[job]
                gone[job] = state
            else:
                self.jobs[job] = (state, reason)
        self.has_started |= bool(gone)
        return gone

    def listed(self) -> dict[str, tuple[str, str]] | None:
        """Return the state of each job, and the reason why it waits; None if SLURM does not answer."""
        done = ask(["squeue", *self.whose(), "--states=all", "--noheader", "--format=%i|%T|%r"])
        if done.returncode != 0:
            return None
        rows = [line.strip().split("|", 2) for line in done.stdout.splitlines()]
        return {job: (state, reason) for job, state, reason in (row for row in rows if len(row) == 3)}

    def whose(self) -> tuple[str, str]:
        """Return the options that choose the jobs of the batch."""
        return f"--user={getpass.getuser()}", f"--name={self.job_name}"

    def check_hope(self, since_s: float) -> None:
        """Check that a job runs or may still start; raises BatchError if none will."""
        self.has_started |= any(state != "PENDING" for state, _ in self.jobs.values())
        is_waiting = bool(self.jobs) and all(state == "PENDING" for state, _ in self.jobs.values())
        if is_waiting and all(BLOCKING_REASONS.match(reason) for _, reason in self.jobs.values()):
            raise BatchError(
                f"SLURM will not start the jobs: {self.summary()}; ask for other resources, or another partition"
            )
        if self.start_timeout_s is not None and not self.has_started and since_s >= self.start_timeout_s:
            raise BatchError(f"no job has started within --slurm-wait: {self.summary()}")

    def summary(self) -> str:
        """Return what the jobs do: "6 jobs RUNNING, 2 jobs PENDING (Resources)"."""
        kinds = Counter(
            f"{state} ({reason})" if state == "PENDING" and reason != "None" else state
            for state, reason in self.jobs.values()
        )
        return ", ".join(f"{counted(number, 'job')} {kind}" for kind, number in sorted(kinds.items()))

    def report(self, since_s: float) -> None:
        """Say what the jobs do, when that changes, and every minute until one has started."""
        text, now_s = self.summary(), time.monotonic()
        if text != self.told or (not self.has_started and now_s - self.told_s >= REMIND_S):
            waited = f", for {since_s / 60:.0f} min" if text == self.told else ""
            tell(f"SLURM: {text}{waited}")
            self.told, self.told_s = text, now_s

    def lost(self, number: int, last: str, how: str) -> str:
        """Return what is said when job after job has ended."""
        return (
            f"SLURM: {number} jobs have ended since a run was finished, the last one, {last}, as {how}"
            f"{self.last_words(last)}; if runs need longer, or more memory: --slurm-time, --slurm-memory"
        )

    def last_words(self, job: str) -> str:
        """Return the last line in the log of a job."""
        for path in sorted(self.logs.glob(f"*-{job}.err")):
            if lines := tail(path).split("\n"):
                return f", and its log {path} ends with: {one_line(lines[-1])}"
        return ""

    def cancel(self, jobs: Sequence[str]) -> None:
        """Cancel some jobs, as far as they are still there."""
        jobs = [job for job in jobs if self.jobs.pop(job, None)]
        if jobs:
            ask(["scancel", *jobs])

    def cancel_all(self) -> None:
        """Cancel all jobs of the batch."""
        self.cancel_jobs()
        atexit.unregister(self.cancel_all)

    def cancel_jobs(self) -> None:
        """Cancel all jobs with the name of the batch, whichever process has submitted them."""
        self.jobs.clear()
        if self.job_name:  # without a name, these would be all jobs of the user
            with contextlib.suppress(OSError):
                ask(["scancel", *self.whose()])


def words_of(text: str) -> str:
    """Return what a command of SLURM says, in one line."""
    lines = [re.sub(r"^\w+: (error: )?", "", line) for line in text.splitlines()]
    return one_line("; ".join(line for line in lines if line.strip()))


def ask(command: Sequence[str], script: str = "") -> subprocess.CompletedProcess[str]:
    """Run a command of SLURM. Ctrl-C reaches the batch alone."""
    return subprocess.run(command, input=script, capture_output=True, text=True, check=False, start_new_session=True)


def directive(option: str) -> str:
    """Return an option of sbatch as it stands in a script: "--qos=long", also of "qos=long"."""
    return option if option.startswith("-") else f"--{option}"


def bytes_of(memory: str) -> int:
    """Return an amount of memory in bytes. A number alone means MB, as for sbatch."""
    unit = memory.lstrip("0123456789")
    return int(memory.removesuffix(unit)) * int(1024 ** POWERS[unit])


def job_name(temporary: TemporaryFolder) -> str:
    """Return the name of all jobs of a batch: the same whenever the same command is given."""
    return f"pogobatch-{hashlib.sha256(str(temporary.done).encode()).hexdigest()[:8]}"
