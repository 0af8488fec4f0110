"""`pogosim compare-brains`: the first tick and variable in which a program in C and its firmware differ."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest
from firmwares import firmware_in, project_of
from robot_sdk import TRIPLE, need
from running import Run, Settings, compile_program, ran, write_scene

PROGRAM = """#include "pogobase.h"
typedef struct {{ uint32_t count; int16_t sign; uint32_t size; float mean; void* self; }} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)
void user_init(void) {{ srand((unsigned)pogobot_helper_getRandSeed()); mydata->self = mydata; }}
void user_step(void) {{
    mydata->count += (uint32_t)rand() % 10;
    mydata->mean = (float)mydata->count / (float)(pogobot_ticks + 1);
    pogobot_motor_set(motorL, (uint16_t)(mydata->count % 1000));
    {step}
}}
int main(void) {{
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}}
"""


ROBOT_ENTRY = {"type": "pogobot", "nb": 2, "geometry": "disk", "radius": 26.5}


def compared(folder: Path, step: str, *options: str) -> Run:
    return compared_text(folder, PROGRAM.format(step=step), {"parameters": {"unused": 3}}, *options)


def compared_text(folder: Path, text: str, settings: Settings, *options: str) -> Run:
    need(f"{TRIPLE}-gcc")
    (folder / "main.c").write_text(text)
    write_scene(folder, settings)
    return ran(folder, sys.executable, "-m", "pogosim", "compare-brains", "main.c", "-c", "scene.yaml", *options)


def test_program_that_is_the_same_in_both_is_said_to_be(tmp_path: Path) -> None:
    result = compared(tmp_path, "")
    assert result.code == 0, result.text
    assert result.output.splitlines() == ["equal for 2 s: 3 robots do the same as a program and as firmware"]


def test_first_tick_and_variable_that_differ_are_listed(tmp_path: Path) -> None:
    step = """
    char c = (char)-1;
    if (pogobot_ticks >= 20) { mydata->size = (uint32_t)sizeof(long); }
    if (pogobot_ticks >= 40) { mydata->sign = c; pogobot_led_setColor((uint8_t)(c > 0), 0, 0); }"""
    result = compared(tmp_path, step)
    assert result.code == 1, result.text
    rows = [re.split(r"  +", line) for line in result.output.splitlines()]
    assert rows[0] == ["time (s)", "tick", "robot", "variable", "program", "firmware"]
    # The step after which the tick has been made, and the ticks by then.
    assert rows[1] == ["0.330", "21", "#0", "mydata.size", "8", "4"]
    assert {row[3] for row in rows[2:]} == {"leds", "mydata.sign"}
    assert {(row[0], row[1], row[2]) for row in rows[2:]} == {("0.650", "41", "#0")}
    assert ["mydata.sign", "-1", "255"] in [row[3:] for row in rows]


def test_comparison_ends_where_it_is_told_to(tmp_path: Path) -> None:
    assert compared(tmp_path, "if (pogobot_ticks > 30) { mydata->size = sizeof(long); }", "--until", "0.3").code == 0
    step = "mydata->size = sizeof(long); mydata->sign = (int16_t)sizeof(void*);"
    assert len(compared(tmp_path, step, "--most", "1").output.splitlines()) == 2


def test_keys_that_are_set_hold_for_both_runs(tmp_path: Path) -> None:
    result = compared(tmp_path, "", "--set", "objects.robots.nb=5", "--set", "simulation_time=1", "--set", "seed=7")
    assert result.code == 0, result.text
    assert result.output.splitlines() == ["equal for 1 s: 5 robots do the same as a program and as firmware"]


def test_program_without_user_data_is_compared(tmp_path: Path) -> None:
    text = """#include "pogobot.h"
    static uint8_t count;
    int main(void) {
        pogobot_init();
        while (1) { count += {step}; pogobot_led_setColor(count, 0, 0); msleep(50); }
    }"""
    without = "there is no USERDATA to compare: the program has none"
    equal = compared_text(tmp_path, text.replace("{step}", "1"), {})
    assert equal.code == 0, equal.text
    assert equal.output.splitlines() == [
        "equal for 2 s: 3 robots do the same as a program and as firmware",
        without,
    ]
    different = compared_text(tmp_path, text.replace("{step}", "sizeof(long)"), {})
    assert different.code == 1, different.text
    assert " leds " in different.output
    assert different.output.splitlines()[-1] == without


def test_program_that_only_writes_its_user_data_is_compared(tmp_path: Path) -> None:
    text = """#include "pogobase.h"
    typedef struct { int count; } USERDATA;
    DECLARE_USERDATA(USERDATA)
    REGISTER_USERDATA(USERDATA)
    void user_step(void) { mydata->count = 5; }
    int main(void) { pogobot_init(); pogobot_start(user_step, user_step); }"""
    result = compared_text(tmp_path, text, {})
    assert result.code == 0, result.text
    assert result.output.splitlines()[-1] == (
        "there is no USERDATA to compare: the robots' compiler leaves out what the program only writes"
    )


def test_entries_of_a_list_that_need_a_program_are_compared(tmp_path: Path) -> None:
    scripted = {**ROBOT_ENTRY, "brain": {"script": []}}
    settings = {"objects": {"robots": [ROBOT_ENTRY, scripted, {**ROBOT_ENTRY, "brain": "program"}]}}
    equal = compared_text(tmp_path, PROGRAM.format(step=""), settings)
    assert equal.code == 0, equal.text
    assert equal.output.splitlines() == ["equal for 2 s: 4 robots do the same as a program and as firmware"]
    step = "if (pogobot_helper_getid() == 5) { mydata->size = sizeof(long); }"
    different = compared_text(tmp_path, PROGRAM.format(step=step), settings)
    assert different.code == 1, different.text
    assert re.split(r"  +", different.output.splitlines()[1])[2:] == ["#5", "mydata.size", "8", "4"]


def test_files_that_a_single_run_writes_are_not_written(tmp_path: Path) -> None:
    settings = {"message_log": "messages.feather", "flash_state": {"output_file": "robots.flash"}}
    result = compared_text(tmp_path, PROGRAM.format(step=""), settings)
    assert result.code == 0, result.text
    assert sorted(path.name for path in tmp_path.iterdir()) == ["main.c", "scene.yaml"]


def test_failed_run_names_no_file_that_is_gone(tmp_path: Path) -> None:
    result = compared(tmp_path, "if (pogobot_ticks > 20) { *(volatile int*)4 = 1; }")
    assert result.code == 2
    line = result.errors.splitlines()[-1]
    assert line.startswith("pogosim compare-brains: the user program failed in user_step of robot #0")
    assert "data file" not in line


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("absent",), "there is no project, .c or .cpp file absent"),
        (("scene.yaml",), "there is no project, .c or .cpp file scene.yaml, which could be built in both ways"),
        ((".",), ". is not a project: it has no Makefile (pogosim new NAME makes a project)"),
        (("main.c", "--category", "others"), "objects: unknown category 'others'"),
        (("main.c", "--most", "0"), "argument --most: "),
        (("main.c", "--set", "seed"), "argument --set: expected KEY=VALUE, such as objects.robots.nb=50, found 'seed'"),
        (("main.c", "--set", "seed=[1"), "argument --set: seed: not YAML: "),
        (("main.c", "--set", "parameters.a=1"), "parameters.a: both runs have the parameters of the source; change"),
        (("main.c", "--set", "objects.robots.nb=many"), "objects.robots.nb: expected an integer from 0 to 10000000"),
    ],
)
def test_what_cannot_be_compared_is_one_line(arguments: tuple[str, ...], said: str, tmp_path: Path) -> None:
    (tmp_path / "main.c").write_text(PROGRAM.format(step=""))
    write_scene(tmp_path, {})
    result = ran(tmp_path, sys.executable, "-m", "pogosim", "compare-brains", *arguments, "-c", "scene.yaml")
    assert result.code == 2
    lines = [line for line in result.errors.splitlines() if line.startswith("pogosim compare-brains: ")]
    assert len(lines) == 1
    assert said in lines[0]


MAGNETOMETER = """#include "pogobase.h"
typedef struct {{ int16_t x, y, z; int read; }} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)
void user_init(void) {{ main_loop_hz = 50; }}
void user_step(void) {{
    mydata->read += magn_read_XYZ(&mydata->x, &mydata->y, &mydata->z, {timeout_ms}) == 0;
}}
int main(void) {{
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}}
"""


@pytest.mark.parametrize("timeout_ms", [10, 20, 21, 50])
def test_clocks_drift_alike_in_ticks_without_a_sleep(timeout_ms: int, tmp_path: Path) -> None:
    """Those take as long as a tick may, or longer, so the main loop does not sleep."""
    settings: Settings = {
        "magnetometer": {"timing": "robot"},
        "objects.robots.temporal_noise_stddev": 5,
        "simulation_time": 2,
        "enable_console_logging": False,
    }
    result = compared_text(tmp_path, MAGNETOMETER.format(timeout_ms=timeout_ms), settings)
    assert result.code == 0, result.text


def test_pose_that_the_magnetometer_refuses_ends_the_run_of_both(tmp_path: Path) -> None:
    need(f"{TRIPLE}-gcc")
    source = tmp_path / "main.c"
    source.write_text(MAGNETOMETER.format(timeout_ms=1))
    program = compile_program(tmp_path / "main", source)
    firmware = firmware_in(project_of(tmp_path / "project", source))
    write_scene(tmp_path, {"magnetometer": {"domain": {"x": [0, 1], "policy": "throw"}}, "simulation_time": 2})
    for brain in ([], ["--set", f"objects.robots.brain={firmware}"]):
        result = ran(tmp_path, program, "-c", "scene.yaml", "-g", *brain)
        assert result.code == 2
        assert re.search(
            r"magn_read_XYZ\(\): the pose x [\d.]+ mm, .* is outside magnetometer.domain, whose policy is throw "
            r"\(called from user_step.* of robot #0 of category 'robots', tick 0, t = 0",
            result.errors,
        )
