"""Firmware that waits, ends or errs in unusual ways does what its program in C does, or says why not."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from firmwares import OF_ROBOTS, firmware_of, run_firmware, text, without_program
from pogosim import ConfigurationError, Simulation
from running import by_robot, compile_text, run, warnings, write_scene

CLOCKS = ["off", "counted"]
COUNTED = "objects.robots.cpu_time"
# Three robots that hear each other.
NEAR: dict[str, object] = {
    "objects.robots.poses": [[400, 500, 0], [480, 500, 0], [560, 500, 0]],
    "simulation_time": 3.0,
    "user_code_timeout": 1,
}


@pytest.mark.parametrize("cpu_time", CLOCKS)
def test_start_that_waits_for_a_message_ends_when_it_has_come(cpu_time: str, tmp_path: Path) -> None:
    init = """
    if (pogobot_helper_getid() != 0) {
        while (!pogobot_infrared_message_available()) { pogobot_infrared_update(); }
    }"""
    step = """
    uint8_t one = 1;
    if (pogobot_helper_getid() == 0 && pogobot_ticks == 30) { pogobot_infrared_sendShortMessage_omni(&one, 1); }"""
    source = text(step, init)
    native = run(compile_text(tmp_path, source), tmp_path / "native", NEAR).frame()
    settings = NEAR | {COUNTED: cpu_time}
    emulated = run_firmware(firmware_of(tmp_path, source), tmp_path / "emulated", settings).frame()
    expected = by_robot(native, "pogobot_ticks")[-1]
    assert expected[0] > expected[1] + 25
    np.testing.assert_allclose(by_robot(emulated, "pogobot_ticks")[-1], expected, atol=1)


@pytest.mark.parametrize(("init", "step"), [("", "if (pogobot_ticks == 10) { while (1) { } }"), ("while (1) { }", "")])
def test_jump_to_itself_is_an_endless_loop(init: str, step: str, tmp_path: Path) -> None:
    """A user_init that never ends needs no code but its jump, which then is that of its caller."""
    firmware = firmware_of(tmp_path, text(step, init))
    result = run_firmware(firmware, tmp_path, NEAR)
    assert result.code == 3
    assert re.search(r"failed in (user_step \(main\.c|_pogobot_start \(main_loop\.c):\d+\) of robot #0", result.errors)
    assert "has run for 1 s on the robot's processor" in result.errors


@pytest.mark.parametrize("cpu_time", CLOCKS)
@pytest.mark.parametrize(
    ("init", "step", "where"),
    [
        ("", "if (pogobot_ticks == 10) { while (1) { pogobot_led_setColor(1, 2, 3); } }", "tick 10"),
        ("while (!pogobot_infrared_message_available()) { pogobot_infrared_update(); }", "", "user_init"),
    ],
)
def test_loop_that_waits_for_ever_is_told(init: str, step: str, where: str, cpu_time: str, tmp_path: Path) -> None:
    firmware = firmware_of(tmp_path, text(step, init))
    (said,) = warnings(run_firmware(firmware, tmp_path, NEAR | {COUNTED: cpu_time}))
    function = "user_init" if init else "user_step"
    assert re.match(rf"robot #0 of category 'robots' has been in {where} for \d\.\d s, in {function} \(main\.c:", said)


def test_static_function_does_not_hide_that_of_the_library(tmp_path: Path) -> None:
    globals_ = """
    __attribute__((noinline)) static void uart_write(uint8_t n) { mydata->level += n; }
    static void (*volatile write)(uint8_t) = uart_write;"""
    step = 'write(2); if (pogobot_ticks == 5) { printf("hello\\n"); }'
    settings = {
        OF_ROBOTS: {"firmware": str(firmware_of(tmp_path, text(step, globals_=globals_))), "columns": ["mydata.level"]}
    }
    result = run(without_program(), tmp_path, settings)
    assert len([line for line in result.robot_lines if line.endswith("hello")]) == 3
    assert result.frame()["mydata.level"].max() == 2 * 125


@pytest.mark.parametrize(
    ("step", "why"),
    [
        ("pogobot_stopwatch_reset(0);", r"pogobot_stopwatch_reset\(\) the address 0x00000000, where its program is"),
        ("pogobot_imu_read(0, 0);", r"pogobot_imu_read\(\) the address 0x00000000, where its program is"),
        ("read_page_flash(0, 0);", r"read_page_flash\(\) the address 0x00000000, where its program is"),
        (
            "static uint8_t bytes[12]; pogobot_stopwatch_reset((time_reference_t*)&bytes[pogobot_ticks | 1]);",
            r"pogobot_stopwatch_reset\(\) the address 0x[0-9a-f]+, which is no multiple of 4",
        ),
    ],
)
def test_addresses_that_the_library_cannot_write_to_are_told(step: str, why: str, tmp_path: Path) -> None:
    result = run_firmware(firmware_of(tmp_path, text(f"{step} mydata->level++;")), tmp_path)
    assert result.code == 3
    assert re.search(rf"failed in user_step \(main\.c:\d+\) of robot #0 .*: it gave {why}", result.errors)


def test_enumerations_have_their_sign_in_columns(tmp_path: Path) -> None:
    globals_ = """
    typedef enum __attribute__((packed)) { FEW = 1, MANY = 200 } amount;
    typedef enum { LOW = -5, HIGH = 5 } level;
    __attribute__((used)) amount much; __attribute__((used)) level deep; __attribute__((used)) uint32_t most;"""
    firmware = firmware_of(tmp_path, text("much = MANY; deep = LOW; most = 0xF0000000u;", globals_=globals_))
    settings = {OF_ROBOTS: {"firmware": str(firmware), "columns": ["much", "deep", "most"]}}
    last = run(without_program(), tmp_path, settings).frame().iloc[-1]
    assert (last["much"], last["deep"], last["most"]) == (200, -5, 0xF0000000)


@pytest.mark.parametrize(
    ("column", "why"),
    [
        ("mydata.items[2].id", r"\[2\] is beyond its end: it has 2 elements"),
        ("flags.one", "one is a bit field, which cannot be a column"),
    ],
)
def test_columns_that_cannot_be_say_why(column: str, why: str, tmp_path: Path) -> None:
    globals_ = "struct { uint8_t one : 1, other : 7; } flags;"
    firmware = firmware_of(tmp_path, text("flags.one ^= 1;", globals_=globals_))
    result = run(without_program(), tmp_path, {OF_ROBOTS: {"firmware": str(firmware), "columns": [column]}})
    assert result.code == 2
    assert re.search(why, result.errors)


def test_python_reads_each_robot_of_its_own_firmware(tmp_path: Path) -> None:
    """A category may have several entries, and its robots may have other firmware, or a host."""
    counting = firmware_of(tmp_path / "counting", text())
    other = firmware_of(tmp_path / "other", text("mydata->count += 2;", globals_="uint32_t more[64] = {1};"))
    robot = {"type": "pogobot", "nb": 2, "geometry": "disk", "radius": 26.5}
    objects = {
        "robots": [robot, robot | {"nb": 12}, robot | {"brain": "host"}],
        "others": robot | {"brain": str(other)},
    }
    scene = write_scene(tmp_path, {"objects": objects})
    with Simulation(counting, scene) as simulation:
        simulation.run(0.5)
        data = simulation.user_data["count"]
        assert data.shape == (18,)
        assert (data[:14] > 30).all()
        assert (data[14:] == 0).all()
        assert simulation.firmware_variable("mydata")["count"].tolist() == data[:16].tolist()
        assert (simulation.firmware_variable("mydata", "others", firmware=other)["count"] > 90).all()
        with pytest.raises(ConfigurationError, match="category 'others' does not run the firmware"):
            simulation.firmware_variable("mydata", "others")
        with pytest.raises(ConfigurationError, match="there is no category 'dogs'"):
            simulation.firmware_variable("mydata", "dogs")
