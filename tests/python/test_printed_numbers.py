"""printf() of the robots, where `long` has 32 bits, prints numbers of every width as they are."""

from __future__ import annotations

from pathlib import Path

import pytest
from running import compile_program, run
from test_headers import C_COMPILERS, CPP_COMPILERS

FAMILIES = ["8", "16", "32", "64", "LEAST8", "LEAST16", "LEAST32", "LEAST64"]
FAMILIES += ["FAST8", "FAST16", "FAST32", "FAST64", "MAX", "PTR"]
CONVERSIONS = {"d": "int", "i": "int", "u": "uint", "o": "uint", "x": "uint", "X": "uint"}
ORDERS = {
    "ours alone": ['"pogobase.h"'],
    "ours first": ['"pogobase.h"', "<inttypes.h>"],
    "theirs first": ["<inttypes.h>", '"pogobase.h"'],
    "theirs first and last": ["<inttypes.h>", '"pogobase.h"', "<inttypes.h>"],
}
CPP_ORDERS = {**ORDERS, "of C++": ["<cinttypes>", '"pogobase.h"', "<cinttypes>", "<iostream>"]}


def type_of(conversion: str, family: str) -> str:
    """int_fast16_t."""
    word = family.rstrip("0123456789").lower()
    bits = family[len(word) :]
    return f"{CONVERSIONS[conversion]}{'_' * (word in ('least', 'fast'))}{word}{bits}_t"


def bits_of(family: str) -> int:
    """How many bits that type has at least."""
    digits = "".join(letter for letter in family if letter.isdigit())
    return int(digits or "64")


def value_of(conversion: str, family: str) -> int:
    """One whose upper half matters."""
    bits = bits_of(family)
    return 5 - (1 << (bits - 1)) if CONVERSIONS[conversion] == "int" else (1 << bits) - 3


def literal(value: int) -> str:
    return f"{value}LL" if value < 0 else f"{value}ULL"


def text_of(value: int, conversion: str) -> str:
    return format(value, {"i": "d", "u": "d"}.get(conversion, conversion))


TABLE = [(conversion, family) for family in FAMILIES for conversion in CONVERSIONS]


def program_text(includes: list[str]) -> str:
    """Print each number of the table by printf() of the robots, and by two functions of the C library."""
    lines = [f"#include {name}" for name in includes] + ["void user_init(void) {", "    char text[100];"]
    for conversion, family in TABLE:
        macro, value = f"PRI{conversion}{family}", literal(value_of(conversion, family))
        lines += [
            "    {",
            f"        {type_of(conversion, family)} number = ({type_of(conversion, family)}){value};",
            f'        snprintf(text, sizeof(text), "%" {macro}, number);',
            f'        printf("{macro} %" {macro} " %s %-12" {macro} "|\\n", number, text, number);',
            "    }",
        ]
    return "\n".join([*lines, "}", "int main(void) { pogobot_init(); pogobot_start(user_init, NULL); return 0; }", ""])


CASES = [(name, "c", order) for name in C_COMPILERS for order in ORDERS] + [
    (name, "cpp", order) for name in CPP_COMPILERS for order in CPP_ORDERS
]


@pytest.mark.parametrize(("name", "language", "order"), CASES)
def test_numbers_of_every_type_are_printed_whole(name: str, language: str, order: str, tmp_path: Path) -> None:
    source = tmp_path / f"main.{language}"
    source.write_text(program_text((CPP_ORDERS if language == "cpp" else ORDERS)[order]))
    flags = ["-Wall", "-Wextra", "-Wformat=2", "-Werror", *(["-x", "c++"] if language == "cpp" else ["-Wpedantic"])]
    prog = compile_program(tmp_path / "prog", source, compiler=name, flags=flags)
    result = run(prog, tmp_path / "run", {"objects.robots.nb": 1, "simulation_time": 0.1})
    assert (result.code, result.errors) == (0, "")
    expected = []
    for conversion, family in TABLE:
        number = text_of(value_of(conversion, family), conversion)
        expected.append(f"[ROBOT #0] [PRINTF] PRI{conversion}{family} {number} {number} {number:<12}|")
    assert result.robot_lines == expected


OTHERS = {
    # As on the robot, `long` has 32 bits: what is beyond them is lost.
    '"%lu", (unsigned long)0x100000007': "7",
    '"%ld", (long)-5': "-5",
    '"%lx", (uint32_t)0xfffffffe': "fffffffe",
    '"%2$lu %1$lu", (uint32_t)4000000000, (uint32_t)5': "5 4000000000",
    '"%*lu|", 5, (uint32_t)7': "    7|",
    # All others have the size that they have here.
    '"%llu", 0xffffffffffffffffULL': "18446744073709551615",
    '"%lld", -0x7fffffffffffffffLL': "-9223372036854775807",
    '"%zu", (size_t)0x100000007': "4294967303",
    '"%td", (ptrdiff_t)-0x100000007': "-4294967303",
    '"%jd", (intmax_t)-0x100000007': "-4294967303",
    '"%p", (void*)0x123456789a': "0x123456789a",
    '"%hhd %hd", 5, -5': "5 -5",
    '"%lf %Lf", 0.5, 0.25L': "0.500000 0.250000",
    '"100%% %d", 5': "100% 5",
}


def test_lengths_of_formats(tmp_path: Path) -> None:
    source = tmp_path / "main.c"
    lines = "".join(f'    printf({call}); printf("\\n");\n' for call in OTHERS)
    # "%lu" of the C library is for its own `long`.
    own = '    char text[50]; snprintf(text, sizeof(text), "%lu", (uint64_t)0x100000007); puts(text);\n'
    start = "int main(void) { pogobot_init(); pogobot_start(user_init, NULL); return 0; }\n"
    source.write_text(f'#include "pogobase.h"\nvoid user_init(void) {{\n{lines}{own}}}\n{start}')
    prog = compile_program(tmp_path / "prog", source, flags=["-Wall", "-Wextra", "-Werror"])
    result = run(prog, tmp_path / "run", {"objects.robots.nb": 1, "simulation_time": 0.1})
    assert result.robot_lines == [f"[ROBOT #0] [PRINTF] {text}" for text in [*OTHERS.values(), "4294967303"]]
