"""What waiting robots must leave alone, and what they say: threads, saving, Python, arguments, large arrays, slips."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from pogosim import Simulation
from running import Run, compile_text, run, write_scene

# A robot waits for 20 ms and more, 37 ms more than the one before it.
EACH_ITS_OWN = """#include "pogobase.h"
typedef struct { int32_t waited_ms; uint32_t loops; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
static int own_ms(void) { return 20 + 37 * pogobot_helper_getid() % 300; }
static void step(void) {
    int const least_ms = own_ms();
    time_reference_t watch;
    pogobot_stopwatch_reset(&watch);
    WAIT
    mydata->waited_ms = (pogobot_stopwatch_get_elapsed_microseconds(&watch) + 500) / 1000;
}
static void schema(void) { data_add_column_int32("waited_ms"); data_add_column_int32("loops"); }
static void save(void) {
    data_set_value_int32("waited_ms", mydata->waited_ms);
    data_set_value_int32("loops", (int32_t)mydata->loops);
}
int main(void) {
    pogobot_init();
    pogobot_start(NULL, step);
    SET_CALLBACK(callback_create_data_schema, schema);
    SET_CALLBACK(callback_export_data, save);
    return 0;
}
"""
WAYS = {
    "milliseconds": "uint32_t const began_ms = current_time_milliseconds();"
    "while (current_time_milliseconds() - began_ms < (uint32_t)least_ms) { mydata->loops++; }",
    "stopwatch": "while (pogobot_stopwatch_get_elapsed_microseconds(&watch) < 1000 * least_ms) { mydata->loops++; }",
    "timer": "time_reference_t timer; pogobot_timer_init(&timer, 1000 * least_ms);"
    "while (!pogobot_timer_has_expired(&timer)) { mydata->loops++; }",
    "msleep": "msleep(least_ms);",
}


def sdk(folder: Path, text: str, name: str = "main.c") -> Path:
    return compile_text(folder, text, name, flags=["-g"], package="pogosim-sdk")


@pytest.mark.parametrize("way", WAYS)
def test_each_robot_waits_as_long_as_it_wants_whatever_the_threads(way: str, tmp_path: Path) -> None:
    program = compile_text(tmp_path, EACH_ITS_OWN.replace("WAIT", WAYS[way]))
    scene = {"objects.robots.nb": 200, "arena_surface": 4e6, "simulation_time": 1.0}
    data = set()
    for threads in (1, 2, 3):
        result = run(program, tmp_path / str(threads), {**scene, "threads": threads})
        assert result.code == 0, result.text
        data.add((result.folder / "data.feather").read_bytes())
        rows = result.frame().query("time > 0.99")
        wanted_ms = 20 + 37 * rows.robot_id.to_numpy() % 300
        assert (np.abs(rows.waited_ms - wanted_ms) <= 1).all()
    assert len(data) == 1


def test_how_often_rows_are_saved_changes_nothing(tmp_path: Path) -> None:
    text = EACH_ITS_OWN.replace(
        "static void save(void) {",
        "static void save(void) { for (int i = 0; i < 3000; i++) current_time_milliseconds();",
    )
    program = compile_text(tmp_path, text.replace("WAIT", WAYS["stopwatch"]))
    found = set()
    for period in (0.5, 0.1, 0.02):
        result = run(program, tmp_path / str(period), {"simulation_time": 1.0, "save_data_period": period})
        rows = result.frame()
        last = rows[rows.time == rows.time.max()]
        found.add(tuple(zip(last.loops, last.pogobot_ticks, last.x, strict=True)))
    assert len(found) == 1


LEFT_BEHIND = """#include "pogobot.h"
struct Witness { ~Witness() { printf("destroyed %d\\n", rand() >= 0); } } witness;
int main() { for (;;) { rand(); msleep(20); } }
"""


def test_static_objects_of_one_run_are_destroyed_as_no_robot_of_another(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    library = compile_text(tmp_path, LEFT_BEHIND, "main.cpp", flags=["-shared", "-fPIC"], package="pogosim-sdk")
    configuration = write_scene(tmp_path, {"data_filename": str(tmp_path / "data.feather")})
    with Simulation(library, configuration) as undisturbed:
        undisturbed.step(50)
        expected = undisturbed.state_hash
    one, other = Simulation(library, configuration), Simulation(library, configuration)
    one.step(20)
    other.step(25)
    one.close()
    other.step(25)
    assert other.state_hash == expected
    other.close()
    assert capfd.readouterr().out.count("destroyed 1\n") == 3


def test_arguments_of_main_are_each_robots_own(tmp_path: Path) -> None:
    program = sdk(
        tmp_path,
        '#include "pogobot.h"\nint main(int argc, char** argv) {\n'
        "    argv[0][0] = (char)('0' + pogobot_helper_getid());\n    msleep(50);\n"
        '    printf("%d %c %d\\n", argc, argv[0][0], argv[1] == NULL);\n    for (;;) { msleep(100); }\n}\n',
    )
    result = run(program, tmp_path / "run", {})
    assert re.findall(r"ROBOT #(\d)\] \[PRINTF\] (.*)", result.text) == [(str(i), f"1 {i} 1") for i in range(3)]


@pytest.mark.parametrize(
    "loop",
    [
        "for (;;) { msleep(0); }",
        "for (;;) { msleep(-5); }",
        "for (;;) { usleep(0); }",
        'for (;;) { printf("."); }',
        "time_reference_t past; pogobot_timer_init(&past, 0); for (;;) { pogobot_timer_wait_for_expiry(&past); }",
        "time_reference_t t; pogobot_stopwatch_reset(&t); "
        "while (pogobot_stopwatch_get_elapsed_microseconds(&t) < 50000) { msleep(0); } for (;;) { msleep(100); }",
    ],
)
def test_loops_of_calls_that_take_no_time_let_time_pass(loop: str, tmp_path: Path) -> None:
    program = sdk(tmp_path, f'#include "pogobot.h"\nint main(void) {{ pogobot_init(); {loop} }}\n')
    result = run(program, tmp_path / "run", {"simulation_time": 0.1, "objects.robots.nb": 1})
    assert result.code == 0, result.text
    assert len(result.frame()) > 0


def test_wait_for_a_timer_that_has_expired_does_not_turn_back_the_clock(tmp_path: Path) -> None:
    program = sdk(
        tmp_path,
        """#include "pogobot.h"
int main(void) {
    time_reference_t watch, timer;
    pogobot_init();
    pogobot_stopwatch_reset(&watch);
    pogobot_timer_init(&timer, 30000);
    msleep(100);
    pogobot_timer_wait_for_expiry(&timer);
    printf("%d\\n", (int)pogobot_stopwatch_get_elapsed_microseconds(&watch));
    for (;;) { msleep(100); }
}
""",
    )
    assert re.findall(r"PRINTF\] (\d+)", run(program, tmp_path / "run", {}).text) == ["100000"] * 3


@pytest.mark.parametrize("kib", [100, 500, 900])
def test_array_larger_than_the_stack_is_named_before_it_reaches_another_robots(kib: int, tmp_path: Path) -> None:
    program = sdk(
        tmp_path,
        f"""#include "pogobot.h"
__attribute__((noinline)) static void fill(void) {{
    volatile char large[{kib} * 1024];
    large[0] = large[sizeof(large) - 1] = 1;
}}
int main(void) {{
    pogobot_init();
    msleep(100);
    if (pogobot_helper_getid() == 1) {{
        fill();
    }}
    for (;;) {{ msleep(100); }}
}}
""",
    )
    result = run(program, tmp_path / "run", {"robot_stack_size": 64})
    assert result.code == 3
    assert "main of robot #1" in result.errors
    assert "stack overflow: the 64 KiB of the stack are full (robot_stack_size)" in result.errors


def drive(folder: Path, body: str, **settings: object) -> Run:
    program = sdk(folder, f'#include "pogobot.h"\nint main(void) {{ pogobot_init(); {body} }}\n')
    return run(program, folder / "run", {"save_data_period": 0.1, "simulation_time": 1.0, **settings})


def test_program_that_returns_at_once_leaves_its_motors_on(tmp_path: Path) -> None:
    result = drive(tmp_path, "pogobot_motor_set(motorL, motorFull); pogobot_motor_set(motorR, motorFull); return 0;")
    assert result.code == 0, result.text
    rows = result.frame()
    first, last = (rows[rows.time.sub(time).abs() < 0.01].set_index("robot_id") for time in (0.1, 1.0))
    assert np.hypot(last.x - first.x, last.y - first.y).min() > 30.0
    told = "main() of 3 robots has returned: such a robot keeps its motors and LEDs and does nothing more"
    assert told in result.text


def test_accelerometer_of_a_waiting_program_measures(tmp_path: Path) -> None:
    program = sdk(
        tmp_path,
        """#include "pogobot.h"
int main(void) {
    float acceleration[3], rotation[3], largest = 0.0f;
    pogobot_init();
    msleep(200);
    pogobot_motor_set(motorL, motorFull);
    pogobot_motor_set(motorR, motorFull);
    for (int i = 0; i < 30; i++) {
        msleep(20);
        pogobot_imu_read(acceleration, rotation);
        if (acceleration[1] > largest) { largest = acceleration[1]; }
    }
    printf("%d mm/s2\\n", (int)(1000.0f * largest));
    for (;;) { msleep(100); }
}
""",
    )
    found = re.findall(r"PRINTF\] (\d+) mm/s2", run(program, tmp_path / "run", {}).text)
    assert len(found) == 3
    assert min(int(value) for value in found) > 500


def test_clocks_of_waiting_programs_drift(tmp_path: Path) -> None:
    body = "for (int i = 0;; i++) { pogobot_led_setColor(i % 256, 0, 0); msleep(10); }"
    steady = drive(tmp_path, body, simulation_time=2.0, data_logger_led=True)
    settings = {"objects.robots.temporal_noise_stddev": 2.0}
    (tmp_path / "drifting").mkdir()
    drifting = drive(tmp_path / "drifting", body, simulation_time=2.0, data_logger_led=True, **settings)
    turns = [set(rows[rows.time == rows.time.max()].led_rgb) for rows in (steady.frame(), drifting.frame())]
    assert len(turns[0]) == 1
    assert len(turns[1]) > 1


def test_child_process_ends_where_it_would_wait(tmp_path: Path) -> None:
    program = sdk(
        tmp_path,
        """#include "pogobot.h"
#include <unistd.h>
int main(void) {
    pogobot_init();
    msleep(50);
    int const parent = pogobot_helper_getid() != 1 || fork() != 0;
    printf("before %d\\n", parent);
    msleep(50);
    printf("after %d\\n", parent);
    for (;;) { msleep(100); }
}
""",
    )
    result = run(program, tmp_path / "run", {})
    assert result.code == 0, result.text
    assert re.findall(r"after \d", result.text) == ["after 1"] * 3


# ---- what they say ----


def test_messages_that_are_never_decoded_are_warned_about(tmp_path: Path) -> None:
    result = drive(tmp_path, "for (;;) { if (pogobot_infrared_message_available()) { break; } msleep(20); } return 0;")
    assert result.errors.count("never calls pogobot_infrared_update(), without which a real robot receives none") == 1


def test_variables_that_do_not_fit_into_a_robot_are_warned_about(tmp_path: Path) -> None:
    text = (
        '#include "pogobot.h"\nchar large[200000];\nint main(void) { pogobot_init(); for (;;) msleep(large[9] + 9); }\n'
    )
    result = run(sdk(tmp_path, text), tmp_path / "run", {})
    assert result.code == 0
    assert re.search(
        r"the program's variables have 200\d{3} bytes, more than the 131072 bytes \(128 KiB\)", result.errors
    )


@pytest.mark.parametrize("name", ["callback_global_setup", "callback_create_data_schema"])
def test_callbacks_that_come_too_late_are_warned_about(name: str, tmp_path: Path) -> None:
    text = f"""#include "pogobot.h"
#include "pogosim/simulation.h"
static void nothing(void) {{ printf("called\\n"); }}
int main(void) {{ pogobot_init(); msleep(100); SET_CALLBACK({name}, nothing); for (;;) {{ msleep(100); }} }}
"""
    result = run(sdk(tmp_path, text), tmp_path / "run", {})
    assert result.code == 0
    assert result.errors.count(f"{name} is set after main() has waited for the first time: it is not called") == 1
    assert "called\n" not in result.output.replace("not called", "")


def test_variables_are_shared_without_a_header_of_the_simulator(tmp_path: Path) -> None:
    text = """#include "pogobot.h"
POGO_SHARED int of_all;
int own;
int main(void) { of_all++; own++; msleep(50); printf("%d %d\\n", of_all, own); for (;;) { msleep(100); } }
"""
    assert re.findall(r"PRINTF\] (.*)", run(sdk(tmp_path, text), tmp_path / "run", {}).text) == ["3 1"] * 3


def test_main_has_its_own_name_in_messages(tmp_path: Path) -> None:
    text = '#include "pogobot.h"\nint main(void) {\n    msleep(100);\n    *(volatile int*)8 = 1;\n}\n'
    result = run(sdk(tmp_path, text), tmp_path / "run", {})
    assert "main of robot #0 of category 'robots', t = 0.1000 s, at main.c:4 in main(): segmentation" in (
        result.errors.replace(str(tmp_path) + "/", "")
    )
