"""`make sim` warns of members of messages that have another size on a real robot, and of no others."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

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


SENDER = """#include "pogobase.h"
TYPES
typedef struct { size_t length; long number; uint8_t buffer[40]; pair_t pair; long numbers[2]; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
static void user_step(void) {
    SENDING
}
static void user_init(void) {}
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
"""
PAIR = "typedef struct { uint32_t i; size_t z; } pair_t;"
PACKED = "typedef struct __attribute__((packed)) { uint8_t i; long z; } pair_t;"
GEN = "pogobot_infrared_sendLongMessage_omniGen"
SENT = {
    "structure": (PAIR, f"pair_t k = {{1, 2}}; {GEN}((uint8_t*)&k, sizeof k);", "'z' in the message 'pair_t'"),
    "packed structure": (
        PACKED,
        f"pair_t k = {{1, 2}}; {GEN}((uint8_t*)&k, sizeof(k));",
        "'z' in the message 'pair_t'",
    ),
    "structure without a name": (
        PAIR,
        f"struct {{ long z; }} k = {{1}}; {GEN}((uint8_t*)&k, sizeof(k));",
        "'z' in the message 'k'",
    ),
    "structure of the user data": (
        PAIR,
        f"{GEN}((uint8_t*)&mydata->pair, sizeof(mydata->pair));",
        "'z' in the message 'pair_t'",
    ),
    "pointer": (
        PAIR,
        f"pair_t const* k = &mydata->pair; {GEN}((uint8_t*)k, sizeof *k);",
        "'z' in the message 'pair_t'",
    ),
    "size of a type": (
        PAIR,
        f"mydata->pair.i = 1; memcpy(mydata->buffer, &mydata->pair, 8); {GEN}(mydata->buffer, sizeof(pair_t));",
        "'z' in the message 'pair_t'",
    ),
    "one of several": (
        PAIR,
        f"pair_t k[2] = {{{{1, 2}}, {{3, 4}}}}; {GEN}((uint8_t*)&k[mydata->length], sizeof(pair_t));",
        "'z' in the message 'pair_t'",
    ),
    "array of long": (PAIR, f"long v[3] = {{1, 2, 3}}; {GEN}((uint8_t*)v, sizeof v);", "'v' is sent as a message"),
    "row": (PAIR, f"long v[2][2] = {{{{1}}, {{2}}}}; {GEN}((uint8_t*)v[1], 4);", "'v' is sent as a message"),
    "long": (PAIR, f"long k = 1; {GEN}((uint8_t*)&k, sizeof k);", "'k' is sent as a message"),
    "long in a block": (
        PAIR,
        f"for (int i = 0; i < 2; i++) {{ long k = i; {GEN}((uint8_t*)(&k), sizeof(k)); }}",
        "'k' is sent as a message",
    ),
    "long of the user data": (PAIR, f"{GEN}((uint8_t*)&mydata->number, 8);", "'number' is sent as a message"),
    "static": (PAIR, f"static unsigned long k = 1; {GEN}((uint8_t*)&k, sizeof k);", "'k' is sent as a message"),
    "address": (PAIR, f'char const* k = "a"; {GEN}((uint8_t*)&k, sizeof(k));', "'k' is sent as a message"),
    "all emitters": (
        PAIR,
        "long k = 1; pogobot_infrared_sendLongMessage_omniSpe((uint8_t*)&k, 8);",
        "'k' is sent as a message",
    ),
    "one emitter": (
        PAIR,
        "long k = 1; pogobot_infrared_sendLongMessage_uniSpe(ir_front, (uint8_t*)&k, 8);",
        "'k' is sent as a message",
    ),
    "short": (
        PAIR,
        "long k = 1; pogobot_infrared_sendShortMessage_omni((uint8_t*)&k, 8);",
        "'k' is sent as a message",
    ),
    "short through one": (
        PAIR,
        "long k = 1; pogobot_infrared_sendShortMessage_uni(ir_front, (uint8_t*)&k, 8);",
        "'k' is sent as a message",
    ),
}


def build_sender(folder: Path, types: str, sending: str, **how: Any) -> Path:
    return compile_text(folder, SENDER.replace("TYPES", types).replace("SENDING", sending), **how)


@pytest.mark.parametrize("what", SENT)
@pytest.mark.parametrize("options", ["-O0", "-O2"])
@pytest.mark.parametrize("name", COMPILERS)
def test_what_is_sent_needs_no_name_of_a_message(name: str, options: str, what: str, tmp_path: Path) -> None:
    types, sending, expected = SENT[what]
    flags = ["-g", options, "-Wall", "-Wextra", "-Wpedantic", "-Werror"]
    result = check(build_sender(tmp_path, types, sending, compiler=name, flags=flags))
    assert result.errors.count("warning") == 1, result.errors
    assert expected in result.errors


UNSUSPICIOUS = [
    "uint8_t text[4] = {1}; GEN(text, sizeof(text));",
    "GEN(mydata->buffer + mydata->length, (uint16_t)mydata->length);",
    "GEN(&mydata->buffer[mydata->number], (uint16_t)(sizeof(mydata->buffer) - mydata->length));",
    'uint8_t byte = 1; GEN(&byte, 1); GEN((uint8_t*)"a, &number", 3);',
    "uint8_t* parts[2] = {mydata->buffer, NULL}; GEN(parts[mydata->length], 3); GEN(*parts, 3);",
    "int64_t k = 1; GEN((uint8_t*)&k, sizeof k);",
    "uint8_t* at = mydata->buffer; GEN(at, (uint16_t)mydata->numbers[1]); GEN(NULL, 0);",
    "message_t raw = {0}; GEN(raw.payload, raw.header.payload_length);",
    "(GEN)((uint8_t*)mydata->buffer, 3); ::GEN(mydata->buffer, 3);",
]


@pytest.mark.parametrize("options", ["-O0", "-O2"])
@pytest.mark.parametrize(
    "name", [name for names in (("g++",), ("clang++", "clang++-14")) if (name := compiler(*names))]
)
def test_bytes_are_no_message_of_another_size(name: str, options: str, tmp_path: Path) -> None:
    sending = "\n    ".join(f"{{ {line} }}" for line in UNSUSPICIOUS).replace("GEN", GEN)
    program = build_sender(tmp_path, PAIR, sending, name="main.cpp", compiler=name, flags=["-g", options])
    assert check(program).text == ""


EXAMPLES = sorted(path.parent / path.parent.name for path in ROOT.glob("examples/*/main.c*"))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.name)
def test_messages_of_the_examples_have_the_same_layout_everywhere(example: Path) -> None:
    assert check(example, "-Werror=message-layout").text == ""
