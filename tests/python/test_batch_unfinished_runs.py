"""Batches whose runs go on from saved states after they were ended: `--save-states`."""

from __future__ import annotations

import contextlib
import os
import random
import signal
import subprocess
import time
from pathlib import Path

import pyarrow as pa
import pyarrow.feather
import pytest
from batches import (
    COMMAND,
    ENVIRONMENT,
    batch,
    batch_apart,
    ended,
    results,
    saved_states,
    script,
    simulators_in,
    start_batch,
    wait_until_gone,
    write_options,
)
from test_state_files import program_of

LONG: dict[str, object] = {"simulation_time": 120.0, "save_data_period": 1.0, "time_step": 0.002}
SAVING = ("--save-states", "0.02")
LIMIT_S = 120.0


def wait_for_states(folder: Path, process: subprocess.Popen[str]) -> bool:
    """Wait until a run has saved its state; False: the batch has ended before."""
    end_s = time.monotonic() + LIMIT_S
    while time.monotonic() < end_s:
        if process.poll() is not None:
            return False
        if saved_states(folder / "tmp"):
            return True
        time.sleep(0.01)
    raise AssertionError("no state was saved")


def end(process: subprocess.Popen[str], number: signal.Signals) -> str:
    """End a batch by a signal; returns what it has said."""
    process.send_signal(number)
    return "".join(process.communicate(timeout=LIMIT_S))


def whole_batch(folder: Path, program: Path, *more: str) -> dict[str, bytes]:
    """Return the results of a batch that was not interrupted, and saved no states."""
    write_options(folder, LONG)
    assert batch_apart(folder, "-r", "2", *more, program=program).code == 0
    return results(folder)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
@pytest.mark.parametrize("backend", ["multiprocessing", "dask"])
def test_batch_goes_on_from_the_states_of_its_runs(backend: str, number: signal.Signals, tmp_path: Path) -> None:
    if backend == "dask":
        pytest.importorskip("distributed")
    program = program_of(tmp_path / "program")
    expected = whole_batch(tmp_path / "whole", program)
    folder, chance = tmp_path / "parts", random.Random(f"{backend} {number}")
    write_options(folder, LONG)
    options = ("-r", "2", "-j", "2", "--backend", backend, *SAVING)
    has_states = False
    for _ in range(3):
        process = start_batch(folder, *options, program=program)
        if not wait_for_states(folder, process):
            process.communicate(timeout=LIMIT_S)
            has_states = False
            break
        time.sleep(chance.uniform(0.0, 0.3))
        end(process, number)
        wait_until_gone(folder)
        has_states = bool(saved_states(folder / "tmp"))
    last = batch_apart(folder, *options, program=program)
    assert last.code == 0, last.errors
    assert not has_states or "go on from their states" in last.output
    assert "begins anew" not in last.errors
    assert results(folder) == expected
    assert not (folder / "tmp").exists()


def test_batch_that_is_asked_to_end_saves_states_at_once(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    write_options(tmp_path, {**LONG, "simulation_time": 1e5})
    process = start_batch(tmp_path, "-j", "2", "--save-states", program=program)
    end_s = time.monotonic() + LIMIT_S
    while not list(tmp_path.glob("tmp/sim_saved*/*/frames/data.feather")) and time.monotonic() < end_s:
        time.sleep(0.01)
    time.sleep(0.5)
    assert end(process, signal.SIGTERM).splitlines()[-1] == (
        "pogobatch: interrupted: tmp has the states of 2 unfinished runs; the same command continues"
    )
    assert len(saved_states(tmp_path / "tmp")) == 2


def test_batch_says_what_it_leaves_and_how_states_are_continued(tmp_path: Path) -> None:
    """Without `--save-states`, runs that have states begin anew; not without a word."""
    long = tmp_path / "long"
    long.touch()
    lines = f'[ "$seed" = 2 ] && [ -e "{long}" ] && set -- "$@" --set simulation_time=1e6'
    program = script(tmp_path / "simulator", lines, program_of(tmp_path / "program"))
    write_options(tmp_path, {**LONG, "simulation_time": 2.0})
    process = start_batch(tmp_path, "-j", "1", "-r", "3", *SAVING, program=program)
    end_s = time.monotonic() + LIMIT_S
    while time.monotonic() < end_s and not (
        len(list(tmp_path.glob("tmp/done_*/*.feather"))) == 2 and saved_states(tmp_path / "tmp")
    ):
        time.sleep(0.01)
    last = end(process, signal.SIGTERM).splitlines()[-1]
    left = "tmp has 2 finished runs and the state of 1 unfinished run"
    assert last == f"pogobatch: interrupted: {left}; the same command continues"
    long.unlink()
    done = batch_apart(tmp_path, "-j", "1", "-r", "3", program=program)
    assert done.code == 0, done.errors
    assert "1 unfinished run has a saved state: give --save-states to continue it" in done.errors


def test_killed_simulators_go_on_while_the_batch_does(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    expected = whole_batch(tmp_path / "whole", program)
    write_options(tmp_path, LONG)
    process = start_batch(tmp_path, "-r", "2", "-j", "2", "-R", "3", *SAVING, program=program)
    killed = 0
    while killed < 3 and wait_for_states(tmp_path, process):
        time.sleep(0.1)
        for simulator in simulators_in(tmp_path)[:1]:
            with contextlib.suppress(ProcessLookupError):
                os.kill(simulator, signal.SIGKILL)
                killed += 1
    _, errors = process.communicate(timeout=LIMIT_S)
    assert process.returncode == 0, errors
    assert results(tmp_path) == expected


def test_runs_that_fail_by_themselves_begin_anew(tmp_path: Path) -> None:
    step = "if (mydata->count >= 3000) { abort(); }\nmydata->count += 1;"
    program = program_of(tmp_path / "program", step, globals_="#include <stdlib.h>")
    write_options(tmp_path, {**LONG, "objects.robots.nb": 2})
    for _ in range(2):
        failed = batch_apart(tmp_path, "-R", "1", *SAVING, program=program)
        assert failed.code == 3, failed.errors
        assert "cannot be saved" not in failed.errors
        assert "go on from" not in failed.output
        assert saved_states(tmp_path / "tmp") == []


def test_program_that_cannot_be_saved_is_told_and_runs(tmp_path: Path) -> None:
    step = "if (!numbers) { numbers = malloc(100); } numbers[0]++;"
    globals_ = "#include <stdlib.h>\nstatic int *numbers = NULL;"
    program = program_of(tmp_path / "program", step, globals_=globals_)
    write_options(tmp_path / "saving")
    write_options(tmp_path / "not")
    done = batch_apart(tmp_path / "saving", *SAVING, program=program)
    assert done.code == 0, done.errors
    assert done.errors.count("the state of this run cannot be saved: the program allocates memory ('malloc')") == 1
    assert batch_apart(tmp_path / "not", program=program).code == 0
    assert results(tmp_path / "saving") == results(tmp_path / "not")


def interrupted(folder: Path, program: Path, changes: dict[str, object], *more: str) -> None:
    """Interrupt a batch of one run that has a state."""
    write_options(folder, changes)
    process = start_batch(folder, *SAVING, *more, program=program)
    assert wait_for_states(folder, process)
    end(process, signal.SIGKILL)
    wait_until_gone(folder)
    assert saved_states(folder / "tmp")


def test_states_that_do_not_fit_are_told_and_the_runs_begin_anew(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    changes: dict[str, object] = {**LONG, "objects.robots.nb": 2}
    expected_folder = tmp_path / "whole"
    write_options(expected_folder, changes)
    assert batch(expected_folder, program=program).code == 0
    for name in ("damaged", "lost"):
        folder = tmp_path / name
        interrupted(folder, program, changes)
        for state in saved_states(folder / "tmp"):
            if name == "damaged":
                state.write_bytes(state.read_bytes()[:-1])
            else:
                (state.parent / "frames" / "data.feather").unlink()
        done = batch_apart(folder, *SAVING, program=program)
        assert done.code == 0, done.errors
        reason = "is cut off" if name == "damaged" else "are missing"
        assert reason in done.errors
        assert "so the run begins anew" in done.errors
        assert results(folder) == results(expected_folder)
    folder = tmp_path / "changed"
    interrupted(folder, program, {**changes, "simulation_time": 1e5})
    write_options(folder, changes)
    done = batch_apart(folder, *SAVING, program=program)
    assert done.code == 0, done.errors
    assert "are of runs with another configuration, program or seed: nothing goes on from them" in done.errors
    assert results(folder) == results(expected_folder)
    assert not list((folder / "tmp").glob("sim_*"))


def test_tasks_and_parts_of_job_arrays_go_on(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    write_options(tmp_path, {**LONG, "objects.robots.nb": {"batch_options": [2, 3], "default_option": 3}})
    of_all = ["-c", "many.yaml", "-S", str(program)]
    run = [*COMMAND, "run", *of_all, "--seeds", "0:1"]
    assert ended([*run, "-t", "t", "-o", "whole"], tmp_path).code == 0
    for number in range(2):
        command = [*run, "--part", f"{number}/2", "-t", f"jobs/{number}", "-o", "results", "-j", "1", *SAVING]
        disturbed(command, tmp_path, signal.SIGTERM if number else signal.SIGKILL)
        assert ended(command, tmp_path).code == 0
    merged = ended([*COMMAND, "merge", "jobs", "-o", "results", "-c", "many.yaml"], tmp_path)
    assert merged.code == 0, merged.errors
    whole = pa.feather.read_table(tmp_path / "whole" / "result.feather")
    assert pa.feather.read_table(tmp_path / "results" / "result.feather").equals(whole)

    task = [*COMMAND, "task", *of_all, "--seed", "1"]
    assert ended([*task, "-o", "tasks/whole"], tmp_path).code == 0
    for number in (signal.SIGTERM, signal.SIGKILL):
        command = [*task, "-o", f"tasks/{number.name}", *SAVING]
        disturbed(command, tmp_path, number)
        done = ended(command, tmp_path)
        assert done.code == 0, done.errors
        tables = [
            pa.feather.read_table(tmp_path / "tasks" / name / "frames" / "data.feather")
            for name in ("whole", number.name)
        ]
        assert tables[0].equals(tables[1])
        assert list(tables[0].schema.metadata) == list(tables[1].schema.metadata)
        names = {path.name for path in (tmp_path / "tasks" / number.name).rglob("*")}
        assert names == {path.name for path in (tmp_path / "tasks" / "whole").rglob("*")}


def disturbed(command: list[str], folder: Path, number: signal.Signals) -> None:
    """Start a command, and end it when a run has saved its state."""
    process = subprocess.Popen(
        command, cwd=folder, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    end_s = time.monotonic() + LIMIT_S
    while not saved_states(folder) and time.monotonic() < end_s:
        assert process.poll() is None, process.communicate()
        time.sleep(0.01)
    time.sleep(0.1)
    end(process, number)


def test_states_are_wanted_at_times(tmp_path: Path) -> None:
    write_options(tmp_path)
    done = batch(tmp_path, "--save-states", "-1")
    assert done.code == 2
    assert "--save-states: expected a time from 0" in done.errors
