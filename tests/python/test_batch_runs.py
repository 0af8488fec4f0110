"""Nothing is lost: crashes, killed runs, killed and interrupted batches."""

from __future__ import annotations

import contextlib
import os
import random
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from batches import batch, ended, results, script, simulators_in, start_batch, wait_for_simulators, wait_until_gone
from batches import write_options as write
from pogosim.utils import load_dataframe

# Long enough to be killed on the way: a second of wall-clock time.
LONG: dict[str, object] = {"simulation_time": 4000.0, "save_data_period": 40.0}
RUNS = ("-r", "3", "-j", "2")

INTERRUPTED = re.compile(
    r"pogobatch: interrupted(: \d+ finished runs? (is|are)|; finished runs are kept) in tmp[;:] .* continues"
)

# A cluster of two workers, whose address is printed.
DASK = """
import sys
from distributed import LocalCluster
if __name__ == "__main__":
    cluster = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address="127.0.0.1:0")
    print(cluster.scheduler_address, flush=True)
    sys.stdin.read()
"""

linux_only = pytest.mark.skipif(sys.platform != "linux", reason="needs /proc and parent-death signals")


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The results of an undisturbed batch."""
    folder = tmp_path_factory.mktemp("undisturbed")
    write(folder, LONG)
    assert batch(folder, *RUNS).code == 0
    return results(folder)


def test_run_that_crashes_is_repeated_and_leaves_no_trace(tmp_path: Path) -> None:
    write(tmp_path)
    expected = tmp_path / "expected"
    write(expected)
    assert batch(expected, "-r", "3").code == 0
    flaky = script(
        tmp_path / "flaky",
        "n=$(ls -d $(dirname $0)/tried.$seed.* 2>/dev/null | wc -l); "
        'mkdir "$(dirname $0)/tried.$seed.$n.$$"; [ "$seed" = 1 ] && [ "$n" -lt 4 ] && kill -SEGV $$',
    )
    result = batch(tmp_path, "-r", "3", program=flaky)
    assert (result.code, result.errors) == (0, "")
    assert results(tmp_path) == results(expected)


def test_run_that_always_crashes_is_reported_and_spoils_no_other(tmp_path: Path) -> None:
    write(tmp_path, {"objects.robots.nb": 2})
    broken = script(tmp_path / "broken", '[ "$seed" = 1 ] && { echo first; echo "last words" >&2; exit 3; }')
    result = batch(tmp_path, "-r", "3", "-R", "1", program=broken)
    assert result.code == 3
    assert "run 1 of results/result.feather, seed 1, failed 2 times: exit code 3" in result.errors
    assert "| last words" in result.errors
    (command,) = [line.split("command: ")[1] for line in result.errors.splitlines() if "command: " in line]
    again = ended(["sh", "-c", command], tmp_path)
    assert (again.code, again.text) == (3, "first\nlast words\n")
    rows, metadata = load_dataframe(tmp_path / "results" / "result.feather")
    assert sorted(set(rows["run"])) == [0, 2]
    assert metadata["combinations"][0]["failed_runs"] == [1]
    assert len(list((tmp_path / "tmp").glob("sim_*"))) == 1


def test_run_whose_configuration_is_refused_is_not_tried_again(tmp_path: Path) -> None:
    write(tmp_path, {"objects.robots.nb": [10, 20]})
    result = batch(tmp_path, "-r", "1")
    assert result.code == 3
    assert "run 0 of results/result.feather, seed 0, failed 1 time: exit code 2" in result.errors
    assert "objects.robots.nb: expected an integer from 0 to 10000000, found a list; several values" in result.errors
    assert "{batch_options: [...], default_option: ...}" in result.errors
    assert result.output.splitlines()[-1] == "Batch run ended without an output file."


def test_batch_whose_runs_all_fail_writes_nothing_and_says_so(tmp_path: Path) -> None:
    write(tmp_path)
    result = batch(tmp_path, "-r", "4", "-R", "0", program=script(tmp_path / "broken", "exit 9"))
    assert result.code == 3
    assert "results/result.feather is not written: none of its runs ended well" in result.errors
    assert "3 more runs failed" in result.errors
    assert results(tmp_path) == {}


@linux_only
def test_killed_simulators_are_started_again(tmp_path: Path, undisturbed: dict[str, bytes]) -> None:
    write(tmp_path, LONG)
    chance = random.Random(1)
    process = start_batch(tmp_path, *RUNS)
    for _ in range(4):
        victims = wait_for_simulators(tmp_path, process)
        time.sleep(chance.uniform(0, 0.1))
        for victim in victims[:1]:
            with contextlib.suppress(ProcessLookupError):
                os.kill(victim, signal.SIGKILL)
    _, errors = process.communicate(timeout=60)
    assert (process.returncode, errors) == (0, "")
    assert results(tmp_path) == undisturbed


@linux_only
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT, signal.SIGTERM])
def test_batch_that_is_killed_again_and_again_continues(
    number: signal.Signals, tmp_path: Path, undisturbed: dict[str, bytes]
) -> None:
    write(tmp_path, LONG)
    chance = random.Random(int(number))
    killed = 0
    for _ in range(4):
        process = start_batch(tmp_path, *RUNS)
        wait_for_simulators(tmp_path, process)
        time.sleep(chance.uniform(0, 0.4))
        process.send_signal(number)
        _, errors = process.communicate(timeout=60)
        wait_until_gone(tmp_path)
        if process.returncode == 0:
            break
        killed += 1
        assert process.returncode in (-signal.SIGKILL, 130)
        if process.returncode == 130:
            assert INTERRUPTED.fullmatch(errors.splitlines()[-1])
        assert set(results(tmp_path)) <= set(undisturbed) | {".result.feather.pogobatch-new"}
    assert killed > 0
    final = batch(tmp_path, *RUNS)
    assert (final.code, final.errors) == (0, "")
    assert results(tmp_path) == undisturbed
    assert sorted(path.name for path in tmp_path.iterdir()) == ["many.yaml", "results"]


@linux_only
@pytest.mark.parametrize("delay_s", [0, 0.02, 0.05, 0.1, 0.2])
def test_batch_that_is_interrupted_after_its_last_line_has_ended_well(delay_s: float, tmp_path: Path) -> None:
    write(tmp_path)
    process = start_batch(tmp_path, "-r", "1")
    assert process.stdout
    while not process.stdout.readline().startswith(" - "):
        pass
    time.sleep(delay_s)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode in (0, 130)
    assert not errors or (process.returncode == 130 and INTERRUPTED.fullmatch(errors.rstrip("\n")))


def interrupted(folder: Path) -> None:
    """Leave a batch of which one of four runs is missing."""
    broken = script(folder / "simulator", '[ "$seed" = 3 ] && exit 3')
    assert batch(folder, "-r", "4", "-R", "0", program=broken).code == 3


@pytest.mark.parametrize(
    ("change", "kept"),
    [
        ({}, 3),
        ({"result_filename_format": "other.feather"}, 3),
        ({"simulation_time": 1.5}, 0),
        ({"objects.robots.radius": 20}, 0),
    ],
)
def test_finished_runs_count_only_for_the_same_configuration(
    change: dict[str, object], kept: int, tmp_path: Path
) -> None:
    world: dict[str, object] = {"objects.robots.nb": 2}
    write(tmp_path, world)
    interrupted(tmp_path)
    write(tmp_path, {**world, **change})
    result = batch(tmp_path, "-r", "4", "-R", "0", program=tmp_path / "simulator")
    assert (f"{kept} of 4 runs are done already" in result.output) == (kept > 0)
    assert result.code == 3


def test_finished_runs_count_only_for_the_same_program_and_arena(tmp_path: Path) -> None:
    write(tmp_path, {"objects.robots.nb": 2, "arena_file": "mine.csv"})
    (tmp_path / "mine.csv").write_text("0,0\n3,0\n3,1\n0,1\n")
    interrupted(tmp_path)
    program = script(tmp_path / "simulator", "# changed\n[ $seed = 3 ] && exit 3")
    assert "done already" not in batch(tmp_path, "-r", "4", "-R", "0", program=program).output
    assert "3 of 4 runs are done already" in batch(tmp_path, "-r", "4", "-R", "0", program=program).output
    (tmp_path / "mine.csv").write_text("0,0\n4,0\n4,1\n0,1\n")
    assert "done already" not in batch(tmp_path, "-r", "4", "-R", "0", program=program).output


def test_damaged_data_of_a_finished_run_is_done_again(tmp_path: Path) -> None:
    write(tmp_path, {"objects.robots.nb": 2})
    interrupted(tmp_path)
    first, *_ = (tmp_path / "tmp").glob("done_*/*.feather")
    first.write_bytes(first.read_bytes()[:500])
    result = batch(tmp_path, "-r", "4", "-R", "0", program=tmp_path / "simulator")
    assert "2 of 4 runs are done already" in result.output
    assert set(load_dataframe(tmp_path / "results" / "result.feather")[0]["run"]) == {0, 1, 2}


@linux_only
def test_same_batch_twice_at_once_is_refused(tmp_path: Path) -> None:
    write(tmp_path, LONG)
    first = start_batch(tmp_path, "-r", "4", "-j", "1")
    wait_for_simulators(tmp_path, first)
    second = batch(tmp_path, "-r", "4", "-j", "1")
    assert second.code == 2
    assert "the same batch is running already" in second.errors
    assert second.errors.count("\n") == 1
    _, errors = first.communicate(timeout=60)
    assert (first.returncode, errors) == (0, "")


@linux_only
def test_killed_dask_worker_loses_no_run(tmp_path: Path, undisturbed: dict[str, bytes]) -> None:
    write(tmp_path, LONG)
    process = start_batch(tmp_path, *RUNS, "--backend", "dask")
    for _ in range(2):
        for simulator in wait_for_simulators(tmp_path, process)[:1]:
            with contextlib.suppress(OSError, IndexError, ValueError):
                stat = Path(f"/proc/{simulator}/stat").read_text()
                parent = int(stat.rpartition(")")[2].split()[1])
                if parent not in (1, process.pid):
                    os.kill(parent, signal.SIGKILL)
        time.sleep(0.3)
    _, errors = process.communicate(timeout=100)
    assert (process.returncode, errors) == (0, "")
    assert results(tmp_path) == undisturbed
    assert simulators_in(tmp_path) == []


@linux_only
def test_killed_scheduler_is_one_line_and_its_runs_count(tmp_path: Path, undisturbed: dict[str, bytes]) -> None:
    write(tmp_path, LONG)
    with (tmp_path / "dask.log").open("w") as log:
        command = [sys.executable, "-c", DASK]
        cluster = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=log, stdin=subprocess.PIPE, text=True)
    assert cluster.stdout is not None
    assert cluster.stdin is not None
    address = cluster.stdout.readline().strip()
    process = start_batch(tmp_path, *RUNS, "--scheduler", address)
    wait_for_simulators(tmp_path, process)
    cluster.kill()
    _, errors = process.communicate(timeout=60)
    cluster.communicate()
    assert process.returncode == 2
    assert errors.count("\n") == 1, errors
    assert "the Dask scheduler ended before the batch; finished runs are kept" in errors
    wait_until_gone(tmp_path)
    (tmp_path / "dask.log").unlink()
    final = batch(tmp_path, *RUNS)
    assert (final.code, final.errors) == (0, "")
    assert results(tmp_path) == undisturbed
