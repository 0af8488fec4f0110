"""What the simulator counts for `pogosim profile`, against cycles that are known."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from firmwares import firmware_of, run_firmware

LOOP_CYCLES = 3  # an addition, and a branch backwards that is taken
MISS_CYCLES = 18
PROGRAM = """#include "pogobase.h"
#include <stdlib.h>
#include <string.h>
typedef struct { double value; uint32_t depth; } USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)
__attribute__((noinline, noipa)) static void work(uint32_t n) {
    asm volatile("1: addi %0, %0, -1\\n bnez %0, 1b" : "+r"(n));
}
__attribute__((noinline, noipa)) static uint32_t deeper(uint32_t n) {
    volatile char room[500];
    room[n] = 1;
    return n == 0 ? 0 : deeper(n - 1) + (uint32_t)room[n];
}
static inline __attribute__((always_inline)) void inlined(void) { work(500); }
void user_init(void) { memset(malloc(3000), 1, 3000); }
void user_step(void) {
    float a[3], g[3];
    work(1000);
    inlined();
    mydata->depth = deeper(3);
    mydata->value *= 1.5;
    pogobot_imu_read(a, g);
}
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
"""


@pytest.fixture(scope="module")
def profile(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("profile")
    result = run_firmware(firmware_of(folder, PROGRAM), folder, {}, ["--profile", "profile.json"])
    assert result.code == 0, result.text
    found: dict[str, Any] = json.loads((folder / "profile.json").read_text())
    return found


def stacks_ending_with(profile: dict[str, Any], *names: str) -> list[dict[str, Any]]:
    functions = profile["functions"]
    return [
        stack
        for stack in profile["stacks"]
        if [functions[frame] for frame in stack["frames"]][-len(names) :] == list(names)
    ]


def test_each_cycle_of_a_tick_counts_once(profile: dict[str, Any]) -> None:
    of_ticks = sum(tick["cycles"] for tick in profile["ticks"])
    assert of_ticks == sum(stack["cycles"] for stack in profile["stacks"])
    assert of_ticks == sum(line["cycles"] for line in profile["lines"])
    assert sum(tick["call_us"] for tick in profile["ticks"]) == pytest.approx(
        sum(stack["call_us"] for stack in profile["stacks"])
    )
    assert [tick["tick"] for tick in profile["ticks"]] == list(range(len(profile["ticks"])))
    assert len(profile["ticks"]) > 100


def test_loop_takes_its_cycles_in_its_function(profile: dict[str, Any]) -> None:
    ticks = len(profile["ticks"])
    calls = stacks_ending_with(profile, "work")
    assert sum(stack["calls"] for stack in calls) == 2 * ticks
    # Besides, each call may find its lines pushed out of the instruction cache.
    assert sum(stack["cycles"] for stack in calls) / ticks == pytest.approx(
        LOOP_CYCLES * 1500, abs=20 + 2 * 3 * MISS_CYCLES
    )


def test_waiting_for_code_is_counted(profile: dict[str, Any]) -> None:
    for tick in profile["ticks"]:
        assert tick["miss_cycles"] % MISS_CYCLES == 0
        assert 0 < tick["miss_cycles"] < tick["cycles"]


def test_function_that_was_inlined_is_a_frame(profile: dict[str, Any]) -> None:
    (call,) = stacks_ending_with(profile, "inlined", "work")
    assert call["cycles"] / len(profile["ticks"]) == pytest.approx(LOOP_CYCLES * 500, abs=10)


def test_recursion_is_a_path_for_each_depth(profile: dict[str, Any]) -> None:
    for depth in range(1, 5):
        (call,) = stacks_ending_with(profile, "user_step", *["deeper"] * depth)
        assert call["calls"] == len(profile["ticks"])
    assert stacks_ending_with(profile, *["deeper"] * 5) == []


def test_library_takes_its_time_where_it_is_called(profile: dict[str, Any]) -> None:
    (call,) = stacks_ending_with(profile, "user_step", "pogobot_imu_read")
    assert call["call_us"] / len(profile["ticks"]) == pytest.approx(150)
    assert stacks_ending_with(profile, "user_step", "__muldf3")


def test_memory_is_measured(profile: dict[str, Any]) -> None:
    assert 4 * 500 < profile["deepest_stack_bytes"] < 4 * 500 + 600
    assert 3000 <= profile["heap_bytes"] < 3200
    assert 20 * 1024 > profile["program_bytes"] > 10 * 1024
    assert profile["memory_bytes"] == 128 * 1024
    assert (profile["clock_hz"], profile["loop_hz"]) == (21_000_000, 60)


def test_profile_changes_nothing(tmp_path: Path) -> None:
    firmware = firmware_of(tmp_path, PROGRAM)
    counted = {"objects.robots.cpu_time": "counted"}
    plain = run_firmware(firmware, tmp_path / "plain", counted).frame()
    assert plain.equals(run_firmware(firmware, tmp_path / "profiled", {}, ["--profile", "p.json"]).frame())


def test_what_cannot_be_profiled_is_one_line(tmp_path: Path) -> None:
    firmware = firmware_of(tmp_path, PROGRAM)
    result = run_firmware(firmware, tmp_path, {}, ["--profile", "absent/profile.json"])
    assert result.code == 2
    assert "cannot write the profile absent/profile.json" in result.text
    scripted = run_firmware(firmware, tmp_path, {"objects.robots.brain": {"script": []}}, ["--profile", "p.json"])
    assert scripted.code == 2
    assert "--profile: no robot of the configuration runs firmware" in scripted.text
