"""Robots that change the mode of the floating-point unit change neither the world nor other robots nor the host."""

from __future__ import annotations

import ctypes
import ctypes.util
import platform
import re
from pathlib import Path
from typing import Any

import pytest
from conftest import Compile
from pogosim import ProgramFailedError, Simulation
from running import PROGRAMS, Run, compile_program, compile_text, run, write_scene

X86_MODES = ["rounding", "flush", "flush results", "flush operands", "traps", "x87"]
MODES = X86_MODES if platform.machine() == "x86_64" else ["rounding"]
PLACES = ["user_step", "user_init", "msg_rx_fn", "msg_tx_fn", "wait", "global_setup", "schema", "export", "global_step"]
SCENE: dict[str, Any] = {
    "arena_surface": 2e6,
    "simulation_time": 2.0,
    "objects.robots.nb": 40,
    "objects.robots.communication_radius": 200,
    "objects.robots.linear_noise_stddev": 0.1,
    "objects.robots.photosensors_noise_stddev": 3.0,
    "objects.lamp": {"type": "static_light", "geometry": "global", "value": 500},
}
WARNING = "the program changed the mode of the floating-point unit"


def run_mode(program: Path, folder: Path, how: str, where: str, **settings: object) -> Run:
    """Run floating_point.c."""
    parameters = {"parameters": {"how": how, "where": where}}
    return run(program, folder, {**SCENE, **parameters, **settings}, ["--hash", "50"])


def states(result: Run) -> list[str]:
    """Hashes of the state during the run, and the data."""
    assert result.code == 0, result.text
    numbers = result.frame().drop(columns="time").astype(str)
    return [*re.findall(r"state after step \d+: (\w+)", result.text), numbers.to_csv()]


@pytest.mark.parametrize("where", PLACES)
def test_mode_that_a_robot_sets_changes_nothing(program: Compile, tmp_path: Path, where: str) -> None:
    prog = program("floating_point.c")
    expected = states(run_mode(prog, tmp_path / "nothing", "nothing", where))
    assert len(expected) == 5
    for how in MODES:
        result = run_mode(prog, tmp_path / how, how, where)
        assert states(result)[:-1] == expected[:-1], how
        assert result.errors.count(WARNING) == 1, "it is said once"


def test_mode_is_of_one_robot_on_threads_too(program: Compile, tmp_path: Path) -> None:
    prog = program("floating_point.c")
    many = {"objects.robots.nb": 300, "arena_surface": 1e7}
    found = {
        (how, threads): states(run_mode(prog, tmp_path / f"{how}{threads}", how, "user_step", threads=threads, **many))
        for how in ("nothing", "rounding")
        for threads in (1, 2)
    }
    assert len({str(state[:-1]) for state in found.values()}) == 1


def test_program_compiled_for_fast_floating_point_runs_in_the_standard_mode(tmp_path: Path) -> None:
    # -Ofast links a constructor that takes denormal numbers for zero in the whole process.
    text = """#include "pogobase.h"
volatile float small = 1e-38f;
void user_step(void) { if (pogobot_ticks == 3) printf("%s", small / 16 > 0 ? "denormal\\n" : "zero\\n"); }
int main(void) { pogobot_init(); pogobot_start(NULL, user_step); return 0; }
"""
    result = run(compile_text(tmp_path, text, flags=["-Ofast"]), tmp_path / "run", {"objects.robots.nb": 1})
    assert (result.code, result.errors) == (0, "")
    assert result.robot_lines == ["[ROBOT #0] [PRINTF] denormal"]


def library(folder: Path) -> Path:
    return compile_program(
        folder / "floating_point.so", PROGRAMS / "floating_point.c", flags=["-g", "-shared", "-fPIC", "-Ofast"]
    )


def c_library() -> Any:
    return ctypes.CDLL(ctypes.util.find_library("m"))


def test_host_keeps_its_own_mode_which_changes_nothing(tmp_path: Path) -> None:
    math = c_library()
    upward = {"x86_64": 0x800, "aarch64": 0x400000}[platform.machine()]
    hashes = set()
    for mode in (0, upward):
        settings = {**SCENE, "parameters": {"how": "rounding", "where": "export"}}
        configuration = write_scene(tmp_path / str(mode), settings)
        assert math.fesetround(mode) == 0
        try:
            with Simulation(library(tmp_path), configuration) as simulation:
                simulation.step(100)
                hashes.add(simulation.state_hash)
                assert math.fegetround() == mode
            assert math.fegetround() == mode
        finally:
            math.fesetround(0)
    assert len(hashes) == 1


@pytest.mark.skipif(platform.machine() != "x86_64", reason="the program sets the mode of x86-64 before it crashes")
def test_host_has_its_mode_after_a_crash(tmp_path: Path) -> None:
    math = c_library()
    configuration = write_scene(tmp_path, {**SCENE, "parameters": {"how": "crash", "where": "user_step"}})
    with Simulation(library(tmp_path), configuration) as simulation:
        with pytest.raises(ProgramFailedError):
            simulation.step(10)
        assert math.fegetround() == 0
