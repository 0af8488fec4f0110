"""Nothing is lost: whatever ends a run, the data file is readable and a message says where it happened."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import Compile
from running import Run, compile_program, end, run, run_command, start, without_places, write_scene

# Robot 1 misbehaves in tick 10, which begins at 0.16 s: ticks last 16 ms.
WHERE = "in user_step of robot #1 of category 'robots', tick 10, t = 0.1600 s"
SAVED_TIMES = [0.0, 0.1]


def misbehave(program: Compile, folder: Path, kind: str, place: str = "user_step", **parameters: object) -> Run:
    chosen = {"kind": kind, "place": place, **parameters}
    return run(program("misbehave.c"), folder, {"parameters": chosen, "user_code_timeout": 0.25})


def saved_times(result: Run) -> list[float]:
    frame = result.frame()
    assert len(frame) == 3 * frame["time"].nunique()
    return [round(float(t), 4) for t in frame["time"].unique()]


def test_program_that_behaves_ends_with_0_and_says_nothing(program: Compile, tmp_path: Path) -> None:
    result = misbehave(program, tmp_path, "nothing")
    assert (result.code, result.errors) == (0, "")
    np.testing.assert_allclose(saved_times(result), np.arange(21) * 0.1, atol=1e-6)


@pytest.mark.parametrize(
    ("kind", "what"),
    [
        ("write_to_null", "segmentation fault at address"),
        ("divide_by_zero", "integer division by zero"),
        ("abort", r"abort\(\)"),
        ("end_the_thread", r"called pthread_exit\(\), which ends the only thread that can run the simulator"),
        ("overflow_the_stack", r"stack overflow: the \d+ KiB of the stack are full \(robot_stack_size\)"),
        ("write_beyond_userdata", "segmentation fault at address"),
        ("free_what_is_not_allocated", r"abort\(\)"),
        ("loop_for_ever", r"did not return within 0\.25 s of processor time \(user_code_timeout\)"),
        ("allocate_for_ever", r"did not return within 0\.25 s of processor time \(user_code_timeout\)"),
        ("print_for_ever", r"did not return within 0\.25 s of processor time \(user_code_timeout\)"),
    ],
)
def test_crash_in_user_code_ends_with_3_a_message_and_a_readable_file(
    program: Compile, tmp_path: Path, kind: str, what: str
) -> None:
    result = misbehave(program, tmp_path, kind)
    assert result.code == 3
    assert f"the user program failed {WHERE}: " in without_places(result.errors)
    assert re.search(what, result.errors)
    assert "The data file 'data.feather' contains all rows up to that point" in result.errors
    assert saved_times(result) == SAVED_TIMES


def test_data_lost_with_the_heap_can_be_had_by_the_run_that_the_message_names(program: Compile, tmp_path: Path) -> None:
    result = misbehave(program, tmp_path, "free_twice")
    assert result.code == 3
    assert f"the user program failed {WHERE}: abort()" in without_places(result.errors)
    if lost := re.search(r"could not be completed.*run it again with (.*)$", result.errors, re.MULTILINE):
        again = run_command(program("misbehave.c"), tmp_path, ["-c", "scene.yaml", "-g", *lost.group(1).split()])
        assert (again.code, again.errors) == (0, "")
    assert saved_times(result) == SAVED_TIMES


def test_destroyed_heap_is_said_whatever_is_left_of_it(program: Compile, tmp_path: Path) -> None:
    result = misbehave(program, tmp_path, "write_over_the_heap")
    assert result.code == 3
    assert "the user program failed in user_step" in result.errors
    assert "tick 10, t = 0.1600 s: " in without_places(result.errors)


@pytest.mark.skipif(sys.platform != "linux", reason="replaces free() of the GNU C library")
def test_heap_that_is_locked_for_ever_after_a_crash_does_not_keep_the_run_from_its_end(
    program: Compile, tmp_path: Path
) -> None:
    write_scene(tmp_path, {})
    command = [str(program("stuck_heap.c")), "-c", "scene.yaml", "-g"]
    with (tmp_path / "errors.txt").open("w+", encoding="utf-8") as errors:
        ended = subprocess.run(command, cwd=tmp_path, stderr=errors, timeout=60, check=False)
        errors.seek(0)
        (line,) = errors.read().splitlines()
    assert ended.returncode == 3
    assert line.endswith("The data file 'data.feather' contains all rows up to that point")


def test_text_without_end_of_line_is_printed_after_a_crash(program: Compile, tmp_path: Path) -> None:
    result = misbehave(program, tmp_path, "write_to_null")
    assert result.robot_lines[-1] == "[ROBOT #1] [PRINTF] going to write to null"


def test_text_that_never_ends_is_printed_in_long_lines(program: Compile, tmp_path: Path) -> None:
    result = misbehave(program, tmp_path, "print_for_ever")
    lines = [line for line in result.robot_lines if line.startswith("[ROBOT #1] [PRINTF] again and again")]
    assert len(lines) > 1
    assert {len(line) for line in lines[:-1]} == {len("[ROBOT #1] [PRINTF] ") + 10 * 6554}


@pytest.mark.parametrize(("kind", "code", "verb"), [("exit_with_7", 7, "failed"), ("exit_with_0", 0, "ended")])
def test_exit_in_user_code_keeps_its_code_and_the_data(
    program: Compile, tmp_path: Path, kind: str, code: int, verb: str
) -> None:
    result = misbehave(program, tmp_path, kind)
    assert result.code == code
    assert f"the user program {verb} {WHERE}: called exit({code})" in without_places(result.errors)
    assert saved_times(result) == SAVED_TIMES


def test_robot_that_stops_the_simulation_ends_it_well(program: Compile, tmp_path: Path) -> None:
    result = misbehave(program, tmp_path, "stop_simulation")
    assert (result.code, result.errors) == (0, "")
    assert saved_times(result) == SAVED_TIMES


def test_cpp_exception_is_reported_with_its_text(program: Compile, tmp_path: Path) -> None:
    result = run(program("throw.cpp"), tmp_path)
    assert result.code == 3
    assert f"the user program failed {WHERE}: C++ exception: a tyre is flat" in without_places(result.errors)
    assert saved_times(result) == SAVED_TIMES


def test_exception_of_a_constructor_of_user_data_ends_with_3_and_an_empty_file(tmp_path: Path) -> None:
    source = tmp_path / "main.cpp"
    constructor = 'throws() { if (pogobot_helper_getid() == 1) { throw std::runtime_error("no air"); } }'
    source.write_text(
        f'#include <stdexcept>\n#include "pogobase.h"\nstruct throws {{ int n = 1; {constructor} }};\n'
        "DECLARE_USERDATA(throws);\nREGISTER_USERDATA(throws);\nint main() { return 0; }\n"
    )
    result = run(compile_program(tmp_path / "main", source), tmp_path)
    assert result.code == 3
    where = "in constructor of USERDATA of robot #1 of category 'robots', t = 0.0000 s"
    assert f"the user program failed {where}: C++ exception: no air" in result.errors
    assert len(result.frame()) == 0


@pytest.mark.parametrize(
    ("place", "who"),
    [
        ("main", "robot #1 of category 'robots', t = 0.0000 s"),
        ("user_init", "robot #1 of category 'robots', tick 0, t = 0.0000 s"),
        ("export_data", "robot #1 of category 'robots', tick 6, t = 0.1000 s"),
        ("robot_end", "robot #1 of category 'robots', tick 125, t = 2.0000 s"),
    ],
)
@pytest.mark.parametrize("kind", ["write_to_null", "loop_for_ever"])
def test_failure_in_any_function_of_the_program_names_the_function(
    program: Compile, tmp_path: Path, place: str, who: str, kind: str
) -> None:
    result = misbehave(program, tmp_path, kind, place)
    assert result.code == 3
    assert f"the user program failed in {place} of {who}: " in without_places(result.errors)
    crashed_in_main = place == "main" and kind != "loop_for_ever"
    assert ("main() must end with 'return 0;'" in result.errors) == crashed_in_main
    # A run that fails before its first row leaves a file without rows, so that an older one does not pass for its own.
    assert (len(result.frame()) > 0) == (place in ("export_data", "robot_end"))


MOVE_THE_LOOP = "move the body of its endless loop into user_step, or include pogobot.h alone (see docs/porting.md)"


@pytest.mark.parametrize("place", ["main", "user_init"])
def test_program_that_keeps_its_own_endless_loop_is_told_to_move_it(
    program: Compile, tmp_path: Path, place: str
) -> None:
    result = misbehave(program, tmp_path, "loop_for_ever", place)
    assert f"(user_code_timeout): {MOVE_THE_LOOP}\n" in result.errors
    assert "a step must not wait" not in result.errors


@pytest.mark.parametrize(("kind", "signals"), [("loop_for_ever", 2), ("sleep_for_ever", 1), ("sleep_for_ever", 2)])
def test_interrupted_program_that_keeps_its_own_endless_loop_is_told_to_move_it(
    program: Compile, tmp_path: Path, kind: str, signals: int
) -> None:
    settings = {"user_code_timeout": 2.0, "parameters.kind": kind, "parameters.place": "main"}
    process = start(program("misbehave.c"), tmp_path, settings)
    for _ in range(signals):
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
    result = end(process, tmp_path)
    assert result.code == 130
    assert "the run was interrupted in main of robot #1 of category 'robots', " in result.errors
    assert f": {MOVE_THE_LOOP}\n" in result.errors
    assert "return 0" not in result.errors


@pytest.mark.parametrize(
    ("place", "when", "rows"),
    [
        ("global_setup", "tick 0, t = 0.0000 s", 0),
        ("create_data_schema", "tick 0, t = 0.0000 s", 0),
        ("global_step", "tick 10, t = 0.1600 s", 6),
    ],
)
def test_failure_in_a_callback_of_the_whole_run_names_no_robot(
    program: Compile, tmp_path: Path, place: str, when: str, rows: int
) -> None:
    result = misbehave(program, tmp_path, "write_to_null", place)
    assert result.code == 3
    assert f"the user program failed in callback_{place}, {when}, in " in result.errors
    assert "(): segmentation fault at address" in result.errors
    assert "robot #" not in result.errors
    assert len(result.frame()) == rows
    assert "[SYSTEM] [PRINTF] going to write to null" in result.output
    assert not any("going to write" in line for line in result.robot_lines)


@pytest.mark.parametrize(("kind", "code"), [("exit_with_0", 0), ("exit_with_2", 2), ("exit_with_7", 7)])
def test_exit_before_the_first_row_leaves_no_older_data(program: Compile, tmp_path: Path, kind: str, code: int) -> None:
    assert len(misbehave(program, tmp_path, "nothing").frame()) > 0
    result = misbehave(program, tmp_path, kind, "user_init")
    assert result.code == code
    assert len(result.frame()) == 0


def test_parameter_that_is_refused_leaves_the_older_data(program: Compile, tmp_path: Path) -> None:
    rows = len(misbehave(program, tmp_path, "nothing").frame())
    assert misbehave(program, tmp_path, "read_number", "user_init", number=1.0e10).code == 2
    assert len(Run(0, "", "", tmp_path).frame()) == rows


@pytest.mark.parametrize(
    ("kind", "place", "what"),
    [
        ("set_unknown_column", "export_data", "no column 'nobody declared this'"),
        (
            "set_wrong_type",
            "export_data",
            'data_set_value_double("declared_as_int16"): the column was declared as int16',
        ),
        ("declare_column_twice", "create_data_schema", "already has a column of this name"),
        ("declare_column_twice", "user_step", "columns can only be added in callback_create_data_schema"),
    ],
)
def test_wrong_use_of_columns_ends_with_2_and_names_the_column(
    program: Compile, tmp_path: Path, kind: str, place: str, what: str
) -> None:
    result = misbehave(program, tmp_path, kind, place)
    assert result.code == 2
    assert what in result.errors
    assert result.errors.count("\n") == 1


def test_values_set_outside_of_the_callback_warn_once(program: Compile, tmp_path: Path) -> None:
    result = misbehave(program, tmp_path, "set_wrong_type")
    assert result.code == 0
    assert result.errors.count("data_set_value_double() has no effect outside of callback_export_data") == 1


def test_parameter_out_of_range_ends_with_2_and_names_the_key(program: Compile, tmp_path: Path) -> None:
    result = misbehave(program, tmp_path, "read_number", "user_init", number=1.0e10)
    assert result.code == 2
    assert "scene.yaml:" in result.errors
    assert "parameters.number: expected an integer" in result.errors


@pytest.mark.parametrize("value", ["many", [1, 2]])
def test_parameter_of_the_wrong_type_is_told_and_the_default_taken(
    program: Compile, tmp_path: Path, value: object
) -> None:
    result = misbehave(program, tmp_path, "read_number", "user_init", number=value)
    assert result.code == 0
    assert "scene.yaml:" in result.errors
    assert "parameters.number: expected an integer" in result.errors


def wait_until_it_runs(process: subprocess.Popen[str]) -> None:
    assert process.stdout is not None
    assert "first tick" in process.stdout.readline()


def test_interrupted_run_ends_with_130_and_complete_data(program: Compile, tmp_path: Path) -> None:
    process = start(program("misbehave.c"), tmp_path, {"simulation_time": 1.0e6, "save_data_period": 1.0})
    wait_until_it_runs(process)
    time.sleep(0.2)
    process.send_signal(signal.SIGINT)
    result = end(process, tmp_path)
    assert result.code == 130
    match = re.search(
        r"interrupted at t = ([0-9.]+) s\. The data file 'data\.feather' contains all rows", result.errors
    )
    assert match
    times = saved_times(result)
    assert times == list(range(len(times)))
    assert times[-1] == int(float(match.group(1)))


BLOCKING_KINDS = [
    "sleep_for_ever",
    "sleep_again_when_interrupted",
    "wait_for_a_mutex",
    "read_from_nobody",
    "select_nothing",
]


def start_blocked(program: Compile, folder: Path, kind: str, timeout_s: float) -> subprocess.Popen[str]:
    settings = {"user_code_timeout": timeout_s, "parameters.kind": kind, "parameters.announced": True}
    process = start(program("misbehave.c"), folder, settings)
    wait_until_it_runs(process)
    assert process.stdout is not None
    assert "here it comes" in process.stdout.readline()
    time.sleep(0.3)
    return process


@pytest.mark.parametrize("kind", ["loop_for_ever", "wait_for_a_mutex"])
def test_second_interrupt_ends_user_code_that_hangs(program: Compile, tmp_path: Path, kind: str) -> None:
    process = start_blocked(program, tmp_path, kind, 0)
    process.send_signal(signal.SIGINT)
    time.sleep(0.3)
    assert process.poll() is None
    process.send_signal(signal.SIGINT)
    result = end(process, tmp_path)
    assert result.code == 130
    assert f"the run was interrupted {WHERE}: interrupted again before it returned" in without_places(result.errors)
    assert saved_times(result) == SAVED_TIMES


def test_signal_that_comes_twice_at_once_is_one(program: Compile, tmp_path: Path) -> None:
    process = start_blocked(program, tmp_path, "wait_for_a_mutex", 0)
    process.send_signal(signal.SIGTERM)
    time.sleep(0.02)
    process.send_signal(signal.SIGTERM)
    time.sleep(0.5)
    assert process.poll() is None
    process.send_signal(signal.SIGTERM)
    assert end(process, tmp_path).code == 130


def test_first_interrupt_says_at_once_what_it_waits_for(program: Compile, tmp_path: Path) -> None:
    process = start_blocked(program, tmp_path, "wait_for_a_mutex", 30)
    process.send_signal(signal.SIGINT)
    assert process.stderr is not None
    told = process.stderr.readline()
    assert told == (
        f"pogosim: Ctrl-C (SIGINT): stopping as soon as {WHERE.removeprefix('in ')}, returns. Send a second "
        "signal to stop now; otherwise it is aborted 30 s after it began (user_code_timeout).\n"
    )
    time.sleep(0.15)
    process.send_signal(signal.SIGINT)
    assert end(process, tmp_path).code == 130


@pytest.mark.parametrize(
    ("kind", "name"), list(zip(BLOCKING_KINDS, ["SIGINT", "SIGTERM", "SIGHUP", "SIGXCPU", "SIGINT"], strict=True))
)
def test_one_signal_ends_user_code_that_has_not_returned_after_its_time(
    program: Compile, tmp_path: Path, kind: str, name: str
) -> None:
    process = start_blocked(program, tmp_path, kind, 0.25)
    process.send_signal(signal.Signals[name])
    result = end(process, tmp_path)
    assert result.code == 130
    assert f"the run was interrupted {WHERE}: it had not returned 0.25 s after it began (user_code_timeout), and " in (
        without_places(result.errors)
    )
    assert name in result.errors
    assert "The data file 'data.feather' contains all rows up to that point" in result.errors
    assert saved_times(result) == SAVED_TIMES


def test_user_code_without_a_limit_has_ten_seconds_after_a_signal(program: Compile, tmp_path: Path) -> None:
    process = start_blocked(program, tmp_path, "wait_for_a_mutex", 0)
    process.send_signal(signal.SIGTERM)
    time.sleep(8)
    assert process.poll() is None
    result = end(process, tmp_path)
    assert result.code == 130
    assert "it had not returned 10 s after SIGTERM requested a stop" in result.errors
    assert saved_times(result) == SAVED_TIMES


def test_blocked_user_code_is_not_ended_without_a_signal(program: Compile, tmp_path: Path) -> None:
    process = start_blocked(program, tmp_path, "wait_for_a_mutex", 0.1)
    time.sleep(1.5)
    assert process.poll() is None
    process.send_signal(signal.SIGTERM)
    assert end(process, tmp_path).code == 130


def test_interrupted_run_whose_steps_return_says_nothing_else(program: Compile, tmp_path: Path) -> None:
    process = start(program("misbehave.c"), tmp_path, {"simulation_time": 1.0e6, "save_data_period": 1.0})
    wait_until_it_runs(process)
    process.send_signal(signal.SIGINT)
    result = end(process, tmp_path)
    assert result.code == 130
    assert result.errors.count("\n") == 1


def test_run_under_nohup_survives_the_end_of_its_terminal(program: Compile, tmp_path: Path) -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        process = start(program("misbehave.c"), tmp_path, {"simulation_time": 3000.0})
    finally:
        signal.signal(signal.SIGHUP, before)
    wait_until_it_runs(process)
    process.send_signal(signal.SIGHUP)
    assert end(process, tmp_path).code == 0
