"""What a program does where no robot has the processor: before main(), after the run, in threads, in children."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
import pytest
from conftest import Compile
from running import PROGRAMS, Run, compile_program, ran, without_places, write_scene

BEFORE = ["constructor", "function before main"]
AFTER = ["destructor", "function after main", "atexit"]
OUTSIDE = BEFORE + AFTER
CRASHES = {
    "crash": "segmentation fault at address 0x0",
    "divide": "integer division by zero",
    "abort": "abort()",
    "throw": "uncaught C++ exception",
    "overflow": "stack overflow",
}
CALLS = {
    "seed": "pogobot_helper_getRandSeed",
    "led": "pogobot_led_setColor",
    "stop": "stop_simulation",
    "category": "get_current_robot_category",
    "milliseconds": "current_time_milliseconds",
}


def each_at_a_place(kinds: Iterable[str], places: Sequence[str]) -> list[tuple[str, str]]:
    """Return each kind once, and each place at least once: the place of a crash and its kind do not interact."""
    return list(zip(itertools.cycle(places), kinds))


def outside(program: Compile, folder: Path, place: str, kind: str) -> Run:
    write_scene(folder, {"console_filename": "console.txt", "enable_console_logging": True})
    environment = {**os.environ, "PLACE": place, "KIND": kind}
    command = [str(program("outside.cpp")), "-c", "scene.yaml", "-g"]
    return ran(folder, *command, env=environment, timeout=60)


def saved_times(result: Run) -> list[float]:
    return [float(t) for t in result.frame()["time"].unique()]


@pytest.mark.parametrize(("place", "kind"), each_at_a_place(CRASHES, BEFORE))
def test_crash_before_main_is_named_and_ends_with_3(program: Compile, tmp_path: Path, place: str, kind: str) -> None:
    result = outside(program, tmp_path, place, kind)
    assert result.code == 3
    assert "pogosim: the user program failed before main(), in the constructor of a static object" in result.errors
    assert CRASHES[kind] in result.errors
    assert "The run did not start." in result.errors
    assert "data file" not in result.errors
    assert not (tmp_path / "data.feather").exists()


@pytest.mark.parametrize(("place", "kind"), each_at_a_place(CRASHES, AFTER))
def test_crash_after_the_run_is_named_and_ends_with_3_and_a_complete_file(
    program: Compile, tmp_path: Path, place: str, kind: str
) -> None:
    result = outside(program, tmp_path, place, kind)
    assert result.code == 3
    assert "pogosim: the user program failed after the run, in the destructor of a static object" in result.errors
    assert CRASHES[kind] in result.errors
    assert "The data file 'data.feather' is complete." in result.errors
    np.testing.assert_allclose(saved_times(result), np.arange(21) * 0.1, atol=1e-6)


@pytest.mark.parametrize(("place", "kind"), each_at_a_place(CALLS, OUTSIDE))
def test_call_of_the_interface_outside_of_the_run_is_named(
    program: Compile, tmp_path: Path, place: str, kind: str
) -> None:
    result = outside(program, tmp_path, place, kind)
    assert result.code == 3
    assert f"{CALLS[kind]}() was called while no robot was running" in result.errors
    assert ("before main()" in result.errors) == (place in BEFORE)


@pytest.mark.parametrize("place", ["constructor", "atexit", "thread"])
def test_what_is_printed_outside_of_robots_comes_as_it_is(program: Compile, tmp_path: Path, place: str) -> None:
    result = outside(program, tmp_path, place, "print")
    assert (result.code, result.errors) == (0, "")
    assert "printed 1 times" in result.output.splitlines()


def test_exit_before_main_keeps_its_code_and_is_said(program: Compile, tmp_path: Path) -> None:
    result = outside(program, tmp_path, "constructor", "exit")
    assert result.code == 5
    assert result.errors == "pogosim: the user program called exit(5) before main(). The run did not start.\n"


@pytest.mark.parametrize("kind", CRASHES)
def test_crash_in_a_thread_of_the_program_ends_the_run_with_3_and_a_complete_file(
    program: Compile, tmp_path: Path, kind: str
) -> None:
    result = outside(program, tmp_path, "thread", kind)
    assert result.code == 3
    assert "the user program failed in a thread that it started, t = 0.1600 s: " in without_places(result.errors)
    assert CRASHES[kind] in result.errors
    assert "The data file 'data.feather' contains all rows up to that point" in result.errors
    np.testing.assert_allclose(saved_times(result), [0.0, 0.1], atol=1e-6)


@pytest.mark.parametrize("kind", ["led", "stop"])
def test_call_of_the_interface_in_a_thread_of_the_program_is_named(program: Compile, tmp_path: Path, kind: str) -> None:
    result = outside(program, tmp_path, "thread", kind)
    assert result.code == 3
    assert f"in a thread that it started, t = 0.1600 s: {CALLS[kind]}() was called there" in without_places(
        result.errors
    )
    np.testing.assert_allclose(saved_times(result), [0.0, 0.1], atol=1e-6)


def test_exit_in_a_thread_of_the_program_keeps_its_code_and_the_data(program: Compile, tmp_path: Path) -> None:
    result = outside(program, tmp_path, "thread", "exit")
    assert result.code == 5
    assert "in a thread that it started, t = 0.1600 s: called exit(5)" in without_places(result.errors)
    np.testing.assert_allclose(saved_times(result), [0.0, 0.1], atol=1e-6)


@pytest.mark.parametrize(
    ("kind", "status"), [("nothing", 6), ("return", 0), ("exit", 5), ("throw", 3), ("crash", -11), ("overflow", -11)]
)
def test_child_process_touches_neither_the_data_nor_the_messages_of_the_run(
    program: Compile, tmp_path: Path, kind: str, status: int
) -> None:
    alone = outside(program, tmp_path / "alone", "nowhere", "nothing")
    result = outside(program, tmp_path / "forked", "child", kind)
    assert (result.code, result.errors) == (0, "")
    data = [run.folder / "data.feather" for run in (alone, result)]
    assert data[0].read_bytes() == data[1].read_bytes()
    # Nothing is printed twice, and nothing of the child's is in the console file.
    assert result.robot_lines.count("[ROBOT #1] [PRINTF] before the fork") == 1
    assert result.robot_lines.count(f"[ROBOT #1] [PRINTF] the child ended with {status}") == 1
    console = (result.folder / "console.txt").read_text()
    assert len(console.splitlines()) == 5
    assert "the child prints" not in console


@pytest.mark.parametrize("place", ["function before main", "destructor"])
def test_fork_works_outside_of_the_run(program: Compile, tmp_path: Path, place: str) -> None:
    result = outside(program, tmp_path, place, "fork")
    assert (result.code, result.errors) == (0, "")
    assert result.output.splitlines().count("the child ended with 6") == 1
    np.testing.assert_allclose(saved_times(result), np.arange(21) * 0.1, atol=1e-6)


@pytest.mark.parametrize("place", ["constructor", "function after main"])
def test_end_of_the_main_thread_outside_of_the_run_is_named(program: Compile, tmp_path: Path, place: str) -> None:
    result = outside(program, tmp_path, place, "pthread_exit")
    assert result.code == 3
    assert "called pthread_exit(), which ends the only thread that can run the simulator" in result.errors
    assert ("before main()" in result.errors) == (place in BEFORE)


def test_thread_of_the_program_may_end_by_pthread_exit(program: Compile, tmp_path: Path) -> None:
    result = outside(program, tmp_path, "thread", "pthread_exit")
    assert (result.code, result.errors) == (0, "")


def test_program_under_the_address_sanitizer_names_calls_before_main(tmp_path: Path) -> None:
    flags = ("-fsanitize=address", "-Wno-unused")
    compiled = compile_program(tmp_path / "outside", PROGRAMS / "outside.cpp", flags=flags)
    result = outside(lambda _: compiled, tmp_path, "constructor", "seed")
    assert result.code == 3
    assert "pogobot_helper_getRandSeed() was called while no robot was running" in result.errors
    assert outside(lambda _: compiled, tmp_path, "thread", "print").code == 0
    assert outside(lambda _: compiled, tmp_path, "thread", "crash").code == 3
