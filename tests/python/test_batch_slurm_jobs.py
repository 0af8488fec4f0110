"""What a batch asks of SLURM, with commands and packages in its place that write down what they are asked."""

from __future__ import annotations

import contextlib
import importlib
import time
from collections.abc import Generator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from pogosim.batch.errors import BatchError
from pogosim.batch.runs.run import Outcome, RunSettings, Task
from pogosim.batch.runs.run_policy import RunPolicy
from pogosim.batch.runs.temporary import TemporaryFolder
from pogosim.batch.workers import queued_workers
from pogosim.batch.workers.backends import by_jobs
from pogosim.batch.workers.cluster_jobs import LOST_PER_JOB, own_folder, with_keys
from pogosim.batch.workers.cluster_jobs import idle as idle_of
from pogosim.batch.workers.queued_workers import EVERY_JOB, QueuedWorkers
from pogosim.batch.workers.slurm import Slurm, bytes_of
from pogosim.batch.workers.slurm_options import SlurmJobs

SBATCH = 'cat > script; echo "sbatch $*" >> asked; echo x >> jobs; echo "$(wc -l < jobs);cluster"'
SQUEUE = 'echo "squeue $*" >> asked; cat states 2>/dev/null'
SCANCEL = 'echo "scancel $*" >> asked'


class Commands:
    """The commands of SLURM: jobs have the numbers 1, 2, ..., and the states that are set."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        for name, lines in (("sbatch", SBATCH), ("squeue", SQUEUE), ("scancel", SCANCEL)):
            self.write(name, lines)

    def write(self, name: str, lines: str) -> None:
        """Write a command."""
        path = self.folder / name
        path.write_text(f"#!/bin/sh\ncd {self.folder}\n{lines}\n")
        path.chmod(0o755)

    def set_states(self, *states: str) -> None:
        """Set what squeue prints: number, state and reason of each job."""
        (self.folder / "states").write_text("".join(f"{state}\n" for state in states))

    def asked(self, name: str) -> list[str]:
        """Return the options of all calls of a command."""
        lines = (self.folder / "asked").read_text().splitlines() if (self.folder / "asked").exists() else []
        return [line.removeprefix(f"{name} ") for line in lines if line.startswith(f"{name} ")]


@pytest.fixture
def commands(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Commands:
    """The commands of SLURM, on the PATH."""
    folder = tmp_path / "bin"
    folder.mkdir()
    monkeypatch.setenv("PATH", str(folder), prepend=":")
    return Commands(folder)


class Jobs(QueuedWorkers):
    """Submitted jobs, whose scheduler has no workers."""

    def __init__(
        self, commands: Commands, wanted: int = 2, cores: int = 1, start_timeout_s: float | None = None
    ) -> None:
        self.slurm = Slurm(SlurmJobs(jobs=wanted))
        super().__init__(self.slurm)
        self.slurm.script, self.slurm.job_name, self.slurm.logs = "#!script\n", "mine", commands.folder
        self.slurm.start_timeout_s = start_timeout_s
        self.cluster = SimpleNamespace(scheduler=SimpleNamespace(workers={}), close=lambda **_: None)
        self.wanted, self.cores = wanted, cores
        self.started_s = time.monotonic()
        self.submit(wanted)

    def look_now(self, left: int = 9) -> None:
        """Look at the jobs now."""
        self.next_look_s = 0.0
        self.poll(left)


# ---- What a job is ----


def settings_of(site: dict[str, Any] | None = None, cores: int = 1, **request: Any) -> dict[str, Any]:
    return Slurm(SlurmJobs(cores=cores, **request)).settings(site or {}, Path("/logs"))


def test_job_has_one_hour_and_two_gigabytes_per_core_by_default() -> None:
    settings = settings_of(cores=3)
    assert settings["cores"] == 3
    assert EVERY_JOB == {"processes": 1, "nanny": False}
    assert (settings["walltime"], settings["job_mem"], settings["memory"]) == ("01:00:00", "6G", 6 * 1024**3)
    assert (settings["queue"], settings["account"]) == (None, None)
    assert (settings["log_directory"], settings["job_extra_directives"]) == ("/logs", [])
    assert settings["worker_extra_args"] == ["--name", "$SLURM_JOB_ID", "--preload", "pogosim.batch.workers.in_job"]


def test_site_says_what_a_job_is_where_the_user_does_not() -> None:
    site = {
        "walltime": "02:00:00",
        "log-directory": "/site",
        "job-extra-directives": ["--site"],
        "worker-extra-args": ["--first"],
        "memory": "9 GB",
    }
    settings = settings_of(site)
    assert (settings["walltime"], settings["log_directory"]) == ("02:00:00", "/site")
    assert settings["worker_extra_args"][:2] == ["--first", "--name"]
    assert not {"memory", "job_mem"} & set(settings)  # dask-jobqueue reads it
    request: dict[str, Any] = {
        "time": "5",
        "memory": "500M",
        "options": ("qos=long", "--exclusive"),
        "account": "a",
        "partition": "p",
    }
    settings = settings_of(site, **request)
    assert (settings["walltime"], settings["job_mem"], settings["memory"]) == ("5", "500M", 500 * 1024**2)
    assert (settings["queue"], settings["account"]) == ("p", "a")
    assert settings["job_extra_directives"] == ["--site", "--qos=long", "--exclusive"]


@pytest.mark.parametrize(
    ("memory", "size"), [("3", 3 * 1024**2), ("3K", 3 * 1024), ("3M", 3 * 1024**2), ("3G", 3 << 30), ("3T", 3 << 40)]
)
def test_units_of_memory_are_those_of_sbatch(memory: str, size: int) -> None:
    assert bytes_of(memory) == size


# ---- Scheduler ----


def task(folder: Path, retries: int = 0) -> Task:
    """Return a run."""
    temporary = TemporaryFolder(folder, "batch", is_kept=False)
    settings = RunSettings(Path("/p"), "", folder, temporary, RunPolicy(retries))
    return Task("key", 0, 0, "", (("data_filename", "d"),), settings)


class Started:
    """The scheduler and the jobs of a batch, with dask-jobqueue's part taken by a class that keeps its arguments."""

    def __init__(self, folder: Path, site: dict[str, Any], tasks: int = 3, retries: int = 0, **request: Any) -> None:
        def cluster(**arguments: Any) -> Any:
            self.arguments = arguments
            scheduler = SimpleNamespace(workers={})
            return SimpleNamespace(job_script=lambda: "#!script\n", scheduler=scheduler, close=lambda **_: None)

        dask = SimpleNamespace(config=SimpleNamespace(collect=lambda: {"jobqueue": {"slurm": site}}))
        security = importlib.import_module("distributed").Security
        client = SimpleNamespace(close=lambda **_: None)
        distributed = SimpleNamespace(Security=security, Client=lambda _: client)
        runs = [task(folder, retries) for _ in range(tasks)]
        self.slurm = Slurm(SlurmJobs(**request))
        with pytest.MonkeyPatch.context() as patched, contextlib.closing(QueuedWorkers(self.slurm)) as self.workers:
            patched.setattr(queued_workers, "imported", lambda *_: (dask, distributed))
            patched.setattr(queued_workers, "imported_jobqueue", lambda _: SimpleNamespace(SLURMCluster=cluster))
            self.workers.do(runs)
            self.keys = sorted(path.name for path in log_folder(folder).iterdir())


def log_folder(folder: Path) -> Path:
    """Return where the logs of jobs are."""
    return folder / "slurm_batch"


@pytest.mark.parametrize(("retries", "allowed"), [(0, 5), (9, 9)])
def test_run_may_lose_five_jobs_or_as_many_as_it_has_retries(
    retries: int, allowed: int, commands: Commands, tmp_path: Path
) -> None:
    options = Started(tmp_path, {}, retries=retries).arguments["scheduler_options"]
    assert options == {"dashboard_address": "127.0.0.1:0", "allowed_failures": allowed}
    assert len(commands.asked("sbatch")) == 3


def test_site_says_how_the_scheduler_is_reached_and_how_many_cores_a_job_has(
    commands: Commands, tmp_path: Path
) -> None:
    # Underscores, too, as in environment variables.
    site = {"scheduler_options": {"interface": "ib0", "dashboard_address": ":1"}, "cores": 2, "memory": None}
    batch = Started(tmp_path, site, tasks=5)
    options = batch.arguments["scheduler_options"]
    assert (options["interface"], options["dashboard_address"], options["allowed_failures"]) == ("ib0", ":1", 5)
    assert (batch.arguments["cores"], batch.arguments["job_mem"]) == (2, "4G")
    assert (batch.workers.cores, batch.workers.wanted, len(commands.asked("sbatch"))) == (2, 3, 3)
    assert Started(tmp_path, site, tasks=5, cores=5, jobs=7).workers.wanted == 1
    assert Started(tmp_path, site, tasks=50, jobs=7, wait_min=2).slurm.start_timeout_s == 120


def test_refused_jobs_leave_no_keys_and_no_folder(commands: Commands, tmp_path: Path) -> None:
    commands.write("sbatch", "echo 'sbatch: error: no such account' >&2; exit 1")
    with pytest.raises(BatchError, match=r"^sbatch refuses the job: no such account$"):
        Started(tmp_path, {})
    assert not log_folder(tmp_path).exists()


def test_keys_and_jobs_go_with_the_batch(commands: Commands, tmp_path: Path) -> None:
    assert Started(tmp_path, {}).keys == ["tls_ca_file.pem", "tls_cert.pem", "tls_key.pem"]
    assert not log_folder(tmp_path).exists()
    assert len(commands.asked("scancel")) == 2  # those of a killed batch, and its own


def test_keys_can_be_read_by_their_owner_only_whatever_was_there(tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir(mode=0o755)
    (folder / "tls_key.pem").touch(mode=0o644)
    own_folder(folder)
    security = with_keys(importlib.import_module("distributed").Security, folder)
    assert folder.stat().st_mode & 0o777 == 0o700
    assert {path.name: path.stat().st_mode & 0o777 for path in folder.iterdir()} == dict.fromkeys(
        ("tls_ca_file.pem", "tls_cert.pem", "tls_key.pem"), 0o600
    )
    assert security.require_encryption
    for role in ("scheduler", "worker", "client"):
        assert security.get_connection_args(role)["ssl_context"] is not None


# ---- Jobs ----


def test_jobs_have_the_script_and_the_name_of_the_batch_and_are_cancelled_by_it(commands: Commands) -> None:
    jobs = Jobs(commands)
    assert commands.asked("sbatch") == ["--parsable --job-name=mine"] * 2
    assert (commands.folder / "script").read_text() == "#!script\n"
    assert list(jobs.slurm.jobs) == ["1", "2"]
    jobs.slurm.cancel(["2", "7"])
    jobs.close()
    released, cancelled = commands.asked("scancel")
    assert released == "2"
    assert cancelled.startswith("--user=")
    assert cancelled.endswith(" --name=mine")


def test_lost_jobs_are_replaced_by_as_many_as_are_still_of_use(commands: Commands) -> None:
    jobs = Jobs(commands, wanted=3, cores=2)
    commands.set_states("1|TIMEOUT|None", "2|RUNNING|None")  # and 3 is forgotten
    jobs.look_now(left=4)
    assert list(jobs.slurm.jobs) == ["2", "4"]
    jobs.look_now(left=0)
    assert len(commands.asked("squeue")) == 1


def test_squeue_is_not_asked_again_and_again(commands: Commands) -> None:
    jobs = Jobs(commands)
    commands.set_states("1|RUNNING|None", "2|RUNNING|None")
    for _ in range(5):
        jobs.poll(2)
    assert len(commands.asked("squeue")) == 1


def test_controller_that_does_not_answer_is_asked_later(commands: Commands) -> None:
    jobs = Jobs(commands)
    commands.write("squeue", "exit 1")
    jobs.look_now()
    assert (list(jobs.slurm.jobs), jobs.lost_in_vain) == (["1", "2"], 0)


def test_batch_ends_when_job_after_job_is_lost_but_not_while_runs_are_finished(commands: Commands) -> None:
    jobs = Jobs(commands, wanted=1)
    commands.set_states()
    for _ in range(LOST_PER_JOB - 1):
        jobs.look_now()
    jobs.lost_in_vain = 0  # as when a run is finished
    for _ in range(LOST_PER_JOB - 1):
        jobs.look_now()
    (commands.folder / f"job-{2 * LOST_PER_JOB - 1}.err").write_text("first\nout of memory\n")
    with pytest.raises(BatchError, match=r"3 jobs have ended since .* ends with: out of memory; if runs need longer"):
        jobs.look_now()


@pytest.mark.parametrize(
    "reason",
    [
        "PartitionConfig",
        "PartitionNodeLimit",
        "PartitionTimeLimit",
        "BadConstraints",
        "DependencyNeverSatisfied",
        "MaxMemPerLimit",
        "InvalidAccount",
        "InvalidQOS",
        "AccountNotAllowed",
        "QOSNotAllowed",
        "AssocMaxWallDurationPerJobLimit",
        "QOSMaxCpuPerJobLimit",
        "QOSMinGRESPerJob",
    ],
)
def test_jobs_that_will_never_start_end_the_batch(reason: str, commands: Commands) -> None:
    jobs = Jobs(commands, wanted=1)
    commands.set_states(f"1|PENDING|{reason}")
    with pytest.raises(BatchError, match=rf"will not start the jobs: 1 job PENDING \({reason}\)"):
        jobs.look_now()


def test_jobs_that_may_start_are_waited_for(commands: Commands) -> None:
    jobs = Jobs(commands)
    for reason in ("Priority", "Resources", "QOSMaxJobsPerUserLimit", "PartitionDown", "AssocGrpCpuLimit"):
        commands.set_states("1|PENDING|BadConstraints", f"2|PENDING|{reason}")
        jobs.look_now()
    commands.set_states("1|PENDING|BadConstraints", "2|RUNNING|None")
    jobs.look_now()
    assert jobs.slurm.has_started


def test_patience_is_for_the_first_job_only(commands: Commands) -> None:
    jobs = Jobs(commands, wanted=1, start_timeout_s=0)
    commands.set_states("1|RUNNING|None")
    jobs.look_now()
    commands.set_states("1|PENDING|Priority")  # put back
    jobs.look_now()
    jobs.slurm.has_started = False
    with pytest.raises(BatchError, match=r"within --slurm-wait: 1 job PENDING \(Priority\)"):
        jobs.look_now()


@pytest.mark.parametrize(
    ("assigned", "left", "idle"),
    [
        ({"1": 1, "2": 0}, 1, ["2", "3"]),  # the only run that is left is done in 1
        ({"1": 2, "2": 0}, 2, ["2", "3"]),
        ({"1": 3, "2": 0}, 3, []),  # one of three waits for a core: a job may take it
        ({"1": 1}, 2, []),
        ({}, 1, []),
    ],
)
def test_job_is_idle_when_all_runs_that_are_left_are_being_done_in_others(
    assigned: dict[str, int], left: int, idle: list[str]
) -> None:
    assert idle_of(["1", "2", "3"], assigned, 2, left) == idle


@pytest.mark.parametrize("problem", ["", "exit code 3"])
def test_run_that_ends_is_progress_and_logs_stay_if_it_failed(
    problem: str, commands: Commands, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def ended(*_: object) -> Generator[Outcome, None, None]:
        yield Outcome("key", problem)

    monkeypatch.setattr(queued_workers, "outcomes_of", ended)
    workers = Jobs(commands)
    workers.folder = own_folder(log_folder(tmp_path))
    workers.lost_in_vain = 2
    assert [outcome.problem for outcome in workers.do([task(tmp_path)])] == [problem]
    assert workers.lost_in_vain == 0
    workers.close()
    assert log_folder(tmp_path).exists() == bool(problem)


def test_batch_without_runs_needs_no_jobs(commands: Commands) -> None:
    with by_jobs(SlurmJobs(), keep_idle=False) as do:
        assert list(do([])) == []
    assert commands.asked("sbatch") == []
