"""gdb stops, looks at and steps a robot that runs firmware, as it does a robot with a probe."""

from __future__ import annotations

import re
import socket
import subprocess
from pathlib import Path

import pytest
from firmwares import OF_ROBOTS, firmware_of, run_firmware, without_program
from running import Run, compiler, end, run, write_scene

PROGRAM = """#include "pogobase.h"
typedef struct { uint32_t count; uint32_t doubled; } USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)
void user_init(void) { mydata->count = 40; }
void user_step(void) {
    mydata->count++;
    mydata->doubled = 2 * mydata->count;
    pogobot_led_setColor((uint8_t)(mydata->count % 25), 0, 10);
    LAST
}
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
"""
CLOCKS = ("off", "counted")


def debugger() -> str:
    """Return a gdb that knows the robots' processor."""
    found = compiler("riscv64-unknown-elf-gdb", "gdb-multiarch")
    assert found, "a gdb for robots is missing: apt-get install gdb-multiarch"
    return found


def free_port() -> int:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return int(listener.getsockname()[1])


def settings(firmware: Path, cpu_time: str = "off") -> dict[str, object]:
    return {
        f"{OF_ROBOTS}.firmware": str(firmware),
        f"{OF_ROBOTS}.columns": ["mydata.count", "mydata.doubled"],
        "objects.robots.cpu_time": cpu_time,
    }


def debug(
    firmware: Path, folder: Path, lines: list[str], cpu_time: str = "off", arguments: tuple[str, ...] = ()
) -> tuple[str, Run]:
    """Run a firmware with gdb, which carries out these lines; return what gdb has printed, and the run."""
    gdb = debugger()
    port = free_port()
    write_scene(folder, settings(firmware, cpu_time))
    command = [str(without_program()), "-c", "scene.yaml", "-g", "--gdb", str(port), *arguments]
    simulator = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        script = folder / "commands.gdb"
        before = ["set pagination off", "set confirm off", "set tcp connect-timeout 30", f"target remote :{port}"]
        script.write_text("\n".join([*before, *lines, ""]))
        said = subprocess.run(
            [gdb, "-nx", "-q", "-batch", "-x", str(script), str(firmware)],
            cwd=folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL,
            text=True,
            timeout=120,
            check=False,
        ).stdout
        return said, end(simulator, folder)
    finally:
        simulator.kill()


@pytest.fixture(scope="module")
def firmware(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return firmware_of(tmp_path_factory.mktemp("firmware"), PROGRAM.replace("LAST", ""))


@pytest.mark.parametrize("cpu_time", CLOCKS)
def test_robot_is_stepped_and_ends_as_without_gdb(cpu_time: str, firmware: Path, tmp_path: Path) -> None:
    lines = [
        "break user_step",
        "continue",
        *("print myuserdata", "info registers pc", "next", "print myuserdata.count"),
        *("delete", "break pogobot_led_setColor", "continue", "print myuserdata", "stepi", "backtrace"),
        *("delete", "watch myuserdata.doubled", "continue", "print myuserdata.count"),
        *("monitor robot", "monitor time", "delete", "continue"),
    ]
    said, result = debug(firmware, tmp_path / "gdb", lines, cpu_time, ("--gdb-robot", "1"))
    values = re.findall(r"^\$\d+ = (.*)$", said, re.MULTILINE)
    assert values == [
        "{count = 40, doubled = 0}",
        "41",
        "{count = 41, doubled = 82}",
        "42",
    ], said
    assert "Breakpoint 1, user_step ()" in said
    assert "Breakpoint 2, pogobot_led_setColor ()" in said
    assert "Old value = 82\nNew value = 84\n" in said
    assert "robot #1 of category 'robots'" in said
    assert re.search(r"^t = 0\.\d+ s, its clock \d+\.\d+ s, tick \d+, \d+ cycles$", said, re.MULTILINE), said
    assert "exited normally]" in said

    assert result.code == 0, result.text
    assert "robot #1: waiting for gdb on port " in result.output
    alone = run(without_program(), tmp_path / "alone", settings(firmware, cpu_time))
    assert alone.code == 0, alone.text
    assert (tmp_path / "gdb" / "data.feather").read_bytes() == (tmp_path / "alone" / "data.feather").read_bytes()


def test_run_goes_on_when_gdb_leaves(firmware: Path, tmp_path: Path) -> None:
    _, result = debug(firmware, tmp_path / "gdb", ["break user_step", "continue", "detach"])
    assert result.code == 0, result.text
    assert "robot #0: gdb has left, and the run goes on" in result.output
    run(without_program(), tmp_path / "alone", settings(firmware))
    assert (tmp_path / "gdb" / "data.feather").read_bytes() == (tmp_path / "alone" / "data.feather").read_bytes()


def test_fault_is_shown_before_the_run_ends(tmp_path: Path) -> None:
    wrong = "if (mydata->count == 45) { *(volatile uint32_t*)0x90000000 = 1; }"
    firmware = firmware_of(tmp_path / "firmware", PROGRAM.replace("LAST", wrong))
    said, result = debug(firmware, tmp_path / "run", ["continue", "print myuserdata.count", "backtrace", "continue"])
    assert "received signal SIGSEGV" in said
    assert "$1 = 45\n" in said
    assert "#0  " in said
    assert "Program terminated with signal SIGSEGV" in said
    assert result.code == 3
    assert "it accessed 0x90000000, where there is no memory" in result.errors


def test_kill_ends_the_run(firmware: Path, tmp_path: Path) -> None:
    said, result = debug(firmware, tmp_path, ["tbreak user_step", "continue", "kill"])
    assert "killed]" in said
    assert result.code == 0, result.text
    assert result.frame()["time"].max() < 0.5


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--gdb", "65536"], "expected a port from 1 to 65535, or 0 for one that is free, found '65536'"),
        (["--gdb", "0", "--gdb-robot", "99"], "--gdb-robot: there is no robot #99"),
        (["--gdb-robot", "1"], "--gdb-robot requires --gdb"),
    ],
)
def test_mistakes_get_one_line(arguments: list[str], message: str, firmware: Path, tmp_path: Path) -> None:
    result = run_firmware(firmware, tmp_path, None, arguments)
    assert result.code == 2
    assert message in result.errors
    assert "Traceback" not in result.text


def test_robots_without_firmware_are_not_debugged(tmp_path: Path) -> None:
    result = run(
        without_program(), tmp_path, {OF_ROBOTS: {"script": [{"time_s": 0, "led": [1, 2, 3]}]}}, ["--gdb", "0"]
    )
    assert result.code == 2
    assert "--gdb: no robot runs firmware" in result.errors


def test_port_that_is_in_use_is_refused(firmware: Path, tmp_path: Path) -> None:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        listener.listen()
        port = listener.getsockname()[1]
        result = run_firmware(firmware, tmp_path, None, ["--gdb", str(port)])
    assert result.code == 2
    assert f"--gdb: port {port} is in use" in result.errors
