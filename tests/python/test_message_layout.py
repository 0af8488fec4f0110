"""`make sim` warns of members of messages that have another size on a real robot, and of no others."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from running import ROOT, Run, compile_text, compiler, pkg_config

COMPILERS = [name for names in (("gcc",), ("clang", "clang-14")) if (name := compiler(*names))]

PROGRAM = """#include "pogobase.h"
#include <time.h>
typedef struct { size_t seen; } neighbour_t;
typedef struct { size_t heard; neighbour_t neighbours[3]; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
MESSAGES
static void receive(message_t* message) {
    neighbour_t* first = &mydata->neighbours[0];
    beacon_t beacon;
    memcpy(&beacon, message->payload, sizeof(beacon));
    greeting_t const* greeting = (greeting_t const*)message->payload;
    first->seen += (size_t)greeting->id + (size_t)beacon.id;
}
static void user_init(void) { msg_rx_fn = receive; }
struct state_packet packet;
some_message_t sent;
int main(void) {
    (void)packet;
    (void)sent;
    pogobot_init();
    pogobot_start(user_init, NULL);
    return 0;
}
"""
RIGHT = """
enum mood { HAPPY, SAD };
typedef struct { uint16_t id; } beacon_t;
typedef struct { int64_t id; uint64_t times[2]; int_least64_t rest; } greeting_t;
struct state_packet { enum mood mood; unsigned flag : 1; double x; };
typedef struct { float x; bool set; char text[4]; long long wide; struct { int16_t y; } part; } some_message_t;
"""
WRONG = """
typedef struct { uint16_t id; long count; } beacon_t;
typedef struct { int64_t id; char const* name; } greeting_t;
struct state_packet { size_t sizes[2]; time_t time; };
typedef struct { struct { uint32_t low; unsigned long high; } part; int_fast16_t fast; } some_message_t;
"""


def check(program: Path, *options: str) -> Run:
    (tool,) = pkg_config("--variable=shared_state")
    command = [tool, "-Wno-shared-state", *options, program.name]
    ended = subprocess.run(command, cwd=program.parent, capture_output=True, text=True, timeout=60, check=False)
    return Run(ended.returncode, ended.stdout, ended.stderr, program.parent)


def build(folder: Path, messages: str, name: str = "cc", options: str = "-O0") -> Path:
    text = PROGRAM.replace("MESSAGES", messages.strip())
    return compile_text(folder, text, compiler=name, flags=["-g", *options.split()])


NAMED = {(9, "'sizes'"), (9, "'time'"), (10, "'high'"), (10, "'fast'")}
RECEIVED = {(7, "'count'"), (8, "'name'")}  # clang does not tell what belongs to USERDATA


@pytest.mark.parametrize("options", ["-O0", "-O2"])
@pytest.mark.parametrize("name", COMPILERS)
def test_members_of_another_size_are_named(name: str, options: str, tmp_path: Path) -> None:
    result = check(build(tmp_path, WRONG, name, options))
    assert result.code == 0
    found = [line.split(" in the message ")[0].split(": warning: ") for line in result.errors.splitlines()]
    expected = NAMED if "clang" in name else NAMED | RECEIVED
    assert len(found) == len(expected)
    assert {(int(place.split(":")[1]), member) for place, member in found} == expected


@pytest.mark.parametrize("name", COMPILERS)
def test_types_of_the_same_size_are_not_named(name: str, tmp_path: Path) -> None:
    assert check(build(tmp_path, RIGHT, name)).text == ""


def test_warning_reads_like_a_compilers_and_can_be_an_error(tmp_path: Path) -> None:
    program = build(tmp_path, RIGHT.replace("uint16_t id; }", "size_t id; }"))
    begin = (
        "main.c:8:25: warning: 'id' in the message 'beacon_t' is of type 'size_t' (8 bytes), which has another size on "
    )
    assert check(program).errors == (
        f"{begin}a real robot: take uint32_t or another type of fixed size [-Wmessage-layout]\n"
    )
    result = check(program, "-Werror=message-layout")
    assert (result.code, "error: 'id'" in result.errors) == (1, True)
    assert check(program, "-Wno-message-layout", "-Werror").text == ""


EXAMPLES = sorted(path.parent / path.parent.name for path in ROOT.glob("examples/*/main.c*"))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.name)
def test_messages_of_the_examples_have_the_same_layout_everywhere(example: Path) -> None:
    assert check(example, "-Werror=message-layout").text == ""
