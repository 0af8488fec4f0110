"""Batches in jobs of PBS, Grid Engine and LSF, whose commands run the jobs on this machine."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pandas as pd
import pytest
from batches import ENVIRONMENT, arguments, batch, results, script
from batches import write_options as write
from pogosim.batch.errors import BatchError
from pogosim.batch.workers import jobqueue
from pogosim.batch.workers.jobqueue import JobqueueSystem, words_of
from pogosim.batch.workers.jobqueue_options import CLUSTERS, QueuedJobs, setting
from running import Run, example
from searches import COMMAND as SEARCH
from searches import history, search, write_search
from searches import options as search_options

RUNS = ("-r", "3")
# Each system: the command that submits jobs, which is given a script or reads it, what it says, and what cancels them.
SYSTEMS = {
    "pbs": ("qsub", "{job}.server", "qdel"),
    "sge": ("qsub", 'Your job {job} ("dask-worker") has been submitted', "qdel"),
    "lsf": ("bsub", "Job <{job}> is submitted to default queue <normal>.", "bkill"),
}
SUBMIT = """
read -r job < "{folder}/next"; echo $((job + 1)) > "{folder}/next"
cat "$@" > "{folder}/script.$job"
setsid bash "{folder}/script.$job" > "{folder}/log.$job" 2>&1 < /dev/null &
echo $! > "{folder}/group.$job"
echo "{says}"
"""
CANCEL = """
for job; do
    job=${{job%.server}}
    echo "$job" >> "{folder}/cancelled"
    kill -TERM -- "-$(cat "{folder}/group.$job")" 2>/dev/null
done
true
"""


class Site:
    """The commands of a batch system; a job is a process group on this machine."""

    def __init__(self, folder: Path, system: str) -> None:
        self.folder = folder
        self.system = system
        submit, says, cancel = SYSTEMS[system]
        (folder / "bin").mkdir(parents=True)
        (folder / "next").write_text("1\n")
        self.submit = folder / "bin" / submit
        self.command(submit, SUBMIT.format(folder=folder, says=says.replace('"', r"\"").format(job="$job")))
        self.command(cancel, CANCEL.format(folder=folder))
        upper = system.upper()
        self.environment = {
            **ENVIRONMENT,
            "PATH": f"{folder / 'bin'}:{os.environ['PATH']}",
            "HOME": str(folder),
            # Root's and users' own settings stay out; the scheduler listens on this machine only.
            f"DASK_JOBQUEUE__{upper}__INTERFACE": "lo",
            f"DASK_JOBQUEUE__{upper}__DEATH_TIMEOUT": "20",
        }

    def command(self, name: str, text: str) -> None:
        """Make a command."""
        path = self.folder / "bin" / name
        path.write_text(f"#!/bin/bash\n{text}")
        path.chmod(0o755)

    def jobs(self) -> list[int]:
        """Return the process groups of the jobs that were submitted."""
        return [int(path.read_text()) for path in sorted(self.folder.glob("group.*"))]

    def alive(self) -> list[int]:
        """Return the process groups of the jobs that have not ended."""
        return [group for group in self.jobs() if is_alive(group)]

    def scripts(self) -> list[str]:
        """Return the scripts of the jobs that were submitted."""
        return [path.read_text() for path in sorted(self.folder.glob("script.*"))]


def is_alive(group: int) -> bool:
    """Return whether a process group has processes that have not ended."""
    said = subprocess.run(["ps", "-o", "stat=", "-g", str(group)], capture_output=True, text=True, check=False)
    return any(not line.startswith("Z") for line in said.stdout.split())


def wait_until(is_so: Callable[[], object]) -> None:
    """Wait until something is so."""
    for _ in range(1200):
        if is_so():
            return
        time.sleep(0.05)
    raise AssertionError("it does not happen")


def do(site: Site, folder: Path, *more: str, program: Path | None = None) -> Run:
    """Do a batch in a folder with many.yaml."""
    command = arguments(program or example("helloworld"), *RUNS, "--jobqueue", site.system, *more)
    done = subprocess.run(
        command, cwd=folder, env=site.environment, capture_output=True, text=True, timeout=120, check=False
    )
    return Run(done.returncode, done.stdout, done.stderr, folder)


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The results of a batch on this machine."""
    folder = tmp_path_factory.mktemp("undisturbed")
    write(folder)
    assert batch(folder, *RUNS).code == 0
    return results(folder)


@pytest.mark.parametrize("system", SYSTEMS)
def test_jobs_do_the_runs_and_leave_nothing_but_the_same_bytes(
    system: str, undisturbed: dict[str, bytes], tmp_path: Path
) -> None:
    site, folder = Site(tmp_path / "site", system), tmp_path / "batch"
    folder.mkdir()
    write(folder)
    settings = ("--jobqueue-set", "queue=short", "--jobqueue-set", "walltime=00:10", "--jobqueue-set", "cores=2")
    result = do(site, folder, "--jobqueue-jobs", "2", *settings)
    assert (result.code, result.errors) == (0, "")
    assert f"{system}: submitted 2 jobs of 2 cores; logs: " in result.output
    assert results(folder) == undisturbed
    assert sorted(path.name for path in folder.iterdir()) == ["many.yaml", "results"]
    wait_until(lambda: not site.alive())
    assert len(site.scripts()) == 2
    for text in site.scripts():
        assert " -q short\n" in text
        assert "00:10\n" in text
        assert "--nthreads 2" in text


def test_settings_of_the_site_are_those_of_its_file(undisturbed: dict[str, bytes], tmp_path: Path) -> None:
    site, folder = Site(tmp_path / "site", "pbs"), tmp_path / "batch"
    folder.mkdir()
    write(folder)
    file = site.folder / ".config" / "dask" / "jobqueue.yaml"
    file.parent.mkdir(parents=True)
    logs = tmp_path / "logs"
    file.write_text(
        "jobqueue:\n  pbs:\n    queue: long\n    cores: 3\n    memory: 5GB\n    interface: lo\n"
        f"    log-directory: {logs}\n    job-extra-directives: ['-m n']\n"
    )
    result = do(site, folder, "--jobqueue-jobs", "1", "--jobqueue-set", "queue=short")
    assert (result.code, result.errors) == (0, "")
    assert results(folder) == undisturbed
    (text,) = site.scripts()
    assert "#PBS -q short\n" in text
    assert "#PBS -m n\n" in text
    assert f"#PBS -o {logs}" in text
    assert "--nthreads 3 --memory-limit 4.66GiB" in text


def test_run_of_a_lost_job_is_done_again_in_another(undisturbed: dict[str, bytes], tmp_path: Path) -> None:
    site, folder, sign = Site(tmp_path / "site", "sge"), tmp_path / "batch", tmp_path / "go"
    folder.mkdir()
    write(folder)
    gated = script(tmp_path / "gated", f"until [ -e '{sign}' ]; do sleep 0.05; done")
    command = arguments(gated, *RUNS, "-R", "0", "--jobqueue", "sge", "--jobqueue-jobs", "2")
    with subprocess.Popen(
        command, cwd=folder, env=site.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        wait_until(lambda: len(list(folder.glob("tmp/sim_*"))) > 1 or process.poll() is not None)
        os.killpg(site.jobs()[0], signal.SIGKILL)
        wait_until(lambda: len(site.jobs()) == 3 or process.poll() is not None)
        sign.touch()
        output, errors = process.communicate(timeout=100)
    assert (process.returncode, errors) == (0, "")
    assert "sge: job 1 has ended before the batch; its runs are done again" in output
    assert results(folder) == undisturbed
    wait_until(lambda: not site.alive())


def test_interrupted_batch_cancels_its_jobs(tmp_path: Path) -> None:
    site, folder = Site(tmp_path / "site", "pbs"), tmp_path / "batch"
    folder.mkdir()
    write(folder)
    endless = script(tmp_path / "endless", "sleep 100")
    command = arguments(endless, *RUNS, "--jobqueue", "pbs", "--jobqueue-jobs", "2")
    with subprocess.Popen(
        command, cwd=folder, env=site.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        wait_until(lambda: len(list(folder.glob("tmp/sim_*"))) > 1 or process.poll() is not None)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
    assert process.returncode == 130
    wait_until(lambda: not site.alive())


def test_search_keeps_its_jobs_from_generation_to_generation(tmp_path: Path) -> None:
    site = Site(tmp_path / "site", "pbs")
    for name in ("here", "there"):
        write_search(tmp_path / name)
    settings = ("--max-evals", "15", "--final-runs", "2")  # three generations
    assert search(tmp_path / "here", *settings).code == 0
    folder = tmp_path / "there"
    command = [*SEARCH, *search_options(*settings, "--jobqueue", "pbs", "--jobqueue-jobs", "2")]
    result = subprocess.run(
        command, cwd=folder, env=site.environment, capture_output=True, text=True, timeout=100, check=False
    )
    assert result.returncode == 0, result.stderr
    assert len(site.scripts()) == 2
    pd.testing.assert_frame_equal(history(folder), history(tmp_path / "here"))


# ---- what cannot be done ----


def test_batch_system_that_refuses_jobs_is_quoted(tmp_path: Path) -> None:
    site, folder = Site(tmp_path / "site", "pbs"), tmp_path / "batch"
    folder.mkdir()
    write(folder)
    site.submit.write_text("#!/bin/sh\necho 'qsub: Unknown queue MSG=cannot locate queue' >&2\nexit 170\n")
    result = do(site, folder)
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert "--jobqueue pbs: the job is refused: qsub: Unknown queue MSG=cannot locate queue" in line


def test_missing_command_is_named(tmp_path: Path) -> None:
    site, folder = Site(tmp_path / "site", "lsf"), tmp_path / "batch"
    folder.mkdir()
    write(folder)
    site.submit.unlink()
    result = do(site, folder)
    assert result.code == 2
    assert "--jobqueue lsf: there is no command 'bsub'; run it where you submit jobs" in result.errors


def test_unknown_setting_is_named(tmp_path: Path) -> None:
    site, folder = Site(tmp_path / "site", "pbs"), tmp_path / "batch"
    folder.mkdir()
    write(folder)
    result = do(site, folder, "--jobqueue-set", "colour=red")
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert "colour" in line
    assert "--jobqueue-set" in line


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        (("--jobqueue", "torque"), f"--jobqueue: expected one of {', '.join(CLUSTERS)}; found 'torque'"),
        (("--jobqueue", "slurm"), "--jobqueue slurm: SLURM has options of its own; use --slurm"),
        (("--jobqueue", "pbs", "--slurm"), "--slurm and --jobqueue: one of them does the runs"),
        (
            ("--jobqueue", "pbs", "--jobqueue-jobs", "0"),
            "--jobqueue-jobs: expected a whole number of at least 1; found 0",
        ),
        (("--jobqueue", "pbs", "--jobqueue-set", "queue"), "--jobqueue-set: expected KEY=VALUE, such as queue=short"),
        (("--jobqueue", "pbs", "--jobqueue-set", "cores=0.5"), "--jobqueue-set cores: expected a whole number of at"),
        (("--jobqueue", "pbs", "--jobqueue-set", "a=[1"), "--jobqueue-set a=[1: the value is no YAML"),
        (
            ("--jobqueue", "pbs", "--jobqueue-set", "cores=null"),
            "--jobqueue-set cores=null: expected a value, found",
        ),
        (("--jobqueue", "pbs", "--jobqueue-set", "nanny=true"), "--jobqueue-set nanny: batches set it themselves"),
        (("--jobqueue", "pbs", "--jobqueue-set", "scheduler-options=3"), "scheduler_options: expected a map, such as"),
        (("--jobqueue", "pbs", "--jobqueue-set", "worker_extra_args=x"), "worker_extra_args: expected a list of texts"),
        (("--jobqueue-jobs", "3"), "--jobqueue-jobs goes with --jobqueue SYSTEM"),
        (("--jobqueue-set", "a=b"), "--jobqueue-set goes with --jobqueue SYSTEM"),
        (("--jobqueue", "pbs", "--workers", "3"), "--jobqueue goes without --backend, --scheduler and --workers; see"),
    ],
)
def test_wrong_options_are_refused(more: tuple[str, ...], expected: str, tmp_path: Path) -> None:
    write(tmp_path)
    result = batch(tmp_path, *RUNS, *more)
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert expected in line


def test_settings_are_yaml_but_for_times() -> None:
    assert setting("cores=8") == ("cores", 8)
    assert setting("walltime=10:30:00") == ("walltime", "10:30:00")
    assert setting("job-extra-directives=['-m n', '-r y']") == ("job_extra_directives", ["-m n", "-r y"])
    assert setting("resource_spec=select=1") == ("resource_spec", "select=1")


def test_classes_are_those_of_dask_jobqueue() -> None:
    classes = pytest.importorskip("dask_jobqueue")
    for system, name in CLUSTERS.items():
        assert getattr(classes, name).job_cls.config_name == system


def test_jobs_are_checked_in_python_too() -> None:
    with pytest.raises(BatchError, match="expected one of pbs"):
        QueuedJobs("condor")


def test_jobs_that_have_not_joined_are_counted(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(jobqueue, "REMIND_S", 0.0)
    system = JobqueueSystem(QueuedJobs("pbs"))
    system.jobs = {str(number): SimpleNamespace(job_id=f"{number}.server") for number in range(4)}
    said = []
    for joined in ([], ["0"], ["1", "2", "3"]):
        system.joined.update(joined)
        system.report(since_s=3.0)
        said.append("".join(capsys.readouterr()))
    assert "pbs: no job has joined the batch yet" in said[0]
    assert "pbs: 3 of 4 jobs have not joined the batch yet, for 0 min (the first: 1.server)" in said[1]
    assert said[2] == ""


def test_words_of_a_refusal_are_those_of_the_command() -> None:
    said = "Command exited with non-zero exit code.\nExit code: 1\nstdout:\n\nstderr:\nno such\nqueue\n"
    assert words_of(RuntimeError(said)) == "no such; queue"
    assert words_of(ValueError("Could not parse job id")) == "Could not parse job id"
