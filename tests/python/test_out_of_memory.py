"""Too little memory is said in words: for what, and how much. Memory is limited as with `ulimit -v`."""

from __future__ import annotations

import re
import resource
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest
from conftest import Compile
from running import Run, compile_program, example, ran, run, write_scene

pytestmark = pytest.mark.skipif(sys.platform == "darwin", reason="macOS has no limit of address space")

MIB = 1 << 20
ADVICE = "reduce it, or raise this run's memory limit (ulimit -v, or the batch system's)"


def limited(program: Path, folder: Path, settings: Mapping[str, object], kind: int, most: int) -> Run:
    """Run a program with a limit on a resource."""
    write_scene(folder, settings)

    def limit() -> None:
        resource.setrlimit(kind, (most, most))

    command = [str(program), "-c", "scene.yaml", "-g"]
    return ran(folder, *command, preexec_fn=limit)


@pytest.fixture(scope="module")
def needed(tmp_path_factory: pytest.TempPathFactory) -> int:
    """Return the address space that a small run needs, MiB, rounded up to a few."""
    folder = tmp_path_factory.mktemp("needed")
    for mib in range(64, 4096, 8):
        if limited(example("helloworld"), folder, {"simulation_time": 0.1}, resource.RLIMIT_AS, mib * MIB).code == 0:
            return mib
    raise AssertionError("no limit is enough")


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (
            {"light_map_nb_bin_x": 10000, "light_map_nb_bin_y": 10000},
            "the light map: 10000 x 10000 cells of 2 bytes, 190.7 MiB",
        ),
        (
            {"objects.robots.nb": 2000, "objects.robots.message_queue_size": 1000, "arena_surface": 4e8},
            "the message queues (message_queue_size) of 2000 robots: 2000000 messages of 390 bytes, 743.9 MiB",
        ),
    ],
)
def test_large_part_of_the_world_that_does_not_fit_is_named_with_its_size(
    tmp_path: Path, needed: int, settings: dict[str, object], message: str
) -> None:
    result = limited(example("helloworld"), tmp_path, settings, resource.RLIMIT_AS, (needed + 64) * MIB)
    assert (result.code, result.errors) == (2, f"Error: not enough memory for {message}; {ADVICE}\n")


@pytest.mark.parametrize(
    ("size", "message"),
    [
        ("1L << 46", "70368744177664 bytes each, 256.0 TiB"),
        ("1L << 62", "4611686018427387904 bytes each, 16.0 EiB"),
    ],
)
def test_user_data_that_no_machine_has_room_for_are_named_with_their_size(
    tmp_path: Path, size: str, message: str
) -> None:
    source = tmp_path / "main.c"
    source.write_text(
        f'#include "pogobase.h"\ntypedef struct {{ char all[{size}]; }} USERDATA;\nDECLARE_USERDATA(USERDATA);\n'
        "REGISTER_USERDATA(USERDATA);\nint main(void) { return 0; }\n"
    )
    result = run(compile_program(tmp_path / "main", source), tmp_path)
    assert result.code == 2
    assert (
        f"Error: not enough memory for the user data (USERDATA) of 3 robots and the global step, {message}; {ADVICE}"
        in result.errors
    )


def test_run_ends_well_or_says_that_memory_is_short_whatever_the_limit(tmp_path: Path, needed: int) -> None:
    settings = {"objects.robots.nb": 3000, "arena_surface": 4e7, "simulation_time": 0.2}

    def code(kib: int) -> int:
        result = limited(example("hanabi"), tmp_path, settings, resource.RLIMIT_AS, kib << 10)
        assert result.code in (0, 2), (kib, result.text)
        assert (result.code == 2) == ("not enough memory" in result.errors), (kib, result.text)
        # A library that Arrow brings along says by itself that it gets no thread.
        ours = re.sub(r"(?m)^<jemalloc>.*\n", "", result.text)
        assert not re.search("bad_alloc|length_error|malloc|_M_", ours), result.text
        return result.code

    codes = {kib: code(kib) for mib in (*range(0, 24, 2), *range(24, 120, 12)) for kib in [needed + mib << 10]}
    enough = min(kib for kib in codes if codes[kib] == 0)
    assert enough > min(codes)
    # The last allocations before it is enough are those of the physics and of the first step.
    for kib in range(enough - 2048, enough, 48):
        code(kib)


def test_exception_of_new_in_a_program_is_named_without_the_library_s_words(tmp_path: Path) -> None:
    source = tmp_path / "main.cpp"
    source.write_text(
        '#include <vector>\n#include "pogobase.h"\nsize_t volatile much = size_t{1} << 60U;\n'
        "static void step() { std::vector<char> all(much); }\n"
        "int main() { pogobot_init(); pogobot_start(nullptr, step); return 0; }\n"
    )
    result = run(compile_program(tmp_path / "main", source, compiler="g++"), tmp_path)
    assert result.code == 3
    assert "in user_step of robot #0" in result.errors
    assert "C++ exception: not enough memory; " in result.errors
    assert "bad_alloc" not in result.errors


@pytest.mark.parametrize("kib", [64, 128, 256])
def test_run_on_a_small_stack_ends_well_or_names_the_stack(tmp_path: Path, kib: int) -> None:
    result = limited(example("hanabi"), tmp_path, {}, resource.RLIMIT_STACK, kib << 10)
    if result.code != 0:
        assert kib < 256
        assert result.code == 3
        assert re.search(r"stack overflow: the \d+ KiB of the stack are full \(ulimit -s\)", result.errors)


def test_overflow_of_a_small_stack_is_named(program: Compile, tmp_path: Path) -> None:
    settings = {"parameters": {"kind": "overflow_the_stack", "place": "user_step"}, "robot_stack_size": 64}
    result = run(program("misbehave.c"), tmp_path, settings)
    assert result.code == 3
    assert "in user_step of robot #1 of category 'robots', tick 10" in result.errors
    assert "stack overflow: the 64 KiB of the stack are full (robot_stack_size)" in result.errors
