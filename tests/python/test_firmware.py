"""Robots run firmware: machine code of the robots' compiler, executed instruction by instruction."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from firmwares import OF_ROBOTS, firmware_of, project_of, run_firmware, text, without_program
from pogosim import Simulation, SimulationError
from pogosim.simulation import ConfigurationError
from project import made, write
from robot_sdk import TRIPLE, call, make_sdk, need
from running import Run, by_robot, compile_text, ran, run, warnings, write_scene

CLOCK_HZ = 21_000_000
TICK_S = 0.016


LED = {"data_logger_led": True}


@pytest.fixture(scope="module")
def swarm(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the firmware of robots that move at random, and tell each other how many ticks they have lived."""
    step = """
    if (pogobot_ticks % 40 == 0) {
        bool left = rand() % 2 == 0;
        pogobot_motor_set(motorL, left ? motorHalf : motorFull);
        pogobot_motor_set(motorR, left ? motorFull : motorHalf);
    }
    pogobot_led_setColor((uint8_t)(nb_msgs_recv % 25), 0, 10);
    if (pogobot_ticks == 30) {
        printf("%lu ticks, %.3f, %s\\n", (unsigned long)pogobot_ticks, sqrt(2.0), "and more");
    }"""
    globals_ = """
    static bool send(void) {
        pogobot_infrared_sendLongMessage_omniGen((uint8_t*)&mydata->count, sizeof(mydata->count));
        return true;
    }
    static void receive(message_t* message) { memcpy(&mydata->level, message->payload, sizeof(mydata->level)); }"""
    init = "srand((unsigned)pogobot_helper_getRandSeed()); msg_tx_fn = send; msg_rx_fn = receive;"
    return firmware_of(tmp_path_factory.mktemp("swarm"), text(step, init, globals_))


SWARM = {
    "objects.robots.nb": 40,
    "simulation_time": 4.0,
    "arena_surface": 4.0e5,
    "parameters": {},
    "objects.robots.communication_radius": 100,
    "data_logger_led": True,
}


# ---- What robots do


def test_robots_move_print_and_talk(swarm: Path, tmp_path: Path) -> None:
    result = run_firmware(swarm, tmp_path, SWARM)
    assert warnings(result) == []
    frame = result.frame()
    assert by_robot(frame, "pogobot_ticks")[-1].tolist() == [250] * 40
    assert np.ptp(by_robot(frame, "x"), axis=0).min() > 1.0
    assert (frame["led_rgb"] // 65536).max() > 0  # messages have come
    assert sorted(result.robot_lines) == sorted(
        f"[ROBOT #{robot}] [PRINTF] 30 ticks, 1.414, and more" for robot in range(40)
    )


def test_ticks_are_those_of_a_program(swarm: Path, tmp_path: Path) -> None:
    """At 60 Hz, the main loop sleeps 16 ms."""
    ticks = by_robot(run_firmware(swarm, tmp_path, SWARM | {"save_data_period": 0.01}).frame(), "pogobot_ticks")
    time_s = 0.01 * np.arange(len(ticks))
    # A row is saved before the robots of its time run.
    np.testing.assert_array_equal(ticks[1:, 0], np.floor(np.round((time_s[1:] - 0.01) / TICK_S, 9)) + 1)


@pytest.mark.parametrize("cpu_time", ["off", "counted"])
def test_any_number_of_threads_gives_the_same_bytes(cpu_time: str, swarm: Path, tmp_path: Path) -> None:
    settings = SWARM | {"objects.robots.cpu_time": cpu_time}
    files, hashes = set(), set()
    for threads in (1, 2, 5):
        result = run_firmware(swarm, tmp_path / str(threads), settings | {"threads": threads}, ["--hash", "100"])
        hashes.add(tuple(re.findall(r"state after step \d+: \w+", result.text)))
        files.add(result.frame().to_csv())
    assert len(files) == len(hashes) == 1
    assert len(next(iter(hashes))) == 4


def test_hash_sees_each_robots_memory(tmp_path: Path) -> None:
    def hash_of(step: str) -> str:
        folder = tmp_path / re.sub(r"\W", "_", step)
        result = run_firmware(firmware_of(folder, text(step)), folder, {}, ["--hash", "200"])
        return str(re.findall(r"state after step 200: (\w+)", result.text)[0])

    assert hash_of("mydata->level = 3;") != hash_of("mydata->level = 4;")


def test_start_of_a_robot_takes_no_time(tmp_path: Path) -> None:
    """As in a program in C, what user_init waits for is over at once, and the clock has gone on."""
    firmware = firmware_of(tmp_path, text(init="msleep(500); mydata->count = 100;"))
    settings = {f"{OF_ROBOTS}.firmware": str(firmware), f"{OF_ROBOTS}.columns": ["mydata.count"]}
    frame = run(without_program(), tmp_path, settings | {"simulation_time": 1.0}).frame()
    counts = by_robot(frame, "mydata.count")[:, 0]
    assert counts[0] == 100
    assert counts[5] == 100  # 0.5 s
    assert counts[6] > 104


def test_robot_sleeps_in_the_middle_of_a_tick(tmp_path: Path) -> None:
    firmware = firmware_of(tmp_path, text("msleep(300); mydata->level = (int16_t)mydata->count;"))
    settings = {f"{OF_ROBOTS}.firmware": str(firmware), f"{OF_ROBOTS}.columns": ["mydata.count", "mydata.level"]}
    result = run(without_program(), tmp_path, settings)
    assert "[TIME] Error code: 0: tick took 300 ms" in result.text
    frame = result.frame()
    assert by_robot(frame, "mydata.count")[[0, 1, 3, 4, 20], 0].tolist() == [0, 1, 1, 2, 7]
    assert by_robot(frame, "mydata.level")[[0, 1, 3, 4, 20], 0].tolist() == [0, 0, 0, 1, 6]


def test_robot_goes_on_when_its_data_have_come(tmp_path: Path) -> None:
    step = "int16_t x, y, z; mydata->level = (int16_t)magn_read_XYZ(&x, &y, &z, 50); mydata->items[0].value = x;"
    firmware = firmware_of(tmp_path, text(step))
    settings = {
        f"{OF_ROBOTS}.firmware": str(firmware),
        f"{OF_ROBOTS}.columns": ["mydata.level", "mydata.items[0].value"],
        "magnetometer": {"timing": "robot"},
    }
    frame = run(without_program(), tmp_path, settings).frame()
    assert set(frame["mydata.level"][frame["time"] > 0.1]) == {0}
    assert (frame["mydata.items[0].value"][frame["time"] > 0.1] != 0).all()


def test_program_that_has_ended_stands_still(tmp_path: Path) -> None:
    source = '#include "pogobot.h"\nint main(void) { pogobot_led_setColor(1, 2, 3); msleep(500); return 0; }\n'
    frame = run_firmware(firmware_of(tmp_path, source), tmp_path, LED).frame()
    assert set(frame["led_rgb"]) == {0x010203}


@pytest.mark.parametrize("cpu_time", ["off", "counted"])
def test_loop_that_polls_a_timer_goes_on(cpu_time: str, tmp_path: Path) -> None:
    source = """#include "pogobot.h"
    int main(void) {
        time_reference_t timer;
        uint8_t colour = 0;
        pogobot_timer_init(&timer, 250000);
        for (;;) {
            if (pogobot_timer_has_expired(&timer)) {
                pogobot_led_setColor(++colour, 0, 0);
                pogobot_timer_init(&timer, 250000);
            }
        }
    }
    """
    frame = run_firmware(firmware_of(tmp_path, source), tmp_path, LED | {"objects.robots.cpu_time": cpu_time}).frame()
    red = by_robot(frame, "led_rgb")[:, 0] / 65536
    assert red[[0, 2, 4, 7, 20]].tolist() == [0, 0, 1, 2, 7]


def test_memory_is_allocated_and_used_up(tmp_path: Path) -> None:
    init = """
    size_t total = 0;
    while (malloc(1000)) { total += 1000; }
    mydata->count = (uint32_t)total;
    printf("%lu bytes, %s\\n", (unsigned long)total, malloc(4000) ? "more" : "no more");"""
    result = run_firmware(firmware_of(tmp_path, text(init=init)), tmp_path)
    said = re.findall(r"(\d+) bytes, no more", result.text)
    assert len(said) == 3
    assert 90_000 < int(said[0]) < 128 * 1024


def test_random_numbers_are_those_of_the_c_library_or_of_the_simulator(tmp_path: Path) -> None:
    """The C library of the robots begins with the same number on each."""
    firmware = firmware_of(tmp_path, text(init='printf("drew %d\\n", rand());'))
    native = compile_text(tmp_path, text(init='printf("drew %d\\n", rand());'))

    def drawn(result: Run) -> list[str]:
        return sorted(result.robot_lines)

    own = drawn(run_firmware(firmware, tmp_path / "own"))
    assert len({line.partition("drew")[2] for line in own}) == 1
    settings = {f"{OF_ROBOTS}.firmware": str(firmware), f"{OF_ROBOTS}.random": "simulator"}
    assert drawn(run(without_program(), tmp_path / "other", settings)) == drawn(run(native, tmp_path / "native"))


def test_robots_of_two_firmwares_and_a_program_talk(tmp_path: Path) -> None:
    sends = """
    uint8_t word[] = "hello";
    pogobot_infrared_sendShortMessage_omni(word, sizeof(word));"""
    hears = """
    pogobot_infrared_update();
    while (pogobot_infrared_message_available()) {
        message_t message;
        pogobot_infrared_recover_next_message(&message);
        mydata->count = 1000;
        pogobot_led_setColor(0, message.payload[0], 0);
    }"""
    objects = {
        name: {"type": "pogobot", "nb": 1, "x": 300 + 60 * place, "y": 500, "geometry": "disk", "radius": 26.5}
        for place, name in enumerate(("natives", "robots", "others"))
    }
    objects["robots"]["brain"] = str(firmware_of(tmp_path / "sends", text(sends)))
    objects["others"]["brain"] = str(firmware_of(tmp_path / "hears", text(hears)))
    program = compile_text(tmp_path, text(hears).replace("user_step)", 'user_step, "natives")'))
    result = run(program, tmp_path, LED | {"objects": objects})
    colours = result.frame().groupby("robot_category")["led_rgb"].max()
    assert colours[["others", "natives", "robots"]].tolist() == [ord("h") << 8, ord("h") << 8, 0]


def test_remote_control_mutes_and_restarts_firmware(tmp_path: Path) -> None:
    step = "pogobot_led_setColor((uint8_t)is_muted(), 0, (uint8_t)(pogobot_ticks / 10));"
    firmware = firmware_of(
        tmp_path / "robot", text(step, "msg_rx_fn = hear;", "static void hear(message_t* m) { (void)m; }")
    )
    script = [{"time_s": 0.5, "message": "never obeyed"}]
    commands = """
    message_t m = {{._packet_type = ir_t_cmd, ._emitting_power_list = 0xff, .payload_length = 8}, {0}};
    if (pogobot_ticks == 30) { memcpy(m.payload, "DEADCAFE", 8); pogobot_infrared_sendRawLongMessage(&m); }
    if (pogobot_ticks == 60) { memcpy(m.payload, "DEADBEEF", 8); pogobot_infrared_sendRawLongMessage(&m); }"""
    program = compile_text(tmp_path, text(commands).replace("user_step)", 'user_step, "remote")'))
    common = {"type": "pogobot", "nb": 1, "y": 500, "geometry": "disk", "radius": 26.5}
    objects = {
        "robots": common | {"x": 300, "brain": str(firmware)},
        "remote": common | {"x": 360},
        "walkers": common | {"x": 420, "brain": {"script": script}},
    }
    frame = run(program, tmp_path, LED | {"objects": objects}).frame()
    own = frame[frame["robot_category"] == "robots"].set_index("time")
    assert own["led_rgb"][0.4] >> 16 == 0
    assert own["led_rgb"][0.8] >> 16 == 1
    assert own["led_rgb"][1.6] >> 16 == 0  # a restart ends that, too
    assert own["pogobot_ticks"][0.9] > 50
    assert own["pogobot_ticks"][1.1] < 10


def test_flash_memory_is_that_of_the_run(tmp_path: Path) -> None:
    init = """
    char page[POGOBOT_USER_FLASH_PAGE_SIZE];
    read_page_flash(7, page);
    mydata->level = page[3];
    page[3]++;
    write_page_flash(7, page);"""
    firmware = firmware_of(tmp_path, text(init=init))
    settings = {
        f"{OF_ROBOTS}.firmware": str(firmware),
        f"{OF_ROBOTS}.columns": ["mydata.level"],
        "flash_state": {"input_file": "flash.bin", "output_file": "flash.bin"},
    }
    for expected in (255, 0, 1):  # erased at first; char has no sign on the robot
        assert set(run(without_program(), tmp_path, settings).frame()["mydata.level"]) == {expected}


# ---- As the robots' own SDK makes it


def test_firmware_of_make_bin_runs_as_it_is(tmp_path: Path) -> None:
    """Its program is in flash, and its start code copies its variables to memory."""
    need(f"{TRIPLE}-gcc")
    sdk = make_sdk(tmp_path / "sdk")
    project = project_of(tmp_path / "project")
    step = "mydata->level = 5; pogobot_motor_set(motorL, motorFull); pogobot_led_setColor(0, 9, 0);"
    write(project, {"main.c": text(step)}, remove=())
    made(project, "bin", f"POGO_SDK={sdk}")
    firmware = project / "build" / "bin" / "firmware.elf"
    assert re.search(r"0026\w{4} .*main", call(f"{TRIPLE}-nm", firmware))
    frame = run_firmware(firmware, tmp_path, LED).frame()
    assert by_robot(frame, "pogobot_ticks")[-1].tolist() == [125] * 3
    assert set(frame["led_rgb"][frame["time"] > 0]) == {0x000900}
    assert np.ptp(by_robot(frame, "angle"), axis=0).min() > 1.0


# ---- Variables


def test_variables_are_columns_by_name(tmp_path: Path) -> None:
    step = """
    mydata->level = (int16_t)-mydata->count;
    mydata->share = 0.5f * (float)mydata->count;
    mydata->is_even = mydata->count % 2 == 0;
    strcpy(mydata->word, mydata->is_even ? "even" : "odd");
    mydata->items[1].value = 1.0 / mydata->count;
    mydata->items[1].id = 200;
    total += mydata->count;"""
    firmware = firmware_of(tmp_path, text(step, globals_="uint32_t total = 0;"))
    names = ["count", "level", "share", "is_even", "word", "items[1].value", "items[1].id"]
    columns = [f"mydata.{name}" for name in names] + ["total"]
    settings = {f"{OF_ROBOTS}.firmware": str(firmware), f"{OF_ROBOTS}.columns": columns}
    result = run(without_program(), tmp_path, settings)
    table = result.table().select(columns)
    assert [str(kind) for kind in table.schema.types] == [
        *("int64", "int16", "float", "bool", "string", "double", "int16", "int64")
    ]
    row = result.frame().iloc[-1]
    assert row[columns].tolist() == [125, -125, 62.5, False, "odd", 1 / 125, 200, 125 * 126 // 2]


@pytest.mark.parametrize(
    ("column", "said"),
    [
        ("mydata.cuont", "the program has no such variable; did you mean 'mydata.count'?"),
        ("mydata.items", "is neither a number nor a text; name one of its parts"),
        ("mydata.items[2].id", "[2] is beyond its end: it has 2 elements"),
        ("mydata.items[99999999999999999999999].id", "the program has no such variable"),
        ("absent", "the program has no such variable"),
    ],
)
def test_columns_that_are_not_there_are_refused(column: str, said: str, swarm: Path, tmp_path: Path) -> None:
    settings = {f"{OF_ROBOTS}.firmware": str(swarm), f"{OF_ROBOTS}.columns": [column]}
    result = run(without_program(), tmp_path, settings)
    assert result.code == 2
    assert result.errors.startswith(f"Error: {swarm}: column '{column}': {said}")


# ---- Time


LOOP = 'asm volatile("1: addi %0, %0, -1\\n bnez %0, 1b" : "+r"(n));'


def test_loop_takes_the_cycles_of_its_instructions(tmp_path: Path) -> None:
    """An addition takes 1 cycle, a branch backwards 2, and 4 when it is not taken."""
    count = 70_000
    step = f"""
    time_reference_t start;
    uint32_t n = {count};
    pogobot_stopwatch_reset(&start);
    {LOOP}
    mydata->count = (uint32_t)pogobot_stopwatch_get_elapsed_microseconds(&start);"""
    firmware = firmware_of(tmp_path, text(step))
    settings = {
        f"{OF_ROBOTS}.firmware": str(firmware),
        f"{OF_ROBOTS}.columns": ["mydata.count"],
        "objects.robots.cpu_time": "counted",
        "objects.robots.processor": {"call_times": {"call_us": 0}},
    }
    frame = run(without_program(), tmp_path, settings).frame()
    expected_us = (3 * count + 2) / CLOCK_HZ * 1e6
    taken_us = set(frame["mydata.count"][frame["time"] > 0.1])
    assert taken_us <= {int(expected_us), int(expected_us) + 1, int(expected_us) + 2}
    assert set(
        run_firmware(firmware, tmp_path / "off", {f"{OF_ROBOTS}": settings_of(firmware)}).frame()["mydata.count"]
    ) == {0}


def settings_of(firmware: Path) -> dict[str, object]:
    return {"firmware": str(firmware), "columns": ["mydata.count"]}


@pytest.mark.parametrize(
    ("processor", "factor"),
    [({}, 1.0), ({"cycle_factor": 1.5}, 1.5), ({"clock_hz": 42_000_000}, 0.5), ({"cycles": {"alu": 4}}, 2.0)],
)
def test_late_ticks_are_late_as_on_the_robot(processor: dict[str, object], factor: float, tmp_path: Path) -> None:
    """A step of 30 ms at 60 Hz: no sleep is left, a line tells of it, and the LED lights up."""
    count = 210_000
    firmware = firmware_of(tmp_path, text(f"uint32_t n = {count}; {LOOP}"))
    settings = {
        "objects.robots.cpu_time": "counted",
        "objects.robots.processor": processor | {"call_times": {"print_byte_us": 0}},
        "simulation_time": 6.0,
    }
    result = run_firmware(firmware, tmp_path, settings)
    tick_s = max(3 * count / CLOCK_HZ * factor, TICK_S)
    ticks = by_robot(result.frame(), "pogobot_ticks")[-1]
    np.testing.assert_allclose(ticks, 6.0 / tick_s, rtol=0.03)  # the line takes some cycles, too
    late = f"[TIME] Error code: 0: tick took {int(1000 * tick_s)} ms; main_loop_hz allows 16 ms"
    assert (late in result.text) == (tick_s > 1 / 60)


def test_messages_of_a_late_robot_are_lost(tmp_path: Path) -> None:
    """Its queue has room for 20."""
    sends = text("uint8_t one = 1; pogobot_infrared_sendShortMessage_omni(&one, 1);")
    hears = text(
        f"uint32_t n = 7000000; {LOOP} mydata->level = (int16_t)pogobot_infrared_get_queue_drop_count();",
        "msg_rx_fn = hear;",
        "static void hear(message_t* m) { (void)m; }",
    )
    objects = {
        name: {"type": "pogobot", "nb": 1, "x": 300 + 60 * place, "y": 500, "geometry": "disk", "radius": 26.5}
        for place, name in enumerate(("robots", "others"))
    }
    objects["others"]["brain"] = str(firmware_of(tmp_path / "sends", sends))
    objects["robots"]["brain"] = {
        "firmware": str(firmware_of(tmp_path / "hears", hears)),
        "columns": ["mydata.level"],
    }
    losses = {}
    for cpu_time in ("off", "counted"):
        objects["robots"]["cpu_time"] = cpu_time
        frame = run(without_program(), tmp_path / cpu_time, {"objects": objects, "simulation_time": 4.0}).frame()
        losses[cpu_time] = frame[frame["robot_category"] == "robots"]["mydata.level"].max()
    assert losses["off"] == 0
    assert losses["counted"] > 100


def test_call_takes_its_time(tmp_path: Path) -> None:
    step = """
    time_reference_t start;
    uint8_t message[100] = {0};
    pogobot_stopwatch_reset(&start);
    pogobot_infrared_sendShortMessage_omni(message, sizeof(message));
    mydata->count = (uint32_t)pogobot_stopwatch_get_elapsed_microseconds(&start);"""
    firmware = firmware_of(tmp_path, text(step))
    times = {"call_us": 0, "message_us": 70, "message_byte_us": 20}
    settings = {
        f"{OF_ROBOTS}": settings_of(firmware),
        "objects.robots.cpu_time": "counted",
        "objects.robots.processor": {"call_times": times},
    }
    frame = run(without_program(), tmp_path, settings).frame()
    expected_us = 70 + 20 * (100 + 3 + 6)  # payload, header, framing
    taken_us = frame["mydata.count"][frame["time"] > 0.1]
    assert taken_us.between(expected_us, expected_us + 3).all()


# ---- What goes wrong


def failure(tmp_path: Path, step: str, globals_: str = "", settings: dict[str, object] | None = None) -> str:
    """Run a firmware that fails; return its message, behind which the data file is complete."""
    firmware = firmware_of(tmp_path, text(step, globals_=globals_))
    result = run_firmware(firmware, tmp_path, settings)
    assert result.code == 3, result.text
    lines = [line for line in result.errors.splitlines() if "[error]" in line]
    assert len(lines) == 1
    assert len(result.frame()) > 0
    return lines[0].partition("[error] ")[2]


@pytest.mark.parametrize(
    ("step", "said"),
    [
        ("*(volatile uint32_t*)0 = 5;", "it wrote to 0x00000000, where its program is: a pointer is NULL or wrong"),
        ("*(volatile uint32_t*)0xf0000800u = 1;", "it accessed 0xf0000800, a register of the robot's hardware"),
        ("mydata->level = *(volatile int16_t*)0x40000000;", "it accessed 0x40000000, where there is no memory"),
        ("*(volatile uint32_t*)(wrong + 1) = 1;", "it accessed 0x00800001, which is no multiple of the size"),
        ("((void (*)(void))wrong)();", "it jumped to 0x00800000, where there is no code"),
        (
            "pogobot_imu_read((float*)wrong, (float*)wrong); mydata->count = 0;",
            "it gave pogobot_imu_read() the",
        ),
        ("__builtin_trap();", "it executed ebreak, where programs give up"),
        ("reboot(); mydata->count = 0;", "it called reboot(), which is not simulated"),
        ("abort();", "it called abort(), as assert() does when its condition is false"),
        ('asm volatile(".word 0xffffffff");', "where 0xffffffff is no instruction of the robot's processor"),
    ],
)
def test_crash_names_what_happened_and_where(step: str, said: str, tmp_path: Path) -> None:
    crash = failure(
        tmp_path,
        f"if (pogobot_ticks == 50 && pogobot_helper_getid() == 1) {{ {step} }}",
        "volatile uint32_t wrong = 0x800000;",
    )
    assert said in crash
    assert re.search(r"\(main\.c:\d+\) of robot #1 of category 'robots', tick 50, t = 0\.8\d*00 s: ", crash)


def test_stack_that_grows_into_variables_is_told(tmp_path: Path) -> None:
    globals_ = """
    static int deeper(int n) {
        volatile char buffer[1000] = {0};
        pogobot_led_setColor(1, 2, 3);
        return n == 0 ? 0 : deeper(n - 1) + buffer[n % 1000];
    }"""
    crash = failure(tmp_path, "mydata->level = (int16_t)deeper((int)mydata->count * 100);", globals_)
    assert re.search(r"deeper \(main\.c:\d+\) of robot #0 .* its stack has grown down to 0x0000\w{4}, into its", crash)


def test_code_that_never_waits_ends_the_run(tmp_path: Path) -> None:
    crash = failure(
        tmp_path, "if (pogobot_ticks == 5) { for (volatile int i = 0;; i++) { } }", "", {"user_code_timeout": 0.5}
    )
    assert "tick 5, t = 0.08" in crash
    assert "it has run for 0.5 s on the robot's processor without waiting" in crash


def test_code_that_never_waits_goes_on_where_time_is_counted(tmp_path: Path) -> None:
    firmware = firmware_of(tmp_path, text("if (pogobot_ticks == 5) { for (volatile int i = 0;; i++) { } }"))
    frame = run_firmware(firmware, tmp_path, {"objects.robots.cpu_time": "counted"}).frame()
    assert set(frame["pogobot_ticks"][frame["time"] > 0.2]) == {5}


def test_slips_are_told_once(tmp_path: Path) -> None:
    step = """
    pogobot_motor_set(motorL, 2000);
    pogobot_led_setColors(1, 2, 3, 9);
    pogobot_photosensors_read(7);
    uint8_t big[400] = {0};
    pogobot_infrared_sendShortMessage_omni(big, sizeof(big));"""
    said = warnings(run_firmware(firmware_of(tmp_path, text(step)), tmp_path))
    assert len(said) == 4
    assert said[0] == (
        "robot #0 of category 'robots', tick 0, t = 0.0000 s: pogobot_motor_set(): value is 2000, expected 0 to 1023 "
        "(motorFull); 1023 is used"
    )


def refusal(file: Path, folder: Path, settings: dict[str, object] | None = None) -> str:
    result = run_firmware(file, folder, settings)
    assert result.code == 2, result.text
    lines = result.errors.splitlines()
    assert len(lines) == 1, lines
    return lines[0]


def test_files_that_are_no_firmware_are_refused(swarm: Path, tmp_path: Path) -> None:
    whole = swarm.read_bytes()
    for name, contents, said in (
        ("empty.elf", b"", "is no firmware: expected an ELF file"),
        ("text.elf", b"#!/bin/sh\n", "is no firmware: expected an ELF file"),
        ("host.elf", Path(sys.executable).read_bytes(), "is a program of 64 bits, not for a robot"),
        ("cut.elf", whole[: len(whole) // 2], "is cut off"),
    ):
        (tmp_path / name).write_bytes(contents)
        assert said in refusal(tmp_path / name, tmp_path)
    stripped = tmp_path / "stripped.elf"
    call(f"{TRIPLE}-strip", "-o", stripped, swarm)
    assert "has no symbols" in refusal(stripped, tmp_path)
    assert "does not fit into the robot's memory" in refusal(
        swarm, tmp_path, {"objects.robots.processor": {"memory_bytes": 8192}}
    )
    assert "there is no file 'absent.elf'" in refusal(Path("absent.elf"), tmp_path)


def test_compressed_instructions_are_refused(tmp_path: Path) -> None:
    source = tmp_path / "main.c"
    source.write_text("int main(void) { return 0; }\n")
    firmware = tmp_path / "compressed.elf"
    flags = ("-march=rv32imc", "-mabi=ilp32", "-nostdlib", "-Wl,-emain")
    call(need(f"{TRIPLE}-gcc"), *flags, source, "-o", firmware)
    assert "has compressed instructions" in refusal(firmware, tmp_path)


def test_damaged_firmware_is_refused_or_fails_but_never_crashes_the_simulator(swarm: Path, tmp_path: Path) -> None:
    whole = bytearray(swarm.read_bytes())
    generator = np.random.default_rng(7)
    codes = set()
    for number in range(60):
        damaged = bytearray(whole)
        # Its program begins behind the first 4096 bytes, and has 13 kB.
        for place in generator.integers(0, 17_000, size=1 + number % 20):
            damaged[place] = generator.integers(256)
        file = tmp_path / "damaged.elf"
        file.write_bytes(damaged)
        result = run_firmware(
            file, tmp_path, {"simulation_time": 0.5, "user_code_timeout": 0.2, "objects.robots.nb": 2}, ["-q", "-nr"]
        )
        codes.add(result.code)
        assert result.code in (0, 2, 3), result.text
        assert len([line for line in result.errors.splitlines() if "rror" in line]) <= 1
    assert codes >= {0, 3}


# ---- From the command line and Python


def test_command_line_runs_a_firmware(swarm: Path, tmp_path: Path) -> None:
    (tmp_path / "conf.yaml").write_text(
        "arena_file: arenas/disk.csv\narena_surface: 1.0e6\nsimulation_time: 1\ndata_filename: data.feather\n"
        "objects:\n  robots: {type: pogobot, nb: 3, geometry: disk, radius: 26.5}\n"
        "  membranes: {type: membrane, nb: 1, geometry: disk, radius: 100, num_dots: 30}\n"
    )
    done = subprocess.run(
        [sys.executable, "-m", "pogosim", "run", str(swarm), "-c", "conf.yaml", "-g"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=100,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    frame = Run(0, "", "", tmp_path).frame()
    assert by_robot(frame[frame["robot_category"] == "robots"], "pogobot_ticks")[-1].tolist() == [62] * 3


def test_program_runs_a_firmware_in_its_place(swarm: Path, tmp_path: Path) -> None:
    program = compile_text(tmp_path, text("pogobot_led_setColor(200, 0, 0);"))
    firmware = run(program, tmp_path / "firmware", SWARM, ["--firmware", str(swarm)])
    assert firmware.frame().equals(run_firmware(swarm, tmp_path / "alone", SWARM).frame())


def test_python_runs_a_firmware(swarm: Path, tmp_path: Path) -> None:
    scene = write_scene(tmp_path, SWARM)
    with Simulation(swarm, scene, data_file=tmp_path / "python.feather") as simulation:
        simulation.run(1.0)
        ticks = simulation.ticks.copy()
    assert ticks.tolist() == [62] * 40


def test_robots_with_bodies_of_another_kind_do_nothing(swarm: Path, tmp_path: Path) -> None:
    shutil.copy(swarm, tmp_path / "robot.elf")
    result = run(
        without_program(),
        tmp_path,
        {"objects.wall": {"type": "pogowall", "geometry": "arena"}},
        ["--firmware", "robot.elf"],
    )
    assert result.code == 0
    assert warnings(result) == []


def test_firmware_in_a_folder_of_its_own_is_found_beside_the_configuration(swarm: Path, tmp_path: Path) -> None:
    (tmp_path / "conf").mkdir()
    shutil.copy(swarm, tmp_path / "conf" / "robot.elf")
    write_scene(tmp_path / "conf", {OF_ROBOTS: "robot.elf"})
    done = ran(tmp_path, without_program(), "-c", "conf/scene.yaml", "-g")
    assert done.code == 0, done.text


@pytest.mark.parametrize(
    "arguments",
    [
        ["--set", "data_filename=robot.elf"],
        ["--set", "console_filename=robot.elf", "--set", "enable_console_logging=true"],
        ["--profile", "robot.elf"],
        ["--profile", "link.elf"],
    ],
    ids=" ".join,
)
@pytest.mark.parametrize(
    "way", [["--firmware", "robot.elf"], ["--set", "objects.robots.brain=robot.elf"]], ids=" ".join
)
def test_firmware_in_use_is_not_overwritten(way: list[str], arguments: list[str], swarm: Path, tmp_path: Path) -> None:
    shutil.copy(swarm, tmp_path / "robot.elf")
    (tmp_path / "link.elf").symlink_to("robot.elf")
    result = run(without_program(), tmp_path, {}, [*way, *arguments])
    assert result.code == 2
    assert "overwrite" in result.errors
    assert (tmp_path / "robot.elf").read_bytes() == swarm.read_bytes()


def test_time_of_a_program_that_is_no_firmware_is_not_counted_in_silence(tmp_path: Path) -> None:
    program = compile_text(tmp_path, text())
    (said,) = warnings(run(program, tmp_path, {"objects.robots.cpu_time": "counted"}))
    assert said.endswith(
        "objects.robots.cpu_time: counted has an effect on firmware (brain: FILE.elf, or --firmware FILE), and "
        "on programs in C with function_costs; the "
        "code of these robots takes no time"
    )


@pytest.mark.parametrize("cpu_time", ["off", "counted"])
def test_rows_are_those_between_two_ticks(cpu_time: str, swarm: Path, tmp_path: Path) -> None:
    """The rest of a tick behind its sleep belongs to it, though the robot's clock is ahead then."""
    frame = run_firmware(swarm, tmp_path, SWARM | {"objects.robots.cpu_time": cpu_time}).frame()
    assert by_robot(frame, "pogobot_ticks")[[0, 1, 2], 0].tolist() == [0, 6, 12]


def test_error_led_does_not_hold_a_tick_up(tmp_path: Path) -> None:
    firmware = firmware_of(tmp_path, text("if (pogobot_ticks == 20) { msleep(40); }"))
    native = compile_text(tmp_path, text("if (pogobot_ticks == 20) { msleep(40); }"))
    settings = {"save_data_period": 0.01}
    expected = by_robot(run(native, tmp_path / "native", settings).frame(), "pogobot_ticks")
    np.testing.assert_array_equal(
        by_robot(run_firmware(firmware, tmp_path / "firmware", settings).frame(), "pogobot_ticks"), expected
    )


def test_function_of_the_program_with_a_name_of_the_library_is_its_own(tmp_path: Path) -> None:
    globals_ = "__attribute__((noinline)) static void busy_wait(uint32_t n) { mydata->level += (int16_t)n; }"
    firmware = firmware_of(tmp_path, text("busy_wait(2);", globals_=globals_))
    settings = {f"{OF_ROBOTS}": {"firmware": str(firmware), "columns": ["mydata.level"]}}
    assert run(without_program(), tmp_path, settings).frame()["mydata.level"].max() == 2 * 125


def test_characters_have_no_sign(tmp_path: Path) -> None:
    firmware = firmware_of(
        tmp_path,
        text("mydata->word[0] = (char)200; letter = (char)200;", globals_="__attribute__((used)) char letter;"),
    )
    settings = {f"{OF_ROBOTS}": {"firmware": str(firmware), "columns": ["letter"]}}
    assert run(without_program(), tmp_path, settings).frame()["letter"].max() == 200


def test_robot_that_restarts_draws_another_seed(tmp_path: Path) -> None:
    init = 'printf("seed %d\\n", pogobot_helper_getRandSeed()); msg_rx_fn = hear;'
    firmware = firmware_of(tmp_path / "robot", text("", init, "static void hear(message_t* m) { (void)m; }"))
    commands = """
    message_t m = {{._packet_type = ir_t_cmd, ._emitting_power_list = 0xff, .payload_length = 8}, {0}};
    if (pogobot_ticks % 30 == 10) { memcpy(m.payload, "DEADBEEF", 8); pogobot_infrared_sendRawLongMessage(&m); }"""
    program = compile_text(tmp_path, text(commands).replace("user_step)", 'user_step, "remote")'))
    common = {"type": "pogobot", "nb": 1, "y": 500, "geometry": "disk", "radius": 26.5}
    objects = {"robots": common | {"x": 300, "brain": str(firmware)}, "remote": common | {"x": 360}}
    profiled = run(program, tmp_path, {"objects": objects}, ["--profile", "profile.json"])
    seeds = [line for line in profiled.robot_lines if "seed" in line]
    assert len(seeds) == len(set(seeds)) == 5
    frames = json.loads((tmp_path / "profile.json").read_text())
    start = frames["functions"].index("_start")
    assert max(stack["frames"].count(start) for stack in frames["stacks"]) == 1


def test_category_without_robots_does_no_harm(swarm: Path, tmp_path: Path) -> None:
    empty = {"type": "pogobot", "nb": 0, "geometry": "disk", "radius": 26.5, "brain": str(swarm)}
    settings = SWARM | {"threads": 2, "objects.others": empty}
    assert run_firmware(swarm, tmp_path, settings, ["--profile", "profile.json"]).code == 0


def test_tick_that_does_not_end_is_told_where_time_is_counted(tmp_path: Path) -> None:
    firmware = firmware_of(tmp_path, text("if (pogobot_ticks == 5) { for (volatile int i = 0;; i++) { } }"))
    (said,) = warnings(run_firmware(firmware, tmp_path, {"objects.robots.cpu_time": "counted"}))
    assert re.fullmatch(
        r"robot #0 of category 'robots' has been in tick 5 for 1\.\d s, in user_step \(main\.c:\d+\), and the tick "
        r"has not ended \(3 such robots\)",
        said,
    )


def test_robot_between_two_ticks_is_in_none(tmp_path: Path) -> None:
    """One whose battery is empty, and one that has restarted and waits in user_init."""
    firmware = firmware_of(
        tmp_path / "robot", text("", "msg_rx_fn = hear; msleep(1500);", "static void hear(message_t* m) { (void)m; }")
    )
    commands = """
    message_t m = {{._packet_type = ir_t_cmd, ._emitting_power_list = 0xff, .payload_length = 8}, {0}};
    if (pogobot_ticks == 200) { memcpy(m.payload, "DEADBEEF", 8); pogobot_infrared_sendRawLongMessage(&m); }"""
    program = compile_text(tmp_path, text(commands).replace("user_step)", 'user_step, "remote")'))
    common = {"type": "pogobot", "nb": 1, "y": 500, "geometry": "disk", "radius": 26.5}
    empty = {"x": 800, "battery": {"capacity_mah": 1e-3}}
    objects = {
        "robots": common | {"x": 300, "brain": str(firmware)},
        "empty": common | {"brain": str(firmware)} | empty,
        "remote": common | {"x": 360},
    }
    result = run(program, tmp_path, {"objects": objects, "simulation_time": 4.5})
    assert "the battery of robot #1 of category 'empty' is empty" in result.text
    assert "has been in" not in result.text


def test_program_that_ends_after_a_restart_stands_still(tmp_path: Path) -> None:
    source = """#include "pogobot.h"
    int main(void) {
        pogobot_init();
        for (int i = 0; i < 100; i++) { msleep(20); pogobot_infrared_update(); }
        exit(0);
    }"""
    firmware = firmware_of(tmp_path / "robot", source)
    commands = """
    message_t m = {{._packet_type = ir_t_cmd, ._emitting_power_list = 0xff, .payload_length = 8}, {0}};
    if (pogobot_ticks == 30) { memcpy(m.payload, "DEADBEEF", 8); pogobot_infrared_sendRawLongMessage(&m); }"""
    program = compile_text(tmp_path, text(commands).replace("user_step)", 'user_step, "remote")'))
    common = {"type": "pogobot", "nb": 1, "y": 500, "geometry": "disk", "radius": 26.5}
    objects = {"robots": common | {"x": 300, "brain": str(firmware)}, "remote": common | {"x": 360}}
    assert run(program, tmp_path, {"objects": objects, "simulation_time": 4.0}).code == 0


def test_code_that_may_run_for_ever_can_be_interrupted(tmp_path: Path) -> None:
    firmware = firmware_of(tmp_path, text("for (volatile int i = 0;; i++) { }"))
    write_scene(tmp_path, {OF_ROBOTS: str(firmware), "user_code_timeout": 0})
    process = subprocess.Popen(
        [without_program(), "-c", "scene.yaml", "-g"], cwd=tmp_path, stderr=subprocess.PIPE, text=True
    )
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    errors = process.communicate(timeout=60)[1]
    assert process.returncode == 130
    assert "the run was interrupted in user_step" in errors


def test_what_is_no_file_is_no_firmware(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.elf")
    (tmp_path / "folder.elf").mkdir()
    for name in ("pipe.elf", "folder.elf", "/dev/zero"):
        assert "expected an ELF file" in refusal(Path(name), tmp_path, {f"{OF_ROBOTS}": {"firmware": name}})


def test_profile_is_not_written_to_a_pipe(swarm: Path, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    result = run_firmware(swarm, tmp_path, {}, ["--profile", "pipe"])
    assert result.code == 2
    assert "cannot write the profile pipe: it is a pipe; give a file" in result.errors


def test_profile_takes_no_other_files_place(swarm: Path, tmp_path: Path) -> None:
    for name in ("scene.yaml", "data.feather"):
        result = run_firmware(swarm, tmp_path, {}, ["--profile", name])
        assert result.code == 2
        assert f"--profile would overwrite '{name}'" in result.errors


def test_python_reads_variables_of_any_shape(tmp_path: Path) -> None:
    globals_ = "__attribute__((used)) char word[20]; __attribute__((used)) uint8_t table[3][4]; volatile double mean;"
    step = 'strcpy(word, "hello"); table[2][3] = 7; mean = 0.5; mydata->count += 2;'
    firmware = firmware_of(tmp_path, text(step, globals_=globals_))
    with Simulation(None, write_scene(tmp_path, {OF_ROBOTS: str(firmware)})) as simulation:
        simulation.run(0.5)
        of = {
            name: simulation.firmware_variable(name, firmware=firmware) for name in ("word", "table", "mean", "mydata")
        }
    assert of["table"].shape == (3, 3, 4)
    assert of["table"][1, 2].tolist() == [0, 0, 0, 7]
    assert of["mean"].tolist() == [0.5] * 3
    assert bytes(of["word"][0].astype(np.uint8)).startswith(b"hello\0")
    assert (of["mydata"]["count"] > 60).all()
    with Simulation(firmware, tmp_path / "scene.yaml") as simulation:
        assert simulation.user_data["count"].shape == (3,)
        with pytest.raises(SimulationError, match="has no variable 'maen'; "):
            simulation.firmware_variable("maen")


def test_wrong_arguments_of_a_variable_are_refused(swarm: Path, tmp_path: Path) -> None:
    with Simulation(swarm, write_scene(tmp_path, {})) as simulation:
        with pytest.raises(ConfigurationError, match=r"^category: expected text, found 5$"):
            simulation.firmware_variable("mydata", 5)  # type: ignore[arg-type]
        with pytest.raises(ConfigurationError, match=r"^name: expected text, found None$"):
            simulation.firmware_variable(None)  # type: ignore[arg-type]
        with pytest.raises(ConfigurationError, match=r"^firmware: expected the path of a file"):
            simulation.firmware_variable("mydata", firmware=5)  # type: ignore[arg-type]
        with pytest.raises(ConfigurationError, match=r"there is no category 'others'"):
            simulation.firmware_variable("mydata", "others")
