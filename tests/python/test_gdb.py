"""gdb shows the simulator's types in a line, and finds the robot that is running and the data of the others."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from debugger import PRINTERS, debug, needs_gdb
from running import LIBRARY, ROOT, build_folder, compile_program, compiler

pytestmark = needs_gdb

SCENE = """
arena_file: arenas/square.csv
arena_surface: 1.0e6
simulation_time: 10
data_filename: data.feather
initial_formation: random
objects:
    few: {type: pogobot, nb: 5}
    many: {type: pogobot, nb: 4}
"""
PROGRAM = r"""
#include "pogobase.h"

typedef struct {
    uint32_t steps;
    uint16_t id;
    uint8_t filler[70];
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

void user_init(void) { mydata->id = pogobot_helper_getid(); }

void user_step(void) {
    mydata->steps++;
    pogobot_led_setColor(255, 128, 0);
}

static void look_at_all(void) {}

int main(void) {
    pogobot_init();
    SET_CALLBACK(callback_global_step, look_at_all);
    pogobot_start(user_init, user_step, "few");
    pogobot_start(user_init, user_step, "many");
    return 0;
}
"""


@pytest.fixture(scope="module")
def types(tmp_path_factory: pytest.TempPathFactory) -> str:
    """What gdb prints of values with known members."""
    folder = tmp_path_factory.mktemp("types")
    source = folder / "gdb_types.cpp"
    source.write_text((ROOT / "tests" / "support" / "gdb_types.cpp").read_text())
    flags = ["-g", "-O0", "-I", str(ROOT / "src"), "-I", str(ROOT / "include")]
    program = compile_program(folder / "types", source, ROOT / "src" / "world" / "mailbox.cpp", flags=flags)
    names = ("world", "leds", "leds[0]", "world.bodies.position_mm", "world.robots", "world.bodies", "world.mailboxes")
    lines = [f"source {PRINTERS}", "break stop_here", "run", "up"]
    lines += [f"print {name}" for name in (*names, "controller", "&controller")]
    return debug([program], lines, folder)


def printed(text: str, number: int) -> str:
    """Return the value that gdb printed as $number."""
    found = re.search(rf"^\${number} = (.*)$", text, re.MULTILINE)
    assert found, text
    return found[1]


def test_world_is_its_time_and_counts(types: str) -> None:
    world = printed(types, 1)
    assert world.startswith("world at step 250, t = 2.5 s: 0 categories, 4 objects, ")
    assert ", 3 robots, " in world
    assert "{step = 250, time_step_s = 0.01, periodic = false, " in world
    assert "std::vector" not in world


def test_colours_are_those_of_the_web(types: str) -> None:
    assert printed(types, 2) == "#ff8000 #000000 #000000 #000000 #000019"
    assert printed(types, 3) == "#ff8000"


def test_vectors_are_pairs(types: str) -> None:
    assert printed(types, 4).endswith("= {(12.5, -3), (100, 0)}")


def test_structures_of_arrays_say_their_length_or_that_lengths_differ(types: str) -> None:
    assert printed(types, 5).startswith("3 robots = {id = std::vector of length 3, ")
    assert printed(types, 6).startswith("bodies in arrays of different length: [0, 2] = {")


def test_mailboxes_count_messages_near_and_far(types: str) -> None:
    assert printed(types, 7) == "3 mailboxes, 22 messages, 11 dropped = {[0] = 1, [1] = 20, [2] = 1}"


def test_controller_has_all_its_members(types: str) -> None:
    controller = printed(types, 8)
    assert controller.startswith("controller = {went_on_us = 0, calls = 156, ")
    header = (ROOT / "src" / "robot" / "controller.hpp").read_text()
    body = header[header.index("struct Controller {") :]
    body = body[: body.index("\n};")]
    names = re.findall(r"^    [\w:<>, *]+ [*]?(\w+)(?: = .*|\{.*\})?;", body, re.MULTILINE)
    assert len(names) > 10
    assert [name for name in names if f"{name} = " not in controller] == []
    assert printed(types, 9).startswith("(pogosim::Controller *) 0x")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where a program and its configuration are."""
    folder = tmp_path_factory.mktemp("run")
    (folder / "scene.yaml").write_text(SCENE)
    (folder / "main.c").write_text(PROGRAM)
    compile_program(folder / "program", folder / "main.c", flags=["-g", "-O0"])
    return folder


def debug_run(folder: Path, *lines: str, before: tuple[str, ...] = (f"source {PRINTERS}",)) -> str:
    return debug([folder / "program", "-c", "scene.yaml", "-g", "-q"], [*before, *lines], folder)


def test_breakpoint_stops_in_one_robot(folder: Path) -> None:
    output = debug_run(
        folder,
        "break user_step if $robot() == 7 && $ticks() == 4",
        *("run", "print $robot()", "print *mydata", "print pogobot_ticks"),
        *("print $data(2).steps", "print $data(2).id", "print $data(7).steps", "print $data(8).id"),
        *("delete", "tbreak user_step", "continue", "print $robot()", "print $data(7).steps"),
    )
    assert printed(output, 1) == "7"
    assert printed(output, 2).startswith("{steps = 4, id = 7, ")
    assert [printed(output, number) for number in range(3, 10)] == ["4", "5", "2", "4", "8", "8", "5"]


def test_world_and_controllers_are_found_in_every_build(folder: Path) -> None:
    output = debug_run(
        folder,
        "break user_step if $robot() == 0 && $ticks() == 3",
        *("run", "print $world()", "print $controller(4)", "print $world().robots.led"),
        *('print $device(4, "clock_us")', 'print $device(4, "motors")'),
    )
    assert re.match(
        r"world at step \d+, t = 0\.0\d+ s: 2 categories, 9 objects, 9 bodies, .* 9 robots", printed(output, 1)
    )
    assert re.match(r"controller = ", printed(output, 2))
    assert re.match(r"std::vector of length 9, capacity \d+ = \{#ff8000 #000000 ", printed(output, 3))
    assert printed(output, 4) == "48000"  # at 60 Hz, as msleep() gives it
    assert printed(output, 5).startswith("{power = ")


def test_gdb_reads_the_file_beside_the_library_if_it_may(folder: Path) -> None:
    library = (build_folder() / "src" / LIBRARY).resolve()
    assert Path(f"{library}-gdb.py").read_text() == PRINTERS.read_text()
    may = (f"add-auto-load-safe-path {build_folder()}",)
    output = debug_run(folder, "break user_step", "run", "print $robot()", before=may)
    assert printed(output, 1) == "0"


@pytest.mark.parametrize(
    ("where", "line", "message"),
    [
        ("break user_step", "print $data(9)", "There is no robot #9: ids are 0 to 8."),
        ("break user_step", "print $controller(-1)", "There is no robot #-1: ids are 0 to 8."),
        ("break look_at_all", "print $data(0)", "A callback of the whole run"),
        ("show version", "print $robot()", "There is no running simulation here"),
    ],
)
def test_mistakes_get_one_sentence(where: str, line: str, message: str, folder: Path) -> None:
    start = () if where.startswith("show") else ("run",)
    output = debug_run(folder, where, *start, line)
    assert message in output
    assert "Traceback" not in output


COMPILERS = [
    (name, ending)
    for names, ending in (
        (("gcc",), "c"),
        (("g++",), "cpp"),
        (("clang", "clang-14"), "c"),
        (("clang++", "clang++-14"), "cpp"),
    )
    if (name := compiler(*names))
]


@pytest.mark.parametrize("level", ["-O0", "-O2"])
@pytest.mark.parametrize(("name", "ending"), COMPILERS)
def test_user_data_of_every_compiler_have_their_type(name: str, ending: str, level: str, tmp_path: Path) -> None:
    (tmp_path / "scene.yaml").write_text(SCENE)
    source = tmp_path / f"main.{ending}"
    source.write_text(PROGRAM)
    compile_program(tmp_path / "program", source, compiler=name, flags=["-g", level])
    output = debug_run(
        tmp_path,
        "break user_step if mydata->id == 3 && mydata->steps == 4",
        *("run", "print *mydata", "print mydata->steps", "whatis mydata", "print $data(2).id", "print *$mydata()"),
        *("delete", "watch -location mydata->steps", "continue", "print $robot()"),
    )
    assert printed(output, 1).startswith("{steps = 4, id = 3, ")
    assert [printed(output, 2), printed(output, 3)] == ["4", "2"]
    assert "type = USERDATA *\n" in output
    assert printed(output, 4) == printed(output, 1)
    assert "Old value = 4\nNew value = 5\n" in output
    assert printed(output, 5) == "3"


@pytest.mark.parametrize(
    ("ending", "declared", "kind"),
    [
        ("c", "struct state {|};", "struct state"),
        ("cpp", "struct state {|};", "state"),
        ("cpp", "namespace swarm { struct state {|};}", "swarm::state"),
        ("cpp", "class Outer { public: struct state {|};};", "Outer::state"),
        ("cpp", "template <int Size> struct state {|};", "state<3>"),
    ],
)
def test_user_data_without_a_typedef_have_their_type(ending: str, declared: str, kind: str, tmp_path: Path) -> None:
    found = compiler(*(("clang", "clang-14") if ending == "c" else ("clang++", "clang++-14")))
    if found is None:
        pytest.skip("clang is not installed")
    (tmp_path / "scene.yaml").write_text(SCENE)
    source = tmp_path / f"main.{ending}"
    begin, end = declared.split("|")
    text = PROGRAM.replace("typedef struct {", begin).replace("} USERDATA;", end).replace("(USERDATA)", f"({kind})")
    source.write_text(text)
    compile_program(tmp_path / "program", source, compiler=found, flags=["-g", "-O0"])
    output = debug_run(
        tmp_path,
        "break user_step if mydata->id == 3 && mydata->steps == 4",
        *("run", "print *mydata", "print $data(2).id"),
    )
    assert printed(output, 1).startswith("{steps = 4, id = 3, ")
    assert printed(output, 2) == "2"


WITHOUT_USERDATA = re.sub(r"typedef struct.*?REGISTER_USERDATA.USERDATA.;|mydata.*?;", "", PROGRAM, flags=re.DOTALL)


@pytest.mark.parametrize("name", [name for name, ending in COMPILERS if ending == "c"])
@pytest.mark.parametrize(
    ("text", "flags", "message"),
    [
        (WITHOUT_USERDATA, ["-g"], "The program has no USERDATA."),
        (PROGRAM, [], "The program has no user data with debug information: compile it with -g."),
    ],
)
def test_missing_user_data_are_said_to_be_missing(
    text: str, flags: list[str], message: str, name: str, tmp_path: Path
) -> None:
    (tmp_path / "scene.yaml").write_text(SCENE)
    (tmp_path / "main.c").write_text(text)
    compile_program(tmp_path / "program", tmp_path / "main.c", compiler=name, flags=flags)
    output = debug_run(tmp_path, "break user_step", "run", "print $data(2)")
    assert message in output
    assert "Traceback" not in output
