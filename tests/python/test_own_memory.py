"""Runs in which each robot has its own variables (robot_memory: own), as on real robots."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from pogosim import Simulation
from running import PROGRAMS, Run, compile_program, compiler, run, write_scene

OWN: dict[str, object] = {
    "robot_memory": "own",
    "simulation_time": 1.0,
    "save_data_period": 0.2,
    "objects.robots.nb": 20,
    "parameters": {"parameter": 42, "array_parameter": [7, 8, 9]},
}
STEPS = 51  # of a robot at 50 Hz in 1 s

BUILDS = {
    "gcc -O2": ("gcc", ["-O2"]),
    "gcc -O0": ("gcc", ["-O0", "-g"]),
    "gcc -O3 -flto": ("gcc", ["-O3", "-flto"]),
    "gcc without PIE": ("gcc", ["-no-pie", "-fno-pie"]),
    "gcc, stripped": ("gcc", ["-s"]),
    "gcc, sections": ("gcc", ["-fdata-sections", "-ffunction-sections", "-Wl,--gc-sections"]),
    "gcc with sanitizers": ("gcc", ["-fsanitize=address,undefined"]),
    "clang -O2": ("clang", ["-O2"]),
    "clang with sanitizers": ("clang", ["-fsanitize=address"]),
}


def check(result: Run) -> None:
    """Each robot has counted for itself."""
    assert (result.code, result.errors) == (0, ""), result.text
    rows = result.frame()
    assert len(rows) == 6 * 20
    last = rows[rows.time > 0.99].set_index("robot_id")
    steps = last.steps.iloc[0]
    assert abs(steps - STEPS) <= 1
    assert (last.steps == steps).all()
    assert (last.countdown == 1000 - last.index - steps).all()
    assert (last.own_place == steps).all()
    assert (last.places == 2).all()  # its own, and that of the global setup
    assert (last.parameter == [42 if robot != 1 else -1 for robot in last.index]).all()
    assert (last.last_of_array == 9).all()
    assert (last.set_in_setup == 77).all()
    assert (last["sum"] == 1 + sum(100 + step for step in range(1, steps + 1))).all()
    assert list(last.text) == [f"robot {robot}" for robot in last.index]
    assert (last["all"] == 20 * steps).all()  # POGO_SHARED
    ends = re.findall(r"(\d+) steps, end (\d+)", result.text)
    assert [int(end) for _, end in ends] == list(range(1, 21))


@pytest.mark.parametrize("build", BUILDS)
def test_each_robot_has_its_own_variables(build: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    name, flags = BUILDS[build]
    monkeypatch.setenv("ASAN_OPTIONS", "detect_leaks=0")
    if compiler(name) is None:
        pytest.skip(f"{name} is not installed")
    program = compile_program(tmp_path / "own", PROGRAMS / "own_memory.c", compiler=name, flags=["-Wall", *flags])
    check(run(program, tmp_path / "run", OWN))


def test_cpp_programs_have_them_too(tmp_path: Path) -> None:
    source = tmp_path / "own_memory.cpp"
    text = (PROGRAMS / "own_memory.c").read_text().replace("allocated = malloc(16)", "allocated = (char*)malloc(16)")
    source.write_text(text)
    check(run(compile_program(tmp_path / "own", source), tmp_path / "run", OWN))


def test_several_files_share_what_is_one_robots(tmp_path: Path) -> None:
    main = tmp_path / "main.c"
    main.write_text(
        '#include "pogobase.h"\nvoid count(void);\nint counted(void);\nvoid step(void) { count(); '
        'printf("%d", counted()); puts(""); }\nint main(void) { pogobot_start(NULL, step); return 0; }\n'
    )
    other = tmp_path / "other.c"
    other.write_text("static int count_of_file;\nvoid count(void) { count_of_file++; }\nint counted(void) { ")
    with other.open("a") as file:
        file.write("return count_of_file; }\n")
    program = compile_program(tmp_path / "two", main, other)
    result = run(program, tmp_path / "run", {"robot_memory": "own", "simulation_time": 0.1})
    assert re.findall(r"PRINTF\] (\d+)", result.text)[:6] == ["1", "1", "1", "2", "2", "2"]


def test_shared_remains_the_default(tmp_path: Path) -> None:
    compiled = compile_program(tmp_path / "own", PROGRAMS / "own_memory.c")
    settings = {key: value for key, value in OWN.items() if key != "robot_memory"}
    rows = run(compiled, tmp_path / "run", settings).frame()
    assert rows.steps.max() > 20 * (STEPS - 1) - 20
    assert len(set(rows[rows.time > 0.99].text)) == 1


def test_threads_give_the_same_bytes(tmp_path: Path) -> None:
    program = compile_program(tmp_path / "own", PROGRAMS / "own_memory.c")
    one = run(program, tmp_path / "1", {**OWN, "threads": 1})
    two = run(program, tmp_path / "2", {**OWN, "threads": 2})
    assert "robots take their steps one after the other: each has its own memory" in two.text
    assert (one.folder / "data.feather").read_bytes() == (two.folder / "data.feather").read_bytes()


def test_programs_in_a_host_have_them(tmp_path: Path) -> None:
    library = compile_program(
        tmp_path / "own.so", PROGRAMS / "own_memory.c", flags=["-Wall", "-shared", "-fPIC", "-O2"]
    )
    configuration = write_scene(tmp_path, {**OWN, "data_filename": str(tmp_path / "data.feather")})
    with Simulation(library, configuration) as one, Simulation(library, configuration) as other:
        for _ in range(50):
            one.step()
            other.step(1)
        assert one.state_hash == other.state_hash, "addresses are not part of the state"
        one.step(1)
        assert one.state_hash != other.state_hash
        other.parameters["parameter"] = 7
        one.step(49)
        other.step(50)
        assert one.to_dataframe().query("time > 0.9").parameter.tolist() == [42, -1] + 18 * [42]
        assert other.to_dataframe().query("time > 0.9").parameter.tolist() == 20 * [7]


def test_hash_sees_what_only_one_robot_has_changed(tmp_path: Path) -> None:
    source = tmp_path / "main.c"
    source.write_text(
        '#include "pogobase.h"\n#include <string.h>\nchar* place;\nint number;\nint start = 5;\n'
        "static void setup(void) { init_from_configuration(start); }\n"
        "void init(void) { place = malloc(8); }\n"
        "void step(void) { if (pogobot_helper_getid() == 2) number = start; place = malloc(8); }\n"
        "int main(void) { pogobot_start(init, step); SET_CALLBACK(callback_global_setup, setup); return 0; }\n"
    )
    program = compile_program(tmp_path / "hash", source)

    def hashes(start: int) -> list[str]:
        settings = {"robot_memory": "own", "simulation_time": 0.1, "parameters": {"start": start}}
        result = run(program, tmp_path / f"run{start}", settings, ["--hash", "5"])
        found = re.findall(r"state after step \d+: (\w+)", result.text)
        assert found, result.text
        return found

    assert hashes(5) == hashes(5)
    assert hashes(5) != hashes(6)


def test_files_that_do_not_say_where_variables_are_are_refused(tmp_path: Path) -> None:
    program = compile_program(tmp_path / "own", PROGRAMS / "own_memory.c")
    data = bytearray(program.read_bytes())
    data[0x28:0x30] = bytes(8)  # e_shoff
    data[0x3C:0x3E] = bytes(2)  # e_shnum
    program.write_bytes(data)
    result = run(program, tmp_path / "run", OWN)
    assert result.code == 2
    assert "robot_memory: own needs to know the program's variables, but its file does not say" in result.errors


def test_other_words_are_refused(tmp_path: Path) -> None:
    program = compile_program(tmp_path / "own", PROGRAMS / "own_memory.c")
    result = run(program, tmp_path / "run", {**OWN, "robot_memory": "private"})
    assert result.code == 2
    text = result.errors.replace(chr(34), "").replace("'", "")
    assert "robot_memory: expected one of auto, shared, own, found private" in text
