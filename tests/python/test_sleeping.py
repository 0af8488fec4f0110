"""msleep(), usleep() and sleep() take the robot's time, as the functions of these names do on robots."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
from running import compile_program, compile_text, run
from test_headers import C_COMPILERS, CPP_COMPILERS

# The call, and the time that it takes by the robot's clock, us.
SLEEPS = {
    "msleep(250)": 250_000,
    "msleep(0)": 0,
    "msleep(-5)": 0,
    "msleep(INT32_MIN)": 0,
    "usleep(1500)": 1500,
    "usleep(0)": 0,
    "usleep(-5)": 0,
    "usleep(INT32_MIN)": 0,
    "usleep(3000000000u)": 0,  # negative as an int
    "usleep((unsigned)-1)": 0,
    "sleep(2)": 2_000_000,
    "sleep(0)": 0,
    "sleep(-1)": 0,
    "sleep((int)0.9)": 0,
    "sleep(INT32_MIN)": 0,
    "usleep(INT32_MAX)": 2_147_483_647,
    "msleep(INT32_MAX)": 2_147_483_647,  # more than the stopwatch can show
    "sleep(INT32_MAX)": 2_147_483_647,
}
LONGER = "pogobot_stopwatch_get_elapsed_microseconds(): the time to return"  # each slip is told once
TEXT = """#include "pogobase.h"
#include <unistd.h>
void user_init(void) {
    time_reference_t watch;
%s}
int main(void) { pogobot_init(); pogobot_start(user_init, NULL); return 0; }
"""
CALL = """    pogobot_stopwatch_reset(&watch);
    %s;
    printf("%%d\\n", (int)pogobot_stopwatch_get_elapsed_microseconds(&watch));
"""


def test_arguments_are_those_of_the_robot(tmp_path: Path) -> None:
    text = TEXT % "".join(CALL % call for call in SLEEPS)
    result = run(compile_text(tmp_path, text), tmp_path / "run", {"objects.robots.nb": 1, "simulation_time": 0.1})
    assert result.code == 0
    said = [line.split("0.0000 s: ")[1].split(" is ")[0] for line in result.errors.splitlines()]
    assert said == ["msleep(): milliseconds", "usleep(): microseconds", "sleep(): seconds", LONGER]
    times = [int(line.rsplit(" ", 1)[1]) for line in result.robot_lines]
    assert dict(zip(SLEEPS, times, strict=True)) == SLEEPS


def test_endless_loop_of_long_sleeps_in_a_callback_meets_its_limit(tmp_path: Path) -> None:
    text = TEXT % "    (void)watch; for (;;) { sleep(INT32_MAX); }\n"
    result = run(compile_text(tmp_path, text), tmp_path / "run", {"user_code_timeout": 0.3})
    assert result.code == 3
    assert "user_init of robot #0" in result.errors
    assert "did not return within 0.3 s of processor time" in result.errors


ORDERS = {
    "ours first": '#include "pogobase.h"\n#include <unistd.h>\n',
    "theirs first": '#include <unistd.h>\n#include "pogobase.h"\n',
}
ORDERS["ours alone"] = '#include "pogobase.h"\n'
ORDERS["of the SDK"] = '#include "pogobot.h"\n#include <unistd.h>\n'


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("name", [*C_COMPILERS, *CPP_COMPILERS])
def test_robot_sleeps_whatever_headers_are_included(name: str, order: str, tmp_path: Path) -> None:
    language = "cpp" if name in CPP_COMPILERS else "c"
    is_sdk = "pogobot.h" in ORDERS[order]
    start = "" if is_sdk else "pogobot_start(NULL, work); "
    loop = "for (;;) { work(); }" if is_sdk else "return 0;"
    text = f"""{ORDERS[order]}static void work(void) {{
    sleep(3);
    usleep(500000);
    pogobot_motor_set(motorL, 500);
    printf("%lu\\n", (unsigned long)(sleep(0) + (unsigned)usleep(0)));
}}
int main(void) {{ pogobot_init(); {start}{loop} }}
"""
    source = tmp_path / f"main.{language}"
    source.write_text(text)
    package = "pogosim-sdk" if is_sdk else "pogosim"
    flags = ["-Wall", "-Wextra", "-Werror", *(["-x", "c++"] if language == "cpp" else ["-std=gnu11"])]
    prog = compile_program(tmp_path / "prog", source, compiler=name, flags=flags, package=package)
    result = run(prog, tmp_path / "run", {"objects.robots.nb": 1, "simulation_time": 9.0, "save_data_period": 0.5})
    assert result.code == 0, result.text
    lines = [line for line in result.robot_lines if "[TIME]" not in line]
    assert lines == ["[ROBOT #0] [PRINTF] 0"] * 2, "after 3.5 s and 7 s"


def test_file_of_a_program_may_have_its_own_sleep(tmp_path: Path) -> None:
    helper = tmp_path / "helper.c"
    helper.write_text("int calls;\nvoid sleep(int ms) { calls += ms; }\nint nap(void) { sleep(5); return calls; }\n")
    main = tmp_path / "main.c"
    main.write_text(
        '#include "pogobase.h"\nint nap(void);\nvoid user_init(void) { printf("%d\\n", nap()); }\n'
        "int main(void) { pogobot_init(); pogobot_start(user_init, NULL); return 0; }\n"
    )
    prog = compile_program(tmp_path / "prog", main, helper)
    assert run(prog, tmp_path / "run", {"objects.robots.nb": 1}).robot_lines == ["[ROBOT #0] [PRINTF] 5"]


def test_threads_of_a_program_sleep_in_their_own_time(tmp_path: Path) -> None:
    text = """#include "pogobase.h"
#include <pthread.h>
#include <unistd.h>
static void* nap(void* unused) { usleep(-5); sleep(-1); usleep(200000); return unused; }
void user_init(void) {
    pthread_t thread;
    pthread_create(&thread, NULL, nap, NULL);
    pthread_join(thread, NULL);
    puts("done");
}
int main(void) { pogobot_init(); pogobot_start(user_init, NULL); return 0; }
"""
    program = compile_text(tmp_path, text)
    began = time.monotonic()
    result = run(program, tmp_path / "run", {"objects.robots.nb": 1, "simulation_time": 0.1})
    assert result.robot_lines == ["[ROBOT #0] [PRINTF] done"]
    assert time.monotonic() - began > 0.2


def test_child_of_a_program_sleeps_in_its_own_time(tmp_path: Path) -> None:
    text = """#include "pogobase.h"
#include <sys/wait.h>
#include <unistd.h>
void user_init(void) {
    pid_t const child = fork();
    if (child == 0) { sleep(0); usleep(200000); _exit(7); }
    int status = 0;
    waitpid(child, &status, 0);
    printf("child %d\\n", WEXITSTATUS(status));
}
int main(void) { pogobot_init(); pogobot_start(user_init, NULL); return 0; }
"""
    began = time.monotonic()
    result = run(compile_text(tmp_path, text), tmp_path / "run", {"objects.robots.nb": 1, "simulation_time": 0.1})
    assert result.robot_lines == ["[ROBOT #0] [PRINTF] child 7"]
    assert time.monotonic() - began > 0.2


# Statements, and what they print: times in us by the robot's clock, which stands still in between.
TIMERS = {
    "pogobot_timer_init(&t, 5000); show(left(&t))": 5000,
    "pogobot_timer_init(&t, -5000); show(left(&t))": -5000,
    "pogobot_timer_init(&t, INT32_MAX); show(left(&t))": 2**31 - 1,
    "pogobot_timer_init(&t, INT32_MIN); show(left(&t))": -(2**31),
    "pogobot_timer_init(&t, -1); show(pogobot_timer_has_expired(&t))": 1,
    "pogobot_timer_init(&t, 1); show(pogobot_timer_has_expired(&t))": 0,
    "pogobot_timer_init(&t, 1); usleep(2); show(pogobot_timer_has_expired(&t))": 1,
    "start(&w); pogobot_timer_init(&t, 300); pogobot_timer_wait_for_expiry(&t); show(elapsed(&w))": 300,
    "start(&w); pogobot_timer_init(&t, -9); pogobot_timer_wait_for_expiry(&t); show(elapsed(&w))": 0,
    "start(&w); pogobot_stopwatch_offset_origin_microseconds(&w, 700); show(elapsed(&w))": -700,
    "start(&w); pogobot_stopwatch_offset_origin_microseconds(&w, -700); show(elapsed(&w))": 700,
    "start(&w); msleep(3); show(pogobot_stopwatch_lap(&w))": 3000,
    "start(&w); msleep(3); pogobot_stopwatch_lap(&w); show(elapsed(&w))": 0,
    "pogobot_timer_init(&t, 0); pogobot_timer_offset_origin_microseconds(&t, 250); show(left(&t))": 250,
}


def test_timers_take_zero_negative_and_large_times(tmp_path: Path) -> None:
    text = """#include "pogobase.h"
#define start pogobot_stopwatch_reset
#define elapsed pogobot_stopwatch_get_elapsed_microseconds
#define left pogobot_timer_get_remaining_microseconds
static void show(int32_t number) { printf("%%ld\\n", (long)number); }
void user_init(void) {
    time_reference_t t, w;
    pogobot_stopwatch_reset(&w);
    pogobot_stopwatch_reset(&t);
%s}
int main(void) { pogobot_init(); pogobot_start(user_init, NULL); return 0; }
"""
    program = compile_text(tmp_path, text % "".join(f"    {statements};\n" for statements in TIMERS))
    result = run(program, tmp_path / "run", {"objects.robots.nb": 1, "simulation_time": 0.1})
    assert (result.code, result.errors) == (0, "")
    numbers = [int(line.rsplit(" ", 1)[1]) for line in result.robot_lines]
    assert dict(zip(TIMERS, numbers, strict=True)) == TIMERS
