"""Commands of the remote control: robots that are muted, unmuted and restarted, and what senders and counters say."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from running import Run, compile_text, run

PERFECT: dict[str, Any] = {
    "arena_surface": 5.0e4,
    "simulation_time": 1.0,
    "objects.robots.msg_success_rate": {"type": "static", "rate": 1.0},
}

# Robot 0 sends `COMMAND` as a raw message at its tick 10 and `SECOND` at tick 30; all robots say at ticks 20 and 40
# what sending returns.
PROGRAM = """#include "pogobase.h"
typedef struct { uint32_t failed, commands; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
static void command(char const* text) {
    message_t message = {0};
    message.header._packet_type = ir_t_cmd;
    message.header._emitting_power_list = pogobot_infrared_emitting_power_list_all_full;
    message.header.payload_length = (uint16_t)strlen(text);
    memcpy(message.payload, text, strlen(text));
    pogobot_infrared_sendRawLongMessage(&message);
}
static void receive(message_t* message) {
    mydata->commands += message->header._packet_type == ir_t_cmd ? 1 : 0;
}
static void user_init(void) {
    msg_rx_fn = receive;
    max_nb_processed_msg_per_tick = 100;
    pogobot_led_setColor(1, 2, 3);
    printf("starts at %lu ms\\n", current_time_milliseconds());
}
static void user_step(void) {
    if (pogobot_helper_getid() == 0 && pogobot_ticks == 10) { command("COMMAND"); }
    if (pogobot_helper_getid() == 0 && pogobot_ticks == 30) { command("SECOND"); }
    if (pogobot_ticks == 20 || pogobot_ticks == 40) {
        uint8_t hi[2] = "hi";
        uint32_t const all = pogobot_infrared_sendLongMessage_omniSpe(hi, 2);
        printf("tick %lu muted %d %d returns %lu %lu %lu %lu got %lu\\n", pogobot_ticks, is_muted(), _master_mute, all,
               pogobot_infrared_sendLongMessage_omniGen(hi, 2), pogobot_infrared_sendShortMessage_omni(hi, 2),
               pogobot_infrared_sendLongMessage_uniSpe(ir_front, hi, 2), mydata->commands);
    }
}
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
"""


def talk(folder: Path, first: str, second: str = "nothing", **settings: Any) -> Run:
    """Run two robots beside each other, the first of which sends two commands."""
    program = compile_text(folder, PROGRAM.replace("COMMAND", first).replace("SECOND", second))
    return run(program, folder, {**PERFECT, "objects.robots.nb": 2, **settings})


def lines_of(result: Run, robot: int) -> list[str]:
    """Return what a robot has printed."""
    start = f"[ROBOT #{robot}] [PRINTF] "
    return [line.removeprefix(start) for line in result.robot_lines if line.startswith(start)]


def test_robot_that_hears_deadcafe_is_muted_until_basecafe(tmp_path: Path) -> None:
    result = talk(tmp_path, "DEADCAFE", "BASECAFE")
    assert result.code == 0
    assert lines_of(result, 1)[1:] == [
        "tick 20 muted 1 1 returns 4 1 1 1 got 2",
        "tick 40 muted 0 0 returns 0 0 0 0 got 4",
    ]
    assert lines_of(result, 0)[1:] == [
        "tick 20 muted 0 0 returns 0 0 0 0 got 0",
        "tick 40 muted 0 0 returns 0 0 0 0 got 0",
    ]
    told = "7 messages of robots of category 'robots' were not sent because they were muted (command DEADCAFE)"
    assert result.errors.count(told) == 1
    assert result.errors.count("sends a command (type ir_t_cmd)") == 1


@pytest.mark.parametrize("text", ["DEADCAF", "deadcafe", "xDEADCAFE", ""])
def test_other_texts_are_no_commands_and_have_the_type_of_users(text: str, tmp_path: Path) -> None:
    result = talk(tmp_path, text)
    assert lines_of(result, 1)[1] == "tick 20 muted 0 0 returns 0 0 0 0 got 0"
    assert result.errors == ""


def test_command_may_be_followed_by_other_bytes(tmp_path: Path) -> None:
    assert "muted 1 1" in lines_of(talk(tmp_path, "DEADCAFE please"), 1)[1]


def test_deadbeef_restarts_the_robot_that_hears_it_and_no_other(tmp_path: Path) -> None:
    result = talk(tmp_path, "DEADBEEF", simulation_time=0.6)
    assert result.code == 0
    # Its ticks begin again, its memory is as at the start, and so is the time.
    assert lines_of(result, 1) == ["starts at 0 ms", "starts at 0 ms", "tick 20 muted 0 0 returns 0 0 0 0 got 0"]
    assert len(lines_of(result, 0)) == 2
    assert "1 restart of robots of category 'robots' by the command DEADBEEF" in result.errors
    frame = result.frame()
    ticks = frame[frame["robot_id"] == 1]["pogobot_ticks"].tolist()
    assert ticks.index(max(ticks)) > ticks.index(min(ticks[1:]))
    assert frame[frame["robot_id"] == 0]["pogobot_ticks"].is_monotonic_increasing


def test_restart_unmutes(tmp_path: Path) -> None:
    result = talk(tmp_path, "DEADCAFE", "DEADBEEF", simulation_time=1.0)
    assert "tick 20 muted 0 0 returns 0 0 0 0 got 0" in lines_of(result, 1)[2:]


SDK = """#include "pogobot.h"
int32_t count = 7;
int main(void) {
    static int32_t loops = 0;
    pogobot_init();
    int32_t const first = rand();
    printf("begins with %ld %ld\\n", count, loops);
    pogobot_led_setColor(0, 9, 0);
    pogobot_motor_set(motorL, motorHalf);
    for (;;) {
        count++;
        loops++;
        pogobot_infrared_update();
        if (pogobot_helper_getid() == 0 && loops == 20) {
            message_t message = {0};
            message.header._packet_type = ir_t_cmd;
            message.header._emitting_power_list = 255;
            message.header.payload_length = 8;
            memcpy(message.payload, "DEADBEEF", 8);
            pogobot_infrared_sendRawLongMessage(&message);
        }
        if (loops == 30) {
            printf("at 30: %ld, %d\\n", count, (int)(first % 1000));
        }
        msleep(10);
    }
}
"""


def test_program_of_the_sdk_begins_anew_in_the_middle_of_main(tmp_path: Path) -> None:
    program = compile_text(tmp_path, SDK, package="pogosim-sdk")
    result = run(program, tmp_path, {**PERFECT, "objects.robots.nb": 2, "simulation_time": 0.8})
    assert result.code == 0
    assert lines_of(result, 0)[0] == "begins with 7 0"
    first, second, third = lines_of(result, 1)
    assert (first, second) == ("begins with 7 0", "begins with 7 0")
    # rand() begins anew, too: a robot draws the same numbers as at its first start.
    alone = run(
        program, tmp_path / "alone", {**PERFECT, "objects.robots.nb": 2, "arena_surface": 4.0e6, "simulation_time": 0.8}
    )
    assert third == lines_of(alone, 1)[1]
    assert third.startswith("at 30: 37, ")


CPP = """#include "pogobot.h"
struct Counter {
    int value;
    Counter() : value(5) {}
};
static Counter counter;
int main() {
    pogobot_init();
    printf("%d\\n", counter.value);
    for (;;) {
        counter.value++;
        pogobot_infrared_update();
        if (pogobot_helper_getid() == 0 && counter.value == 20) {
            message_t message = {};
            message.header._packet_type = ir_t_cmd;
            message.header._emitting_power_list = 255;
            message.header.payload_length = 8;
            memcpy(message.payload, "DEADBEEF", 8);
            pogobot_infrared_sendRawLongMessage(&message);
        }
        msleep(10);
    }
}
"""


def test_restart_constructs_static_objects_of_the_robot_anew(tmp_path: Path) -> None:
    program = compile_text(tmp_path, CPP, name="main.cpp", package="pogosim-sdk")
    result = run(program, tmp_path, {**PERFECT, "objects.robots.nb": 2})
    assert (result.code, lines_of(result, 1)) == (0, ["5", "5"])


def test_parameters_and_flash_outlive_a_restart_with_own_memory(tmp_path: Path) -> None:
    text = (
        PROGRAM.replace("static void command", "int32_t speed = 1;\nint32_t steps = 0;\nstatic void command", 1)
        .replace('printf("starts', 'printf("speed %ld steps %ld\\n", speed, steps);\n    printf("starts', 1)
        .replace("static void user_step(void) {", "static void user_step(void) {\n    steps++;", 1)
        .replace("int main(void) {", "static void setup(void) { init_from_configuration(speed); }\nint main(void) {", 1)
        .replace("    return 0;", "    SET_CALLBACK(callback_global_setup, setup);\n    return 0;", 1)
    )
    program = compile_text(tmp_path, text.replace("COMMAND", "DEADBEEF"))
    settings = {**PERFECT, "objects.robots.nb": 2, "robot_memory": "own", "parameters": {"speed": 4}}
    result = run(program, tmp_path, settings)
    assert [line for line in lines_of(result, 1) if "speed" in line] == ["speed 4 steps 0"] * 2


SETUP = """int32_t gain = 1; int32_t derived = 0; float scaled[2]; int32_t counted = 0; int32_t half = 1;
static void setup(void) {
    init_from_configuration(gain);
    init_from_configuration(half);
    half /= 2;
    derived = gain * 2;
    scaled[1] = 0.5f * (float)derived;
    counted++;
}
static void command"""


@pytest.mark.parametrize("memory", ["own", "shared"])
def test_what_the_global_setup_computed_outlives_a_restart(memory: str, tmp_path: Path) -> None:
    say = 'printf("derived %ld %.1f %ld half %ld\\n", derived, (double)scaled[1], counted, half);'
    text = (
        PROGRAM.replace("static void command", SETUP, 1)
        .replace('printf("starts', f'{say}\n    printf("starts', 1)
        .replace("int main(void) {", "int main(void) {\n    counted = 4;", 1)
        .replace("    return 0;", "    SET_CALLBACK(callback_global_setup, setup);\n    return 0;", 1)
    )
    program = compile_text(tmp_path, text.replace("COMMAND", "DEADBEEF"))
    settings = {**PERFECT, "objects.robots.nb": 2, "robot_memory": memory, "parameters": {"gain": 3, "half": 8}}
    result = run(program, tmp_path, settings)
    assert result.code == 0, result.text
    counted = 5 if memory == "own" else 4  # by main() of the restart, for all robots that share the variable
    said = [line for line in lines_of(result, 1) if "derived" in line]
    assert said == ["derived 6 3.0 5 half 4", f"derived 6 3.0 {counted} half 4"]


def test_threads_do_not_change_what_a_restart_does(tmp_path: Path) -> None:
    folders = [tmp_path / "one", tmp_path / "four"]
    for folder, threads in zip(folders, (1, 4), strict=True):
        folder.mkdir()
        talk(folder, "DEADBEEF", "DEADCAFE", threads=threads, **{"objects.robots.nb": 40, "arena_surface": 1.0e6})
    assert (folders[0] / "data.feather").read_bytes() == (folders[1] / "data.feather").read_bytes()


COUNTERS = """#include "pogobase.h"
#include "slip.h"
typedef struct { uint32_t got; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
#ifdef __cplusplus
extern "C"
#else
extern
#endif
const slip_send_descriptor_s slip_send_descriptor;
static void user_init(void) { main_loop_hz = 100; }
static void user_step(void) {
    message_t message = {0};
    message.header._packet_type = ir_t_user;
    message.header._emitting_power_list = 255;
    message.header.payload_length = 3;
    if (pogobot_helper_getid() == 0 && pogobot_ticks == 2) {
        uint8_t* const bytes = (uint8_t*)&message;
        slip_send_message(&slip_send_descriptor, bytes, 8 + 3);     // well formed
        slip_send_message(&slip_send_descriptor, bytes, 8 + 4);     // longer than it says
        slip_send_message(&slip_send_descriptor, bytes, 8 + 2);     // shorter
        slip_send_message(&slip_send_descriptor, bytes, 5);         // not even a header
        slip_send_message(&slip_send_descriptor, bytes, 8 + 3, 3);  // well formed
        slip_send_message(&slip_send_descriptor, bytes, 8 + 3, 2);  // another length at its end
        message.header.payload_length = MAX_PAYLOAD_SIZE_BYTES;
        slip_send_message(&slip_send_descriptor, bytes, 8 + MAX_PAYLOAD_SIZE_BYTES);
    }
    if (pogobot_helper_getid() == 0 && pogobot_ticks == 10) {
        for (int i = 0; i < 30; i++) {
            uint8_t byte = 1;
            pogobot_infrared_sendLongMessage_uniSpe(ir_all, &byte, 1);
        }
    }
    if (pogobot_helper_getid() == 1) {
        while (pogobot_ticks < 8 && pogobot_infrared_message_available()) {
            pogobot_infrared_recover_next_message(&message);
            mydata->got++;
        }
        if (pogobot_ticks == 8 || pogobot_ticks == 20 || pogobot_ticks == 21) {
            slip_error_counter_s errors;
            pogobot_infrared_reset_receiver_error_counter();
            pogobot_infrared_get_receiver_error_counter(&errors, 0);
            IR_reset_interrupt_flags();
            printf("got %lu malformed %lu dropped %lu\\n", mydata->got, pogobot_infrared_get_malformed_count(),
                   pogobot_infrared_get_queue_drop_count());
            if (pogobot_ticks == 20) { pogobot_infrared_ll_init(); }
        }
    }
}
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
"""


def test_counters_say_what_was_lost_and_what_was_malformed_since_the_start(tmp_path: Path) -> None:
    program = compile_text(tmp_path, COUNTERS)
    settings = {**PERFECT, "objects.robots.nb": 2, "objects.robots.communication_ignore_occlusions": False}
    log = {"message_log": "messages.feather"}
    result = run(program, tmp_path, {**settings, **log})
    assert result.code == 0, result.text
    first, second, third = lines_of(result, 1)
    got, malformed, dropped = (int(word) for word in first.split()[1::2])
    faces = got // 3  # of the receiver, each of which gets a copy
    assert (got, malformed, dropped) == (3 * faces, 4 * faces, 0)
    assert second == f"got {got} malformed {malformed} dropped {30 * faces - 20}"
    assert third == f"got {got} malformed 0 dropped 0"  # pogobot_infrared_ll_init()
    rows = result.frame("messages.feather")
    assert rows["outcome"].value_counts().to_dict() == {
        "heard": 23 if faces == 1 else 13,
        "malformed": 4,
        "queue_full": 10 if faces == 1 else 20,
    }


def test_packet_with_the_header_of_a_short_message_arrives_as_one(tmp_path: Path) -> None:
    text = """#include "pogobase.h"
#include "slip.h"
extern const slip_send_descriptor_s slip_send_descriptor;
static void receive(message_t* message) {
    message_header_t const header = message->header;
    printf("%d %d %x %x %d %s\\n", header._packet_type, header._emitting_power_list, header._sender_id,
           header._sender_ir_index, header.payload_length, (char*)message->payload);
}
static void user_init(void) { msg_rx_fn = receive; }
static void user_step(void) {
    if (pogobot_helper_getid() == 0 && pogobot_ticks == 2) {
        short_message_t message = {.header = {._packet_type = ir_t_short, .payload_length = 2}, .payload = "a"};
        slip_send_message(&slip_send_descriptor, (uint8_t*)&message, sizeof(message_short_header_t) + 2);
    }
    if (pogobot_helper_getid() == 0 && pogobot_ticks == 4) {
        uint8_t text[2] = "b";
        pogobot_infrared_sendShortMessage_omni(text, 2);
    }
}
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
"""
    result = run(compile_text(tmp_path, text), tmp_path, {**PERFECT, "objects.robots.nb": 2})
    assert sorted(set(lines_of(result, 1))) == ["3 0 ff f 2 a", "3 0 ff f 2 b"]


def test_only_the_descriptor_of_the_emitters_is_simulated(tmp_path: Path) -> None:
    text = """#include "pogobase.h"
#include "slip.h"
static void user_step(void) {
    static slip_send_descriptor_s const own = {0, NULL};
    uint8_t byte = 1;
    slip_send_message(&own, &byte, 1);
}
int main(void) {
    pogobot_init();
    pogobot_start(NULL, user_step);
    return 0;
}
"""
    result = run(compile_text(tmp_path, text), tmp_path)
    assert result.code == 2
    assert "slip_send_message(): only the descriptor of the infrared emitters" in result.errors


def test_program_may_mute_its_robot_itself(tmp_path: Path) -> None:
    text = """#include "pogobase.h"
static void user_step(void) {
    uint8_t byte = 1;
    if (pogobot_ticks == 3) {
        _master_mute = 1;
        printf("%d %lu\\n", is_muted(), pogobot_infrared_sendShortMessage_omni(&byte, 1));
        _master_mute = 0;
        printf("%d %lu\\n", is_muted(), pogobot_infrared_sendShortMessage_omni(&byte, 1));
    }
}
int main(void) {
    pogobot_init();
    pogobot_start(NULL, user_step);
    return 0;
}
"""
    result = run(compile_text(tmp_path, text), tmp_path, {"objects.robots.nb": 1})
    assert lines_of(result, 0) == ["1 1", "0 0"]
