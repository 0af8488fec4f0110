"""Every function of the robots' library does the same in a program in C and in its firmware."""

from __future__ import annotations

import re

import pytest
from firmwares import firmware_in, project_of
from running import ROOT, Run, compile_program, run, warnings

SOURCE = ROOT / "tests" / "programs" / "every_function.c"
TABLES = sorted((ROOT / "src" / "firmware").glob("*_functions.cpp"))
# Functions that a program does not call by these names with Pogosim's headers: macros, input that no robot has, and
# what the C library calls.
OF_SDK = {
    "busy_wait",
    "busy_wait_us",
    "magn_check",
    "slip_send_message",
    "uart_init",
    "uart_isr",
    "uart_read",
    "uart_read_nonempty",
    "uart_sync",
    "uart_write",
    "readchar",
    "readchar_nonblock",
    "base_getchar",
    "_exit",
}
# Two robots face each other; a light between them and the wall.
SCENE: dict[str, object] = {
    "objects.robots.nb": 2,
    "objects.robots.poses": [[450, 500, 0], [540, 500, 3.14159265]],
    "objects.robots.motor_noise": None,
    "objects.sun": {"type": "static_light", "geometry": "disk", "radius": 600, "value": 20000, "x": 500, "y": 700},
    "magnetometer": {"enabled": True},
    "simulation_time": 3.0,
    "save_data_period": 0.02,
}


def names_in_tables() -> set[str]:
    texts = "".join(table.read_text() for table in TABLES)
    return set(re.findall(r'LibraryFunction\{(?:\.name = )?"(\w+)"', texts))


def said_by_robots(result: Run) -> list[str]:
    assert result.code == 0, result.text
    return result.robot_lines


def told(result: Run) -> list[str]:
    """Return the warnings about robots, without the lines of the program's source."""
    return sorted(re.sub(r"^.*?(robot #)", r"\1", line) for line in warnings(result) if "robot #" in line)


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> tuple[Run, Run]:
    """Return the run of the program in C, and that of its firmware."""
    folder = tmp_path_factory.mktemp("every")
    firmware = firmware_in(project_of(folder / "project", SOURCE))
    program = compile_program(folder / "program", SOURCE)
    native = run(program, folder / "native", SCENE)
    brain = {"objects.robots.brain": {"firmware": str(firmware), "random": "simulator"}}
    return native, run(program, folder / "emulated", SCENE | brain)


def test_all_functions_of_the_tables_are_called() -> None:
    names, source = names_in_tables(), SOURCE.read_text()
    assert len(names) > 60
    assert {name for name in names if not re.search(rf"\b{name}\(", source)} == OF_SDK


def test_robots_print_the_same(runs: tuple[Run, Run]) -> None:
    native, emulated = (said_by_robots(result) for result in runs)
    assert any("60 end 0" in line for line in native)
    assert emulated == native


def test_same_slips_are_told(runs: tuple[Run, Run]) -> None:
    native, emulated = (told(result) for result in runs)
    assert len(native) >= 5
    assert emulated == native


def test_robots_move_and_shine_the_same(runs: tuple[Run, Run]) -> None:
    native, emulated = (result.table() for result in runs)
    assert native.num_rows > 200
    assert emulated.equals(native)
