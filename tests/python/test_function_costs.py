"""What functions take on the robot, measured on its firmware, makes the ticks of the program in C as long."""

from __future__ import annotations

import subprocess
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

__attribute__((noinline, unused)) static void spend(uint32_t n) {
    for (uint32_t i = 0; i < 3 * n; i++) {
        __asm__ volatile("");
    }
}

static bool speak(void) {
    uint8_t one = 1;
    spend(4500);
    return pogobot_infrared_sendShortMessage_omni(&one, 1);
}

static void hear(message_t* message) {
    (void)message;
    mydata->heard++;
    spend(9000);
}

void user_init(void) {
    msg_tx_fn = speak;
    msg_rx_fn = hear;
    percent_msgs_sent_per_ticks = 100;
}

void user_step(void) {
    spend(36000);
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
    "simulation_time": 10.0,
}
COSTS = "objects.robots.function_costs"
SHORT = ["--robots", "2", "--set", "simulation_time=2"]  # of a profile, which takes longer than the run


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Return the firmware of the program, and the file of its costs in a crowd."""
    folder = tmp_path_factory.mktemp("measured")
    firmware, costs = firmware_of(folder, PROGRAM), folder / "costs.yaml"
    scene = write_scene(folder, {key: value for key, value in CROWD.items() if key != "objects.robots.cpu_time"})
    assert main(["profile", str(firmware), "-c", str(scene), *SHORT, "--costs", str(costs)]) == 0
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
    assert costs[MAIN_LOOP]["cycles"] < 11_000


def test_program_in_c_ticks_as_often_as_its_firmware(measured: tuple[Path, Path], tmp_path: Path) -> None:
    firmware, costs = measured
    program = compile_text(tmp_path, PROGRAM)
    emulated = ticks(run_firmware(firmware, tmp_path / "emulated", CROWD))
    native = ticks(run(program, tmp_path / "native", {**CROWD, COSTS: str(costs)}))
    untimed = ticks(run(program, tmp_path / "untimed", {**CROWD, "objects.robots.cpu_time": "off"}))
    assert untimed == pytest.approx(626, abs=2)
    assert emulated < 0.75 * untimed
    assert native == pytest.approx(emulated, rel=0.03)


def test_costs_are_measured_again_into_the_file_that_the_configuration_names(
    measured: tuple[Path, Path], tmp_path: Path
) -> None:
    firmware, costs = measured
    (tmp_path / "costs.yaml").write_text("function_costs: {user_step: {cycles: 1}}\n")
    scene = write_scene(tmp_path, {**CROWD, COSTS: str(tmp_path / "costs.yaml")})
    arguments = ["profile", str(firmware), "-c", str(scene), *SHORT]
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
    assert "objects.robots.function_costs say nothing of hear, speak, which the main loop has called in no time" in line


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
        (
            {"objects.robots.cpu_time": "counted", COSTS: {f"f{i}": {"cycles": 1} for i in range(900)}},
            "the program has no function 'f0', nor 899 more",
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


# ---- Programs in which the main loop's functions have other names, or change


def ticks_of_both(folder: Path, source: str, settings: dict[str, object], name: str = "main.c") -> tuple[float, float]:
    """Measure a program's firmware, and return the ticks of its robots and of the program's in C."""
    firmware, costs = firmware_of(folder, source, name), folder / "costs.yaml"
    plain = {key: value for key, value in settings.items() if key != "objects.robots.cpu_time"}
    scene = write_scene(folder, {**plain, COSTS: "costs.yaml"})  # which is not there yet
    assert main(["profile", str(firmware), "-c", str(scene), *SHORT, "--costs", str(costs)]) == 0
    emulated = run_firmware(firmware, folder / "emulated", settings)
    native = run(compile_text(folder, source, name), folder / "native", {**settings, COSTS: str(costs)})
    assert [line for line in warnings(native) if "function_costs" in line] == []
    return ticks(emulated), ticks(native)


def test_callback_that_ends_itself_takes_its_own_time(tmp_path: Path) -> None:
    source = PROGRAM.replace("spend(9000);", "spend(90000);\n    msg_rx_fn = NULL;").replace(
        "spend(36000);", "msg_rx_fn = hear;"
    )
    source = source.replace("void user_init", "void user_step(void);\nvoid user_init")
    emulated, native = ticks_of_both(tmp_path, source, CROWD)
    assert emulated < 400
    assert native == pytest.approx(emulated, rel=0.06)


def test_time_of_loops_that_wait_by_the_clock_counts_once(tmp_path: Path) -> None:
    wait = """time_reference_t begin;
    pogobot_stopwatch_reset(&begin);
    while (pogobot_stopwatch_get_elapsed_microseconds(&begin) < 30000) {
    }"""
    source = PROGRAM.replace("spend(36000);", wait).replace("spend(4500);", "").replace("spend(9000);", "")
    emulated, native = ticks_of_both(tmp_path, source, CROWD)
    assert emulated == pytest.approx(10.0 / 0.036, rel=0.15)  # with the line that tells of it
    assert native == pytest.approx(emulated, rel=0.05)


def test_functions_of_cpp_have_their_costs(tmp_path: Path) -> None:
    source = (
        PROGRAM.replace("static bool speak", "namespace { bool speak")
        .replace("static void hear", "} namespace deep { void hear")
        .replace("void user_init", "}\nvoid user_init")
        .replace("msg_rx_fn = hear", "msg_rx_fn = deep::hear")
    )
    emulated, native = ticks_of_both(tmp_path, source, CROWD, "main.cpp")
    assert native == pytest.approx(emulated, rel=0.03)


def test_names_that_look_like_the_librarys_are_the_programs(tmp_path: Path) -> None:
    source = PROGRAM.replace("hear", "_hear").replace("_heard", "heard").replace("speak", "pogobot_speak")
    emulated, native = ticks_of_both(tmp_path, source, CROWD)
    assert native == pytest.approx(emulated, rel=0.03)


def test_suffixes_of_the_linker_are_none_of_the_program(tmp_path: Path) -> None:
    stacks = {
        (MAIN_LOOP, "hear.lto_priv.0"): (30.0, 0.0, 1.0),
        (MAIN_LOOP, "hear.lto_priv.1"): (90.0, 0.0, 2.0),
        (MAIN_LOOP,): (50.0, 0.0, 0.0),
    }
    costs = costs_of_calls(read_profile(write_profile(tmp_path / "p.json", raw_profile(stacks))))
    assert (costs["hear"].cycles, costs["hear"].calls) == (120, 3)


def test_program_without_names_is_told_so(tmp_path: Path) -> None:
    program = compile_text(tmp_path, PROGRAM)
    subprocess.run(["strip", program], check=True)
    result = run(program, tmp_path, {**CROWD, COSTS: {"user_step": {"cycles": 1}}})
    assert any("the program does not name its functions (strip, -s)" in line for line in warnings(result))


def test_longest_times_fit_into_the_clock(tmp_path: Path) -> None:
    settings = {
        **CROWD,
        COSTS: {"user_step": {"cycles": 1e12}, "hear": {"cycles": 0}, "speak": {"cycles": 0}},
        "objects.robots.processor": {"clock_hz": 1, "cycle_factor": 1000},
        "simulation_time": 1.0,
    }
    assert ticks(run(compile_text(tmp_path, PROGRAM), tmp_path, settings)) == 0
