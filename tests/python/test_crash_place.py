"""Messages about failures name the line of the program by its debug information."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pogosim
import pytest
from project import made
from running import compile_program, compiler, run, write_scene
from test_template import project

__all__ = ["project"]

PROGRAM = """
#include "pogobase.h"
#include <assert.h>
#include <stdlib.h>
#include <string.h>

typedef struct { int ticks; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

POGO_SHARED int32_t failure = 0;
POGO_SHARED int32_t gain = 0;
POGO_SHARED int *volatile nothing;
POGO_SHARED void (*volatile bad_function)(void);
POGO_SHARED volatile int result;

__attribute__((noinline)) static void fail(int depth) {
    volatile char name[8] = "nobody";
    if (depth > 0) {
        fail(depth - 1);
        result++;
        return;
    }
    switch (failure) {
        case 0:
            *nothing = 3;  // write
            break;
        case 1:
            abort();  // abort
            break;
        case 2:
            assert(failure == 3);  // assert
            break;
        case 3:
            result = (int)strlen((char *)nothing);  // library
            break;
        case 4:
            bad_function();  // pointer
            result++;
            break;
        case 5:
            for (;;) {  // endless
            }
            break;
        case 6:
            exit(4);  // exit
            break;
        case 7:
            init_from_configuration(gain);  // refused
            break;
    }
    result += name[0];
}

static void user_init(void) { main_loop_hz = 60; }

static void user_step(void) {
    if (++mydata->ticks > 20 && pogobot_helper_getid() == 1) {
        fail(2);
        result++;
    }
}

static void global_setup(void) { init_from_configuration(failure); }

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    return 0;
}
"""
FAILURES = ["write", "abort", "assert", "library", "pointer", "endless", "exit", "refused"]


def written(file: Path, text: str) -> Path:
    file.write_text(text)
    return file


def line_of(mark: str, text: str = PROGRAM) -> int:
    return next(number for number, line in enumerate(text.splitlines(), 1) if line.endswith(f"// {mark}"))


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    made_programs: dict[tuple[str, ...], Path] = {}

    def compiled(*flags: str, compiler: str = "cc") -> Path:
        folder = tmp_path_factory.mktemp("crashes")
        source = written(folder / "crash.c", PROGRAM)
        key = (compiler, *flags)
        if key not in made_programs:
            made_programs[key] = compile_program(folder / "crash", source, compiler=compiler, flags=flags)
        return made_programs[key]

    return compiled


def failed(program: Path, folder: Path, failure: str, **settings: Any) -> str:
    """Run a program that fails in this way and return its message."""
    number = FAILURES.index(failure)
    result = run(
        program, folder, {"parameters.failure": number, "parameters.gain": 1e12, "user_code_timeout": 0.3, **settings}
    )
    assert result.code == {"exit": 4, "refused": 2}.get(failure, 3), result.text
    [message] = [line for line in result.errors.splitlines() if "[error]" in line]
    assert "user_step of robot #1" in message
    return message


@pytest.mark.parametrize("failure", FAILURES)
@pytest.mark.parametrize("name", ["gcc", "clang"])
def test_message_names_the_line(name: str, failure: str, program: Callable[..., Path], tmp_path: Path) -> None:
    if compiler(name) is None:
        pytest.skip(f"{name} is not installed")
    message = failed(program("-g", "-O0", compiler=name), tmp_path, failure)
    lines = {line_of(failure), line_of(failure) + (failure == "endless")}
    assert any(f"/crash.c:{line} in fail()" in message for line in lines), message


def test_message_without_debug_information_names_the_function(program: Callable[..., Path], tmp_path: Path) -> None:
    message = failed(program("-g0"), tmp_path, "write")
    assert ", t = 0.3200 s, in fail(): segmentation fault at address 0x0" in message


def test_message_about_a_program_without_symbols_names_the_robot(program: Callable[..., Path], tmp_path: Path) -> None:
    message = failed(program("-g", "-s"), tmp_path, "write")
    assert ", t = 0.3200 s: segmentation fault at address 0x0" in message


def test_several_threads_name_the_same_line(program: Callable[..., Path], tmp_path: Path) -> None:
    message = failed(program("-g"), tmp_path, "write", threads=2)
    assert f"/crash.c:{line_of('write')} in fail(): segmentation fault at address 0x0" in message


OVERWRITTEN = """
#include "pogobase.h"
#include <string.h>

typedef struct { int ticks; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

static void overwrite(void *volatile place, volatile int bytes) { memset(place, 0x5a, (size_t)bytes); }

__attribute__((noinline)) static int smash(void) {
    volatile char small[16];
    overwrite((void *)small, 400);
    return small[3];
}

static void user_step(void) { mydata->ticks += smash(); }
static void user_init(void) { main_loop_hz = 60; }
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
"""


def test_destroyed_stack_ends_the_run_all_the_same(tmp_path: Path) -> None:
    source = written(tmp_path / "smash.c", OVERWRITTEN)
    program = compile_program(tmp_path / "smash", source, flags=["-g", "-O0", "-fno-stack-protector"])
    result = run(program, tmp_path / "run", {})
    assert result.code == 3
    assert "segmentation fault" in result.errors
    assert "user_step of robot #0" in result.errors
    assert len(result.frame()) > 0


SDK = """
#include "pogobot.h"

static int count;
static int *volatile nothing;

static void look(void) {
    msleep(100);
    if (++count == 5 && pogobot_helper_getid() == 1) {
        *nothing = 1;  // write
    }
}

int main(void) {
    pogobot_init();
    for (;;) {
        look();
    }
}
"""


def test_line_of_a_program_for_the_sdk_after_waits(tmp_path: Path) -> None:
    source = written(tmp_path / "walk.c", SDK)
    program = compile_program(tmp_path / "walk", source, flags=["-g"], package="pogosim-sdk")
    result = run(program, tmp_path / "run", {"simulation_time": 1})
    assert result.code == 3
    place = f"/walk.c:{line_of('write', SDK)} in look(): segmentation fault at address 0x0. The"
    assert "t = 0.5000 s, at /" in result.errors
    assert place in result.errors
    assert "in C++" not in result.errors


def test_line_in_python(project: Path, tmp_path: Path) -> None:
    source = project / "main.c"
    source.write_text(PROGRAM)
    made(project)
    shared_object = next(project.glob("*.so"))
    scene = write_scene(tmp_path, {})
    simulation = pogosim.Simulation(shared_object, scene)
    with pytest.raises(pogosim.ProgramFailedError, match=rf"at main.c:{line_of('write')} in fail\(\): segmentation"):
        simulation.run()
    simulation = pogosim.Simulation(shared_object, scene)
    other = shared_object.read_bytes()
    shared_object.unlink()
    shared_object.write_bytes(other)  # built again in the meantime
    with pytest.raises(pogosim.ProgramFailedError, match=r"t = \S+ s: segmentation"):
        simulation.run()
