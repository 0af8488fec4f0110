"""Batches in jobs of a real SLURM, with one node, that is started for these tests."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pandas as pd
import pytest
from batches import COMMAND, ENVIRONMENT, arguments, batch, results, saved_states, script, wait_until_gone
from batches import write_options as write
from pogosim.extras import installing
from pogosim.utils import load_dataframe
from running import ROOT, Run, example, run_command
from searches import COMMAND as SEARCH
from searches import history, search, write_search
from searches import options as search_options

RUNS = ("-r", "3")
JOBS = ("--slurm", "--slurm-jobs", "2", "--slurm-memory", "500M")
# Root's and users' own settings stay out; the scheduler listens on this machine only.
SITE = {"DASK_JOBQUEUE__SLURM__INTERFACE": "lo", "DASK_JOBQUEUE__SLURM__DEATH_TIMEOUT": "20"}

# SLURM is among the packages that bootstrap.sh installs for tests: if it is missing or does not start, they fail.
pytestmark = pytest.mark.skipif(
    sys.platform != "linux" or (os.environ.get("POGOSIM_PACKAGES") == "skip" and not shutil.which("sbatch")),
    reason="SLURM is not installed, and packages are not to be",
)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, str]]:
    """The environment of a user of a cluster with a node of 4 cores."""
    home = tmp_path_factory.mktemp("home")
    command = [str(ROOT / "tests" / "slurm" / "one_node.sh"), "sh", "-c", 'echo "$SLURM_CONF"; cat']
    cluster = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert cluster.stdin is not None
    assert cluster.stdout is not None
    assert cluster.stderr is not None
    configuration = cluster.stdout.readline().strip()
    assert configuration, cluster.stderr.read()
    yield {**ENVIRONMENT, **SITE, "SLURM_CONF": configuration, "HOME": str(home)}
    _, errors = cluster.communicate()
    assert (cluster.returncode, errors) == (0, "")
    assert not Path(configuration).parent.exists()


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The results of a batch on this machine."""
    folder = tmp_path_factory.mktemp("undisturbed")
    write(folder)
    assert batch(folder, *RUNS).code == 0
    return results(folder)


def start(folder: Path, site: dict[str, str], *more: str, program: Path | None = None) -> subprocess.Popen[str]:
    """Start a batch in a folder with many.yaml. Ctrl-C reaches it alone."""
    return subprocess.Popen(
        arguments(program or example("helloworld"), *RUNS, *JOBS, *more),
        cwd=folder,
        env=site,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def ended(process: subprocess.Popen[str], folder: Path) -> Run:
    """Wait for the end of a batch."""
    output, errors = process.communicate(timeout=100)
    return Run(process.returncode, output, errors, folder)


def lines_until(word: str, process: subprocess.Popen[str]) -> str:
    """Return the lines that a batch has printed up to one with this word."""
    assert process.stdout is not None
    lines = ""
    while word not in lines:
        line = process.stdout.readline()
        assert line, f"it ended without {word}: {lines}"
        lines += line
    return lines


def ask(site: dict[str, str], *command: str) -> list[str]:
    """Return the lines that a command of SLURM prints."""
    return subprocess.run(command, env=site, capture_output=True, text=True, check=True).stdout.split("\n")[:-1]


def jobs(site: dict[str, str], *more: str) -> list[str]:
    """Return the jobs that have not ended."""
    return ask(site, "squeue", "--noheader", "--format=%i", *more)


def wait_until(is_so: Callable[[], object]) -> None:
    """Wait until something is so."""
    for _ in range(1200):
        if is_so():
            return
        time.sleep(0.05)
    raise AssertionError("it does not happen")


class Gate:
    """A program whose runs wait until they are let through."""

    def __init__(self, folder: Path) -> None:
        self.sign = folder / "go"
        self.program = script(folder / "gated", f"until [ -e '{self.sign}' ]; do sleep 0.05; done")

    def open(self) -> None:
        """Let all runs through."""
        self.sign.touch()


@pytest.fixture
def gate(tmp_path_factory: pytest.TempPathFactory) -> Gate:
    """A program whose runs wait."""
    return Gate(tmp_path_factory.mktemp("gate"))


def wait_for_simulators(folder: Path, process: subprocess.Popen[str]) -> None:
    """Wait until a run has begun in each of two jobs."""
    wait_until(lambda: len(list(folder.glob("tmp/sim_*"))) > 1 or process.poll() is not None)
    assert process.poll() is None, process.communicate()


def test_jobs_do_the_runs_and_leave_nothing_but_the_same_bytes(
    site: dict[str, str], undisturbed: dict[str, bytes], gate: Gate, tmp_path: Path
) -> None:
    write(tmp_path)
    more = ("--slurm-cores", "2", "--slurm-time", "10", "--slurm-partition", "main", "--slurm-option", "comment=mine")
    process = start(tmp_path, site, *more, program=gate.program)
    said = lines_until("RUNNING", process)
    gate.open()
    result = ended(process, tmp_path)
    assert (result.code, result.errors) == (0, "")
    assert "SLURM: submitted 2 jobs of 2 cores" in said
    assert results(tmp_path) == undisturbed
    assert sorted(path.name for path in tmp_path.iterdir()) == ["many.yaml", "results"]
    wait_until(lambda: not jobs(site))
    used = ask(site, "squeue", "--states=all", "--noheader", "--format=%C %l %P %k")
    assert set(used) == {"2 10:00 main mine"}


def test_array_of_jobs_does_a_batch_in_parts(
    site: dict[str, str], undisturbed: dict[str, bytes], tmp_path: Path
) -> None:
    write(tmp_path)
    part = "--part $SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT -t jobs/$SLURM_ARRAY_TASK_ID"
    command = f"{' '.join(COMMAND)} run -c many.yaml -S {example('helloworld')} --seeds 0:2 --retry-same-seed {part}"
    said = ask(site, "sbatch", "--wait", "--array=0-2", "--mem=200M", f"--chdir={tmp_path}", "--wrap", command)
    assert "Submitted batch job" in said[0]
    merging = [*COMMAND, "merge", "jobs", "-o", "results", "-c", "many.yaml"]
    merged = subprocess.run(merging, cwd=tmp_path, env=site, capture_output=True, text=True, check=False, timeout=60)
    assert (merged.returncode, merged.stderr) == (0, "")
    rows, _ = load_dataframe(tmp_path / "results" / "result.feather")
    expected = tmp_path / "undisturbed.feather"
    expected.write_bytes(undisturbed["result.feather"])
    pd.testing.assert_frame_equal(
        rows.drop(columns=["seed", "retry_attempt"]), load_dataframe(expected)[0], check_like=True
    )


def test_search_keeps_its_jobs_from_generation_to_generation(site: dict[str, str], tmp_path: Path) -> None:
    for name in ("here", "there"):
        write_search(tmp_path / name)
    settings = ("--max-evals", "15", "--final-runs", "2")  # three generations
    assert search(tmp_path / "here", *settings).code == 0
    folder = tmp_path / "there"
    command = [*SEARCH, *search_options(*settings, *JOBS)]
    result = subprocess.run(command, cwd=folder, env=site, capture_output=True, text=True, timeout=100, check=False)
    assert result.returncode == 0, result.stderr
    assert result.stdout.count("SLURM: submitted 2 jobs of 1 core") == 1
    pd.testing.assert_frame_equal(history(folder), history(tmp_path / "here"))
    assert sorted(path.name for path in folder.iterdir()) == ["obj.py", "opt_out", "space.yaml"]
    wait_until(lambda: not jobs(site))


def test_run_of_a_cancelled_job_is_done_again_in_another(
    site: dict[str, str], undisturbed: dict[str, bytes], gate: Gate, tmp_path: Path
) -> None:
    write(tmp_path)
    process = start(tmp_path, site, "-R", "0", program=gate.program)
    wait_for_simulators(tmp_path, process)
    lost, kept = jobs(site)
    ask(site, "scancel", lost)
    wait_until(lambda: set(jobs(site)) - {lost, kept})
    gate.open()
    result = ended(process, tmp_path)
    assert (result.code, result.errors) == (0, "")
    assert f"SLURM: job {lost} has ended before the batch (CANCELLED); its runs are done again" in result.output
    assert results(tmp_path) == undisturbed
    assert sorted(path.name for path in tmp_path.iterdir()) == ["many.yaml", "results"]


def test_run_of_a_cancelled_job_goes_on_in_another(site: dict[str, str], tmp_path: Path) -> None:
    """A job at its time limit is ended in the same way: SIGTERM to all its processes."""
    changes: dict[str, object] = {"simulation_time": 1000.0, "time_step": 0.002, "objects.robots.nb": 2}
    write(tmp_path / "whole", changes)
    assert batch(tmp_path / "whole", *RUNS).code == 0
    write(tmp_path / "slurm", changes)
    process = start(tmp_path / "slurm", site, "--save-states", "0.02")
    try:
        end_s, cancelled = time.monotonic() + 90, 0
        while process.poll() is None and time.monotonic() < end_s and cancelled < 2:
            states = saved_states(tmp_path / "slurm" / "tmp")
            running = jobs(site, "--states=RUNNING")
            if states and running:
                ask(site, "scancel", running[0])
                cancelled += 1
                time.sleep(3)
            time.sleep(0.1)
        done = ended(process, tmp_path / "slurm")
    finally:
        process.kill()
    assert done.code == 0, done.text
    assert cancelled > 0
    assert "begins anew" not in done.errors
    assert results(tmp_path / "slurm") == results(tmp_path / "whole")


def test_jobs_of_a_killed_batch_leave_and_the_same_command_continues(
    site: dict[str, str], undisturbed: dict[str, bytes], gate: Gate, tmp_path: Path
) -> None:
    write(tmp_path)
    process = start(tmp_path, site, program=gate.program)
    wait_for_simulators(tmp_path, process)
    process.kill()
    process.communicate()
    wait_until_gone(tmp_path)
    wait_until(lambda: not jobs(site))
    gate.open()
    final = ended(start(tmp_path, site, program=gate.program), tmp_path)
    assert (final.code, final.errors) == (0, "")
    assert results(tmp_path) == undisturbed
    assert sorted(path.name for path in tmp_path.iterdir()) == ["many.yaml", "results"]


def test_interrupt_cancels_the_jobs(site: dict[str, str], tmp_path: Path) -> None:
    write(tmp_path)
    for number in (signal.SIGINT, signal.SIGTERM):
        process = start(tmp_path, site)
        wait_until(lambda: ((tmp_path / "tmp").exists() and jobs(site)) or process.poll() is not None)  # noqa: B023
        process.send_signal(number)
        result = ended(process, tmp_path)
        assert (result.code, result.errors.count("\n")) == (130, 1), result.errors
        assert "interrupted" in result.errors
        assert "in tmp" in result.errors
        wait_until(lambda: not jobs(site))


def test_jobs_that_end_again_and_again_end_the_batch_with_the_last_words_of_their_log(
    site: dict[str, str], tmp_path: Path
) -> None:
    write(tmp_path)
    broken = {**site, "DASK_JOBQUEUE__SLURM__PYTHON": "/no/such/python"}
    result = ended(start(tmp_path, broken), tmp_path)
    assert result.code == 2
    assert result.errors.startswith("pogobatch: SLURM: 6 jobs have ended since a run was finished, the last one, ")
    assert "/no/such/python: No such file or directory" in result.errors
    assert result.errors.count("\n") == 1


@pytest.mark.parametrize(
    ("options", "what"),
    [
        (["--slurm-partition", "nowhere"], "sbatch refuses the job: invalid partition specified: nowhere; Batch job"),
        (["--slurm-time", "2-0"], "SLURM will not start the jobs: "),
        (
            ["--slurm-partition", "closed", "--slurm-wait", "0"],
            "no job has started within --slurm-wait: 2 jobs PENDING (PartitionDown)",
        ),
    ],
)
def test_jobs_that_slurm_does_not_want_are_one_line(
    options: list[str], what: str, site: dict[str, str], tmp_path: Path
) -> None:
    write(tmp_path)
    result = ended(start(tmp_path, site, *options), tmp_path)
    assert result.code == 2
    assert what in result.errors
    assert result.errors.count("\n") == 1
    assert jobs(site) == []
    assert sorted(path.name for path in tmp_path.iterdir()) == ["many.yaml", "results"]


@pytest.mark.parametrize(
    ("options", "what"),
    [
        (["--slurm", "--slurm-time", "4h"], "--slurm-time: expected minutes, hours:minutes:seconds or days-hours"),
        (["--slurm", "--slurm-time", "1:60:00"], "--slurm-time: expected minutes, hours:minutes:seconds"),
        (["--slurm", "--slurm-memory", "lots"], "--slurm-memory: expected a number with K, M, G or T, such as 4G"),
        (["--slurm", "--slurm-jobs", "0"], "--slurm-jobs: expected a whole number of at least 1; found 0"),
        (["--slurm", "--slurm-cores", "0"], "--slurm-cores: expected a whole number of at least 1; found 0"),
        (["--slurm", "--slurm-option", ""], "--slurm-option: expected one line of text; found ''"),
        (["--slurm", "-j", "4"], "--slurm goes without --backend, --scheduler and --workers"),
        (["--slurm-cores", "4"], "--slurm-cores goes with --slurm"),
    ],
)
def test_wrong_option_for_slurm_is_one_line(options: list[str], what: str, tmp_path: Path) -> None:
    write(tmp_path)
    result = batch(tmp_path, *options)
    assert (result.code, result.errors.count("\n")) == (2, 1)
    assert what in result.errors


def test_missing_slurm_and_missing_package_are_one_line(tmp_path: Path) -> None:
    write(tmp_path)
    options = [*arguments(example("helloworld"), "--slurm")[len(COMMAND) :]]
    hidden = tmp_path / "hidden"
    hidden.mkdir()
    for name, said in (("", "there is no command 'sbatch'"), ("dask_jobqueue", installing("slurm"))):
        if name:
            (hidden / f"{name}.py").write_text("raise ImportError('not installed')\n")
        command = [f"PATH={hidden}", f"PYTHONPATH={hidden}", f"HOME={tmp_path}", *COMMAND, *options]
        result = run_command(Path("/usr/bin/env"), tmp_path, command)
        assert (result.code, result.errors.count("\n")) == (2, 1), result.errors
        assert said in result.errors
