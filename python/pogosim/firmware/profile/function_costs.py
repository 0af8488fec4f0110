"""What functions of a program take, in YAML: the file of `function_costs`, by which a program in C takes time, too."""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import yaml

from pogosim.firmware.profile.costs import files_of_functions, functions_of_library
from pogosim.firmware.profile.raw import Profile, ProfileError, Stack
from pogosim.firmware.profile.routines import family_of
from pogosim.lines import counted

MAIN_LOOP = "pogo_main_loop_step"
DIGITS = 6  # significant ones, of a number in the file
USER_STEP = "user_step"
# What the main loop itself calls (pogosim/main_loop.c), besides the compiler's helpers.
OF_MAIN_LOOP = re.compile(
    r"__(?!Z).*|_?rand(?:om)?(?:_r)?|msleep|qualitative_colormap|mem(?:cpy|set)|pogobot_led_setColors"
    r"|pogobot_infrared_(?:update|message_available|recover_next_message|clear_message_queue)"
    r"|pogobot_stopwatch_(?:reset|get_elapsed_microseconds|offset_origin_microseconds)"
)
# What the linker adds to the names of static functions when it optimises the whole program.
SUFFIXES = re.compile(r"(?:\.(?:lto_priv|constprop|isra|part|cold)(?:\.\d+)?)+$")


@dataclass
class CallCost:
    """What the calls of a function took, with all that it calls.

    Attributes:
        cycles: Cycles that its code took, before the cycle factor of the robot model.
        library_us: Time in functions of the robots' library, us.
        calls: How often the main loop called it.
    """

    cycles: float = 0.0
    library_us: float = 0.0
    calls: float = 0.0


def costs_of_calls(profile: Profile) -> dict[str, CallCost]:
    """Return what the functions that the main loop calls took in all ticks, by name; the main loop itself comes first.

    Raises:
        ProfileError: The program has no main loop.
    """
    main_loop = place_of_main_loop(profile)
    helpers, library = helpers_of(profile, main_loop), library_of(profile)
    costs: defaultdict[str, CallCost] = defaultdict(CallCost)
    costs[MAIN_LOOP].calls = len(profile.ticks)
    if USER_STEP in profile.functions:
        costs[USER_STEP].calls = 0.0  # also if it does nothing
    for stack in profile.stacks:
        depth = depth_of_callee(stack, main_loop, helpers)
        is_called = depth < len(stack.frames) and stack.frames[depth] not in library
        cost = costs[name_in_program(profile.functions[stack.frames[depth]]) if is_called else MAIN_LOOP]
        cost.cycles += stack.cycles / profile.cycle_factor
        cost.library_us += stack.call_us
        cost.calls += stack.calls if is_called and depth == len(stack.frames) - 1 else 0
    for cost in costs.values():
        cost.calls = cost.calls or len(profile.ticks)  # inlined into the main loop, as only user_step may be
    return dict(costs)


def place_of_main_loop(profile: Profile) -> int:
    """Return the main loop's place in Profile.functions.

    Raises:
        ProfileError: There is none on a stack.
    """
    for stack in profile.stacks:
        for function in stack.frames:
            if profile.functions[function] == MAIN_LOOP:
                return function
    raise ProfileError(
        f"the program never calls {MAIN_LOOP}, the main loop that pogobot_start runs, so it has no costs by function"
    )


def helpers_of(profile: Profile, main_loop: int) -> frozenset[int]:
    """Return the functions of the main loop's source file, by place in Profile.functions."""
    files = files_of_functions(profile)
    file = files.get(main_loop)
    same_file = (function for function, name in files.items() if name == file)
    return frozenset({main_loop, *same_file})


def library_of(profile: Profile) -> frozenset[int]:
    """Return the functions that the main loop calls for itself, by place in Profile.functions."""
    return functions_of_library(profile) | frozenset(
        function
        for function, name in enumerate(profile.functions)
        if OF_MAIN_LOOP.fullmatch(name) is not None or family_of(name) is not None
    )


def depth_of_callee(stack: Stack, main_loop: int, helpers: frozenset[int]) -> int:
    """Return where on a stack the first function is that the main loop calls; the length of the stack if there is none.

    Code outside the main loop, before the first tick, counts as the main loop.
    """
    if main_loop not in stack.frames:
        return len(stack.frames)
    first = stack.frames.index(main_loop)
    return next((at for at in range(first, len(stack.frames)) if stack.frames[at] not in helpers), len(stack.frames))


def name_in_program(name: str) -> str:
    """Return the name of a function as the program's own compiler gives it: functions of one name share their costs."""
    return SUFFIXES.sub("", name)


def write_function_costs(profile: Profile, file: Path) -> None:
    """Write what each function takes, on average over its calls.

    Raises:
        ProfileError: The program has no main loop.
        OSError: It cannot be written.
    """
    mean = {
        name: {
            "cycles": float(f"{cost.cycles / cost.calls:.{DIGITS}g}"),
            "library_us": float(f"{cost.library_us / cost.calls:.{DIGITS}g}"),
        }
        for name, cost in costs_of_calls(profile).items()
    }
    text = yaml.safe_dump({"function_costs": mean}, sort_keys=False, allow_unicode=True)
    ticks = counted(len(profile.ticks), "tick")
    firmware = Path(profile.firmware).name
    file.write_text(f"# What a call takes on the robot: means over {ticks} of {firmware}.\n{text}", encoding="utf-8")
