"""Configurations that were written for other programs, or for the original simulator, run as they are."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from conftest import Compile
from running import Run, Settings, compile_text, example, run, run_command, warnings

READS_PARAMETERS = """#include "pogobase.h"
uint8_t led_mode = 3; float ratio = 0.5f; bool flag = true; float list[2] = {1, 2}; char word[8] = "abc";
static void setup(void) {
    init_from_configuration(led_mode); init_from_configuration(ratio); init_from_configuration(flag);
    init_array_from_configuration(list); init_array_from_configuration(word);
}
static void user_init(void) { init_from_configuration(led_mode); }
static void end(void) {
    if (pogobot_helper_getid() == 0) {
        printf("%d %g %d %g %s\\n", led_mode, (double)ratio, flag, (double)list[1], word);
    }
}
int main(void) {
    pogobot_init();
    pogobot_start(user_init, NULL);
    SET_CALLBACK(callback_global_setup, setup);
    SET_CALLBACK(callback_robot_end, end);
    return 0;
}
"""


def printed(result: Run) -> str:
    (line,) = result.robot_lines
    return line.partition("[PRINTF] ")[2]


# ---- Parameters of other programs ----


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("led_mode", "sign", "an integer from 0 to 255, found 'sign'"),
        ("led_mode", [1], "an integer from 0 to 255, found a list"),
        ("led_mode", {"x": 1}, "an integer from 0 to 255, found a map"),
        ("ratio", "fast", "a number, found 'fast'"),
        ("flag", "maybe", "true or false, found 'maybe'"),
        ("list", 5, "a list of at least 2 numbers, found 5"),
        ("list", ["a", "b"], "a number, found 'a'"),
        ("word", [1], "a string, found a list"),
    ],
)
def test_parameter_of_another_type_is_a_warning_and_the_programs_default(
    name: str, value: object, expected: str, tmp_path: Path
) -> None:
    program = compile_text(tmp_path, READS_PARAMETERS)
    result = run(program, tmp_path, {f"parameters.{name}": value})
    (warning,) = warnings(result)
    place = rf"parameters\.{name}" + (r"\.0" if expected.endswith("'a'") else "")
    assert re.fullmatch(
        rf"scene\.yaml:\d+: {place}: expected {re.escape(expected)}; the program keeps its own value "
        r"\(--strict refuses this\)",
        warning,
    )
    assert printed(result) == "3 0.5 1 2 abc"
    for option in ("--strict", "--strict-config"):
        strict = run(program, tmp_path, {f"parameters.{name}": value}, [option])
        assert strict.code == 2
        assert f"expected {expected}" in strict.errors


def test_parameter_out_of_range_is_an_error_as_before(tmp_path: Path) -> None:
    program = compile_text(tmp_path, READS_PARAMETERS)
    for name, value in (("led_mode", 300), ("ratio", 1e300), ("list", [1])):
        result = run(program, tmp_path, {f"parameters.{name}": value})
        assert result.code == 2, name
        assert f"parameters.{name}: expected " in result.errors


def test_setting_of_another_type_is_meant_for_this_program(tmp_path: Path) -> None:
    program = compile_text(tmp_path, READS_PARAMETERS)
    result = run(program, tmp_path, {}, ["--set", "parameters.led_mode=sign"])
    assert result.code == 2
    assert "--set: parameters.led_mode: expected an integer from 0 to 255, found 'sign'" in result.errors


def test_flags_may_be_numbers(tmp_path: Path) -> None:
    program = compile_text(tmp_path, READS_PARAMETERS)
    result = run(program, tmp_path, {"parameters.flag": 0})
    assert (warnings(result), printed(result)) == ([], "3 0.5 0 2 abc")


@pytest.mark.parametrize(("value", "read"), [(True, 1), (False, 0), ("off", 0)])
def test_numbers_may_be_flags(value: object, read: int, tmp_path: Path) -> None:
    program = compile_text(tmp_path, READS_PARAMETERS)
    for options in ([], ["--strict"]):
        result = run(program, tmp_path, {"parameters.led_mode": value}, options)
        assert (warnings(result), printed(result)) == ([], f"{read} 0.5 1 2 abc")
    exact = run(program, tmp_path, {"parameters.led_mode": value}, ["--strict-config"])
    assert exact.code == 2
    assert "parameters.led_mode: expected an integer from 0 to 255" in exact.errors


# ---- Options of a batch in a single run ----


def test_single_run_says_that_options_are_for_a_batch(tmp_path: Path) -> None:
    (warning,) = warnings(run(example("helloworld"), tmp_path, {"objects.robots.nb": {"batch_options": [3, 4]}}))
    assert re.sub(r"yaml:\d+", "yaml", warning) == (
        "scene.yaml: objects.robots.nb: has batch_options but no default_option; run it with pogobatch (a single run "
        "takes the default, 1)"
    )


def test_program_that_asks_for_options_is_told_that_they_are_for_a_batch(tmp_path: Path) -> None:
    program = compile_text(tmp_path, READS_PARAMETERS)
    (warning,) = warnings(run(program, tmp_path, {"parameters.led_mode": {"batch_options": [1, 2]}}))
    assert re.fullmatch(
        r"scene\.yaml:\d+: parameters\.led_mode: has batch_options but no default_option; run it with pogobatch; the "
        r"program keeps its own",
        warning,
    )


def test_membrane_that_is_too_thick_for_want_of_a_default_says_so(tmp_path: Path) -> None:
    membrane = {"type": "membrane", "geometry": "disk", "radius": {"batch_options": [100, 120]}, "dot_radius": 12}
    result = run(example("helloworld"), tmp_path, {"objects.ring": membrane})
    assert result.code == 2
    (error,) = [line for line in result.errors.splitlines() if line.startswith("Error: ")]
    assert "the membrane is too thick" in error
    assert error.endswith("(objects.ring.radius has batch_options but no default_option; run it with pogobatch)")


def test_arena_of_options_is_for_a_batch(tmp_path: Path) -> None:
    result = run(example("helloworld"), tmp_path, {"arena_file": {"batch_options": ["arenas/disk.csv"]}})
    assert result.code == 2
    assert "arena_file: has batch_options but no default_option; run it with pogobatch" in result.errors


# ---- Periodic squares ----


@pytest.mark.parametrize(
    ("name", "settings", "text"),
    [
        ("nothing.csv", {"boundary_condition": "periodic"}, ""),
        ("blank.csv", {"boundary_condition": "periodic"}, "\n# nothing\n\n"),
        ("torus.csv", {}, ""),
        ("empty.csv", {}, "\n"),
        ("arenas/torus.csv", {}, ""),
        ("torus.csv", {}, None),
        ("empty.csv", {"boundary_condition": "periodic"}, None),
    ],
)
def test_empty_arena_is_a_periodic_square(name: str, settings: Settings, text: str | None, tmp_path: Path) -> None:
    if text is not None:
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    result = run(example("helloworld"), tmp_path, {"arena_file": name, "arena_surface": 4.0e6, **settings})
    assert warnings(result) == []
    metadata = {key.decode(): value.decode() for key, value in (result.table().schema.metadata or {}).items()}
    assert "boundary_condition: periodic" in metadata["resolved_configuration"]
    assert metadata["arena_polygons"].count("2000") == 4


def test_empty_arena_with_walls_is_an_error_that_says_what_to_write(tmp_path: Path) -> None:
    (tmp_path / "nothing.csv").write_text("")
    result = run(example("helloworld"), tmp_path, {"arena_file": "nothing.csv"})
    assert result.code == 2
    assert "the file has no polygon; expected the corners of an arena" in result.errors


def test_torus_with_corners_is_what_it_says(tmp_path: Path) -> None:
    (tmp_path / "torus.csv").write_text("0,0\n2,0\n2,1\n0,1\n")
    result = run(example("helloworld"), tmp_path, {"arena_file": "torus.csv"})
    assert b"boundary_condition: solid" in (result.table().schema.metadata or {})[b"resolved_configuration"]


# ---- Keys of the tools, and old ones ----


def test_settings_of_batch_tools_are_neither_read_nor_passed_on(tmp_path: Path) -> None:
    settings = {
        "pogobatch": {
            "result_filename_format": "r_{objects.robots.nb}.feather",
            "rundra": {"sync": {"exclude": ["x"]}},
        },
        "_rundr": {"version": 1, "seeds": "0:9"},
        "coroutine_stack_size": 131072,
    }
    result = run(example("helloworld"), tmp_path, settings, ["--strict"])
    assert (result.code, result.errors) == (0, "")
    configuration = (result.table().schema.metadata or {})[b"configuration"]
    assert b"pogobatch" not in configuration
    assert b"_rundr" not in configuration


def test_configuration_of_old_keys_without_a_robot_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "old.yaml").write_text("nBots: 12\ncommRadius: 80\narena_file: arenas/disk.csv\n")
    for arguments in ([], ["--check-config"]):
        result = run_command(example("helloworld"), tmp_path, ["-c", "old.yaml", "-g", *arguments])
        assert result.code == 2
        assert "Error: old.yaml:1: nBots: no robot would be created: the keys of versions before 0.10 " in result.errors
        assert "objects: {robots: {type: pogobot, nb: 12, " in result.errors


# ---- Warnings that say nothing ----


@pytest.mark.parametrize(
    "thing",
    [
        {"type": "pogowall", "geometry": "arena"},
        {"type": "pogobject", "geometry": "disk", "radius": 40},
        {"type": "active_object", "geometry": "disk", "radius": 40},
        {"type": "static_light", "geometry": "global"},
    ],
    ids=lambda thing: str(thing["type"]),
)
def test_things_without_wheels_need_no_program(thing: dict[str, object], program: Compile, tmp_path: Path) -> None:
    result = run(program("slips.c"), tmp_path, {"objects.things": thing})
    assert [text for text in warnings(result) if "pogobot_start" in text] == []


def test_slip_in_the_name_of_the_walls_is_still_a_warning(tmp_path: Path) -> None:
    program = compile_text(
        tmp_path,
        '#include "pogobase.h"\nint main(void) { pogobot_init(); pogobot_start(NULL, NULL); '
        'pogobot_start(NULL, NULL, "wals"); return 0; }\n',
        flags=[],
    )
    settings = {"objects.walls": {"type": "pogowall", "geometry": "arena"}}
    (warning,) = [text for text in warnings(run(program, tmp_path, settings)) if "pogobot_start" in text]
    assert "category 'walls'" in warning
    assert warning.endswith("did you mean 'wals'?")


def test_shared_counter_is_said_to_run_as_many_times_too_fast_as_there_are_robots(tmp_path: Path) -> None:
    program = compile_text(
        tmp_path,
        '#include "pogobase.h"\nuint32_t clock_of_all;\nstatic void user_step(void) { clock_of_all++; }\n'
        "int main(void) { pogobot_init(); pogobot_start(NULL, user_step); return 0; }\n",
        flags=["-g"],
    )
    (warning,) = warnings(run(program, tmp_path, {"objects.robots.nb": 18}))
    assert "'clock_of_all' (" in warning
    assert "a clock or counter there that each robot advances runs 18 times too fast" in warning
