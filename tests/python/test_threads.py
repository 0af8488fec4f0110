"""Runs with several threads, as users start them: the same bytes, and one line when something goes wrong."""

from __future__ import annotations

import re
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pogosim
import pytest
from running import PROGRAMS, ROOT, Run, compile_program, compiler, example, run, start, without_places, write_scene

Compile = Callable[[str], Path]

COMPILERS = [name for name in (compiler("gcc"), compiler("clang", "clang-14")) if name]

SWARM: dict[str, object] = {
    "objects.robots.nb": 600,
    "arena_surface": 6e6,
    "simulation_time": 1.0,
    "user_code_timeout": 0.25,
    "objects.lamp": {"type": "static_light", "geometry": "global", "value": 0},
}

SWARMS: dict[str, dict[str, object]] = {
    "run_and_tumble": {"physics_engine": "disk"},
    "moving_oscillators": {},
    "push_sum": {"message_log": "messages.feather"},
    "phototaxis": {"boundary_condition": "periodic"},
}


def errors_of(result: Run) -> list[str]:
    """All but what is said of machines with few processors."""
    return [line for line in result.errors.splitlines() if "which makes the run slower" not in line]


def run_with(threads: object, name: str, folder: Path) -> Run:
    folder.mkdir()
    large = {"objects.robots.nb": 5000, "arena_surface": 4e7, "simulation_time": 3.0, "save_data_period": 0.5}
    result = run(example(name), folder, {**large, **SWARMS[name], "threads": threads})
    assert result.code == 0, result.text
    return result


@pytest.mark.parametrize("name", SWARMS)
def test_any_number_of_threads_gives_the_same_bytes(name: str, tmp_path: Path) -> None:
    expected = run_with(1, name, tmp_path / "1")
    files = sorted(path.name for path in expected.folder.glob("*.feather"))
    assert len(expected.frame()) == 7 * 5000
    for threads in (2, 3, "auto"):
        result = run_with(threads, name, tmp_path / str(threads))
        for file in files:
            assert (result.folder / file).read_bytes() == (expected.folder / file).read_bytes(), (threads, file)


@pytest.mark.skipif(sys.platform != "linux", reason="finds its threads in /proc")
def test_crash_of_a_worker_ends_the_run_soon_with_its_data(program: Compile, tmp_path: Path) -> None:
    began_s = time.monotonic()
    result = run(
        program("crash_of_other_threads.c"),
        tmp_path,
        {"threads": 3, "objects.robots.nb": 3000, "arena_surface": 3e7, "initial_formation": "disk"},
    )
    assert time.monotonic() - began_s < 20.0
    assert result.code == 3
    (line,) = errors_of(result)
    # The signal may find a worker in the step of another robot.
    place = r"(the simulator crashed while it was working on a step|the user program failed in user_step of robot #\d+)"
    assert re.search(rf"{place}.*segmentation fault", line)
    assert line.endswith("The data file 'data.feather' contains all rows up to that point")
    assert 0.4 <= float(result.frame()["time"].max()) < 1.5


def what_is_said(text: str) -> list[str]:
    """Lines of the log without their dates, and what is about the number of threads."""
    lines = [re.sub(r"^\[[-\d :.]*\] ", "", line) for line in text.splitlines()]
    return [line for line in lines if "threads: " not in line]


def run_robots(program: Path, folder: Path, threads: int, kind: str, **parameters: object) -> Run:
    settings = {**SWARM, "threads": threads, "parameters": {"kind": kind, "every": 100, "limit": 5, **parameters}}
    return run(program, folder / str(threads), settings)


@pytest.mark.parametrize(
    "kind",
    [
        "nothing",
        "stop_simulation",
        "take_a_message_that_is_not_there",
        "read_a_parameter_again",
        "write_to_null",
        "divide_by_zero",
        "abort",
        "exit_with_7",
        "set_unknown_column",
    ],
)
def test_robots_on_several_threads_do_say_and_fail_as_on_one(program: Compile, tmp_path: Path, kind: str) -> None:
    expected = run_robots(program("many_threads.c"), tmp_path, 1, kind)
    assert len(expected.robot_lines) > 50
    for threads in (2, 3, 8):
        result = run_robots(program("many_threads.c"), tmp_path, threads, kind)
        assert f"threads: {threads}; robots take their steps on all of them" in result.output
        assert result.code == expected.code
        assert what_is_said(result.errors) == what_is_said(expected.errors)
        data = [(one.folder / "data.feather").read_bytes() for one in (result, expected)]
        assert data[0] == data[1]
        said = [[line for line in what_is_said(one.output) if "PRINTF" in line] for one in (result, expected)]
        if kind in ("nothing", "stop_simulation", "take_a_message_that_is_not_there", "read_a_parameter_again"):
            assert said[0] == said[1]
        else:  # then come the unfinished lines of all robots, some of which were a tick further
            assert said[0][:-600] == said[1][:-600]


def test_first_robot_that_fails_is_named(program: Compile, tmp_path: Path) -> None:
    result = run_robots(program("many_threads.c"), tmp_path, 4, "write_to_null")
    assert result.code == 3
    (line,) = errors_of(result)
    assert (
        "the user program failed in user_step of robot #100 of category 'robots', tick 10, t = 0.1600 s: "
        in without_places(line)
    )
    assert "segmentation fault at address" in line
    assert line.endswith("The data file 'data.feather' contains all rows up to that point")
    assert {f"[ROBOT #{robot}]" for robot in (200, 300)}.isdisjoint(
        line.split(" [PRINTF] ")[0] for line in result.robot_lines if "going to write" in line
    )


@pytest.mark.parametrize("every", [5, 555])  # on all threads, on one
def test_robot_that_never_returns_ends_the_run(program: Compile, tmp_path: Path, every: int) -> None:
    began_s = time.monotonic()
    result = run_robots(program("many_threads.c"), tmp_path, 2, "loop_for_ever", every=every)
    assert time.monotonic() - began_s < 20.0
    assert result.code == 3
    (line,) = errors_of(result)
    assert f"user_step of robot #{every} of" in line
    assert "did not return within 0.25 s of processor time" in line
    assert max(result.frame()["time"]) == pytest.approx(0.1)


def test_crash_beside_a_robot_that_never_returns_ends_the_run(program: Compile, tmp_path: Path) -> None:
    began_s = time.monotonic()
    parameters = {"kind": "one_crashes_beside_one_that_loops", "every": 1, "limit": 5}
    settings = {**SWARM, "threads": 2, "user_code_timeout": 0, "parameters": parameters}
    result = run(program("many_threads.c"), tmp_path, settings)
    assert time.monotonic() - began_s < 40.0
    assert result.code == 3
    (line,) = errors_of(result)
    assert "failed in user_step of robot #299 of category 'robots', tick 10" in line
    assert "segmentation fault" in line
    assert "run it again with -s 1 --set simulation_time=" in line


@pytest.mark.parametrize("every", [5, 555])
def test_second_interrupt_ends_robots_that_never_return(program: Compile, tmp_path: Path, every: int) -> None:
    parameters = {"kind": "loop_for_ever", "every": every, "limit": 5}
    settings = {**SWARM, "threads": 2, "user_code_timeout": 0, "parameters": parameters}
    process = start(program("many_threads.c"), tmp_path, settings)
    time.sleep(2.0)
    process.send_signal(signal.SIGINT)
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    errors = process.communicate(timeout=30)[1]
    assert process.returncode == 130
    assert errors.count("stopping as soon as user_step of robot #") >= 1
    assert f"the run was interrupted in user_step of robot #{every} of category 'robots'" in errors
    assert "interrupted again before it returned" in errors


def test_first_interrupt_ends_a_run_on_several_threads_after_its_step(program: Compile, tmp_path: Path) -> None:
    settings = {**SWARM, "threads": 2, "simulation_time": 10000}
    process = start(program("many_threads.c"), tmp_path, settings)
    time.sleep(1.5)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=30)
    assert process.returncode == 130


def test_changed_parameter_that_all_robots_read_ends_the_run(program: Compile, tmp_path: Path) -> None:
    assert run_robots(program("many_threads.c"), tmp_path, 1, "change_a_parameter").code == 0
    result = run_robots(program("many_threads.c"), tmp_path, 2, "change_a_parameter")
    assert result.code == 3
    (line,) = errors_of(result)
    assert "failed in user_step, tick " in line
    assert "has changed the variable that is set from the parameter 'limit', which all robots share" in line


REASONS = {
    "static uint32_t steps; void user_step(void) { steps++; }": "all robots share the variable 'steps'",
    "void user_step(void) { static int calls; calls++; }": "all robots share the variable 'calls'",
    "static __thread int calls; void user_step(void) { calls++; }": "all robots share the variable 'calls'",
    "POGO_SHARED uint32_t steps; void user_step(void) { steps++; }": "all robots share the variable 'steps'",
    'void user_step(void) { fputs("a", stderr); }': "the program uses '(stderr|fwrite|fputc|fputs)'",
    'void user_step(void) { setenv("A", "B", 1); }': "the program uses 'setenv'",
    'void user_step(void) { char text[] = "a b"; strtok(text, " "); }': "the program uses 'strtok'",
    "#include <fenv.h>\nvoid user_step(void) { fesetround(FE_UPWARD); }": "the program uses 'fesetround'",
    "#include <errno.h>\nvoid user_step(void) { mydata->number = errno; }": "the program uses '__errno_location'",
    """static struct { float speed; uint32_t count; } all;
void user_step(void) { all.count++; init_float_from_configuration(&all.speed, "speed", 1); }
void set(void) {
    init_float_from_configuration(&all.speed, "speed", 1);
    init_float_from_configuration(&all.speed, "fast", 1);
}
#define MORE SET_CALLBACK(callback_global_setup, set);
""": "all robots share the variable 'all'",
    """#include "pogosim/world.h"
void user_step(void) {}
void set(void) { pogosim_world_user_data(0); }
#define MORE SET_CALLBACK(callback_global_setup, set);
""": "callback_global_setup has had USERDATA of robots",
}


@pytest.mark.parametrize("code", REASONS)
def test_robots_that_share_something_take_their_steps_one_after_the_other(tmp_path: Path, code: str) -> None:
    source = tmp_path / "shares.c"
    source.write_text(
        f"""#define _GNU_SOURCE
#include "pogobase.h"
typedef struct {{ int number; }} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)
void user_init(void) {{}}
{code}
#ifndef MORE
#define MORE
#endif
int main(void) {{ pogobot_init(); pogobot_start(user_init, user_step); MORE return 0; }}
"""
    )
    result = run(compile_program(tmp_path / "shares", source), tmp_path, {**SWARM, "threads": 2})
    assert result.code == 0
    (line,) = [line for line in result.output.splitlines() if "threads: 2" in line]
    assert re.search(f"robots take their steps one after the other: {REASONS[code]}", line)


def test_supervisor_that_has_had_userdata_ends_the_steps_on_several_threads(tmp_path: Path) -> None:
    source = tmp_path / "gives.c"
    source.write_text(
        """#include "pogobase.h"
#include "pogosim/world.h"
typedef struct { int* number; } USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)
void user_init(void) {}
void user_step(void) {
    if (mydata->number) {
        *mydata->number = *mydata->number * 3 + pogobot_helper_getid();
        pogobot_led_setColor((uint8_t)*mydata->number, 0, 0);
    }
}
void supervise(void) {
    if (pogobot_ticks == 5) {
        int* number = calloc(1, sizeof(int));
        for (uint32_t i = 0; i < get_nb_robots(); i++) {
            ((USERDATA*)pogosim_world_user_data(i))->number = number;
        }
    }
}
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_step, supervise);
    return 0;
}
"""
    )
    program = compile_program(tmp_path / "gives", source)
    runs = [
        run(program, tmp_path / str(threads), {**SWARM, "threads": threads}, ["--hash", "10"]) for threads in (1, 2)
    ]
    assert "robots take their steps on all of them" in runs[1].output
    assert "robots take their steps one after the other from now on" in runs[1].output
    hashes = [
        [line.split("state after")[1] for line in one.output.splitlines() if "state after" in line] for one in runs
    ]
    assert hashes[0] == hashes[1]
    assert len(hashes[0]) == 10


def test_stripped_program_takes_its_steps_one_after_the_other(tmp_path: Path) -> None:
    stripped = compile_program(tmp_path / "stripped", PROGRAMS / "many_threads.c", flags=("-s",))
    result = run_robots(stripped, tmp_path, 2, "nothing")
    assert "one after the other: the program has no symbol table" in result.output


@pytest.mark.parametrize("name", COMPILERS)
@pytest.mark.parametrize("flags", [("-Wl,-x",), ("-Wl,-x", "-flto"), ("-Wl,-X", "-Wl,--gc-sections"), ("-O3", "-flto")])
def test_program_without_symbols_of_static_variables_takes_its_steps_one_after_the_other(
    name: str, flags: tuple[str, ...], tmp_path: Path
) -> None:
    program = compile_program(tmp_path / "program", PROGRAMS / "many_threads.c", compiler=name, flags=flags)
    result = run_robots(program, tmp_path, 2, "nothing")
    said = "one after the other: the symbols of the program's static variables were stripped"
    assert (said in result.output) == ("-Wl,-x" in flags)
    assert ("robots take their steps on all of them" in result.output) == ("-Wl,-x" not in flags)


@pytest.mark.parametrize("name", COMPILERS)
def test_programs_of_each_compiler_have_threads(name: str, tmp_path: Path) -> None:
    """clang calls bcmp() in place of memcmp() and strcmp(), and stpcpy() in place of sprintf()."""
    program = compile_program(tmp_path / "program", PROGRAMS / "many_threads.c", compiler=name)
    assert "robots take their steps on all of them" in run_robots(program, tmp_path, 2, "nothing").output


def test_runs_inside_python_have_threads_too(tmp_path: Path) -> None:
    program = compile_program(tmp_path / "robots.so", PROGRAMS / "many_threads.c", flags=("-shared", "-fPIC"))
    arena = {"arena_file": str(ROOT / "arenas" / "disk.csv"), "parameters": {"kind": "nothing", "every": 7, "limit": 5}}
    hashes = []
    for threads in (1, 2):
        scene = write_scene(tmp_path, {**SWARM, **arena, "threads": threads})
        with pogosim.Simulation(program, scene, seed=4) as simulation:
            simulation.step(30)
            simulation.parameters["limit"] = 8
            simulation.step(30)
            hashes.append(simulation.state_hash)
    assert hashes[0] == hashes[1]
    scene = write_scene(tmp_path, {**SWARM, **arena, "threads": 2, "parameters.kind": "write_to_null"})
    with (
        pogosim.Simulation(program, scene, seed=4) as simulation,
        pytest.raises(pogosim.ProgramFailedError, match="user_step of robot #7 of"),
    ):
        simulation.step(60)


def test_cpp_programs_with_containers_and_exceptions_share_nothing(tmp_path: Path) -> None:
    source = tmp_path / "containers.cpp"
    source.write_text(
        """#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>
#include "pogobase.h"
struct Userdata { std::vector<int> seen; std::map<int, std::string> names; std::unordered_map<int, int> count; };
DECLARE_USERDATA(Userdata);
REGISTER_USERDATA(Userdata);
static constexpr int weights[4] = {1, 2, 3, 4};
void user_init() { srand(static_cast<unsigned>(pogobot_helper_getRandSeed())); }
void user_step() {
    mydata->seen.push_back(rand() % 1000 * weights[rand() % 4]);
    std::sort(mydata->seen.begin(), mydata->seen.end());
    mydata->names[rand() % 10] = "robot " + std::to_string(rand() % 100);
    mydata->count[mydata->seen.front()]++;
    try {
        if (rand() % 20 == 0) {
            throw std::runtime_error("one in twenty");
        }
    } catch (std::exception const& error) {
        printf("%s %s\\n", error.what(), mydata->names.begin()->second.c_str());
    }
}
int main() { pogobot_init(); pogobot_start(user_init, user_step); return 0; }
"""
    )
    program = compile_program(tmp_path / "containers", source)
    runs = [run(program, tmp_path / str(threads), {**SWARM, "threads": threads}) for threads in (1, 3)]
    assert "robots take their steps on all of them" in runs[1].output
    assert len(runs[0].robot_lines) > 1000
    assert runs[0].robot_lines == runs[1].robot_lines
