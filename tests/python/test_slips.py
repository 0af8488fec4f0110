"""A beginner's slip is not silent: one warning says what was meant, and the run goes on."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest
from conftest import Compile
from running import Run, Settings, compile_program, compile_text, run, warnings

FIRST = "robot #0 of category 'robots', tick 10, t = 0.1600 s: "
START = "robot #0 of category 'robots', tick 0, t = 0.0000 s: "
CROWD: Settings = {
    "objects.robots.nb": 60,
    "objects.robots.msg_success_rate": {"type": "static", "rate": 1.0},
}


def slip(
    program: Compile,
    folder: Path,
    kind: str,
    settings: Settings | None = None,
    *arguments: str,
) -> Run:
    return run(
        program("slips.c"),
        folder,
        {"parameters.kind": kind, **(settings or {})},
        arguments,
    )


# ---- In the program ----


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        (
            "negative_power",
            f"{FIRST}pogobot_motor_set(): value is -500, expected 0 to 1023 (motorFull); powers are unsigned, so this "
            "one drives the motor at full power; ",
        ),
        (
            "motor_3",
            f"{FIRST}pogobot_motor_set(): motor is 3, expected motorR (0), motorL (1) or motorB (2); nothing is set",
        ),
        ("direction_2", f"{FIRST}pogobot_motor_dir_set(): value is 2, expected 0 or 1; 1 is used"),
        ("direction_of_motor_3", f"{FIRST}pogobot_motor_dir_set(): motor is 3, expected "),
        (
            "stored_direction",
            f"{FIRST}pogobot_motor_dir_mem_set(): p_directions is 7, expected 0 or 1 for each motor; ",
        ),
        ("stored_power", f"{FIRST}pogobot_motor_power_mem_set(): p_powers is 2000, expected 0 to 1023 "),
        ("nowhere_to_read_to", f"{FIRST}pogobot_motor_power_mem_get(): p_powers is NULL, expected "),
        ("led_5", f"{FIRST}pogobot_led_setColors(): id is 5, expected 0 (head) to 4 (left); nothing is set"),
        ("sensor_3", f"{FIRST}pogobot_photosensors_read(): sensor_number is 3, expected p_B (0, back), "),
        ("write_of_page_5888", f"{FIRST}write_page_flash(): page is 5888, expected 0 to 5887 "),
        ("read_of_page_65535", f"{FIRST}read_page_flash(): page is 65535, expected 0 to 5887 "),
        (
            "direction_5",
            f"{FIRST}pogobot_infrared_sendShortMessage_uni(): dir is 5, expected ir_front (0) to ir_left (3), or "
            "ir_all (4); the message goes in all directions",
        ),
        ("direction_-1", f"{FIRST}pogobot_infrared_sendLongMessage_uniSpe(): dir is -1, expected "),
        (
            "long_message",
            f"{START}pogobot_infrared_sendShortMessage_omni(): the length of the message is 383, expected 0 to 382 "
            "bytes (MAX_PAYLOAD_SIZE_BYTES); nothing is sent, and the function returns 1",
        ),
        (
            "long_long_message",
            f"{FIRST}pogobot_infrared_sendLongMessage_omniSpe(): the length of the message is 1000, ",
        ),
        ("raw_long_message", f"{FIRST}pogobot_infrared_sendRawLongMessage(): the length of the message is 383, "),
        (
            "raw_message_without_power",
            f"{FIRST}pogobot_infrared_sendRawLongMessage(): _emitting_power_list is 0, expected ",
        ),
        ("raw_short_message", f"{FIRST}pogobot_infrared_sendRawShortMessage(): the length of the message is 383, "),
        ("no_message", f"{FIRST}pogobot_infrared_sendShortMessage_omni(): message is NULL, expected "),
        ("power_4", f"{FIRST}pogobot_infrared_set_power(): power is 4, expected 0 to 3; 3 is used"),
        ("receiver_4", f"{FIRST}pogobot_infrared_get_receiver_error_counter(): ir_index is 4, expected 0 (front) to "),
        ("sleep_-1", f"{FIRST}msleep(): milliseconds is -1, expected at least 0; it takes no time"),
        ("old_stopwatch", f"{FIRST}pogobot_stopwatch_get_elapsed_microseconds(): the time to return is 3000000000, "),
        ("hue", f"{FIRST}hsv_to_rgb(): h_deg is 400, expected 0 to 360; it counts as red"),
        ("hidden_row", f"{FIRST}disable_data_export() has no effect outside of callback_export_data"),
        ("large_half", f"{START}data_set_value_float16(): value is 1000000, expected -65504 to 65504; infinity is "),
        ("error_led_7", f"{START}error_codes_led_idx is 7, expected 0 (head) to 4 (left), or a negative number "),
        (
            "dark",
            f"{FIRST}pogobot_photosensors_read(): there is no lamp in this world, so it is dark everywhere; add an ",
        ),
        (
            "faster",
            "robot #0 of category 'robots', tick 11, t = 0.1700 s: main_loop_hz is 200, but a robot ticks at most once "
            "in each time_step of 0.01 s: ticks are skipped; ",
        ),
        ("no_init", "the program never calls pogobot_init(), "),
        (
            "late_init",
            "robot #0 of category 'robots': pogobot_init() is called after pogobot_start(), ",
        ),
        (
            "two_starts",
            "robot #0 of category 'robots': pogobot_start() is called again for the category ",
        ),
        (
            "setup_of_userdata",
            "callback_global_setup changed USERDATA (mydata) of robot #2 only: initialise it in user_init",
        ),
        ("empty_column", "the column 'age' of the data file will be empty: "),
        ("sends_never", "no robot of category 'robots' sent a message: "),
        (
            "sends_too_often",
            f"{START}percent_msgs_sent_per_ticks is 150, expected 0 to 100; it counts as 100",
        ),
        (
            "wrong_category",
            "the program has no pogobot_start() for category 'robots' (only for robot, predators); its robots will do "
            "nothing; did you mean 'robot'?",
        ),
        (
            "no_start",
            "the program has no pogobot_start() for category 'robots'; its robots will do nothing",
        ),
        ("reads_none", "no robot of category 'robots' read a message: "),
    ],
)
def test_slip_in_a_program_is_warned_of_once(program: Compile, tmp_path: Path, kind: str, text: str) -> None:
    (warning,) = warnings(slip(program, tmp_path, kind))
    assert warning.startswith(text)


def test_each_function_says_each_kind_of_mistake_once(program: Compile, tmp_path: Path) -> None:
    """The second motor of a function is no news; the same mistake with another function is."""
    found = warnings(slip(program, tmp_path, "motor_power"))
    cut = "value is {}, expected 0 to 1023 (motorFull); 1023 is used"
    assert found == [
        f"{FIRST}pogobot_motor_set(): {cut.format(5000)}",
        f"{FIRST}pogobot_motor_power_set(): {cut.format(1024)}",
    ]


def test_photosensors_under_a_lamp_are_not_warned_of(program: Compile, tmp_path: Path) -> None:
    lamp = {"type": "static_light", "geometry": "global", "value": 100}
    assert warnings(slip(program, tmp_path, "dark", {"objects.lamp": lamp})) == []


def test_rate_that_fits_into_the_time_step_may_be_set_at_any_time(program: Compile, tmp_path: Path) -> None:
    assert warnings(slip(program, tmp_path, "faster", {"time_step": 0.005})) == []


def test_robots_on_several_threads_say_what_they_say_on_one(program: Compile, tmp_path: Path) -> None:
    settings = {"objects.robots.nb": 300, "simulation_time": 0.5, "arena_surface": 4.0e6}
    texts = [
        warnings(slip(program, tmp_path / str(threads), "motor_power", {**settings, "threads": threads}))
        for threads in (1, 2)
    ]
    assert texts[0] == texts[1]


@pytest.mark.parametrize("kind", ["nothing", "polls", "sends_itself", "late_reading"])
def test_program_without_a_slip_is_not_nagged(program: Compile, tmp_path: Path, kind: str) -> None:
    assert (
        warnings(
            slip(
                program,
                tmp_path,
                kind,
                {"parameters.late": 1.0} if kind == "late_reading" else {},
            )
        )
        == []
    )


def test_messages_that_are_not_read_are_counted(program: Compile, tmp_path: Path) -> None:
    (warning,) = warnings(slip(program, tmp_path, "deaf", CROWD))
    count, _, rest = warning.partition(" ")
    assert int(count) > 1000
    assert rest.startswith("messages arrived, but no robot reads them: set msg_rx_fn ")


def test_one_message_is_not_several(tmp_path: Path) -> None:
    sending = "static void send(void) { uint8_t m = 1; pogobot_infrared_sendShortMessage_omni(&m, 1); }\n"
    step = "static void step(void) { if (pogobot_ticks == 3 && pogobot_helper_getid() == 0) send(); }\n"
    main = "int main(void) { pogobot_init(); pogobot_start(NULL, step); return 0; }\n"
    program = compile_text(tmp_path, f'#include "pogobase.h"\n{sending}{step}{main}')
    poses = {"objects.robots.nb": None, "objects.robots.poses": [[300, 300, 0], [360, 300, 0]]}
    sure = {"objects.robots.msg_success_rate": {"type": "static", "rate": 1.0}}
    (warning,) = warnings(run(program, tmp_path, {**poses, **sure}))
    assert warning.startswith("1 message arrived, but no robot reads it: set msg_rx_fn in user_init, or look for ")


def test_messages_that_a_limit_of_0_keeps_from_being_read_are_warned_of_once(program: Compile, tmp_path: Path) -> None:
    (warning,) = warnings(slip(program, tmp_path, "reads_none", CROWD))
    assert warning.startswith("no robot of category 'robots' read a message: ")


def test_full_queues_are_counted_by_category_of_the_receivers(program: Compile, tmp_path: Path) -> None:
    second = {"type": "pogobot", "nb": 2, "geometry": "disk", "radius": 26.5}
    settings = {**CROWD, "arena_surface": 3.0e5, "objects.strangers": second}
    idle, lost = warnings(slip(program, tmp_path, "slow", settings))
    assert "the program has no pogobot_start() for category 'strangers' (only for " in idle
    assert "); its robots will do nothing" in idle
    count, _, rest = lost.partition(" ")
    assert int(count) > 0
    assert rest == (
        "messages to robots of category 'robots' were lost because their queues were full (message_queue_size: 20)"
    )


def test_user_data_beyond_a_real_robots_memory_are_warned_of(tmp_path: Path) -> None:
    source = tmp_path / "main.c"
    source.write_text(
        '#include "pogobase.h"\ntypedef struct { uint8_t bytes[131073]; } USERDATA;\nDECLARE_USERDATA(USERDATA)\n'
        "REGISTER_USERDATA(USERDATA)\nint main(void) { pogobot_init(); pogobot_start(NULL, NULL); return 0; }\n"
    )
    (warning,) = warnings(run(compile_program(tmp_path / "main", source), tmp_path))
    assert warning.startswith(
        "USERDATA has 131073 bytes, more than the 131072 bytes (128 KiB) of a real robot's memory"
    )


STACK = """#include "pogobase.h"
static int sum(volatile uint8_t* numbers, int count) {
    int total = 0;
    for (int i = 0; i < count; i++) {
        numbers[i] = 1;
        total += numbers[i];
    }
    return total;
}
static void user_step(void) {
    volatile uint8_t numbers[BYTES];
    pogobot_led_setColor((uint8_t)sum(numbers, BYTES), 0, 0);
}
int main(void) { pogobot_init(); pogobot_start(NULL, user_step); return 0; }
"""


@pytest.mark.parametrize(("size", "is_told"), [(100_000, False), (140_000, True)])
def test_stack_beyond_a_real_robots_memory_is_warned_of(tmp_path: Path, size: int, is_told: bool) -> None:
    text = STACK.replace("BYTES", str(size))
    found = warnings(run(compile_text(tmp_path, text, flags=["-O0"]), tmp_path))
    assert len(found) == is_told
    for warning in found:
        grown = re.match(
            r"the stack of a robot has grown to (\d+) bytes, and its variables have 0: together more", warning
        )
        assert grown
        assert size < int(grown[1]) < size + 20_000


HEAP = """#include "pogobase.h"
#include <stdlib.h>
typedef struct { uint8_t* numbers; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
static void user_init(void) { mydata->numbers = (uint8_t*)malloc(BYTES); }
static void user_step(void) { mydata->numbers[0] = 1; }
int main(void) { pogobot_init(); pogobot_start(user_init, user_step); return 0; }
"""


@pytest.mark.skipif(sys.platform != "linux", reason="asks the GNU C library")
@pytest.mark.parametrize(("size", "is_told"), [(1000, False), (120_000, False), (140_000, True)])
@pytest.mark.parametrize("robots", [1, 20])
def test_allocations_beyond_a_real_robots_memory_are_warned_of(
    tmp_path: Path, size: int, is_told: bool, robots: int
) -> None:
    text = HEAP.replace("BYTES", str(size))
    found = warnings(run(compile_text(tmp_path, text), tmp_path, {"objects.robots.nb": robots}))
    assert len(found) == is_told
    for warning in found:
        allocated = re.match(
            r"each robot has allocated (\d+) bytes in main\(\) and user_init, on average: more", warning
        )
        assert allocated
        assert size < int(allocated[1]) < size + 10_000


def test_user_data_of_the_only_robot_may_be_set_for_the_whole_run(program: Compile, tmp_path: Path) -> None:
    assert warnings(slip(program, tmp_path, "setup_of_userdata", {"objects.robots.nb": 1})) == []


def test_setup_that_leaves_constructed_user_data_alone_is_not_warned_of(tmp_path: Path) -> None:
    source = tmp_path / "main.cpp"
    source.write_text(
        '#include <string>\n#include "pogobase.h"\n'
        'struct data { char padded = 1; double number = 2.0; std::string text = "long enough to be on the heap"; };\n'
        "DECLARE_USERDATA(data);\nREGISTER_USERDATA(data);\nPOGO_SHARED uint32_t length = 0;\n"
        "static void setup() { length = mydata->text.size(); }\nstatic void nothing() {}\n"
        "int main() { pogobot_init(); pogobot_start(nothing, nothing); "
        "SET_CALLBACK(callback_global_setup, setup); return 0; }\n"
    )
    assert warnings(run(compile_program(tmp_path / "main", source), tmp_path)) == []


def unset_columns(result: Run) -> list[str]:
    return [line.partition("[info] ")[2] for line in result.output.splitlines() if "[info] the column" in line]


def test_columns_that_the_callback_never_sets_are_named_at_the_end(program: Compile, tmp_path: Path) -> None:
    result = slip(program, tmp_path, "unset_columns")
    assert warnings(result) == [], "a short run of a right program may have columns without a value"
    assert unset_columns(result) == [
        "the columns 'age', 'name' of the data file are empty: callback_export_data never set them (data_set_value_*)"
    ]
    assert result.frame()["age"].isna().all()
    assert (result.frame()["size"] == 3).all()


@pytest.mark.parametrize(
    ("settings", "named"),
    [
        ({"data_logger_fields": ["time", "age"]}, "the column 'age' of the data file is empty: "),
        ({"data_logger_fields": ["time", "size"]}, None),
        ({"enable_data_logging": False}, None),
        ({"objects": {"wall": {"type": "passive_object", "geometry": "disk", "radius": 20}}}, None),
    ],
    ids=["one", "not in the file", "no file", "no robots"],
)
def test_columns_that_no_row_could_have_are_not_named(
    program: Compile, tmp_path: Path, settings: Settings, named: str | None
) -> None:
    told = unset_columns(slip(program, tmp_path, "unset_columns", settings))
    assert len(told) == (named is not None)
    assert named is None or told[0].startswith(named)


# ---- Parameters ----


def unread(folder: Path, *, all_of_them: bool = False) -> str:
    lines = (folder / "scene.yaml").read_text().splitlines()
    places = {line.split(":")[0].strip(): number + 1 for number, line in enumerate(lines)}
    others = f", walk.speed (scene.yaml:{places['speed']}), list (scene.yaml:{places['list']})"
    return (
        "parameters never read by the program: "
        f"turn_duratoin (scene.yaml:{places['turn_duratoin']}; did you mean 'turn_duration'?)"
        f"{others if all_of_them else ' and 2 more (-v lists them)'}"
    )


UNREAD: Settings = {
    "parameters.turn_duratoin": 400,
    "parameters.walk": {"speed": 1},
    "parameters.list": [1],
}


def test_unused_parameter_that_looks_like_a_slip_is_named_and_the_others_are_counted(
    program: Compile, tmp_path: Path
) -> None:
    result = slip(program, tmp_path, "nothing", UNREAD)
    assert warnings(result) == [unread(tmp_path)]


def test_unused_parameters_without_a_near_name_are_counted(program: Compile, tmp_path: Path) -> None:
    settings = {"parameters.of_others": 1, "parameters.of_another": 2}
    assert warnings(slip(program, tmp_path, "nothing", settings)) == [
        "parameters never read by the program: 2 (-v lists them)"
    ]


def test_unused_parameters_of_the_command_line_are_named_with_what_the_program_reads(
    program: Compile, tmp_path: Path
) -> None:
    settings = {"parameters.turn_duration": 400, "parameters.of_others": 1}
    slips = ["--set", "parameters.turn_durtion=5", "--set", "parameters.duration=5", "--set", "parameters.colour=red"]
    result = slip(program, tmp_path, "nothing", settings, *slips)
    assert result.code == 0
    assert warnings(result) == [
        "parameters never read by the program: turn_durtion (--set; did you mean 'turn_duration'?), "
        "duration (--set; did you mean 'turn_duration'?), colour (--set) and 1 more (-v lists them)"
    ]
    strict = slip(program, tmp_path, "nothing", settings, *slips, "--strict")
    assert (strict.code, "turn_durtion (--set; did you mean 'turn_duration'?)" in strict.errors) == (2, True)


def test_all_unused_parameters_are_listed_with_verbose(program: Compile, tmp_path: Path) -> None:
    result = slip(program, tmp_path, "nothing", UNREAD, "-v")
    assert f"[debug] {unread(tmp_path, all_of_them=True)}\n" in result.text


def test_unused_parameters_are_an_error_with_strict_after_the_whole_run(program: Compile, tmp_path: Path) -> None:
    settings = UNREAD
    result = slip(program, tmp_path, "nothing", settings, "--strict")
    assert result.code == 2
    everything = unread(tmp_path, all_of_them=True)
    assert result.errors == f"Error: {everything} (--strict; the run itself is complete)\n"
    assert result.frame()["time"].max() == pytest.approx(2.0)
    plain = slip(program, tmp_path / "plain", "nothing", settings)
    assert (plain.folder / "data.feather").read_bytes() == (tmp_path / "data.feather").read_bytes()


@pytest.mark.parametrize(
    "parameters",
    [{"late": 1.0}, {"vector": [1, 2]}, {"turn_duration": None}],
    ids=["late", "list", "null"],
)
def test_parameter_that_is_read_at_any_time_is_not_listed(
    program: Compile, tmp_path: Path, parameters: dict[str, object]
) -> None:
    settings = {"parameters": {"kind": "late_reading", **parameters}}
    assert warnings(run(program("slips.c"), tmp_path, settings, ["--strict"])) == []


@pytest.mark.parametrize(
    ("parameter", "value", "rest"),
    [
        ("vector", [1, 2, 3], "the program has room for 2 numbers, found 3; the rest is ignored"),
        ("kind", "n" * 40, "the program has room for 31 characters, found 40; the rest is ignored"),
    ],
)
def test_parameter_that_does_not_fit_into_its_variable_is_warned_of_once(
    program: Compile, tmp_path: Path, parameter: str, value: object, rest: str
) -> None:
    (warning,) = warnings(run(program("slips.c"), tmp_path, {f"parameters.{parameter}": value}))
    assert re.fullmatch(rf"scene.yaml:\d+: parameters.{parameter}: {rest}", warning)


def test_part_of_a_map_that_is_not_read_is_listed(tmp_path: Path) -> None:
    source = tmp_path / "main.c"
    source.write_text(
        '#include "pogobase.h"\nstruct { float speed; } walk;\nint32_t first = 0;\n'
        "static void setup(void) { init_from_configuration(walk.speed); "
        'init_int32_from_configuration(&first, "ids.0", 0); }\n'
        "int main(void) { pogobot_init(); pogobot_start(NULL, NULL); "
        "SET_CALLBACK(callback_global_setup, setup); return 0; }\n"
    )
    program = compile_program(tmp_path / "main", source)
    settings = {"parameters": {"walk": {"speed": 1.0, "sped": 2.0}, "ids": [4, 5]}}
    (warning,) = warnings(run(program, tmp_path, settings))
    assert "never read by the program: walk.sped (scene.yaml:" in warning
    assert "ids" not in warning


def test_fraction_of_an_integer_parameter_is_warned_of_once(program: Compile, tmp_path: Path) -> None:
    (warning,) = warnings(slip(program, tmp_path, "nothing", {"parameters.turn_duration": 400.7}))
    assert warning.startswith("scene.yaml:")
    assert warning.endswith(": parameters.turn_duration: expected an integer, found 400.7; 400 is used")


# ---- Values that a function or a variable cannot say ----

SAME = """#include "pogobase.h"
typedef struct {{ uint8_t count; }} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)
{functions}
static void user_init(void) {{ {init} }}
static void user_step(void) {{}}
int main(void) {{
    pogobot_init();
    pogobot_start(user_init, user_step);
    {setup}
    return 0;
}}
"""


def program_with(folder: Path, init: str = "", functions: str = "", setup: str = "") -> Path:
    return compile_text(folder, SAME.format(init=init, functions=functions, setup=setup))


@pytest.mark.parametrize(
    ("init", "robots", "warning"),
    [
        ("srand(42);", 3, "3 robots have called srand(42): with the same seed, they draw the same random numbers."),
        ("srand(42);", 1, ""),
        ("srand((unsigned)pogobot_helper_getRandSeed());", 3, ""),
        ("srand(pogobot_helper_getid());", 3, ""),
        ("if (pogobot_helper_getid() == 1) { srand(42); }", 3, ""),
    ],
)
def test_robots_of_the_same_seed_are_told(tmp_path: Path, init: str, robots: int, warning: str) -> None:
    result = run(program_with(tmp_path, init), tmp_path, {"objects.robots.nb": robots, "simulation_time": 0.1})
    assert [line[: len(warning)] for line in warnings(result)] == ([warning] if warning else [])


@pytest.mark.parametrize(
    ("send", "warning"),
    [
        (
            "return pogobot_infrared_sendShortMessage_omni(data, 1);",
            r"msg_tx_fn has sent messages in \d+ calls and ret",
        ),
        ("return true;", ""),
        ("return pogobot_infrared_sendShortMessage_omni(data, 1) == 0;", ""),
        ("(void)data; return false;", ""),
    ],
)
def test_results_of_msg_tx_fn_that_are_always_wrong_are_told(tmp_path: Path, send: str, warning: str) -> None:
    functions = f"static bool send(void) {{ static uint8_t POGO_SHARED data[1] = {{1}}; (void)data; {send} }}"
    program = program_with(tmp_path, "msg_tx_fn = send;", functions.replace("POGO_SHARED ", ""))
    said = warnings(run(program, tmp_path, {"simulation_time": 2}))
    found = [line for line in said if line.startswith("msg_tx_fn has")]
    assert len(found) == (1 if warning else 0)
    assert not warning or re.match(warning, found[0])


EXPORT = """
static void add(void) {{ data_add_column_int{bits}("n"); }}
static void export_values(void) {{ data_set_value_int{bits}("n", {value}); }}
"""


@pytest.mark.parametrize(
    ("bits", "value", "recorded", "warns"),
    [
        (8, "(uint8_t)156", -100, True),
        (8, "127", 127, False),
        (8, "-128", -128, False),
        (8, "-129", 127, True),
        (16, "(uint16_t)40000", -25536, True),
        (16, "32767", 32767, False),
        (32, "INT64_C(4000000000)", -294967296, True),
        (32, "(uint64_t)4294967288u", -8, True),
        (32, "*(uint32_t const*)mydata - 8u", -8, False),
        (32, "UINT32_MAX", -1, False),
        (16, "*(uint32_t const*)mydata - 8u", -8, True),
        (32, "INT32_MIN", -(2**31), False),
    ],
)
def test_integers_beyond_the_type_of_their_column_are_told(
    tmp_path: Path, bits: int, value: str, recorded: int, *, warns: bool
) -> None:
    program = program_with(
        tmp_path,
        functions=EXPORT.format(bits=bits, value=value),
        setup="SET_CALLBACK(callback_create_data_schema, add); SET_CALLBACK(callback_export_data, export_values);",
    )
    result = run(program, tmp_path, {"simulation_time": 0.1})
    said = warnings(result)
    assert len(said) == (1 if warns else 0), said
    assert not warns or f"data_set_value_int{bits}(): value is " in said[0]
    assert set(result.frame()["n"]) == {recorded}
