"""Every pointer that a program hands to the simulator may be NULL: that is named, or documented to be harmless."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from conftest import Compile
from running import ROOT, compile_text, compiler, run

# What the headers say that NULL does, besides an error.
HARMLESS = {
    "pogobot_infrared_sendLongMessage_omniGen.message",
    "pogobot_infrared_sendLongMessage_omniSpe.message",
    "pogobot_infrared_sendLongMessage_uniSpe.message",
    "pogobot_infrared_sendShortMessage_omni.message",
    "pogobot_infrared_sendShortMessage_uni.message",
    "pogobot_infrared_sendRawLongMessage.message",
    "pogobot_infrared_sendRawShortMessage.message",
    "pogobot_infrared_get_receiver_error_counter.counter",
    *(f"magn_read_XYZ.{axis}" for axis in "xyz"),
    "pogobot_motor_dir_mem_get.p_directions",
    "pogobot_motor_dir_mem_set.p_directions",
    "pogobot_motor_power_mem_get.p_powers",
    "pogobot_motor_power_mem_set.p_powers",
    *(f"{f}.{channel}" for f in ("qualitative_colormap", "rainbow_colormap", "hsv_to_rgb") for channel in "rgb"),
    "current_robot_category_is.category",
    "_pogobot_start.user_init",
    "_pogobot_start.user_step",
    "pogo_main_loop_step.user_step",
    "data_set_value_string.value",
}


# What hosts and the program's part of the simulator call, not programs.
NOT_FOR_PROGRAMS = {"host.h", "painter.h", "program.h"}

# Behind macros and inline functions that name every argument.
NOT_CALLED_BY_PROGRAMS = {
    "data_set_value_int.name",  # data_set_value_int8() and others call it
    "recover_next_message.message",
    "send_packet.descriptor",  # slip.h calls it
    "send_packet.data",
    "init_unsupported.variable",
    "init_unsupported.name",
    "first.note",
}

# Type, name and arguments of a function, in one line.
DECLARATION = re.compile(r"(?m)^(?:static POGO_INLINE )?[a-z]\w*(?: const)?[ *]+(\w+)\((.*)\)(?:;| \{)$")

# How messages name arguments.
WORDS = {
    "array": "the variable",
    "text": "the (text|variable)",
    "expected": "the text of what was expected",
}


def pointer_arguments() -> list[str]:
    """Return "function.argument" for each pointer argument of each function that the headers declare."""
    found = set()
    for path in (ROOT / "include" / "pogosim").rglob("*.h"):
        if path.name in NOT_FOR_PROGRAMS:
            continue
        text = re.sub(r"//[^\n]*", "", path.read_text())
        # Macros and inline functions call those that are declared; on a real robot others are.
        text = re.sub(r"(?m)^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", "", text)
        text = re.sub(r'extern "C\+\+" \{.*?\n\}', "", text, flags=re.DOTALL)
        for name, arguments in DECLARATION.findall(text):
            split = re.split(r",\s*(?![^()]*\))", arguments)
            pointers = [a for a in split if "*" in a and "..." not in a]
            for argument in pointers:
                pointed = re.search(r"\(\*(\w+)\)", argument) or re.search(r"(\w+)$", argument)
                assert pointed, argument
                found.add(f"{name.removeprefix('pogosim_')}.{pointed[1]}")
    return sorted(found - NOT_CALLED_BY_PROGRAMS)


@pytest.mark.parametrize("call", pointer_arguments())
def test_null_is_named_or_harmless(program: Compile, tmp_path: Path, call: str) -> None:
    result = run(program("null_pointers.c"), tmp_path, {"simulation_time": 0.1, "parameters": {"call": call}})
    function, _, argument = call.partition(".")
    if call in HARMLESS:
        assert result.code == 0, result.errors
        return
    assert result.code == 2, result.text
    words = WORDS.get(argument, f"(the )?{argument}")
    assert re.search(rf"{function.removeprefix('_')}\(\): {words}.* is NULL", result.errors), result.errors


def test_list_of_pointer_arguments_is_that_of_the_headers() -> None:
    found = pointer_arguments()
    assert len(found) > 80
    assert {"pogobot_imu_read.gyro", "printf.format", "_pogobot_start.user_init"} <= set(found)
    assert set(found) >= HARMLESS


PROGRAM = """#include "pogobase.h"
typedef struct { int a; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
static void user_step(void) {
    pogobot_infrared_recover_next_message(NULL);
    pogobot_led_setColor(1, 2, 3);
}
static void user_init(void) {}
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
"""


@pytest.mark.parametrize("options", ["-O0", "-O2"])
@pytest.mark.parametrize("name", [name for names in (("gcc",), ("clang", "clang-14")) if (name := compiler(*names))])
def test_line_is_the_program_s_own_though_the_header_has_the_call(name: str, options: str, tmp_path: Path) -> None:
    program = compile_text(tmp_path, PROGRAM, compiler=name, flags=["-g", options])
    errors = run(program, tmp_path / "run", {"simulation_time": 0.1}).errors
    assert "pogobot_infrared_recover_next_message(): message is NULL (called from user_step of robot #0" in errors
    assert "main.c:6 in user_step())" in errors
