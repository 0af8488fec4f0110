"""Signals end a run, whenever they come, with what there is of its data."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from running import Settings, compile_program, end, example, start, write_scene

Build = Callable[[str], Path]
END_SIGNALS = [
    "SIGINT",
    "SIGTERM",
    "SIGHUP",
    "SIGXCPU",
    "SIGUSR1",
    "SIGUSR2",
    "SIGQUIT",
]
LONG = {"simulation_time": 1.0e6, "save_data_period": 0.02}

PROGRAM = """
#define _GNU_SOURCE
#include "pogobase.h"
#include <pthread.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
typedef struct { int unused; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
POGO_SHARED int* volatile nowhere;
%s
int main(void) { pogobot_init(); pogobot_start(user_init, user_step); return 0; }
"""

# Each piece of the data file takes its time to reach the disk.
SLOW_DISK = """
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>
ssize_t pwrite(int descriptor, void const* data, size_t size, off_t position) {
    struct timespec left = {.tv_sec = 0};
    double const wait_s = atof(getenv("WRITE_TAKES_S"));
    left.tv_sec = (time_t)wait_s;
    left.tv_nsec = (long)((wait_s - (double)left.tv_sec) * 1e9);
    while (nanosleep(&left, &left) != 0 && errno == EINTR) {
    }
    ssize_t (*write_there)(int, void const*, size_t, off_t) = dlsym(RTLD_NEXT, "pwrite");
    return write_there(descriptor, data, size, position);
}
"""


@pytest.fixture
def build(tmp_path: Path) -> Build:
    def compile_text(text: str) -> Path:
        source = tmp_path / "main.c"
        source.write_text(PROGRAM % text)
        return compile_program(tmp_path / "main", source, flags=["-pthread"])

    return compile_text


def start_in(
    program: Path,
    folder: Path,
    settings: Settings,
    environment: Mapping[str, str] | None = None,
) -> subprocess.Popen[str]:
    write_scene(folder, settings)
    command = [str(program), "-c", "scene.yaml", "-g"]
    environment = {**os.environ, **(environment or {})}
    pipe = subprocess.PIPE
    return subprocess.Popen(command, cwd=folder, env=environment, stdout=pipe, stderr=pipe, text=True)


# ---- after a crash, while the data are saved ----


def slow_disk(folder: Path, write_takes_s: float) -> dict[str, str]:
    source, library = folder / "slow_disk.c", folder / "slow_disk.so"
    source.write_text(SLOW_DISK)
    subprocess.run(["cc", "-shared", "-fPIC", "-o", library, source], check=True)
    return {"LD_PRELOAD": str(library), "WRITE_TAKES_S": str(write_takes_s)}


def crash_after(code: str) -> str:
    return f"""
    void user_init(void) {{}}
    void user_step(void) {{
        if (pogobot_ticks == 20 && pogobot_helper_getid() == 1) {{ printf("crash\\n"); {code} *nowhere = 1; }}
    }}
    """


def crash_on_slow_disk(program: Path, folder: Path, write_takes_s: float) -> subprocess.Popen[str]:
    process = start_in(program, folder, {"save_data_period": 0.01}, slow_disk(folder, write_takes_s))
    assert process.stdout is not None
    assert "crash" in process.stdout.readline()
    time.sleep(0.2)
    return process


@pytest.mark.parametrize("name", ["SIGINT", "SIGUSR1"])
def test_signal_while_the_data_of_a_crashed_run_are_saved_loses_none(build: Build, tmp_path: Path, name: str) -> None:
    process = crash_on_slow_disk(build(crash_after("")), tmp_path, 0.5)
    process.send_signal(signal.Signals[name])
    result = end(process, tmp_path)
    assert result.code == 3
    assert "segmentation fault" in result.errors
    assert "could not be completed" not in result.errors
    assert result.frame()["time"].max() == pytest.approx(0.32, abs=0.011)


def test_thread_that_crashes_while_the_data_of_a_crashed_run_are_saved_loses_none(build: Build, tmp_path: Path) -> None:
    thread = "static void* crash_later(void* _) { usleep(200000); *nowhere = 1; return _; }\n"
    program = build(thread + crash_after("pthread_t t; pthread_create(&t, NULL, crash_later, NULL);"))
    result = end(crash_on_slow_disk(program, tmp_path, 0.5), tmp_path)
    assert result.code == 3
    assert "could not be completed" not in result.errors
    assert len(result.frame()) > 0


def test_data_of_a_crashed_run_are_saved_however_long_it_takes(build: Build, tmp_path: Path) -> None:
    program = build(crash_after('setenv("WRITE_TAKES_S", "6", 1);'))
    began_s = time.monotonic()
    result = end(crash_on_slow_disk(program, tmp_path, 0.0), tmp_path)
    assert time.monotonic() - began_s > 12
    assert (result.code, result.errors.count("\n")) == (3, 1)
    assert len(result.frame()) > 0


def test_crashed_run_whose_data_get_nowhere_ends_by_itself(build: Build, tmp_path: Path) -> None:
    program = build(crash_after('setenv("WRITE_TAKES_S", "1e6", 1);'))
    result = end(crash_on_slow_disk(program, tmp_path, 0.0), tmp_path)
    assert result.code == 3
    assert "segmentation fault" in result.errors
    assert "could not be completed; recover its rows with pogosim-recover" in result.errors


def test_crashed_run_that_hangs_after_its_data_are_saved_says_that_they_are(build: Build, tmp_path: Path) -> None:
    thread = "static void* lock_later(void* _) { usleep(500000); flockfile(stdout); sleep(1000); return _; }\n"
    start_thread = 'pthread_t t; pthread_create(&t, NULL, lock_later, NULL); printf("no end of line");'
    program = build(thread + crash_after(start_thread + 'setenv("WRITE_TAKES_S", "1", 1);'))
    result = end(crash_on_slow_disk(program, tmp_path, 0.0), tmp_path)
    assert result.code == 3
    assert "could not be completed" not in result.errors
    assert "The data file 'data.feather' is complete." in result.errors
    assert len(result.frame()) > 0


# ---- before the run ----


def with_usual_signals(folder: Path, simulated: Path | None = None) -> Path:
    """Return a program for a run that ignores no signals, though the process of the tests may ignore some."""
    program = folder / "program"
    program.write_text(f'#!/bin/sh\nexec env --default-signal "{simulated or example("helloworld")}" "$@"\n')
    program.chmod(0o755)
    return program


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGQUIT"])
def test_signal_before_the_run_ends_it_with_130_and_keeps_the_older_data(tmp_path: Path, name: str) -> None:
    os.mkfifo(tmp_path / "scene.yaml")  # nothing writes to it, so loading takes for ever
    (tmp_path / "data.feather").write_text("older")
    command = [str(with_usual_signals(tmp_path)), "-c", "scene.yaml", "-g"]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    time.sleep(0.5)
    process.send_signal(signal.Signals[name])
    result = end(process, tmp_path)
    assert result.code == 130
    assert name in result.errors
    assert result.errors.endswith(" before the first robot ran: this run has no data file.\n")
    assert (tmp_path / "data.feather").read_text() == "older"


@pytest.mark.parametrize("name", ["SIGTERM", "SIGQUIT"])
def test_signal_ends_a_constructor_that_never_returns(build: Build, tmp_path: Path, name: str) -> None:
    forever = "__attribute__((constructor)) static void hang(void) { for (;;) { pause(); } }\n"
    process = start(build(forever + crash_after("")), tmp_path)
    time.sleep(0.5)
    process.send_signal(signal.Signals[name])
    result = end(process, tmp_path)
    assert result.code == 130
    assert f"{name}" in result.errors
    assert "before main(), where constructors of static objects run: this run has no data file" in result.errors


# ---- during the run ----


@pytest.mark.parametrize("name", END_SIGNALS)
def test_signal_ends_a_run_with_130_and_complete_data(tmp_path: Path, name: str) -> None:
    process = start(with_usual_signals(tmp_path), tmp_path, LONG)
    time.sleep(1.0)
    process.send_signal(signal.Signals[name])
    result = end(process, tmp_path)
    assert result.code == 130
    assert "interrupted at t = " in result.errors
    assert len(result.frame()) > 0


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("SIGUSR1", "static void* set(void)"),
        ("SIGTERM", "static void* set(void)"),
        ("SIGQUIT", "__attribute__((constructor)) static void* set(void)"),
    ],
)
def test_program_that_handles_a_signal_itself_keeps_it(build: Build, tmp_path: Path, name: str, place: str) -> None:
    handling = f"""
    POGO_SHARED static volatile sig_atomic_t caught;
    static void note(int _) {{ caught = _; }}
    {place} {{ signal({name}, note); return NULL; }}
    void user_init(void) {{ if ({int("constructor" not in place)}) set(); }}
    void user_step(void) {{
        if (pogobot_helper_getid() == 0 && pogobot_ticks == 10) {{ raise({name}); printf("caught %d\\n", caught); }}
    }}
    """
    result = end(start(build(handling), tmp_path), tmp_path)
    assert (result.code, result.errors) == (0, "")
    assert result.robot_lines == [f"[ROBOT #0] [PRINTF] caught {signal.Signals[name].value}"]


@pytest.mark.parametrize("name", ["SIGHUP", "SIGUSR1"])
def test_signal_that_the_parent_process_ignores_stays_ignored(tmp_path: Path, name: str) -> None:
    number = signal.Signals[name]
    before = signal.signal(number, signal.SIG_IGN)
    try:
        process = start(example("helloworld"), tmp_path, {"simulation_time": 3000.0})
    finally:
        signal.signal(number, before)
    for _ in range(5):
        time.sleep(0.1)
        process.send_signal(number)
    result = end(process, tmp_path)
    assert (result.code, result.errors) == (0, "")


def start_blocked(program: Path, folder: Path, timeout_s: float) -> subprocess.Popen[str]:
    process = start(program, folder, {"user_code_timeout": timeout_s})
    assert process.stdout is not None
    assert "here it comes" in process.stdout.readline()
    return process


def test_time_that_a_step_has_after_a_signal_counts_from_its_start(build: Build, tmp_path: Path) -> None:
    steps = """
    void user_init(void) {}
    void user_step(void) { printf("here it comes\\n"); for (;;) { pause(); } }
    """
    process = start_blocked(build(steps), tmp_path, 8.0)
    time.sleep(7.0)
    process.send_signal(signal.SIGTERM)
    signalled_s = time.monotonic()
    result = end(process, tmp_path)
    assert result.code == 130
    assert time.monotonic() - signalled_s < 5.0


LIBRARY = """
#include <signal.h>
#include <time.h>
static void wait_until(clockid_t clock, double passed_s) {
    struct timespec t;
    clock_gettime(clock, &t);
    double const end_s = (double)t.tv_sec + (double)t.tv_nsec * 1e-9 + passed_s;
    while ((double)t.tv_sec + (double)t.tv_nsec * 1e-9 < end_s) {
        clock_gettime(clock, &t);
    }
}
void work(int signals, double processor_time_s) {
    for (int i = 0; i < signals; i++) {
        wait_until(CLOCK_MONOTONIC, 0.2);
        raise(SIGINT);
    }
    wait_until(CLOCK_THREAD_CPUTIME_ID, processor_time_s);
}
"""


@pytest.mark.parametrize(("signals", "processor_time_s"), [(0, 0.4), (2, 0.02)])
def test_step_that_does_not_return_is_left_outside_of_libraries(
    tmp_path: Path, signals: int, processor_time_s: float
) -> None:
    """A library may hold a lock, or have its memory in disorder, while it runs."""
    library, program = tmp_path / "libwork.so", tmp_path / "main.c"
    (tmp_path / "work.c").write_text(LIBRARY)
    subprocess.run(["cc", "-O1", "-shared", "-fPIC", "-o", library, tmp_path / "work.c"], check=True)
    steps = f"""
    void work(int signals, double processor_time_s);
    void user_init(void) {{}}
    void user_step(void) {{
        printf("enters");
        work({signals}, {processor_time_s});
        printf(" and leaves");
        for (;;) {{ (void)*(int volatile*)&nowhere; }}
    }}
    """
    program.write_text(PROGRAM % steps)
    flags = [f"-L{tmp_path}", f"-Wl,-rpath,{tmp_path}", "-Wl,--no-as-needed", "-lwork"]
    settings = {"user_code_timeout": 0.25 if signals == 0 else 0.0}
    result = end(start(compile_program(tmp_path / "main", program, flags=flags), tmp_path, settings), tmp_path)
    assert result.code == (3 if signals == 0 else 130)
    assert result.robot_lines == ["[ROBOT #0] [PRINTF] enters and leaves"]


def test_many_short_steps_are_not_one_long_one(build: Build, tmp_path: Path) -> None:
    steps = """
    #include <time.h>
    static double own_s(void) {
        struct timespec t;
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
        return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
    }
    void user_init(void) {}
    void user_step(void) { for (double const end_s = own_s() + 0.005; own_s() < end_s;) { } }
    """
    settings = {"user_code_timeout": 0.1, "simulation_time": 1.0}
    result = end(start(build(steps), tmp_path, settings), tmp_path)
    assert (result.code, result.errors) == (0, "")


def test_simulator_that_waits_for_a_lock_which_a_crashed_thread_holds_ends_by_itself(
    build: Build, tmp_path: Path
) -> None:
    steps = """
    static void* crash_with_lock(void* _) { flockfile(stdout); sleep(4); *nowhere = 1; return _; }
    void user_init(void) {
        pthread_t thread;
        if (pogobot_helper_getid() == 0) { pthread_create(&thread, NULL, crash_with_lock, NULL); }
    }
    void user_step(void) {}
    """
    result = end(start(build(steps), tmp_path, LONG), tmp_path)
    assert result.code == 3
    assert "pogosim: the user program failed in a thread that it started: segmentation fault" in result.errors
    assert "could not be completed; recover its rows with pogosim-recover" in result.errors


# ---- in a child ----


@pytest.mark.parametrize(
    "name",
    ["SIGINT", "SIGUSR1", "SIGALRM", "SIGPROF", "SIGXFSZ", "SIGSEGV"],
)
def test_signal_has_its_usual_effect_on_a_child_of_the_program(build: Build, tmp_path: Path, name: str) -> None:
    steps = """
    void user_init(void) {}
    void user_step(void) {
        if (pogobot_ticks == 5 && pogobot_helper_getid() == 0) {
            int status = 0;
            pid_t const child = fork();
            if (child == 0) { raise(%s); _exit(1); }
            waitpid(child, &status, 0);
            printf("by %%d\\n", WIFSIGNALED(status) ? WTERMSIG(status) : 0);
        }
    }
    """
    result = end(start(with_usual_signals(tmp_path, build(steps % name)), tmp_path), tmp_path)
    assert (result.code, result.errors) == (0, "")
    assert result.robot_lines == [f"[ROBOT #0] [PRINTF] by {signal.Signals[name].value}"]


def test_child_keeps_the_handlers_of_the_program(build: Build, tmp_path: Path) -> None:
    steps = """
    static void leave(int _) { _exit(42 + 0 * _); }
    void user_init(void) { signal(SIGUSR1, leave); }
    void user_step(void) {
        if (pogobot_ticks == 5 && pogobot_helper_getid() == 0) {
            int status = 0;
            pid_t const child = fork();
            if (child == 0) { raise(SIGUSR1); _exit(1); }
            waitpid(child, &status, 0);
            printf("with %d\\n", WEXITSTATUS(status));
        }
    }
    """
    result = end(start(build(steps), tmp_path), tmp_path)
    assert (result.code, result.errors) == (0, "")
    assert result.robot_lines == ["[ROBOT #0] [PRINTF] with 42"]


# ---- after the run ----


@pytest.mark.parametrize("place", ["destructor", "constructor"])
def test_signal_ends_an_exit_handler_that_never_returns(build: Build, tmp_path: Path, place: str) -> None:
    forever = "static void hang(void) { for (;;) { pause(); } }\n"
    register = {
        "destructor": "__attribute__((destructor)) static void last(void) { hang(); }\n",
        "constructor": "__attribute__((constructor)) static void first(void) { atexit(hang); }\n",
    }
    steps = "void user_init(void) {}\nvoid user_step(void) {}\n"
    process = start(build(forever + register[place] + steps), tmp_path)
    time.sleep(1.5)
    process.send_signal(signal.SIGTERM)
    result = end(process, tmp_path)
    assert result.code == 130
    assert result.errors == (
        "pogosim: SIGTERM after the run, while destructors of static objects and exit handlers ran. "
        "The data file 'data.feather' is complete.\n"
    )
    assert len(result.frame()) == 63


# ---- a console file that is a pipe ----


def test_console_file_that_is_a_pipe_without_a_reader_is_refused(
    tmp_path: Path,
) -> None:
    os.mkfifo(tmp_path / "console")
    settings = {"console_filename": "console", "enable_console_logging": True}
    result = end(start(example("helloworld"), tmp_path, settings), tmp_path)
    assert result.code == 2
    assert "cannot open the console file 'console' (console_filename): it is a pipe without a reader" in result.errors


def test_console_file_may_be_a_pipe_with_a_reader(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "console")
    reader = subprocess.Popen(["cat", "console"], cwd=tmp_path, stdout=subprocess.PIPE, text=True)
    settings = {"console_filename": "console", "enable_console_logging": True}
    result = end(start(example("helloworld"), tmp_path, settings), tmp_path)
    assert (result.code, result.errors) == (0, "")
    assert "[ROBOT #0]" in reader.communicate(timeout=10)[0]


# ---- processor time ----


def test_limit_of_a_step_counts_the_processor_time_of_its_own_thread(build: Build, tmp_path: Path) -> None:
    busy = """
    #include <time.h>
    static void* spin(void* _) { for (volatile unsigned long n = 0;; n++) { } return _; }
    static double own_s(void) {
        struct timespec t;
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
        return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
    }
    void user_init(void) {
        pthread_t thread;
        for (int i = 0; i < 4 && pogobot_helper_getid() == 0; i++) { pthread_create(&thread, NULL, spin, NULL); }
    }
    void user_step(void) {
        double const end_s = own_s() + (pogobot_ticks == 5 && pogobot_helper_getid() == 0 ? 0.3 : 0.0);
        while (own_s() < end_s) { }
    }
    """
    settings = {"user_code_timeout": 0.5, "simulation_time": 0.2}
    result = end(start(build(busy), tmp_path, settings), tmp_path)
    assert (result.code, result.errors) == (0, "")


def test_alarm_that_the_program_does_not_handle_is_told(build: Build, tmp_path: Path) -> None:
    program = build("void user_init(void) { alarm(1); }\nvoid user_step(void) { usleep(10); }")
    result = end(start_in(program, tmp_path, {**LONG, "GUI_speed_up": 1.0}), tmp_path)
    assert result.code == -signal.SIGALRM
    assert "Error: ended by an alarm that the program or its host has set (alarm(), " in result.errors
