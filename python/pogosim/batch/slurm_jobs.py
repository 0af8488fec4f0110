"""The jobs of a batch in SLURM: submitted, watched, replaced when they are lost, cancelled at the end."""

from __future__ import annotations

import contextlib
import getpass
import re
import shutil
import subprocess
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from pogosim.batch.cluster_jobs import LOST_PER_JOB, jobs_for
from pogosim.batch.errors import BatchError, one_line, tell
from pogosim.batch.run_log import tail
from pogosim.lines import counted

COMMANDS = ("sbatch", "squeue", "scancel")
ENDED = re.compile("BOOT_FAIL|CANCELLED|COMPLETED|DEADLINE|FAILED|NODE_FAIL|OUT_OF_MEMORY|PREEMPTED|REVOKED|TIMEOUT")
# Reasons for which a job waits until it, or the site's limits, are changed.
BLOCKING_REASONS = re.compile(
    r"(Partition(Config|NodeLimit|TimeLimit)|BadConstraints|DependencyNeverSatisfied|MaxMemPerLimit"
    r"|Invalid(Account|QOS)|(Account|QOS)NotAllowed|(Assoc|QOS)(Max|Min)\w+PerJob\w*)$"
)
REMIND_S = 60.0
SHORTEST_POLL_S, LONGEST_POLL_S = 2.0, 30.0  # squeue burdens the controller of the whole cluster


def check_commands() -> None:
    """Check that SLURM is here.

    Raises:
        BatchError: A command is missing.
    """
    for command in COMMANDS:
        if shutil.which(command) is None:
            raise BatchError(f"--slurm: there is no command '{command}'; run it where you submit jobs with sbatch")


def words_of(text: str) -> str:
    """Return what a command of SLURM says, in one line."""
    lines = [re.sub(r"^\w+: (error: )?", "", line) for line in text.splitlines()]
    return one_line("; ".join(line for line in lines if line.strip()))


def ask(command: Sequence[str], script: str = "") -> subprocess.CompletedProcess[str]:
    """Run a command of SLURM. Ctrl-C reaches the batch alone."""
    return subprocess.run(command, input=script, capture_output=True, text=True, check=False, start_new_session=True)


class Jobs:
    """The jobs of a batch. All have the same script and name, and `wanted` of them are kept alive.

    Args:
        script: What sbatch gets.
        name: Name of the jobs; no other jobs of the user have it.
        wanted: Number of jobs.
        cores: Runs at the same time in each.
        start_timeout_s: How long to wait for the first job to start, in s; None: as long as it takes.
        logs: Folder of the jobs' logs.
    """

    def __init__(
        self, script: str, name: str, wanted: int, cores: int, start_timeout_s: float | None, logs: str | Path
    ) -> None:
        self.script = script
        self.name = name
        self.wanted = wanted
        self.cores = cores
        self.start_timeout_s = start_timeout_s
        self.logs = Path(logs)
        self.states: dict[str, tuple[str, str]] = {}  # state and reason of the jobs that have not ended
        self.lost_in_vain = 0  # jobs that have ended since a run was finished
        self.has_started = False
        self.started_s = self.told_s = time.monotonic()
        self.next_poll_s = 0.0
        self.told = ""

    def submit(self, number: int) -> None:
        """Submit some jobs.

        Raises:
            BatchError: SLURM refuses them.
        """
        for _ in range(number):
            done = ask(["sbatch", "--parsable", f"--job-name={self.name}"], self.script)
            job = done.stdout.strip().partition(";")[0]
            if done.returncode != 0 or not job.isdigit():
                raise BatchError(f"sbatch refuses the job: {words_of(done.stderr) or words_of(done.stdout)}")
            self.states[job] = ("PENDING", "None")

    def poll(self, left: int) -> None:
        """Look at the jobs if it is time to: say what they do, and replace those that were lost.

        Args:
            left: Runs that are not finished.

        Raises:
            BatchError: No job will start, or job after job is lost.
        """
        now = time.monotonic()
        if now < self.next_poll_s or not left:
            return
        self.next_poll_s = now + min(LONGEST_POLL_S, max(SHORTEST_POLL_S, 0.1 * (now - self.started_s)))
        listed = self.listed()
        if listed is None:
            return  # the controller does not answer; it may later
        for job in list(self.states):
            state, reason = listed.get(job, ("forgotten by SLURM", ""))
            if ENDED.match(state) or job not in listed:
                self.forget(job, state)
            else:
                self.states[job] = (state, reason)
        self.check_hope()
        self.submit(jobs_for(left, self.wanted, self.cores) - len(self.states))
        self.say()

    def listed(self) -> dict[str, tuple[str, str]] | None:
        """Return the state of each job, and the reason why it waits; None if SLURM does not answer."""
        whose = (f"--user={getpass.getuser()}", f"--name={self.name}")
        done = ask(["squeue", *whose, "--states=all", "--noheader", "--format=%i|%T|%r"])
        if done.returncode != 0:
            return None
        rows = [line.strip().split("|", 2) for line in done.stdout.splitlines()]
        return {job: (state, reason) for job, state, reason in (row for row in rows if len(row) == 3)}

    def forget(self, job: str, state: str) -> None:
        """Count a job that has ended before the batch.

        Raises:
            BatchError: Too many have.
        """
        del self.states[job]
        self.has_started = True
        self.lost_in_vain += 1
        tell(f"SLURM: job {job} has ended before the batch ({state}); its runs are done again")
        if self.lost_in_vain >= LOST_PER_JOB * self.wanted:
            said = self.last_words(job)
            raise BatchError(
                f"SLURM: {self.lost_in_vain} jobs have ended since a run was finished, the last one, {job}, as {state}"
                f"{said}; if runs need longer, or more memory: --slurm-time, --slurm-memory"
            )

    def last_words(self, job: str) -> str:
        """Return the last line in the log of a job."""
        for path in sorted(self.logs.glob(f"*-{job}.err")):
            if lines := tail(path).split("\n"):
                return f", and its log {path} ends with: {one_line(lines[-1])}"
        return ""

    def check_hope(self) -> None:
        """Check that a job runs or may still start.

        Raises:
            BatchError: None will.
        """
        self.has_started |= any(state != "PENDING" for state, _ in self.states.values())
        reasons = [reason for _, reason in self.states.values()]
        is_waiting = bool(reasons) and not any(state != "PENDING" for state, _ in self.states.values())
        if is_waiting and all(BLOCKING_REASONS.match(reason) for reason in reasons):
            raise BatchError(
                f"SLURM will not start the jobs: {self.summary()}; ask for other resources, or another partition"
            )
        waited_s = time.monotonic() - self.started_s
        if self.start_timeout_s is not None and not self.has_started and waited_s >= self.start_timeout_s:
            raise BatchError(f"no job has started within --slurm-wait: {self.summary()}")

    def summary(self) -> str:
        """Return what the jobs do: "6 jobs RUNNING, 2 jobs PENDING (Resources)"."""
        kinds = Counter(
            f"{state} ({reason})" if state == "PENDING" and reason != "None" else state
            for state, reason in self.states.values()
        )
        return ", ".join(f"{counted(number, 'job')} {kind}" for kind, number in sorted(kinds.items()))

    def say(self) -> None:
        """Say what the jobs do, when that changes, and every minute until one has started."""
        text, now = self.summary(), time.monotonic()
        if text != self.told or (not self.has_started and now - self.told_s >= REMIND_S):
            waited = f", for {(now - self.started_s) / 60:.0f} min" if text == self.told else ""
            tell(f"SLURM: {text}{waited}")
            self.told, self.told_s = text, now

    def note_progress(self) -> None:
        """Note that a run was finished."""
        self.lost_in_vain = 0

    def release(self, jobs: Sequence[str]) -> None:
        """Cancel some jobs that are not needed any more."""
        jobs = [job for job in jobs if self.states.pop(job, None)]
        if jobs:
            ask(["scancel", *jobs])

    def cancel(self) -> None:
        """Cancel all jobs of the batch, also those that a killed one with the same name has left."""
        self.states.clear()
        with contextlib.suppress(OSError):
            ask(["scancel", f"--user={getpass.getuser()}", f"--name={self.name}"])
