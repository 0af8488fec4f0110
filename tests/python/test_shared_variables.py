"""A run says which variables its robots share by mistake, once, and nothing where they share none."""

from __future__ import annotations

from pathlib import Path

import pogosim
import pytest
from running import ROOT, Settings, compile_text, compiler, run, warnings, write_scene

PROGRAM = """#include "pogobase.h"
#include <math.h>
{variables}
static void user_step(void) {{ {step} }}
static void read_parameter(int32_t* variable) {{ init_int32_from_configuration(variable, "gain", 5); }}
static void setup(void) {{ (void)read_parameter; {setup} }}
int main(void) {{
    pogobot_init();
    pogobot_start(NULL, user_step);
    SET_CALLBACK(callback_global_setup, setup);
    return 0;
}}
"""
REMEDY = (
    "which real robots cannot: a clock or counter there that each robot advances runs 3 times too fast. Put what each "
    "robot has into USERDATA, read parameters with init_from_configuration(), "
    "declare constants const and what the supervisor or all robots use POGO_SHARED, or set robot_memory: own"
)
COMPILERS = [name for names in (("gcc",), ("clang", "clang-14")) if (name := compiler(*names))]


def build(
    folder: Path, variables: str, step: str = "", setup: str = "", flags: str = "-g", name: str = "main.c"
) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    text = PROGRAM.format(variables=variables, step=step, setup=setup)
    return compile_text(folder, text, name, flags=["-Wall", *flags.split()])


def told(program: Path, folder: Path, settings: Settings | None = None) -> list[str]:
    return [text.replace(f"{folder}/", "") for text in warnings(run(program, folder, settings))]


@pytest.mark.parametrize("options", ["-g -O0", "-g -O2"])
@pytest.mark.parametrize("name", COMPILERS)
def test_shared_variables_are_named_with_their_lines(name: str, options: str, tmp_path: Path) -> None:
    text = PROGRAM.format(
        variables="uint32_t total;\nstatic uint8_t table[4];",
        step="static int steps; table[steps++ % 4]++; total += table[0];",
        setup="",
    )
    program = compile_text(tmp_path, text, compiler=name, flags=["-Wall", *options.split()])
    assert told(program, tmp_path) == [
        "all robots share the variables 'total' (main.c:3), 'table' (main.c:4), 'steps' in user_step() (main.c:5), "
        f"{REMEDY}"
    ]


def test_one_variable_is_one(tmp_path: Path) -> None:
    assert told(build(tmp_path, "uint32_t total;", "total++;"), tmp_path) == [
        f"all robots share the variable 'total' (main.c:3), {REMEDY}"
    ]


def test_variable_of_the_supervisor_is_not_said_to_be_one_of_real_robots(tmp_path: Path) -> None:
    text = PROGRAM.format(
        variables="static uint32_t steps_of_world;\nstatic void look(void) { steps_of_world++; }", step="", setup=""
    )
    text = text.replace("pogobot_start(", "SET_CALLBACK(callback_global_step, look);\n    pogobot_start(", 1)
    program = compile_text(tmp_path, text, flags=["-g"])
    assert told(program, tmp_path) == [f"all robots share the variable 'steps_of_world' (main.c:3), {REMEDY}"]


def test_of_many_variables_the_first_are_named(tmp_path: Path) -> None:
    variables = "\n".join(f"uint32_t number_{i};" for i in range(6))
    (warning,) = told(build(tmp_path, variables), tmp_path)
    assert "variables 'number_0' (main.c:3), 'number_1' (main.c:4), 'number_2' (main.c:5) and 3 more, which" in warning


@pytest.mark.parametrize("name", COMPILERS)
def test_without_debug_information_names_are_known(name: str, tmp_path: Path) -> None:
    text = PROGRAM.format(variables="uint32_t total;", step="static int steps; total += (uint32_t)steps++;", setup="")
    program = compile_text(tmp_path, text, compiler=name, flags=["-Wall", "-g0"])
    (warning,) = told(program, tmp_path)
    assert "'total'" in warning
    assert "'steps'" in warning or "'user_step::steps'" in warning
    assert "main.c" not in warning


NOTHING_SHARED = {
    "parameter": ("static float gain = 1.0f;", "", "init_from_configuration(gain);"),
    "parameter that is not read": ("static float gain = 1.0f;", "", "if (0) init_from_configuration(gain);"),
    "parameter behind a pointer": ("static int32_t gain = 1;", "", "read_parameter(&gain);"),
    "member": (
        "static struct { int32_t low; char mark; } limits;",
        "limits.mark++;",
        "init_from_configuration(limits.low);",
    ),
    "element": ("static int32_t table[3];", "table[0]++;", "init_from_configuration(table[1]);"),
    "constant": (
        'static int const powers[] = {1, 2}; char const* const names[] = {"a", "b"};',
        "(void)powers; (void)names;",
        "",
    ),
    "mark": ("POGO_SHARED uint32_t total; POGO_SHARED static int count;", "total++; count++;", ""),
    "variable of a thread": ("static _Thread_local int number;", "number++;", ""),
}


@pytest.mark.parametrize("flags", ["-g", "-g0", "-g0 -O2"])
@pytest.mark.parametrize("case", NOTHING_SHARED)
def test_what_is_not_shared_by_mistake_is_not_named(case: str, flags: str, tmp_path: Path) -> None:
    assert told(build(tmp_path, *NOTHING_SHARED[case], flags=flags), tmp_path) == []


@pytest.mark.parametrize(
    "settings",
    [{"objects.robots.nb": 1}, {"robot_memory": "own"}],
    ids=["alone", "own memory"],
)
def test_robots_that_cannot_share_are_not_warned_of(settings: Settings, tmp_path: Path) -> None:
    assert told(build(tmp_path, "uint32_t total;", "total++;"), tmp_path, settings) == []


def test_walls_that_run_the_default_controller_do_not_count(tmp_path: Path) -> None:
    start = "pogobot_start(NULL, user_step);"
    text = PROGRAM.format(variables="uint32_t total;", step="total++;", setup="").replace(
        start, start + ' pogobot_start(default_walls_user_init, default_walls_user_step, "walls");'
    )
    program = compile_text(tmp_path, text, flags=["-g"])
    walls = {"type": "pogowall", "geometry": "arena"}
    assert told(program, tmp_path, {"objects.robots.nb": 1, "objects.walls": walls}) == []
    assert len(told(program, tmp_path, {"objects.walls": walls})) == 1


def test_program_of_the_sdk_shares_nothing_unless_the_configuration_says_so(tmp_path: Path) -> None:
    text = '#include "pogobot.h"\nint own;\nint main(void) { pogobot_init(); for (;;) { own++; msleep(100); } }\n'
    program = compile_text(tmp_path, text, flags=["-g"], package="pogosim-sdk")
    assert told(program, tmp_path) == []
    assert "'own' (main.c:2)" in told(program, tmp_path, {"robot_memory": "shared"})[0]


def test_stripped_program_is_not_nagged(tmp_path: Path) -> None:
    assert told(build(tmp_path, "uint32_t total;", "total++;", flags="-s"), tmp_path) == []


CPP = """#include <cstdlib>
#include "pogobase.h"
static float const root = float(std::rand());
struct Counter { int count = 0; Counter() { count = int(root); } };
{variable}
static void step() {{ {step} }}
int main() {{ pogobot_init(); pogobot_start(nullptr, step); return 0; }}
"""


def test_constants_that_cpp_calculates_are_not_shared_by_mistake(tmp_path: Path) -> None:
    text = CPP.replace("{variable}", "").replace("{step}", "(void)root;").replace("{{", "{").replace("}}", "}")
    for flags in (["-g"], ["-g0"]):
        result = run(compile_text(tmp_path, text, "main.cpp", flags=flags), tmp_path)
        assert warnings(result) == []


def test_objects_of_cpp_are_named(tmp_path: Path) -> None:
    text = CPP.replace("{variable}", "namespace mine { Counter counter; }").replace("{step}", "mine::counter.count++;")
    program = compile_text(tmp_path, text.replace("{{", "{").replace("}}", "}"), "main.cpp", flags=["-g"])
    (warning,) = told(program, tmp_path)
    assert warning.startswith("all robots share the variable 'mine::counter' (main.cpp:5), which ")


CONSTANTS = {
    "in a function": (
        'static std::string const& name() { static std::string const one = "robot"; return one; }',
        "(void)name().size();",
    ),
    "several": (
        "struct Table { int at[3]; }; static Table make() { return {{1, 2, int(std::rand())}}; }",
        'static auto const table = make(); static std::string const names[] = {"a", "b"}; '
        "(void)table.at[names[0].size()];",
    ),
    "member": ('struct Own { static inline std::string const name = "x"; };', "(void)Own::name.size();"),
    "number that is a member": ("struct Own { static inline int const n = std::rand(); };", "(void)Own::n;"),
    "of a template": (
        "template <class T> T const& nothing() { static T const none{}; return none; }",
        "(void)nothing<std::string>().size();",
    ),
}
CPP_COMPILERS = [name for names in (("g++",), ("clang++", "clang++-14")) if (name := compiler(*names))]


def build_cpp(folder: Path, variable: str, step: str, name: str, *flags: str) -> Path:
    text = "#include <string>\n" + CPP.replace("{{", "{").replace("}}", "}")
    text = text.replace("{variable}", variable).replace("{step}", step)
    return compile_text(folder, text, "main.cpp", compiler=name, flags=list(flags))


@pytest.mark.parametrize("flags", [["-g", "-O0"], ["-g", "-O2"], ["-g0"]], ids=" ".join)
@pytest.mark.parametrize("name", CPP_COMPILERS)
@pytest.mark.parametrize("case", CONSTANTS)
def test_constant_objects_are_not_shared_by_mistake(case: str, name: str, flags: list[str], tmp_path: Path) -> None:
    assert told(build_cpp(tmp_path, *CONSTANTS[case], name, *flags), tmp_path) == []


@pytest.mark.parametrize("name", CPP_COMPILERS)
def test_constant_number_that_the_first_robot_sets_is_told_as_that(name: str, tmp_path: Path) -> None:
    step = "static uint16_t const id = pogobot_helper_getid(); uint16_t volatile used = id; (void)used;"
    (warning,) = told(build_cpp(tmp_path, "", step, name, "-g"), tmp_path)
    assert "variable 'id' in step() (main.cpp:7, set once, by the first robot), which real robots cannot" in warning


def test_robots_that_share_such_a_constant_take_their_steps_one_after_the_other(tmp_path: Path) -> None:
    result = run(build_cpp(tmp_path, *CONSTANTS["in a function"], "g++", "-g"), tmp_path, {"threads": 2})
    assert (
        "all robots share the variable 'name()::one' (the first robot that gets there sets it: put it into "
        "USERDATA, or make it constexpr)"
    ) in result.output


def test_process_says_it_once_for_each_program(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    shared = "-shared -fPIC -g"
    programs = [build(tmp_path / name, f"uint32_t {name};", f"{name}++;", flags=shared) for name in ("first", "second")]
    scene = write_scene(tmp_path, {"arena_file": str(ROOT / "arenas" / "disk.csv")})
    for program in (*programs, *programs):
        with pogosim.Simulation(program, scene) as one:
            one.step(2)
            one.reset()
            one.step(2)
    text = caplog.text
    assert text.count("all robots share the variable 'first'") == 1
    assert text.count("all robots share the variable 'second'") == 1
