"""`make sim` warns of members of messages that have another size on a real robot, and of no others."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from running import ROOT, Run, compile_text, compiler, pkg_config, ran

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
    return ran(program.parent, *command, timeout=60)


def build(folder: Path, messages: str, name: str = "cc", options: str = "-O0") -> Path:
    text = PROGRAM.replace("MESSAGES", messages.strip())
    return compile_text(folder, text, compiler=name, flags=["-g", *options.split()])


NAMED = {(9, "'sizes'"), (9, "'time'"), (10, "'high'"), (10, "'fast'")}
RECEIVED = {(7, "'count'"), (8, "'name'")}


@pytest.mark.parametrize("options", ["-O0", "-O2"])
@pytest.mark.parametrize("name", COMPILERS)
def test_members_of_another_size_are_named(name: str, options: str, tmp_path: Path) -> None:
    result = check(build(tmp_path, WRONG, name, options))
    assert result.code == 0
    found = [line.split(" in the message ")[0].split(": warning: ") for line in result.errors.splitlines()]
    expected = NAMED | RECEIVED
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


END = """
}
static void user_init(void) {}
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
"""
SENDER = (
    """#include "pogobase.h"
TYPES
typedef struct { size_t length; long number; uint8_t buffer[40]; pair_t pair; long numbers[2]; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
static void user_step(void) {
    SENDING"""
    + END
)
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


# What a program that names its messages keeps for itself.
BOOKKEEPING = """#include "pogobase.h"
typedef struct { uint16_t id; int16_t heading; } beacon_t;
typedef struct { size_t index; long score; } best_t;
typedef struct { beacon_t* first; size_t count; beacon_t items[8]; } message_queue_t;
typedef struct { bool (*handler)(void); size_t calls; } msg_handler_t;
typedef struct { uint32_t n; message_queue_t queue; MEMBER } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
GLOBAL
static void receive(message_t* m) {
    beacon_t b;
    memcpy(&b, m->payload, sizeof b);
    best_t best = {0, -1000000};
    for (size_t i = 0; i < 8; i++) {
        if (mydata->queue.items[i].heading > best.score) best.index = i;
    }
    mydata->queue.items[best.index] = b;
}
static bool send(void) {
    uint8_t bytes[sizeof(beacon_t)] = {0};
    beacon_t b = {pogobot_helper_getid(), 0};
    memcpy(bytes, &b, sizeof bytes);
    return SENDING == 0;
}
static void user_init(void) { msg_tx_fn = send; msg_rx_fn = receive; }
int main(void) {
    pogobot_init();
    pogobot_start(user_init, NULL);
    return 0;
}
"""
OF_USERDATA = {"MEMBER": "msg_handler_t handler;", "GLOBAL": ""}
GLOBAL = {"MEMBER": "", "GLOBAL": "msg_handler_t handler;"}
FOLLOWED = f"{GEN}((uint8_t*)&b, sizeof b)"
BYTES = f"{GEN}(bytes, sizeof bytes)"


def keep_books(folder: Path, name: str, options: str, parts: dict[str, str], sending: str) -> Run:
    text = BOOKKEEPING
    for word, replacement in {**parts, "SENDING": sending}.items():
        text = text.replace(word, replacement)
    return check(compile_text(folder, text, compiler=name, flags=["-g", options]))


@pytest.mark.parametrize("name", COMPILERS)
@pytest.mark.parametrize(("parts", "sending"), [(OF_USERDATA, FOLLOWED), (GLOBAL, FOLLOWED), (OF_USERDATA, BYTES)])
def test_what_is_not_sent_is_no_message_whatever_its_name(
    name: str, parts: dict[str, str], sending: str, tmp_path: Path
) -> None:
    assert keep_books(tmp_path, name, "-O2", parts, sending).text == ""


@pytest.mark.parametrize("name", COMPILERS)
def test_names_tell_what_may_be_sent_where_no_call_does(name: str, tmp_path: Path) -> None:
    errors = keep_books(tmp_path, name, "-O0", GLOBAL, BYTES).errors
    assert errors.count("in the message 'msg_handler_t'") == errors.count("warning") == 2


PAYLOADS = {
    "copied": "pair_t k; memcpy(&k, m->payload, sizeof(k)); use(k.i);",
    "copied to an array": "pair_t k[2]; memcpy(k, m->payload + 1, sizeof(pair_t)); use(k[0].i);",
    "copied to user data": "memcpy(&mydata->pair, m->payload, sizeof(mydata->pair));",
    "moved": "pair_t k; memmove(&k, (*m).payload, 16); use(k.i);",
    "cast": "use(((pair_t*)m->payload)->i);",
    "cast with const": "pair_t const* k = (pair_t const *)(m->payload); use(k->i);",
    "cast in an argument": "use(take((pair_t *) &m->payload[0]));",
    "cast to an address of a constant": "const pair_t k = *(const pair_t*)m->payload; use(k.i);",
    "through void": "pair_t* k = (void*)m->payload; use(k->i);",
    "through a pointer to bytes": "uint8_t const* p = m->payload; pair_t const* k = (pair_t const*)p; use(k->i);",
    "from such a pointer": "uint8_t* p = (void*)m->payload; p = p + 1; pair_t k; memcpy(&k, p, sizeof k); use(k.i);",
    "written": "message_t raw; pair_t k = {1, 2}; memcpy(raw.payload, &k, sizeof k); raw.header.payload_length = 16;"
    "pogobot_infrared_sendRawLongMessage(&raw);",
    "of a short message": "short_message_t raw; pair_t k = {1, 2}; memcpy(raw.payload, &k, sizeof k);"
    "pogobot_infrared_sendRawShortMessage(ir_all, &raw);",
    "of one of several": "static message_t box[3]; pair_t k; memcpy(&k, box[kept + 1].payload, sizeof k); use(k.i);",
    "in a second line": "pair_t k;\n    memcpy(&k,  // where; it (goes)\n        m->payload, sizeof(k)); use(k.i);",
}
NO_PAYLOADS = [
    "uint8_t id = m->payload[0]; pair_t k; memcpy(&k, &id, 1); use(k.i);",
    "uint8_t const id = *m->payload; pair_t k; memcpy(&k, &id, 1); use(k.i);",
    "// (pair_t*)m->payload\n use(m->payload[0]);",
    'pair_t k = {1, 2}; k.i = m->payload[0]; use(k.i); use((uint32_t)sizeof "(pair_t*)m->payload");',
    "uint32_t k; memcpy(&k, m->payload, sizeof k); pair_t other = {k, 2}; use(other.i);",
    "struct { pair_t payload[2]; } own = {0}; pair_t* k = (pair_t*)own.payload; use(k->i);",
    "float k = *(float*)m->payload; use((uint32_t)k);",
]


def build_receiver(folder: Path, name: str, options: str, reading: str) -> Path:
    body = f"static void receive(message_t* m) {{ (void)m; {reading} }}"
    text = SENDER.replace("static void user_init(void) {", body + "static void user_init(void) { msg_rx_fn = receive; ")
    types = PAIR + "uint32_t kept; void use(uint32_t i); void use(uint32_t i) { kept += i; }"
    types += "static inline uint32_t take(pair_t* k) { return k->i; }"
    text = text.replace("TYPES", types).replace("SENDING", "")
    return compile_text(folder, text, compiler=name, flags=["-g", options])


@pytest.mark.parametrize("what", PAYLOADS)
@pytest.mark.parametrize("name", COMPILERS)
def test_what_a_payload_is_taken_for_is_a_message(name: str, what: str, tmp_path: Path) -> None:
    errors = check(build_receiver(tmp_path, name, "-O2", PAYLOADS[what])).errors
    assert errors.count("warning") == 1, errors
    assert "'z' in the message 'pair_t'" in errors


@pytest.mark.parametrize("reading", NO_PAYLOADS)
@pytest.mark.parametrize("name", COMPILERS)
def test_what_has_nothing_to_do_with_a_payload_is_no_message(name: str, reading: str, tmp_path: Path) -> None:
    assert check(build_receiver(tmp_path, name, "-O0", reading)).text == ""


SIZE_OF_ADDRESS = [
    "pair_t* k = &mydata->pair; GEN((uint8_t*)k, sizeof(k));",
    "void* k = &mydata->pair; GEN((uint8_t*)k, sizeof k);",
    "uint8_t* k = mydata->buffer; GEN(k, sizeof(k));",
]


@pytest.mark.parametrize("sending", SIZE_OF_ADDRESS)
@pytest.mark.parametrize("options", ["-O0", "-O2"])
@pytest.mark.parametrize("name", COMPILERS)
def test_size_of_a_pointer_is_not_the_size_of_a_message(name: str, options: str, sending: str, tmp_path: Path) -> None:
    fine = "typedef struct { uint32_t i; } pair_t;"
    text = sending.replace("GEN", GEN)
    errors = check(build_sender(tmp_path, fine, text, compiler=name, flags=["-g", options, "-w"])).errors
    assert errors == (
        "main.c:7: warning: 'sizeof(k)' is the size of an address, 8 bytes here and 4 on a real robot: take the "
        "size of what it points to [-Wmessage-layout]\n"
    )


def test_long_double_is_told_of_as_another_format(tmp_path: Path) -> None:
    sending = f"struct {{ long double x; }} k = {{1}}; {GEN}((uint8_t*)&k, sizeof k);"
    assert (
        "'x' in the message 'k' is of type 'long double', whose bytes mean another number on a real robot: take "
        in (check(build_sender(tmp_path, PAIR, sending, flags=["-g"])).errors)
    )


CPP_COMPILERS = [name for names in (("g++",), ("clang++", "clang++-14")) if (name := compiler(*names))]
CPP = """#include <array>
#include <bitset>
#include <optional>
#include <vector>
struct Base { long id; };
struct Derived : Base { uint8_t k; };
struct Second : Derived { float x; };
struct Array { std::array<long, 2> numbers; };
struct Listed { std::vector<uint8_t> list; };
struct Maybe { std::optional<size_t> count; };
struct Fine { std::array<uint8_t, 4> bytes; std::array<std::array<float, 2>, 2> matrix; };
struct
Virtual { virtual ~Virtual() = default; uint8_t x = 0; };
struct Inner : Fine { Virtual part; };
typedef struct { uint32_t i; } pair_t;
"""
OF_CLASSES = {
    "Derived": ["main.cpp:6:20: warning: 'id' in the message 'Derived' is of type 'long"],
    "Second": ["main.cpp:6:20: warning: 'id' in the message 'Second' is of type 'long"],
    "Array": ["main.cpp:9:38: warning: 'numbers' in the message 'Array' contains 'long"],
    "Listed": ["main.cpp:10:38: warning: 'list' in the message 'Listed' contains an address, which means nothing"],
    "Maybe": ["main.cpp:11:38: warning: 'count' in the message 'Maybe' contains "],
    "Fine": [],
    "Virtual": ["main.cpp:14: warning: 'Virtual' is sent as a message and has virtual functions, so it contains an"],
    "Inner": [
        "main.cpp:14: warning: 'Virtual' in the message 'Inner' has virtual functions, so it contains an address"
    ],
    "std::array<long, 2>": ["main.cpp:22:25: warning: 'k' in the message 'array<long"],
}


@pytest.mark.parametrize("what", OF_CLASSES)
@pytest.mark.parametrize("name", CPP_COMPILERS)
def test_members_of_base_classes_and_of_library_classes_count(name: str, what: str, tmp_path: Path) -> None:
    sending = f"{what} k; {GEN}((uint8_t*)&k, sizeof(k));"
    how = {"name": "main.cpp", "compiler": name, "flags": ["-g", "-std=gnu++20"]}
    found = check(build_sender(tmp_path, CPP, sending, **how)).errors.splitlines()
    assert len(found) == len(OF_CLASSES[what]), found
    column = re.compile(r":(\d+):\d+:")  # clang does not tell columns
    for line, expected in zip(found, OF_CLASSES[what], strict=True):
        assert column.sub(r":\1:", line).startswith(column.sub(r":\1:", expected))


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
@pytest.mark.parametrize("name", CPP_COMPILERS)
def test_bytes_are_no_message_of_another_size(name: str, options: str, tmp_path: Path) -> None:
    sending = "\n    ".join(f"{{ {line} }}" for line in UNSUSPICIOUS).replace("GEN", GEN)
    program = build_sender(tmp_path, PAIR, sending, name="main.cpp", compiler=name, flags=["-g", options])
    assert check(program).text == ""


NESTED = (
    """#include "pogobase.h"
typedef struct { uint16_t id; int16_t value; } beacon_t;
typedef struct { long big; beacon_t out; beacon_t* outs; } part_t;
typedef struct {
    size_t size; beacon_t out; beacon_t arr[3]; beacon_t table[2][3]; part_t part; uint8_t* slots[2]; uint8_t** sp;
    uint8_t bytes[8]; beacon_t* list[3]; part_t parts[2];
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
long counter;
static part_t* get(void) { return &mydata->part; }
static void user_step(void) {
    part_t* p = get();
    part_t ps[2] = {0};
    part_t** pp = &p;
    long k = 1;
    size_t len = 2;
    void* raw = p;
    (void)p; (void)ps; (void)pp; (void)k; (void)len; (void)raw;
    SENDING"""
    + END
)
RIGHT_SENDS = [
    "(uint8_t*)&(*mydata).out, sizeof((*mydata).out)",
    "(uint8_t*)&(*p).out, sizeof((*p).out)",
    "(uint8_t*)&(*pp)->out, sizeof((*pp)->out)",
    "(uint8_t*)&(p[0]).out, sizeof(beacon_t)",
    "(uint8_t*)&p[0].out, 4",
    "(uint8_t*)&(mydata->part).out, sizeof (mydata->part).out",
    "(uint8_t*)&((part_t*)p)->out, sizeof(((part_t*)p)->out)",
    "(uint8_t*)&((part_t*)raw)->out, 4",
    "*(mydata->slots + 1), 3",
    "(uint8_t*)(p != NULL ? &p->out : &mydata->out), sizeof(beacon_t)",
    "p != NULL ? (uint8_t*)&p->out : (uint8_t*)&mydata->out, 4",
    "(uint8_t*)(p ? p->outs : mydata->list[0]), 4",
    "(uint8_t*)p->outs, sizeof(*p->outs)",
    "(uint8_t*)&*p->outs, sizeof *p->outs",
    "(uint8_t*)mydata->list[1], sizeof(*mydata->list[1])",
    "(uint8_t*)mydata->arr, sizeof(mydata->arr)",
    "(uint8_t*)(mydata->arr + 1), sizeof(mydata->arr[0])",
    "(uint8_t*)&mydata->arr[mydata->size % 3], sizeof(beacon_t)",
    "(uint8_t*)&mydata->table[1][mydata->size].id, sizeof(uint16_t)",
    "(uint8_t*)mydata->table[0], sizeof mydata->table[0]",
    "(uint8_t*)&ps[1].out, sizeof(ps[1].out)",
    "(uint8_t*)&(ps + 1)->out, sizeof((ps + 1)->out)",
    "(uint8_t*)&get()->out, sizeof(get()->out)",
    "(uint8_t*)&(get())->out, (uint16_t)sizeof(beacon_t)",
    "(uint8_t*)mydata + offsetof(USERDATA, out), sizeof(beacon_t)",
    "(uint8_t*)&mydata->part + offsetof(part_t, out), 4",
    "((uint8_t*)&mydata->part) + 8, len",
    "&((uint8_t*)p)[8], 4",
    "(uint8_t*)raw, 4",
    "(uint8_t*)(uintptr_t)&p->out, 4",
    "mydata->bytes + len, (uint16_t)(sizeof(mydata->bytes) - len)",
    "*mydata->sp, 2",
    "mydata->sp[k], 2",
    "(uint8_t*)p, sizeof(uint16_t)",
    "(uint8_t*)(&(((p->out)))), sizeof(p->out)",
    "(uint8_t*)&(beacon_t){1, 2}, sizeof(beacon_t)",
    "(uint8_t[]){1, 2, 3}, 3",
    '(uint8_t*)(len > 1 ? "ab" : "cd"), 2',
    "(len++, mydata->bytes), 2",
]


def with_nested(folder: Path, sending: list[str], **how: Any) -> Path:
    lines = "\n    ".join(f"{GEN}({arguments});" for arguments in sending)
    return compile_text(folder, NESTED.replace("SENDING", lines), **how)


@pytest.mark.parametrize("options", ["-O0", "-O2"])
@pytest.mark.parametrize("name", COMPILERS)
def test_part_of_a_structure_is_sent_however_it_is_spelt(name: str, options: str, tmp_path: Path) -> None:
    assert check(with_nested(tmp_path, RIGHT_SENDS, compiler=name, flags=["-g", options])).text == ""


WRONG_SENDS = {
    "(uint8_t*)&(*p), sizeof(*p)": {"'big' in the message 'part_t'", "'outs' in the message 'part_t'"},
    "(uint8_t*)&(*mydata).part, 4": {"'big' in the message 'part_t'", "'outs' in the message 'part_t'"},
    "(uint8_t*)((part_t*)raw), 8": {"'big' in the message 'part_t'", "'outs' in the message 'part_t'"},
    "(uint8_t*)&(*pp)->big, sizeof((*pp)->big)": {"'big' is sent as a message"},
    "(uint8_t*)&(p[0]).outs, 8": {"'outs' is sent as a message"},
    "(uint8_t*)(len ? &k : &counter), 8": {"'k' is sent as a message", "'counter' is sent as a message"},
    "len ? (uint8_t*)&p->big : mydata->bytes, 8": {"'big' is sent as a message"},
    "(uint8_t*)(mydata->parts + 1), 8": {"'big' in the message 'part_t'", "'outs' in the message 'part_t'"},
    "(uint8_t*)&p, sizeof p": {"'p' is sent as a message"},
    "(uint8_t*)&(part_t){1}, 8": {"'big' in the message 'part_t'", "'outs' in the message 'part_t'"},
    "mydata->bytes, (uint16_t)(2 + sizeof(part_t))": {
        "'big' in the message 'part_t'",
        "'outs' in the message 'part_t'",
    },
}


@pytest.mark.parametrize("arguments", WRONG_SENDS)
@pytest.mark.parametrize("name", COMPILERS)
def test_what_is_sent_is_found_however_it_is_spelt(name: str, arguments: str, tmp_path: Path) -> None:
    result = check(with_nested(tmp_path, [arguments], compiler=name, flags=["-g", "-O2"]))
    said = {line.split("warning: ")[1] for line in result.errors.splitlines()}
    expected = WRONG_SENDS[arguments]
    assert len(said) == len(expected), said
    assert all(any(line.startswith(begin) for line in said) for begin in expected), said


CPP_SENDS = [
    "reinterpret_cast<uint8_t*>(&(*mydata).out), sizeof(beacon_t)",
    "reinterpret_cast<std::uint8_t*>(&p->out), sizeof p->out",
    "static_cast<uint8_t*>(static_cast<void*>(&(*pp)->out)), 4",
    "const_cast<uint8_t*>(&mydata->bytes[0]), 4",
    "(uint8_t*)std::next(&mydata->arr[0]), 4",
    "(uint8_t*)&ps[std::min<size_t>(len, 1)].out, 4",
    "boxes.front(), 4",
]


@pytest.mark.parametrize("name", [name for names in (("g++",), ("clang++",)) if (name := compiler(*names))])
def test_casts_of_cpp_are_followed(name: str, tmp_path: Path) -> None:
    text = NESTED.replace(
        "typedef struct { uint16_t", "#include <algorithm>\n#include <vector>\ntypedef struct { uint16_t"
    )
    text = text.replace("    (void)p;", "    std::vector<uint8_t*> boxes{mydata->bytes};\n    (void)p;")
    right = "\n    ".join(f"{GEN}({arguments});" for arguments in CPP_SENDS)
    how: dict[str, Any] = {"name": "main.cpp", "compiler": name, "flags": ["-g", "-O1"]}
    assert check(compile_text(tmp_path, text.replace("SENDING", right), **how)).text == ""
    wrong = f"{GEN}(reinterpret_cast<uint8_t*>(&(*pp)->big), uint16_t(sizeof(long)));"
    result = check(compile_text(tmp_path, text.replace("SENDING", wrong), **how))
    assert result.errors.count("warning") == 1
    assert "'big' is sent as a message" in result.errors


EXAMPLES = sorted(path.parent / path.parent.name for path in ROOT.glob("examples/*/main.c*"))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.name)
def test_messages_of_the_examples_have_the_same_layout_everywhere(example: Path) -> None:
    assert check(example, "-Werror=message-layout").text == ""
