"""Programs that wait in the middle of a step: the world goes on, and so do they when it is time."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pogosim import Simulation
from running import PROGRAMS, Run, compile_program, run, write_scene

Compile = Callable[[str], Path]

STEP_S = 0.01  # of the scene


def wait(program: Compile, folder: Path, how: str, wait_ms: int = 100, **settings: object) -> Run:
    """Run waits.c."""
    parameters = {"how": how, "wait_ms": wait_ms}
    return run(program("waits.c"), folder, {"parameters": parameters, **settings})


@pytest.mark.parametrize(
    ("how", "slack_us"),
    [
        ("msleep", 0),
        ("usleep", 0),
        ("small sleeps", 0),
        ("expiry", 0),
        ("timer", 20),
        ("remaining time", 20),
        ("stopwatch", 20),
        ("milliseconds", 20),
    ],
)
def test_robot_goes_on_at_its_time(program: Compile, tmp_path: Path, how: str, slack_us: int) -> None:
    result = wait(program, tmp_path, how)
    assert (result.code, result.errors) == (0, ""), result.text
    last = result.frame().query("time > 1.95")
    assert len(last) == 3
    least_us = 99_000 if how == "milliseconds" else 100_000
    assert last.waited_us.between(least_us, 100_000 + slack_us).all()
    assert (last.waits.sub(19.5).abs() <= 1).all(), "a tick takes as long as its wait"
    ticks = re.findall(r"\[TIME\] Error code: 0: tick took (\d+) ms; main_loop_hz allows 20 ms", result.text)
    assert len(ticks) == last.waits.sum()
    assert set(ticks) <= {"99", "100"}


def test_short_waits_do_not_change_the_rate_of_the_loop(program: Compile, tmp_path: Path) -> None:
    waiting = wait(program, tmp_path / "waiting", "msleep", wait_ms=7).frame()
    at_once = wait(program, tmp_path / "at_once", "nothing").frame()
    last = waiting.time.max()
    assert (waiting[waiting.time == last].ticks - at_once[at_once.time == last].ticks).abs().max() <= 1


def test_world_goes_on_while_a_robot_waits(program: Compile, tmp_path: Path) -> None:
    settings: dict[str, Any] = {
        "objects.robots.nb": 1,
        "objects.robots.x": 1500,
        "objects.robots.y": 1500,
        "arena_surface": 1e7,
        "save_data_period": 0.01,
    }
    result = wait(program, tmp_path, "drive", wait_ms=500, **settings)
    assert (result.code, result.errors) == (0, ""), result.text
    rows = result.frame()
    start = rows.iloc[0]
    distance = np.hypot(rows.x.to_numpy() - start.x, rows.y.to_numpy() - start.y)
    assert distance[-1] == pytest.approx(100 * 0.5, abs=2 * 100 * STEP_S)  # full power: 100 mm/s
    halfway = distance[rows.time.sub(0.25).abs().argmin()]
    assert halfway == pytest.approx(100 * 0.25, abs=2 * 100 * STEP_S)
    assert (distance[rows.time.to_numpy() > 0.53] == distance[-1]).all()


def test_robots_wait_for_a_message(program: Compile, tmp_path: Path) -> None:
    near: dict[str, Any] = {"objects.robots.communication_radius": 3000, "save_data_period": 0.01}
    result = wait(program, tmp_path, "message", **near)
    assert (result.code, result.errors) == (0, ""), result.text
    others = result.frame().query("robot_id > 0")
    # Robot 0 sends at its tick 25, at 25 * 20 ms.
    assert not others.query("time < 0.5").waits.any()
    assert others.query("time < 0.5 and time > 0").is_waiting.all()
    assert (others.query("time > 0.53").groupby("robot_id").waits.min() == 1).all()
    assert others.waited_us.max() == pytest.approx(500_000, abs=2.1e6 * STEP_S)


def test_robots_wait_for_a_message_in_user_init(program: Compile, tmp_path: Path) -> None:
    near: dict[str, Any] = {"objects.robots.communication_radius": 3000, "save_data_period": 0.01}
    result = wait(program, tmp_path, "init", **near)
    assert result.code == 0, result.text
    assert "user_init of all 3 robots has not returned since t = 0 s" in result.errors
    rows = result.frame()
    assert (rows.time == 0).sum() == 3, "rows of time 0 are there as always"
    assert not rows.query("ticks > 0").size, "all wait for a message, and nobody sends one"


def test_robots_wait_for_a_sensor(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    lamp = {"objects.lamp": {"type": "static_light", "geometry": "global", "value": 500}}
    write_scene(folder, {"parameters": {"how": "darkness"}, **lamp})
    flags = ["-Wall", "-g", "-shared", "-fPIC"]
    library = compile_program(tmp_path / "waits.so", PROGRAMS / "waits.c", flags=flags)
    with Simulation(library, folder / "scene.yaml") as simulation:
        simulation.step(50)
        assert simulation.user_data["is_waiting"].all()
        simulation.lamps[0].is_on = False
        simulation.step(3)
        assert (simulation.user_data["waits"] > 0).all()


def test_each_call_in_progress_keeps_its_variables(program: Compile, tmp_path: Path) -> None:
    result = wait(program, tmp_path, "recursion", wait_ms=30, **{"objects.robots.nb": 50})
    assert (result.code, result.errors) == (0, ""), result.text
    assert set(result.frame().query("time > 0.2").number) == {50 * 51 // 2}
    assert "not the variables" not in result.text


def test_waits_are_the_same_in_every_run_and_on_threads(program: Compile, tmp_path: Path) -> None:
    many = {"objects.robots.nb": 500, "arena_surface": 1e7}
    results = {
        name: wait(program, tmp_path / name, "small sleeps", wait_ms=33, **many, **settings)
        for name, settings in {"1": {}, "again": {}, "2": {"threads": 2}, "3": {"threads": 3}}.items()
    }
    data = {name: (result.folder / "data.feather").read_bytes() for name, result in results.items()}
    assert len(set(data.values())) == 1
    assert {result.code for result in results.values()} == {0}
    lines = {name: re.sub(r"^\[[^]]*\] ", "", result.text, flags=re.MULTILINE) for name, result in results.items()}
    assert lines["1"] == lines["again"]


def test_wait_that_never_ends_ends_with_the_run(program: Compile, tmp_path: Path) -> None:
    result = wait(program, tmp_path, "message", **{"objects.robots.communication_radius": 0})
    assert result.code == 0, result.text
    assert "user_step of 2 of 3 robots has not returned since t = 0 s" in result.errors
    last = result.frame().query("time > 1.95 and robot_id > 0")
    assert last.is_waiting.all()
    assert not last.waits.any()


def test_loop_without_end_still_meets_its_limit(program: Compile, tmp_path: Path) -> None:
    result = wait(program, tmp_path, "no end", user_code_timeout=0.3)
    assert result.code == 3
    assert "did not return within 0.3 s of processor time (user_code_timeout)" in result.errors
    assert "user_step of robot #0" in result.errors


def test_crash_after_a_wait_names_robot_and_time(program: Compile, tmp_path: Path) -> None:
    result = wait(program, tmp_path, "crash")
    assert result.code == 3
    assert "user_step of robot #1 of category 'robots', tick 0, t = 0.1000 s, in " in result.errors
    assert "(): segmentation fault" in result.errors
    assert len(result.frame()) == 3 * 2, "the rows up to then"


def test_overflow_of_the_stack_after_waits_is_named(program: Compile, tmp_path: Path) -> None:
    result = wait(program, tmp_path, "overflow", robot_stack_size=128, simulation_time=10.0)
    assert result.code == 3
    assert "stack overflow: the 128 KiB of the stack are full (robot_stack_size)" in result.errors


@pytest.mark.parametrize("size", [0, 10, -5, 1 << 30, "large"])
def test_stacks_of_impossible_size_are_refused(program: Compile, tmp_path: Path, size: object) -> None:
    result = wait(program, tmp_path, "msleep", robot_stack_size=size)
    assert result.code == 2
    assert "robot_stack_size" in result.errors


def test_many_robots_may_wait(program: Compile, tmp_path: Path) -> None:
    settings: dict[str, Any] = {"objects.robots.nb": 5000, "arena_surface": 1e8, "simulation_time": 0.5}
    result = wait(program, tmp_path, "msleep", **settings)
    assert (result.code, result.errors) == (0, ""), result.text[-2000:]
    assert (result.frame().query("time > 0.45").waits == 4).all()


def test_robot_that_is_switched_off_while_it_waits_goes_on_later(tmp_path: Path) -> None:
    flags = ["-Wall", "-g", "-shared", "-fPIC"]
    library = compile_program(tmp_path / "waits.so", PROGRAMS / "waits.c", flags=flags)
    configuration = write_scene(tmp_path, {"parameters": {"how": "msleep", "wait_ms": 100}, "simulation_time": 5.0})
    with Simulation(library, configuration) as simulation:
        simulation.step(5)
        simulation.objects[1].kill()
        simulation.step(100)
        assert list(simulation.user_data["waits"] > 0) == [True, False, True]
        assert simulation.user_data["is_waiting"][1]
        simulation.objects[1].revive()
        simulation.step(2)
        assert simulation.user_data["waits"][1] == 1
        simulation.step(50)
        assert simulation.user_data["waits"][1] > 3


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_waits_under_the_address_sanitizer(tmp_path: Path, compiler: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(os.environ, "ASAN_OPTIONS", "detect_leaks=0:detect_stack_use_after_return=1")
    program = compile_program(
        tmp_path / "waits", PROGRAMS / "waits.c", compiler=compiler, flags=["-g", "-fsanitize=address"]
    )
    for how, code in {"recursion": 0, "small sleeps": 0, "no end": 3}.items():
        settings = {"parameters": {"how": how, "wait_ms": 30}, "user_code_timeout": 0.5, "objects.robots.nb": 20}
        result = run(program, tmp_path / how.replace(" ", "_"), settings)
        assert result.code == code, result.text
        assert "AddressSanitizer" not in result.errors


def test_exceptions_that_are_handled_during_a_wait_stay_with_their_robot(tmp_path: Path) -> None:
    source = tmp_path / "main.cpp"
    source.write_text(
        """#include "pogobase.h"
#include <stdexcept>
#include <string>
struct USERDATA { int caught = 0; };
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)
void user_init() { main_loop_hz = 50; }
void user_step() {
    int const id = pogobot_helper_getid();
    std::string const text = "error of robot " + std::to_string(id) + ", at its tick " + std::to_string(pogobot_ticks);
    try {
        throw std::runtime_error(text);
    } catch (std::exception const& error) {
        msleep(10 + 7 * id);
        try {
            throw;
        } catch (std::runtime_error const& again) {
            msleep(5);
            mydata->caught += again.what() == text && error.what() == text;
        }
    }
    if (mydata->caught != int(pogobot_ticks) + 1) {
        printf("wrong\\n");
    }
    if (id == 3 && pogobot_ticks == 20) {
        throw std::runtime_error("the end");
    }
}
int main() { pogobot_init(); pogobot_start(user_init, user_step); return 0; }
"""
    )
    result = run(compile_program(tmp_path / "throws", source), tmp_path / "run", {"objects.robots.nb": 10})
    assert result.code == 3
    assert "wrong" not in result.text
    assert "user_step of robot #3 of category 'robots', tick 20" in result.errors
    assert "C++ exception: the end" in result.errors
