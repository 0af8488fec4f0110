"""Programs written for the robots' SDK, without knowledge of our header, run as they are.

Each robot of theirs checks about once a second that its variables are as it has left them, and prints "SELF ok" or
what is wrong with them.
"""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest
from running import PROGRAMS, compile_program, run

SOURCES = sorted((PROGRAMS / "sdk").glob("*/main.c*"))
NAMES = [source.parent.name for source in SOURCES]
ROBOTS = 50
SECONDS = 60
SHORT = {"17_ringlog": 20}  # seconds after which main() returns


def scene(seconds: float = SECONDS) -> dict[str, object]:
    return {
        "simulation_time": seconds,
        "arena_surface": 1e6,
        "objects.robots.nb": ROBOTS,
        "objects.robots.communication_radius": 200,
    }


@pytest.mark.parametrize("name", [name for name in NAMES if not name.endswith("registers")])
def test_each_robot_keeps_its_own_state_for_a_minute(name: str, tmp_path: Path) -> None:
    [source] = [source for source in SOURCES if source.parent.name == name]
    program = compile_program(tmp_path / "prog", source, flags=["-g"], package="pogosim-sdk")
    result = run(program, tmp_path / "run", scene())
    assert result.code == 0, result.text
    assert "SELF BAD" not in result.text
    assert "another robot" not in result.text
    said = re.findall(r"\[ROBOT #(\d+)\] \[PRINTF\] SELF ok id=(\d+)", result.text)
    assert all(robot == number for robot, number in said)
    lines = Counter(robot for robot, _ in said)
    assert len(lines) == ROBOTS
    seconds = SHORT.get(name, SECONDS)
    assert seconds - 10 <= min(lines.values()) and max(lines.values()) <= seconds, lines


def test_functions_of_registers_do_not_link(tmp_path: Path) -> None:
    with pytest.raises(AssertionError, match="registers of the hardware are not simulated") as failure:
        compile_program(
            tmp_path / "prog", PROGRAMS / "sdk" / "10_registers" / "main.c", flags=["-g"], package="pogosim-sdk"
        )
    assert re.search("undefined reference to .leds_out_write", str(failure.value))


def test_address_of_a_register_is_named_as_such(tmp_path: Path) -> None:
    source = PROGRAMS / "sdk" / "20_registers" / "main.c"
    program = compile_program(tmp_path / "prog", source, flags=["-g"], package="pogosim-sdk")
    result = run(program, tmp_path / "run", scene(1))
    assert result.code == 3
    assert "main.c:" in result.errors
    assert "a register of the hardware on the robot: those are not simulated" in result.errors
