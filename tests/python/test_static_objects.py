"""Static objects of programs in C++: with variables of their own, robots construct them themselves."""

from __future__ import annotations

import re
import signal
from pathlib import Path
from typing import Any

import pytest
from pogosim import Simulation
from running import PROGRAMS, Run, compile_program, compiler, run, start, write_scene

SOURCE = PROGRAMS / "static_objects.cpp"
ROBOTS = 20
SCENE: dict[str, Any] = {"simulation_time": 2.0, "objects.robots.nb": ROBOTS}


def check(result: Run, gain: int) -> None:
    """Each robot has objects of its own, as its program has constructed them."""
    assert (result.code, result.errors) == (0, ""), result.text
    said = re.findall(r"\[ROBOT #(\d+)\] \[PRINTF\] (\d+): (.*)", result.text)
    assert [robot for robot, number, _ in said] == [number for _, number, _ in said]
    assert len(said) == ROBOTS
    assert {what for *_, what in said} == {f"own, 11 numbers, 13 steps, own name, witness 1, noted 1, gain {gain}"}


@pytest.mark.parametrize(
    "build", ["g++ -O2", "g++ -O0", "clang++ -O2", "g++ -fsanitize=address,undefined", "g++ -static-libstdc++"]
)
def test_each_robot_has_its_own_objects(build: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    name, *flags = build.split()
    if compiler(name) is None:
        pytest.skip(f"{name} is not installed")
    monkeypatch.setenv("ASAN_OPTIONS", "detect_leaks=0")
    program = compile_program(
        tmp_path / "objects", SOURCE, compiler=name, flags=["-Wall", *flags], package="pogosim-sdk"
    )
    result = run(program, tmp_path / "run", SCENE)
    check(result, 30)
    assert re.findall(r"destroyed \d+", result.text) == ["destroyed 1"], "with the process, not with each robot"
    check(run(program, tmp_path / "configured", {**SCENE, "parameters.gain": 5}), 5)


def test_runs_in_python_have_them(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    library = compile_program(
        tmp_path / "objects.so", SOURCE, flags=["-Wall", "-shared", "-fPIC"], package="pogosim-sdk"
    )
    console = tmp_path / "console.txt"
    configuration = write_scene(tmp_path, {**SCENE, "console_filename": str(console)})
    with Simulation(library, configuration) as one, Simulation(library, configuration) as other:
        one.step(150)
        other.step(150)
        assert one.state_hash == other.state_hash
        hash_before = one.state_hash
        one.reset()
        one.step(150)
        assert one.state_hash == hash_before
    assert "another robot" not in capfd.readouterr().out


def test_constructors_draw_the_same_numbers_after_each_reset(tmp_path: Path) -> None:
    source = tmp_path / "main.cpp"
    source.write_text("""#include <cstdlib>
#include "pogobase.h"
struct Data { int drawn; };
DECLARE_USERDATA(Data)
REGISTER_USERDATA(Data)
int drawn = std::rand();
void step() { mydata->drawn = drawn; }
int main() { pogobot_init(); pogobot_start(nullptr, step); return 0; }
""")
    library = compile_program(tmp_path / "draws.so", source, flags=["-shared", "-fPIC", "-g"])
    with Simulation(library, write_scene(tmp_path, {"objects.robots.nb": 1})) as simulation:
        drawn = []
        for _ in range(3):
            simulation.step(5)
            drawn.append(int(simulation.user_data["drawn"][0]))
            simulation.reset()
    assert drawn[0] != 0
    assert len(set(drawn)) == 1


def test_objects_are_shared_where_variables_are(tmp_path: Path) -> None:
    source = tmp_path / "main.cpp"
    source.write_text("""#include <vector>
#include "pogobase.h"
std::vector<int> all{1, 2};
int constructed = 0;
struct Counter { Counter() { ++constructed; } } counter;
void step() {
    all.push_back(3);
    if (pogobot_ticks == 3) printf("%d constructed, %d\\n", constructed, int(all.size()));
}
int main() { pogobot_init(); pogobot_start(nullptr, step); return 0; }
""")
    program = compile_program(tmp_path / "prog", source)
    settings: dict[str, Any] = {"simulation_time": 0.2, "objects.robots.nb": 3}
    shared = run(program, tmp_path / "shared", settings)
    assert re.findall(r"PRINTF\] (.*)", shared.text) == ["1 constructed, 12", "1 constructed, 13", "1 constructed, 14"]
    own = run(program, tmp_path / "own", {**settings, "robot_memory": "own"})
    assert re.findall(r"PRINTF\] (.*)", own.text) == 3 * ["1 constructed, 6"]


def test_crash_in_a_constructor_names_the_robot(tmp_path: Path) -> None:
    source = tmp_path / "main.cpp"
    source.write_text("""#include "pogobot.h"
#include "pogosim/simulation.h"
POGO_SHARED int constructed;
struct Second { Second() { if (++constructed == 3) *(volatile int*)8 = 1; } } second;
struct First { First() {} ~First() {} } first;
int main() { for (;;) msleep(10); }
""")
    program = compile_program(tmp_path / "prog", source, package="pogosim-sdk", flags=["-g"])
    result = run(program, tmp_path / "run", SCENE)
    assert result.code == 3
    assert "a constructor of static objects of robot #1" in result.errors
    assert "main.cpp:4" in result.errors


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGUSR1"])
@pytest.mark.parametrize("source", [SOURCE, PROGRAMS / "endless.c"], ids=lambda path: path.suffix)
def test_signals_end_the_run_and_nothing_else(source: Path, name: str, tmp_path: Path) -> None:
    """What notes that main() has not begun, and is among the constructors, is not called again."""
    program = compile_program(tmp_path / "prog", source, package="pogosim-sdk")
    process = start(program, tmp_path / "run", {"simulation_time": 1.0e6, "objects.robots.nb": 3})
    assert process.stdout is not None
    assert "PRINTF" in process.stdout.readline()
    process.send_signal(signal.Signals[name])
    output, errors = process.communicate(timeout=60)
    assert process.returncode == 130, errors
    assert "interrupted at t = " in errors + output
    assert "main()" not in errors
    assert len(Run(0, output, errors, tmp_path / "run").frame()) > 0
