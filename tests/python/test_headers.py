"""Programs compile against the headers in every supported language, and do the same thing in each."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from conftest import Compile
from running import PROGRAMS, ROOT, build_folder, compile_program, compiler, pkg_config, run

STRICT = ["-Wall", "-Wextra", "-Wfloat-conversion", "-Werror"]
C_STANDARDS = ["c11", "c17", "gnu11"]
CPP_STANDARDS = ["c++17", "c++20", "gnu++20"]
C_COMPILERS = [name for name in (compiler("gcc"), compiler("clang", "clang-14")) if name]
CPP_COMPILERS = [name for name in (compiler("g++"), compiler("clang++", "clang++-14")) if name]

CASES = [
    (c, [f"-std={std}", *options])
    for c in C_COMPILERS
    for std in C_STANDARDS
    for options in ([], ["-DNO_SEMICOLON", "-O2"])
] + [
    (cpp, ["-x", "c++", f"-std={std}", *options])
    for cpp in CPP_COMPILERS
    for std in CPP_STANDARDS
    for options in (
        [],
        ["-DINSIDE_EXTERN_C", "-O2"],
        ["-DNO_SEMICOLON", "-DPLAIN_MAIN"],
        ["-DINSIDE_EXTERN_C", "-DNO_SEMICOLON", "-fno-exceptions", "-fno-rtti"],
    )
]

SETTINGS = {
    "arena_surface": 5.0e4,
    "objects.robots.msg_success_rate": {"type": "static", "rate": 1.0},
    "objects.lamp": {"type": "static_light", "geometry": "global", "value": 0},
    "parameters": {
        "a_bool": True,
        "an_int8": -8,
        "an_int16": -1600,
        "an_int32": -320000,
        "a_uint8": 200,
        "a_uint16": 60000,
        "a_uint32": 4000000000,
        "a_float": 0.5,
        "a_double": 1.0e100,
        "settings": {"gain": 2.5},
        "floats": [10, 20.5, 30],
        "doubles": [0.25, 0.75],
        "text": "too lon",
    },
}
READ = "[SYSTEM] [PRINTF] read 1 -8 -1600 -320000 200 60000 4000000000 0.5 1e+100 2.5 [10 20.5 30] [0.25 0.75] too lon"
PRINTED = [
    "sum 0",
    "rainbow 25 0 0, light 0, temperature 42.0",
    "directions 010 status 2 powers 512 512 0 battery 4200",
    "rand positive repeats",
    "std 1",
    "puts",
    "p",
    "3 robots, category __system",
    "timer after 112000 us at 112 ms, 7 ticks",
    "heard something, last of type 16 from 2, 4 bytes: 1 2 3 2",
    "end of a robot",
]


@pytest.mark.parametrize(("name", "flags"), CASES, ids=lambda part: part if isinstance(part, str) else " ".join(part))
def test_sample_compiles_without_warnings_and_prints_the_same(name: str, flags: list[str], tmp_path: Path) -> None:
    sample = compile_program(tmp_path / "sample", PROGRAMS / "sample.c", compiler=name, flags=[*flags, *STRICT])
    result = run(sample, tmp_path, SETTINGS)
    assert (result.code, result.errors) == (0, "")
    printed = [line.split("[info] ")[1] for line in result.output.splitlines() if "[PRINTF]" in line]
    who = ["SYSTEM" if "__system" in line else "ROBOT #0" for line in PRINTED]
    assert printed == [READ, *(f"[{name}] [PRINTF] {line}" for name, line in zip(who, PRINTED, strict=True))]


@pytest.mark.parametrize("name", C_COMPILERS)
@pytest.mark.parametrize("std", C_STANDARDS)
@pytest.mark.parametrize("semicolon", [[], ["-DNO_SEMICOLON"]], ids=["semicolon", "none"])
def test_sample_compiles_as_c_with_pedantic_warnings(name: str, std: str, semicolon: list[str], tmp_path: Path) -> None:
    # ISO C wants no second semicolon after a declaration; users write one.
    flags = [f"-std={std}", *semicolon, "-Wpedantic", *STRICT]
    compile_program(tmp_path / "sample", PROGRAMS / "sample.c", compiler=name, flags=flags)


def public_headers() -> list[str]:
    """Names of headers for programs and hosts, without those that say only that they are another simulator's."""
    folder = ROOT / "include"
    headers = [*folder.glob("pogosim/*.h"), *folder.glob("pogosim/pogolib/*.h")]
    return sorted(str(header.relative_to(folder)) for header in headers if "#error" not in header.read_text())


@pytest.mark.parametrize(
    ("name", "standards"),
    [(name, ["c99", "c11", "c17", "c2x"]) for name in C_COMPILERS]
    + [(name, ["c++11", "c++14", "c++17", "c++20", "c++2b"]) for name in CPP_COMPILERS],
)
def test_public_headers_are_accepted_with_every_standard(name: str, standards: list[str], tmp_path: Path) -> None:
    is_cpp = "++" in name
    every = "".join(f'#include "{header}"\n' for header in ["pogobase.h", *public_headers()])
    (tmp_path / "every.c").write_text(every + "int main(void) { return 0; }\n")
    (tmp_path / "sdk.c").write_text('#include "pogobot.h"\nint main(void) { return 0; }\n')
    template = ROOT / "template_prj" / "main.c"  # ends declarations with semicolons, of which C++ is pedantic
    options = [*STRICT, "-Wpedantic", "-fsyntax-only", *(f"-I{ROOT}/include{sub}" for sub in ("", "/sdk"))]
    options += ["-x", "c++"] if is_cpp else []
    for standard in standards:
        for source in (tmp_path / "every.c", tmp_path / "sdk.c", template):
            extra = ["-Wno-pedantic"] if is_cpp and source == template else []
            command = [name, f"-std={standard}", *options, *extra, str(source)]
            done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
            assert (done.returncode, done.stderr) == (0, ""), command


BYTES = "(uint8_t*)&m, sizeof(m)"
SENDING_CALLS = [
    f"pogobot_infrared_{function}({direction}{BYTES})"
    for function, direction in [
        ("sendLongMessage_omniGen", ""),
        ("sendLongMessage_omniSpe", ""),
        ("sendLongMessage_uniSpe", "ir_left, "),
        ("sendShortMessage_omni", ""),
        ("sendShortMessage_uni", "ir_all, "),
    ]
]
# Calls as in tables of functions, in inline functions, and with commas that are in no parentheses.
CALLS = """#include "pogobase.h"
typedef struct { uint8_t a; uint16_t b; } msg_t;
typedef struct {
    uint32_t (*pogobot_infrared_sendShortMessage_omni)(uint8_t* const, uint16_t const);
    uint32_t (*pogobot_infrared_sendLongMessage_uniSpe)(ir_direction, uint8_t* const, uint16_t const);
    void (*data_set_value_int8)(char const*, int8_t);
    void (*data_set_value_int32)(char const*, int32_t);
} api_t;
static api_t const table = {pogobot_infrared_sendShortMessage_omni, pogobot_infrared_sendLongMessage_uniSpe,
                            data_set_value_int8, data_set_value_int32};
static api_t const* api = &table;
inline uint32_t send_all(msg_t m);
inline uint32_t send_all(msg_t m) {
    return SENDING_CALLS;
}
extern uint32_t send_all(msg_t m);
static void add(void) {
    data_add_column_int8("byte");
    data_add_column_int32("word");
    data_add_column_int32("sum");
}
static void step(void) {
    msg_t m = {1, 2};
    uint32_t failed = send_all(m) + api->pogobot_infrared_sendShortMessage_omni((uint8_t*)&m, sizeof(m));
    failed += table.pogobot_infrared_sendLongMessage_uniSpe(ir_front, (uint8_t*)&m, sizeof(m));
    LANGUAGE_SENDS
    if (failed) { pogobot_infrared_sendShortMessage_omni(NULL, 0); }
}
static void set(void) {
    uint32_t const difference = pogobot_ticks - pogobot_ticks - 8;
    api->data_set_value_int8("byte", -3);
    table.data_set_value_int32("word", INT32_MIN);
    LANGUAGE_SETS
}
int main(void) {
    pogobot_init();
    pogobot_start(NULL, step);
    SET_CALLBACK(callback_create_data_schema, add);
    SET_CALLBACK(callback_export_data, set);
    return 0;
}
""".replace("SENDING_CALLS", " + ".join(SENDING_CALLS))
C_CALLS = {
    "LANGUAGE_SENDS": "failed += pogobot_infrared_sendShortMessage_omni((uint8_t*)&(msg_t){1, 2}, sizeof(msg_t));",
    "LANGUAGE_SETS": 'data_set_value_int32("sum", difference + (struct { unsigned c, d; }){1, 2}.d);',
}
CPP_CALLS = {
    "LANGUAGE_SENDS": "failed += pogobot_infrared_sendShortMessage_omni(std::array<uint8_t, 2>{1, 2}.data(), 2);",
    "LANGUAGE_SETS": """enum Two : uint8_t { two = 2 };
    auto const two_of = [](auto, auto) { return std::map<int, uint32_t>{{1, 2u}}.at(1); };
    data_set_value_int32("sum", [&, d = difference] { return d + two_of(two, std::max<int>(1, 2)); }());""",
}


@pytest.mark.parametrize(
    ("name", "standard"),
    [(name, standard) for name in C_COMPILERS for standard in C_STANDARDS]
    + [(name, standard) for name in CPP_COMPILERS for standard in CPP_STANDARDS],
)
def test_functions_that_are_macros_too_are_called_as_functions(name: str, standard: str, tmp_path: Path) -> None:
    is_cpp = "++" in standard
    text = "#include <algorithm>\n#include <array>\n#include <map>\n" * is_cpp + CALLS
    for key, calls in (CPP_CALLS if is_cpp else C_CALLS).items():
        text = text.replace(key, calls)
    source = tmp_path / ("main.cpp" if is_cpp else "main.c")
    source.write_text(text)
    flags = [f"-std={standard}", *STRICT, "-Wpedantic", "-Wconversion"]
    result = run(compile_program(tmp_path / "main", source, compiler=name, flags=flags), tmp_path)
    assert (result.code, [line for line in result.errors.splitlines() if "arrived" not in line]) == (0, [])
    row = result.frame().iloc[-1]
    assert [int(row[column]) for column in ("byte", "word", "sum")] == [-3, -(2**31), -6]


STANDARD_HEADERS = "".join(f"#include <{name}>\n" for name in ("algorithm", "cstdio", "iostream", "map", "random"))


@pytest.mark.parametrize(
    "included", ['#include "pogobase.h"\n' * 2, 'extern "C" {\n#include "pogobase.h"\n}\n'], ids=["bare", "extern C"]
)
@pytest.mark.parametrize("standard_first", [False, True])
def test_header_goes_before_and_after_those_of_the_standard_library(
    included: str, standard_first: bool, tmp_path: Path
) -> None:
    source = tmp_path / "main.cpp"
    order = [STANDARD_HEADERS, included] if standard_first else [included, STANDARD_HEADERS]
    source.write_text("".join(order) + 'int main() { std::printf("hi\\n"); std::puts("x"); return 0; }\n')
    result = run(compile_program(tmp_path / "main", source), tmp_path, {"objects.robots.nb": 1})
    assert result.robot_lines == ["[ROBOT #0] [PRINTF] hi", "[ROBOT #0] [PRINTF] x"]


def test_program_of_two_files_shares_its_user_data(tmp_path: Path) -> None:
    folder = PROGRAMS / "two_files"
    program = compile_program(tmp_path / "two_files", folder / "main.c", folder / "count.c")
    result = run(program, tmp_path)
    assert result.robot_lines == [f"[ROBOT #{robot}] [PRINTF] counted to {10 * (robot + 1)}" for robot in range(3)]


def test_program_may_be_of_c_and_cpp_files(tmp_path: Path) -> None:
    folder = PROGRAMS / "two_files"
    count = tmp_path / "count.o"
    command = ["cc", "-std=c11", *STRICT, *pkg_config("--cflags"), "-c", str(folder / "count.c"), "-o", str(count)]
    subprocess.run(command, check=True)
    main = tmp_path / "main.cpp"
    main.write_text((folder / "main.c").read_text())
    program = compile_program(tmp_path / "mixed", main, count, flags=[f"-I{folder}", *STRICT])
    assert run(program, tmp_path).robot_lines[-1] == "[ROBOT #2] [PRINTF] counted to 30"


def test_program_needs_neither_user_data_nor_a_step(program: Compile, tmp_path: Path) -> None:
    result = run(program("no_userdata.c"), tmp_path)
    assert (result.code, result.errors) == (0, "")
    assert result.robot_lines == [f"[ROBOT #{robot}] [PRINTF] robot {robot}" for robot in range(3)]
    assert result.frame()["pogobot_ticks"].max() == 125


def test_user_data_without_register_userdata_do_not_link(tmp_path: Path) -> None:
    folder = PROGRAMS / "two_files"
    main = tmp_path / "main.c"
    main.write_text((folder / "main.c").read_text().replace("REGISTER_USERDATA(Userdata);", ""))
    with pytest.raises(AssertionError, match="undefined reference to `REGISTER_USERDATA_once'"):
        compile_program(tmp_path / "main", main, folder / "count.c", flags=[f"-I{folder}"])


@pytest.mark.parametrize("cpp", CPP_COMPILERS)
@pytest.mark.parametrize("standard", CPP_STANDARDS)
def test_members_of_user_data_may_have_initial_values_in_cpp(cpp: str, standard: str, tmp_path: Path) -> None:
    source = tmp_path / "main.cpp"
    source.write_text(
        """#include "pogobase.h"
#include <vector>
struct State {
    int count = 5;
    int other;
    std::vector<int> list{1, 2, 3};
};
DECLARE_USERDATA(State);
REGISTER_USERDATA(State);
static void user_init() {
    mydata->list.push_back(++mydata->count);
    printf("%d %d %d of %zu", mydata->count, mydata->other, mydata->list.back(), mydata->list.size());
}
int main() { pogobot_start(user_init, nullptr); return 0; }
"""
    )
    flags = [f"-std={standard}", *STRICT]
    result = run(compile_program(tmp_path / "main", source, compiler=cpp, flags=flags), tmp_path)
    assert result.robot_lines == [f"[ROBOT #{robot}] [PRINTF] 6 0 6 of 4" for robot in range(3)]


MAINS = [
    "int main(void)",
    "int main()",
    "int main(int argc, char** argv)",
    "int main(int argc, char* argv[])",
    "int main(int argc, char const** argv)",
    "int main(int argc, char** argv, char** environment)",
]


@pytest.mark.parametrize("signature", MAINS)
def test_main_may_take_arguments_in_every_standard(signature: str, tmp_path: Path) -> None:
    source = tmp_path / "main"
    told = 'printf("%d %s %d\\n", argc, argv[0], argv[1] == NULL);' if "argc" in signature else 'printf("none\\n");'
    used = "(void)environment;" if "environment" in signature else ""
    code = f'#include "pogobase.h"\n{signature} {{\n{used}{told}\nreturn 0;\n}}\n'
    compiled: list[Path] = []
    for names, standards, suffix in [(C_COMPILERS, C_STANDARDS, ".c"), (CPP_COMPILERS, CPP_STANDARDS, ".cpp")]:
        path = source.with_suffix(suffix)
        path.write_text(code)
        for name in names:
            for standard in standards:
                compiled.append(tmp_path / f"{name}-{standard}-{suffix[1:]}".replace("+", "p"))
                compile_program(compiled[-1], path, compiler=name, flags=[f"-std={standard}", *STRICT, "-Wpedantic"])
    for binary in (compiled[0], compiled[-1]):
        result = run(binary, tmp_path)
        assert result.code == 0
        told_by_main = f"1 {binary} 1" if "argc" in signature else "none"
        assert result.robot_lines == [f"[ROBOT #{robot}] [PRINTF] {told_by_main}" for robot in range(3)]


def test_program_without_main_does_not_link(tmp_path: Path) -> None:
    source = tmp_path / "main.c"
    source.write_text('#include "pogobase.h"\n')
    with pytest.raises(AssertionError, match="robot_main"):
        compile_program(tmp_path / "program", source)


@pytest.mark.parametrize("name", ["simulator", "robot", "configuration"])
def test_headers_of_the_original_simulator_say_what_to_do(name: str, tmp_path: Path) -> None:
    source = tmp_path / "main.cpp"
    source.write_text(f'#include "pogosim/{name}.h"\nint main() {{ return 0; }}\n')
    with pytest.raises(AssertionError, match="Include pogobase"):
        compile_program(tmp_path / "program", source)


def test_library_shows_users_the_interface_and_nothing_else() -> None:
    """Everything else is hidden, so that a program's own names cannot meet ours."""
    library = next((build_folder() / "src").glob("libpogosim.*"))
    listing = subprocess.run(
        ["nm", "-D", "--defined-only", str(library)], capture_output=True, text=True, check=True
    ).stdout
    names = {line.split()[-1] for line in listing.splitlines()}
    headers = "".join(path.read_text() for path in (ROOT / "include").rglob("*.h"))
    of_libc = {"fork", "pthread_create", "pthread_exit"}
    of_box2d = {"_Z15b2Alloc_Defaulti", "_ZN7b2TimerC1Ev", "_ZN7b2Timer5ResetEv", "_ZNK7b2Timer15GetMillisecondsEv"}
    renamed = {"pogosim_hsv_to_rgb"}  # hsv_to_rgb of the interface, which the simulated one calls
    assert {name for name in names - of_libc - of_box2d - renamed if name not in headers} == set()
    assert {"pogobot_ticks", "pogosim_printf", "pogosim_mydata", "pogosim_run_program", "pogosim_run_open"} <= names


def test_interface_layer_is_short_enough_to_be_read() -> None:
    lines = sum(len(path.read_text().splitlines()) for path in (ROOT / "src" / "interface").glob("*.c"))
    assert lines < 200


def check_does_not_compile(source: Path, variable: str, function: str, message: str) -> None:
    """Check that a variable, given to a function, does not compile, with a message that matches."""
    source.write_text(f'#include "pogobase.h"\nstatic {variable};\nint main(void) {{ {function}(v); return 0; }}\n')
    with pytest.raises(AssertionError, match=message):
        compile_program(source.with_name("program"), source, flags=[])


@pytest.mark.parametrize("suffix", [".c", ".cpp"])
@pytest.mark.parametrize("variable", ["int* v", "struct { int a; } v", "int v[3]", "int64_t v", "char v[9]"])
def test_variable_that_cannot_be_read_from_the_configuration_does_not_compile_and_says_why(
    suffix: str, variable: str, tmp_path: Path
) -> None:
    message = r"init_from_configuration\(\) reads variables of type bool, float, double"
    check_does_not_compile(tmp_path / f"main{suffix}", variable, "init_from_configuration", message)


@pytest.mark.parametrize("suffix", [".c", ".cpp"])
@pytest.mark.parametrize("variable", ["float* v", "char* v", "int v[3]", "float v[2][2]"])
def test_array_that_cannot_be_read_from_the_configuration_does_not_compile_and_says_why(
    suffix: str, variable: str, tmp_path: Path
) -> None:
    message = r"init_array_from_configuration\(\) reads arrays of float, double or char \(texts\) whose size"
    check_does_not_compile(tmp_path / f"main{suffix}", variable, "init_array_from_configuration", message)
