"""What functions and lines take: their own cycles, those with all that they call, and how often they are called."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

from pogosim.firmware.profile.raw import Line, Profile


@dataclass(frozen=True)
class FunctionCost:
    """What a function takes, in all ticks, in cycles of the clock with those that go by in the robots' library.

    Attributes:
        function: Place in Profile.functions.
        name: Its name.
        file: Source file with most of its cycles; "" if no line of it is known.
        own: Cycles of the function itself.
        total: Cycles with all that it calls, each once: a function that calls itself does not count them twice.
        calls: How often it was called.
        callers: How often by each function, by place in Profile.functions; most often first.
    """

    function: int
    name: str
    file: str
    own: float
    total: float
    calls: float
    callers: dict[int, float]


def total_cycles(profile: Profile) -> float:
    """Return what all stacks took, in cycles: of which functions have their shares."""
    return sum(profile.cost(stack) for stack in profile.stacks)


def function_costs(profile: Profile) -> list[FunctionCost]:
    """Return what each function on a stack takes; that with most cycles of its own first."""
    own: defaultdict[int, float] = defaultdict(float)
    total: defaultdict[int, float] = defaultdict(float)
    calls: defaultdict[int, float] = defaultdict(float)
    callers: defaultdict[int, defaultdict[int, float]] = defaultdict(lambda: defaultdict(float))
    for stack in profile.stacks:
        cost = profile.cost(stack)
        innermost = stack.frames[-1]
        own[innermost] += cost
        calls[innermost] += stack.calls
        for function in set(stack.frames):
            total[function] += cost
        if len(stack.frames) > 1:
            callers[innermost][stack.frames[-2]] += stack.calls
    files = files_of_functions(profile)
    found = [
        FunctionCost(
            function,
            profile.functions[function],
            files.get(function, ""),
            own[function],
            total[function],
            calls[function],
            dict(sorted(callers[function].items(), key=lambda caller: -caller[1])),
        )
        for function in total
    ]
    return sorted(found, key=lambda cost: (-cost.own, -cost.total, cost.name))


def files_of_functions(profile: Profile) -> dict[int, str]:
    """Return the source file that has most cycles of each function, by place in Profile.functions."""
    cycles: defaultdict[int, defaultdict[str, float]] = defaultdict(lambda: defaultdict(float))
    for line in profile.lines:
        if line.file:
            cycles[line.function][line.file] += line.cycles
    return {function: max(files, key=lambda file: files[file]) for function, files in cycles.items()}


def hottest_lines(profile: Profile) -> list[Line]:
    """Return the lines whose file is known, that with most cycles first."""
    known = [line for line in profile.lines if line.file and line.number > 0]
    return sorted(known, key=lambda line: (-line.cycles, line.file, line.number))


def functions_of_library(profile: Profile) -> frozenset[int]:
    """Return the functions of the robots' library that take time of the clock, by place in Profile.functions."""
    return frozenset(stack.frames[-1] for stack in profile.stacks if stack.call_us > 0)
