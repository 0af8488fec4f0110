"""`pogosim compare-brains`: the first tick and variable in which a program in C and its firmware differ."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest
from robot_sdk import TRIPLE, need
from running import Run, ran, write_scene

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


def compared(folder: Path, step: str, *options: str) -> Run:
    need(f"{TRIPLE}-gcc")
    (folder / "main.c").write_text(PROGRAM.format(step=step))
    write_scene(folder, {"parameters": {"unused": 3}})
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
    assert len(compared(tmp_path, step, "--most", "1").output.splitlines()) >= 2


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("absent",), "there is no project, .c or .cpp file absent"),
        (("scene.yaml",), "there is no project, .c or .cpp file scene.yaml, which could be built in both ways"),
        ((".",), ". is not a project: it has no Makefile (pogosim new NAME makes a project)"),
        (("main.c", "--category", "others"), "objects: unknown category 'others'"),
        (("main.c", "--most", "0"), "argument --most: "),
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
