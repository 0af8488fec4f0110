"""What to change in a program, for the largest shares of a tick: one table of rules.

How much faster the other way is was measured on the emulated processor with Debian 12's compiler and picolibc 1.8, in
cycles per call, double and float: addition 470 and 310, multiplication 1390 and 600, division 1660 and 630, sqrt 2750
and 410, sin 21100 and 10800, exp 22000 and 11000, pow 77600 and 39400; division of 64 and 32 bits: 490 and 38.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from pogosim.firmware.profile import routines
from pogosim.firmware.profile.costs import hottest_lines, total_cycles
from pogosim.firmware.profile.load import load_of
from pogosim.firmware.profile.numbers import percent, ticks_per_second
from pogosim.firmware.profile.raw import Profile
from pogosim.firmware.profile.routines import Family, family_of, name_in_source, pattern_in_source
from pogosim.firmware.profile.sources import Sources, shown_place

LEAST_SHARE = 0.05  # of the tick, for advice
LEAST_SHARE_OF_MISSES = 0.2  # less is usual
CYCLES_OF_DIVISION = 10.0  # per instruction, from which a line waits for divisions or multiplications
POWER_OF_TWO = re.compile(r"[/%]\s*(\d+)[uUlL]*\b(?!\s*[.eE]|\.)")


@dataclass(frozen=True)
class Advice:
    """What takes a large share of the tick, and what to do about it.

    Attributes:
        share: Share of the tick's cycles, 0 to 1; above 1, of its budget.
        text: One sentence or two.
    """

    share: float
    text: str


@dataclass
class Use:
    """What a function spends in routines of a family, directly, and in all that they call.

    Attributes:
        family: The family.
        caller: Place of the function in Profile.functions; None if the routine is the outermost one.
        cycles: Cycles of the clock, by name of the routine.
    """

    family: Family
    caller: int | None
    cycles: defaultdict[str, float]


def of_double_maths(names: Sequence[str]) -> str:
    """Say what to do about functions of math.h for double."""
    of_floats = quoted([f"{name}f" for name in names])
    ratio = "about a seventh" if names[0] == "sqrt" else "about half"
    return f"{of_floats} (float) {'takes' if len(names) == 1 else 'take'} {ratio}"


def of_float_maths(names: Sequence[str]) -> str:
    """Say what to do about functions of math.h for float."""
    if names[0] == "sqrtf":
        return "compare squares instead of roots, or compute it less often"
    return "a table of values, or an approximation with integers, takes a small part of that"


# What to do about routines, given their names in the source, most cycles first.
RULES: dict[Family, Callable[[Sequence[str]], str]] = {
    routines.DOUBLE_MATHS: of_double_maths,
    routines.FLOAT_MATHS: of_float_maths,
    routines.DOUBLE: lambda _: (
        "computing with float takes about half: float variables, constants with the suffix f (0.5f), sqrtf and sinf"
    ),
    routines.FLOAT: lambda _: "computing with integers, or in fixed point, takes a small part of that",
    routines.PRINTING: lambda _: "print less often, for example in one tick of 60, and shorter texts",
    routines.DIVISION_64: lambda _: "a division of 32 bits (uint32_t) takes about a thirteenth",
    routines.DIVISION_32: lambda _: "multiply, or divide by a power of two, which is a shift, where you can",
}


def advice_of(profile: Profile, sources: Sources) -> list[Advice]:
    """Return what to change: first a tick over its budget, then what takes at least 5 % of it, largest share first."""
    found = [*of_routines(profile, sources), *of_divisions(profile, sources), *of_misses(profile)]
    return [*of_budget(profile), *sorted(found, key=lambda one: -one.share)]


def of_budget(profile: Profile) -> list[Advice]:
    """Return what to do about ticks that are over their budget."""
    load, budget = load_of(profile), profile.budget_cycles
    if budget is None or load.worst <= budget:
        return []
    tick = load.worst_tick
    text = (
        f"tick {tick.number} of robot {tick.robot} takes {percent(load.worst / budget)} of its budget, and "
        f"{percent(load.share_over_budget)} of the ticks are over it: lower main_loop_hz "
        f"({ticks_per_second(profile)}), or spread the work over several ticks"
    )
    return [Advice(load.worst / budget, text)]


def of_misses(profile: Profile) -> list[Advice]:
    """Return what to do about code that is too large for the instruction cache."""
    share = load_of(profile).share_of_misses
    if share < LEAST_SHARE_OF_MISSES:
        return []
    text = (
        f"waiting for code that is not in the instruction cache: {percent(share)} of the tick; the code that runs "
        "again and again is larger than its 2 KiB: do one thing for all neighbours and then the next, rather than "
        "all for each, and call fewer large routines (those of double, printf) in a loop"
    )
    return [Advice(share, text)]


def of_routines(profile: Profile, sources: Sources) -> list[Advice]:
    """Return what to do about routines of the compiler and the C library."""
    whole = total_cycles(profile)
    large = [use for use in uses_of(profile) if whole > 0 and sum(use.cycles.values()) >= LEAST_SHARE * whole]
    return [told(profile, use, sum(use.cycles.values()) / whole, sources) for use in large]


def uses_of(profile: Profile) -> list[Use]:
    """Return what functions spend in routines. A path counts once: for the outermost routine on it, such as printf."""
    uses: dict[tuple[Family, int | None], Use] = {}
    for stack in profile.stacks:
        for depth, function in enumerate(stack.frames):
            family = family_of(profile.functions[function])
            if family is None:
                continue
            caller = stack.frames[depth - 1] if depth > 0 else None
            use = uses.setdefault((family, caller), Use(family, caller, defaultdict(float)))
            use.cycles[name_in_source(profile.functions[function])] += profile.cost(stack)
            break
    return list(uses.values())


def told(profile: Profile, use: Use, share: float, sources: Sources) -> Advice:
    """Return advice about the use of routines."""
    names = sorted(use.cycles, key=lambda name: -use.cycles[name])
    place = where(profile, use, names, sources)
    return Advice(share, f"{quoted(names)}{place}: {percent(share)} of the tick; {RULES[use.family](names)}")


def where(profile: Profile, use: Use, names: Sequence[str], sources: Sources) -> str:
    """Return where routines are called, with the line if the sources tell: " in `f` (main.c:84)"."""
    if use.caller is None:
        return ""
    pattern = re.compile(pattern_in_source(names[0]))
    for line in hottest_lines(profile):
        if line.function == use.caller and pattern.search(code_of(sources.text(line.file, line.number))):
            return f" in `{profile.functions[use.caller]}` ({shown_place(line.file, line.number)})"
    return f" in `{profile.functions[use.caller]}`"


def code_of(line: str) -> str:
    """Return a line of C without its comment at the end."""
    return re.sub(r"//.*|/\*.*", "", line)


def of_divisions(profile: Profile, sources: Sources) -> list[Advice]:
    """Return what to do about lines that wait for divisions by a constant power of two."""
    whole = total_cycles(profile)
    found = []
    for line in hottest_lines(profile):
        if whole <= 0 or line.cycles < LEAST_SHARE * whole:
            break
        divisor = power_of_two_in(code_of(sources.text(line.file, line.number)))
        if divisor is None or line.cycles < CYCLES_OF_DIVISION * line.instructions:
            continue
        bits = divisor.bit_length() - 1
        text = (
            f"the division by {divisor} in `{profile.functions[line.function]}` "
            f"({shown_place(line.file, line.number)}): {percent(line.cycles / whole)} of the tick; of unsigned values, "
            f"a shift (>> {bits}) for /, and a mask (& {divisor - 1}) for %, take a few cycles"
        )
        found.append(Advice(line.cycles / whole, text))
    return found


def power_of_two_in(code: str) -> int | None:
    """Return the first constant power of two, 2 or more, by which a line of C divides; None if there is none."""
    divisors = [int(found) for found in POWER_OF_TWO.findall(code) if not found.startswith("0")]
    return next((number for number in divisors if number > 1 and number & (number - 1) == 0), None)


def quoted(names: Sequence[str]) -> str:
    """Return names as in a sentence, at most three: "`sqrt`, `sin` and others"."""
    shown = [f"`{name}`" for name in names[:3]]
    if len(names) > len(shown):
        return f"{', '.join(shown)} and others"
    return " and ".join([", ".join(shown[:-1]), shown[-1]]) if len(shown) > 1 else shown[0]
