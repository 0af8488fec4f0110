"""Profiles of firmware as the simulator writes them, made of call paths and ticks."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

CLOCK_HZ = 21_000_000
LOOP_HZ = 60
BUDGET_CYCLES = CLOCK_HZ / LOOP_HZ

Path_ = tuple[str, ...]  # functions, outermost first


def raw_profile(
    stacks: Mapping[Path_, tuple[float, float, float]],
    lines: Sequence[tuple[str, str, int, float, float]] = (),
    ticks: Sequence[tuple[float, float]] | None = None,
    **more: Any,
) -> dict[str, Any]:
    """Return a profile.

    Args:
        stacks: Own cycles, us in the robots' library and calls of each call path.
        lines: Function, file, line, cycles and instructions.
        ticks: Cycles and us in the library of each tick of robot 0; None: one tick with all of the stacks.
        more: Other values of the file.
    """
    names = list(dict.fromkeys([name for path in stacks for name in path] + [line[0] for line in lines]))
    if ticks is None:
        ticks = [(sum(cost[0] for cost in stacks.values()), sum(cost[1] for cost in stacks.values()))]
    return {
        "version": 1,
        "firmware": "/nowhere/swarm/build/emu/firmware.elf",
        "clock_hz": CLOCK_HZ,
        "cycle_factor": 1.0,
        "loop_hz": LOOP_HZ,
        "memory_bytes": 131072,
        "program_bytes": 13040,
        "variable_bytes": 64,
        "deepest_stack_bytes": 712,
        "heap_bytes": 0,
        "robots": [{"id": 0, "category": "robots"}],
        "ticks": [
            {"robot": 0, "tick": number, "begin_s": 0.016 * number, "cycles": cycles, "call_us": call_us}
            for number, (cycles, call_us) in enumerate(ticks)
        ],
        "functions": names,
        "lines": [
            {"function": names.index(name), "file": file, "line": line, "cycles": cycles, "instructions": instructions}
            for name, file, line, cycles, instructions in lines
        ],
        "stacks": [
            {"frames": [names.index(name) for name in path], "cycles": cycles, "call_us": call_us, "calls": calls}
            for path, (cycles, call_us, calls) in stacks.items()
        ],
        "spans": [],
        **more,
    }


def write_profile(file: Path, values: object) -> Path:
    """Write a profile, or something else, as JSON."""
    file.write_text(json.dumps(values), encoding="utf-8")
    return file


# A program that computes with doubles. Its ten ticks have 100000 cycles each, and spend 1 ms in all in the library.
MAIN = ("main", "pogobot_start")
STEP = (*MAIN, "user_step")
SWARM_STACKS = {
    ("main",): (0, 0, 0),
    MAIN: (20_000, 0, 0),
    STEP: (380_000, 0, 10),
    (*STEP, "__muldf3"): (200_000, 0, 150),
    (*STEP, "sqrt"): (300_000, 0, 100),
    (*STEP, "sqrt", "__adddf3"): (50_000, 0, 100),
    (*STEP, "pogobot_led_setColor"): (10_000, 1000, 10),
    (*STEP, "printf"): (15_000, 0, 10),
    (*STEP, "printf", "vfprintf"): (25_000, 0, 10),
}
SWARM_LINES = [
    ("user_step", "main.c", 2, 300_000, 60_000),
    ("user_step", "main.c", 4, 80_000, 20_000),
    ("sqrt", "", 0, 300_000, 100_000),
]
SWARM_SOURCE = """void user_step(void) {
    double distance = sqrt(x * x + y * y); // sin(x) would do
    // sqrt(2)
    total = 0.5 * distance;
}
"""


def swarm_profile(**more: Any) -> dict[str, Any]:
    """Return the profile of that program."""
    return raw_profile(SWARM_STACKS, SWARM_LINES, [(100_000, 100)] * 10, **more)
