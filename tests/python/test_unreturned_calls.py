"""A function of robots that waits and does not return is told once for each category."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

import pytest
from conftest import Compile
from pogosim import Simulation
from running import PROGRAMS, Run, compile_program, compile_text, run, write_scene

OTHERS = {"type": "pogobot", "nb": 1, "geometry": "disk", "radius": 26.5}


def run_loop(program: Path, folder: Path, how: str, **settings: object) -> Run:
    """Run unreturned.c, whose robots hear each other."""
    result = run(program, folder, {"parameters": {"how": how}, "objects.robots.communication_radius": 3000, **settings})
    assert result.code == 0, result.text
    return result


@pytest.fixture(scope="module")
def with_lines(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("unreturned")
    return compile_program(folder / "prog", PROGRAMS / "unreturned.c", flags=["-g", "-O0"])


def line_of(comment: str) -> int:
    lines = (PROGRAMS / "unreturned.c").read_text().splitlines()
    return next(number for number, line in enumerate(lines, 1) if comment in line)


ADVICE = (
    "Let it return: the main loop calls user_step at each tick. An endless loop as on the robot belongs in main(), "
    "with pogobot.h (docs/porting.md)"
)


@pytest.mark.parametrize("how", ["msleep", "update", "clock", "motor", "sleep"])
def test_user_step_that_never_returns_is_told(with_lines: Path, tmp_path: Path, how: str) -> None:
    result = run_loop(with_lines, tmp_path, how, simulation_time=6.0)
    assert result.errors.count("[warning]") == 1, result.errors
    assert (
        "category 'robots': user_step of all 3 robots has not returned since t = 0 s (robot #0 waits at "
        in result.errors
    )
    assert (
        "): pogobot_ticks stays 0, msg_tx_fn sends nothing, msg_rx_fn gets no message until it returns. " + ADVICE
        in result.errors
    )
    if how in ("msleep", "sleep"):
        line = line_of(f"here it {'sleeps' if how == 'sleep' else 'waits'}")
        assert re.search(rf"unreturned\.c:{line} in loop\(\)\)", result.errors)
    assert (result.frame().pogobot_ticks == 0).all()


def test_callbacks_that_a_program_does_not_have_are_not_named(program: Compile, tmp_path: Path) -> None:
    errors = run_loop(program("unreturned.c"), tmp_path, "no callbacks").errors
    assert "): pogobot_ticks stays 0 until it returns. Let it return" in errors


@pytest.mark.parametrize(
    ("how", "consequence"),
    [
        ("user_init", "user_step is not called"),
        ("msg_tx_fn", "pogobot_ticks stays 0, user_step is not called again, msg_rx_fn gets no message"),
        ("msg_rx_fn", "pogobot_ticks stays as it is, user_step is not called again"),
    ],
)
def test_function_that_does_not_return_is_named(program: Compile, tmp_path: Path, how: str, consequence: str) -> None:
    errors = run_loop(program("unreturned.c"), tmp_path, how).errors
    assert errors.count("[warning]") == 1, errors
    assert f"category 'robots': {how} of all 3 robots has not returned" in errors
    assert f"): {consequence} until it returns. Let it return" in errors


def test_robots_that_do_not_return_are_counted(program: Compile, tmp_path: Path) -> None:
    errors = run_loop(program("unreturned.c"), tmp_path, "late").errors
    assert errors.count("has not returned") == 1, errors
    assert "category 'robots': user_step of 2 of 3 robots has not returned since t = 0.8 s (robot #1 waits" in errors
    assert "): pogobot_ticks stays as it is, " in errors


def test_each_category_is_told_once(program: Compile, tmp_path: Path) -> None:
    errors = run_loop(program("unreturned.c"), tmp_path, "msleep", **{"objects.others": OTHERS}).errors
    assert re.findall(r"\[warning\] category '(\w+)': user_step of (.*?) has", errors) == [
        ("robots", "all 3 robots"),
        ("others", "its robot"),
    ]


def test_it_is_told_early_in_a_long_run(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    folder = tmp_path / "run"
    configuration = write_scene(folder, {"parameters": {"how": "msleep"}, "simulation_time": 1e4})
    flags = ["-g", "-shared", "-fPIC"]
    library = compile_program(tmp_path / "unreturned.so", PROGRAMS / "unreturned.c", flags=flags)
    with Simulation(library, configuration) as simulation:
        simulation.run(59.0)
        assert "has not returned" not in caplog.text
        simulation.run(61.0)
        assert caplog.text.count("has not returned") == 1
        simulation.run(200.0)
    assert caplog.text.count("has not returned") == 1


@pytest.mark.parametrize(
    ("how", "count"), [("msg_rx_fn", "3 of 4 robots"), ("late", "3 of 4 robots"), ("msg_tx_fn", "all 4 robots")]
)
def test_it_is_told_early_though_a_few_robots_go_on(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, how: str, count: str
) -> None:
    # The robot far away hears no message.
    near, far = ({"x": 300 + 60 * i, "y": 300} for i in range(3)), {"x": 900, "y": 900}
    robots = {"objects.robots.nb": 4, "objects.robots.poses": [[p["x"], p["y"], 0] for p in (*near, far)]}
    settings = {"parameters": {"how": how}, "simulation_time": 1e4, "arena_surface": 1e6, **robots}
    configuration = write_scene(tmp_path, {**settings, "objects.robots.communication_radius": 200})
    flags = ["-g", "-shared", "-fPIC"]
    library = compile_program(tmp_path / "unreturned.so", PROGRAMS / "unreturned.c", flags=flags)
    with Simulation(library, configuration) as simulation:
        simulation.run(50.0)
        assert "has not returned" not in caplog.text
        simulation.run(80.0)
        assert caplog.text.count("has not returned") == 1
        assert f"{how if how != 'late' else 'user_step'} of {count} has not returned" in caplog.text


@pytest.mark.parametrize("how", ["long sleep", "long steps", "now and then", "dance"])
def test_robots_that_wait_for_long_and_return_are_not_told(program: Compile, tmp_path: Path, how: str) -> None:
    result = run_loop(program("unreturned.c"), tmp_path, how, simulation_time=90.0)
    assert result.errors == ""


def test_loop_with_long_pauses_is_told_at_the_end(program: Compile, tmp_path: Path) -> None:
    errors = run_loop(program("unreturned.c"), tmp_path, "dance", simulation_time=65.0).errors
    assert "user_step of all 3 robots has not returned since t = 0 s" in errors


def test_end_of_the_run_during_a_few_long_sleeps_is_not_told(program: Compile, tmp_path: Path) -> None:
    assert run_loop(program("unreturned.c"), tmp_path, "now and then", simulation_time=3.5).errors == ""


def test_call_that_lasts_less_than_ten_times_the_usual_is_not_told(program: Compile, tmp_path: Path) -> None:
    # A call of 1 s, then one that has lasted 5 s, or 12 s, when the run ends.
    prog = program("unreturned.c")
    assert run_loop(prog, tmp_path / "5", "slower", simulation_time=6.0).errors == ""
    assert "has not returned" in run_loop(prog, tmp_path / "12", "slower", simulation_time=13.5).errors


def test_robot_that_is_switched_off_is_not_told(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    configuration = write_scene(tmp_path, {"parameters": {"how": "late"}, "simulation_time": 5.0})
    flags = ["-g", "-shared", "-fPIC"]
    library = compile_program(tmp_path / "unreturned.so", PROGRAMS / "unreturned.c", flags=flags)
    with Simulation(library, configuration) as simulation:
        simulation.step(200)
        simulation.objects[1].kill()
        simulation.objects[2].kill()
        simulation.run()
    assert "has not returned" not in caplog.text


def test_programs_for_the_sdk_may_loop_for_ever(tmp_path: Path) -> None:
    text = '#include "pogobot.h"\nint main(void) { pogobot_init(); for (;;) { msleep(10); } }\n'
    program = compile_text(tmp_path, text, package="pogosim-sdk")
    assert run(program, tmp_path / "run", {"simulation_time": 70.0}).errors == ""


def test_run_on_threads_tells_the_same(program: Compile, tmp_path: Path) -> None:
    many: dict[str, Any] = {"objects.robots.nb": 200, "arena_surface": 1e7, "objects.robots.communication_radius": 100}
    errors = {
        threads: re.sub(
            r"^\[[^]]*\] ",
            "",
            run_loop(program("unreturned.c"), tmp_path / str(threads), "late", threads=threads, **many).errors,
        )
        for threads in (1, 2)
    }
    assert errors[1] == errors[2]
    assert "user_step of 199 of 200 robots" in errors[1]


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_place_is_found_under_the_address_sanitizer(
    tmp_path: Path, compiler: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(os.environ, "ASAN_OPTIONS", "detect_leaks=0:detect_stack_use_after_return=1")
    flags = ["-g", "-O0", "-fsanitize=address"]
    program = compile_program(tmp_path / "prog", PROGRAMS / "unreturned.c", compiler=compiler, flags=flags)
    errors = run_loop(program, tmp_path / "run", "msleep").errors
    assert "AddressSanitizer" not in errors
    assert f"unreturned.c:{line_of('here it waits')} in loop()" in errors
