"""What functions take on the robot, measured on its firmware, makes the ticks of the program in C as long."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from firmwares import firmware_of, run_firmware
from pogosim.command.main import main
from pogosim.firmware.profile.function_costs import MAIN_LOOP, costs_of_calls
from pogosim.firmware.profile.raw import read_profile
from profiles import raw_profile, write_profile
from running import Run, by_robot, compile_text, run, warnings, write_scene

PROGRAM = """
#include "pogobase.h"

typedef struct {
    uint32_t heard;
} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)

static void spend(uint32_t n) {
    for (volatile uint32_t i = 0; i < n; i++) {
    }
}

static bool speak(void) {
    uint8_t one = 1;
    spend(2000);
    return pogobot_infrared_sendShortMessage_omni(&one, 1);
}

static void hear(message_t* message) {
    (void)message;
    mydata->heard++;
    spend(4000);
}

void user_init(void) {
    msg_tx_fn = speak;
    msg_rx_fn = hear;
    percent_msgs_sent_per_ticks = 100;
}

void user_step(void) {
    spend(16000);
    pogobot_led_setColor(255, 0, 0);
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
"""
# Six robots in one place hear each other.
CROWD: dict[str, object] = {
    "objects.robots.nb": 6,
    "initial_formation": "disk",
    "objects.robots.cpu_time": "counted",
    "objects.robots.communication_radius": 400,
    "simulation_time": 20.0,
}
COSTS = "objects.robots.function_costs"


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Return the firmware of the program, and the file of its costs in a crowd."""
    folder = tmp_path_factory.mktemp("measured")
    firmware, costs = firmware_of(folder, PROGRAM), folder / "costs.yaml"
    scene = write_scene(folder, {key: value for key, value in CROWD.items() if key != "objects.robots.cpu_time"})
    assert main(["profile", str(firmware), "-c", str(scene), "--robots", "6", "--costs", str(costs)]) == 0
    return firmware, costs


def costs_in(file: Path) -> dict[str, dict[str, float]]:
    found: dict[str, dict[str, float]] = yaml.safe_load(file.read_text())["function_costs"]
    return found


def ticks(result: Run) -> float:
    """Return the ticks of a robot, on average."""
    assert result.code == 0, result.text
    return float(np.mean(by_robot(result.frame(), "pogobot_ticks")[-1]))


def test_costs_are_those_of_the_functions_that_the_main_loop_calls(measured: tuple[Path, Path]) -> None:
    costs = costs_in(measured[1])
    assert list(costs) == [MAIN_LOOP, "user_step", "speak", "hear"]
    # They spend cycles as their loops are long, and the time of the calls that they make.
    assert costs["user_step"]["cycles"] == pytest.approx(4 * costs["hear"]["cycles"], rel=0.02)
    assert costs["user_step"]["cycles"] == pytest.approx(8 * costs["speak"]["cycles"], rel=0.02)
    assert costs["user_step"]["library_us"] == pytest.approx(5.0)  # led_us
    assert costs["speak"]["library_us"] == pytest.approx(50 + 10 * (3 + 1 + 6))  # message_us, and message_byte_us
    assert costs["hear"]["library_us"] == 0
    assert costs[MAIN_LOOP]["cycles"] < 10_000


def test_program_in_c_ticks_as_often_as_its_firmware(measured: tuple[Path, Path], tmp_path: Path) -> None:
    firmware, costs = measured
    program = compile_text(tmp_path, PROGRAM)
    emulated = ticks(run_firmware(firmware, tmp_path / "emulated", CROWD))
    native = ticks(run(program, tmp_path / "native", {**CROWD, COSTS: str(costs)}))
    untimed = ticks(run(program, tmp_path / "untimed", {**CROWD, "objects.robots.cpu_time": "off"}))
    assert untimed == pytest.approx(1251, abs=2)
    assert emulated < 0.75 * untimed
    assert native == pytest.approx(emulated, rel=0.03)


def test_costs_are_measured_again_into_the_file_that_the_configuration_names(
    measured: tuple[Path, Path], tmp_path: Path
) -> None:
    firmware, costs = measured
    (tmp_path / "costs.yaml").write_text("function_costs: {user_step: {cycles: 1}}\n")
    scene = write_scene(tmp_path, {**CROWD, COSTS: str(tmp_path / "costs.yaml")})
    arguments = ["profile", str(firmware), "-c", str(scene), "--robots", "6"]
    assert main([*arguments, "--costs", str(tmp_path / "costs.yaml")]) == 0
    assert costs_in(tmp_path / "costs.yaml") == costs_in(costs)


def test_map_in_the_configuration_does_as_a_file_and_threads_change_nothing(
    measured: tuple[Path, Path], tmp_path: Path
) -> None:
    program = compile_text(tmp_path, PROGRAM)
    from_file = run(program, tmp_path / "file", {**CROWD, COSTS: str(measured[1])}).table()
    inline = run(program, tmp_path / "map", {**CROWD, COSTS: costs_in(measured[1]), "threads": 3}).table()
    assert inline.equals(from_file)


def test_long_step_is_told_as_on_the_robot(tmp_path: Path) -> None:
    program = compile_text(tmp_path, PROGRAM)
    result = run(program, tmp_path, {**CROWD, COSTS: {"user_step": {"cycles": 630_000}}, "simulation_time": 1.0})
    assert "[TIME] Error code: 0: tick took 30 ms; main_loop_hz allows 16 ms" in result.text
    (line,) = (line for line in warnings(result) if "function_costs" in line)
    assert "objects.robots.function_costs say nothing of " in line
    assert "which takes no time; measure them again: pogosim profile --costs FILE" in line


BAD = {
    "absent.yaml": "there is no file 'absent.yaml'",
    "list.yaml": "expected a map of keys at the top level, found a list",
    "more.yaml": "a file of costs has a map `function_costs`",
    "number.yaml": "expected a map of functions",
}


@pytest.mark.parametrize("name", BAD)
def test_bad_files_are_refused_in_a_line(name: str, tmp_path: Path) -> None:
    (tmp_path / "list.yaml").write_text("- user_step\n")
    (tmp_path / "more.yaml").write_text("function_costs: {user_step: {cycles: 1}}\nuser_step: 2\n")
    (tmp_path / "number.yaml").write_text("function_costs: 25000\n")
    result = run(compile_text(tmp_path, PROGRAM), tmp_path, {**CROWD, COSTS: name})
    assert result.code == 2
    assert BAD[name] in result.text


@pytest.mark.parametrize(
    ("costs", "message"),
    [
        (25_000, "there is no file '25000'"),
        ([], "expected a map of functions"),
        ({"user_step": 25_000}, "expected a map"),
        ({"user_step": {"cycles": -1}}, "function_costs.user_step.cycles"),
        ({"user_step": {"cycles": "many"}}, "function_costs.user_step.cycles"),
    ],
    ids=str,
)
def test_bad_values_are_refused_in_a_line(costs: Any, message: str, tmp_path: Path) -> None:
    result = run(compile_text(tmp_path, PROGRAM), tmp_path, {**CROWD, COSTS: costs})
    assert result.code == 2
    assert message in result.text


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (
            {"objects.robots.cpu_time": "counted"},
            "on programs in C with function_costs; the code of these robots takes",
        ),
        ({COSTS: {"user_step": {"cycles": 1}}}, "function_costs have an effect on programs in C alone, with cpu_time:"),
        (
            {
                "objects.robots.cpu_time": "counted",
                "objects.robots.brain": {"script": [{"time_s": 0, "led": [1, 1, 1]}]},
            },
            "cpu_time: counted has no effect on robots that no code drives",
        ),
        (
            {"objects.robots.cpu_time": "counted", COSTS: {"usr_step": {"cycles": 1}}},
            "the program has no function 'usr_step'; did you mean 'user_step'?",
        ),
        ({COSTS: {"user_step": {"cycles": 1, "cycle": 1}}}, "function_costs.user_step.cycle'"),
    ],
    ids=str,
)
def test_what_has_no_effect_is_told(settings: dict[str, object], message: str, tmp_path: Path) -> None:
    result = run(compile_text(tmp_path, PROGRAM), tmp_path, settings)
    assert result.code == 0
    assert any(message in line for line in warnings(result)), result.text


def test_costs_do_not_contain_the_cycle_factor(tmp_path: Path) -> None:
    stacks = {
        (MAIN_LOOP, "user_step"): (300.0, 0.0, 3.0),
        (MAIN_LOOP, "user_step", "pogobot_led_setColor"): (0.0, 2.0, 1.0),
        (MAIN_LOOP, "user_step", "__muldf3"): (60.0, 0.0, 30.0),
        (MAIN_LOOP, "__divsi3"): (20.0, 0.0, 1.0),
        (MAIN_LOOP,): (50.0, 0.0, 0.0),
    }
    values = raw_profile(stacks, cycle_factor=2.0)
    profile = read_profile(write_profile(tmp_path / "p.json", values))
    costs = costs_of_calls(profile)
    assert (costs["user_step"].cycles, costs["user_step"].library_us, costs["user_step"].calls) == (360, 2.0, 3)
    assert (costs[MAIN_LOOP].cycles, costs[MAIN_LOOP].calls) == (70, 1)


def test_program_without_a_main_loop_has_no_costs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    values = raw_profile({("main",): (1.0, 0.0, 0.0)})
    file = write_profile(tmp_path / "p.json", values)
    assert main(["profile", str(file), "--costs", str(tmp_path / "costs.yaml")]) == 2
    assert f"never calls {MAIN_LOOP}" in capsys.readouterr().err
    assert not (tmp_path / "costs.yaml").exists()
