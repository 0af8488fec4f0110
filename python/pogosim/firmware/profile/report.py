"""The report of a profile as text: load, functions, lines, routines, memory, advice."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from pathlib import Path

from pogosim.firmware.profile.advice import advice_of
from pogosim.firmware.profile.costs import FunctionCost, function_costs, hottest_lines, total_cycles
from pogosim.firmware.profile.load import PERCENTILE, load_of
from pogosim.firmware.profile.numbers import bytes_shown, percent, plain, ticks_per_second
from pogosim.firmware.profile.raw import Profile
from pogosim.firmware.profile.routines import family_of
from pogosim.firmware.profile.sources import Sources, shown_place
from pogosim.lines import counted

ROWS = 15  # of a table; the rest is in the CSV file
WIDTH = 100  # columns of paragraphs
SOURCE_WIDTH = 60  # characters of a source line
CALLERS = 3  # that are named
SLACK = 0.01  # of the cycles, by which stacks and ticks may differ


def report_of(profile: Profile, sources: Sources) -> list[str]:
    """Return the lines of the report."""
    costs = function_costs(profile)
    parts = [
        load_lines(profile),
        function_lines(profile, costs),
        hottest(profile, sources),
        routine_lines(profile, costs),
        memory_lines(profile),
        advice_lines(profile, sources),
    ]
    return [line for part in parts if part for line in ("", *part)][1:]


def load_lines(profile: Profile) -> list[str]:
    """Return how much of its budget a tick takes."""
    load = load_of(profile)
    robots = len({tick.robot for tick in profile.ticks})
    text = f"{Path(profile.firmware).name}: {counted(len(profile.ticks), 'tick')} of {counted(robots, 'robot')}"
    budget = profile.budget_cycles
    worst = f"tick {load.worst_tick.number} of robot {load.worst_tick.robot}"
    if budget is None:
        text += (
            f", whose program has no main loop, and so no budget. A tick takes {plain(load.mean)} cycles on average; "
            f"{PERCENTILE} % of the ticks take at most {plain(load.percentile)}, and the worst one, {worst}, "
            f"{plain(load.worst)}."
        )
    else:
        text += (
            f", {ticks_per_second(profile)}: a budget of {plain(budget)} cycles for each. A tick takes "
            f"{percent(load.mean / budget)} of it on average ({plain(load.mean)} cycles); {PERCENTILE} % of the ticks "
            f"take at most {percent(load.percentile / budget)}, and the worst one, {worst}, "
            f"{percent(load.worst / budget)}."
        )
    text += (
        f" Functions of the robots' library take {percent(load.share_of_calls)} of this time, and waiting for code "
        f"that is not in the instruction cache {percent(load.share_of_misses)}."
    )
    in_ticks = load.mean * len(profile.ticks)
    if abs(total_cycles(profile) - in_ticks) > SLACK * in_ticks:
        text += f" The tables hold {plain(total_cycles(profile))} cycles, and the ticks {plain(in_ticks)}."
    return textwrap.wrap(text, WIDTH, break_on_hyphens=False)


def function_lines(profile: Profile, costs: Sequence[FunctionCost]) -> list[str]:
    """Return the table of functions."""
    ticks, whole = len(profile.ticks), total_cycles(profile)
    titles = ("function", "own cycles/tick", "share", "with calls/tick", "share", "calls/tick")
    rows = [
        (
            cost.name,
            plain(cost.own / ticks),
            percent(share_of(cost.own, whole)),
            plain(cost.total / ticks),
            percent(share_of(cost.total, whole)),
            plain(cost.calls / ticks),
        )
        for cost in costs
    ]
    return table("Functions, by their own cycles:", titles, rows, left=(0,))


def hottest(profile: Profile, sources: Sources) -> list[str]:
    """Return the table of lines."""
    ticks, whole = len(profile.ticks), total_cycles(profile)
    lines = [line for line in hottest_lines(profile) if line.cycles > 0]
    titles: tuple[str, ...] = ("line", "cycles/tick", "share", "instructions/tick", "function", "source")
    rows: list[tuple[str, ...]] = [
        (
            shown_place(line.file, line.number),
            plain(line.cycles / ticks),
            percent(share_of(line.cycles, whole)),
            plain(line.instructions / ticks),
            profile.functions[line.function],
            textwrap.shorten(sources.text(line.file, line.number), SOURCE_WIDTH, placeholder=" ..."),
        )
        for line in lines
    ]
    if not any(source for *_, source in rows):  # no file is found
        titles, rows = titles[:-1], [row[:-1] for row in rows]
    return table("Hottest lines, without what they call:", titles, rows, left=(0, 4, 5)) if rows else []


def routine_lines(profile: Profile, costs: Sequence[FunctionCost]) -> list[str]:
    """Return the table of routines of the compiler and the C library, by their cycles with what they call."""
    ticks = len(profile.ticks)
    titles = ("routine", "of", "calls/tick", "cycles/call", "called by")
    rows = [
        (
            cost.name,
            family.title,
            plain(cost.calls / ticks),
            plain(cost.total / cost.calls) if cost.calls > 0 else "",
            callers_of(profile, cost),
        )
        for cost in sorted(costs, key=lambda cost: -cost.total)
        if (family := family_of(cost.name)) is not None
    ]
    title = "Routines for what the processor cannot do itself, and of the C library:"
    return table(title, titles, rows, left=(0, 1, 4)) if rows else []


def callers_of(profile: Profile, cost: FunctionCost) -> str:
    """Return the functions that call one most often."""
    names = [profile.functions[caller] for caller in cost.callers]
    more = f" and {len(names) - CALLERS} more" if len(names) > CALLERS else ""
    return ", ".join(names[:CALLERS]) + more


def memory_lines(profile: Profile) -> list[str]:
    """Return how much memory is in use."""
    parts = {
        "program": profile.program_bytes,
        "variables": profile.variable_bytes,
        "deepest stack": profile.deepest_stack_bytes,
        "heap": profile.heap_bytes,
    }
    used = sum(parts.values())
    named = ", ".join(f"{name} {bytes_shown(count)}" for name, count in parts.items())
    share = share_of(used, profile.memory_bytes)
    text = f"Memory: {bytes_shown(used)} of {bytes_shown(profile.memory_bytes)} ({percent(share)}): {named}."
    return textwrap.wrap(text, WIDTH)


def advice_lines(profile: Profile, sources: Sources) -> list[str]:
    """Return what to change."""
    found = advice_of(profile, sources)
    if not found:
        return []
    lines = [
        textwrap.wrap(
            one.text, WIDTH, initial_indent="- ", subsequent_indent="  ", break_on_hyphens=False, break_long_words=False
        )
        for one in found
    ]
    return ["What could be faster:", *(line for wrapped in lines for line in wrapped)]


def share_of(part: float, whole: float) -> float:
    """Return a share, 0 to 1; 0 of nothing."""
    return part / whole if whole > 0 else 0.0


def table(title: str, titles: Sequence[str], rows: Sequence[Sequence[str]], left: Sequence[int]) -> list[str]:
    """Return a table, of which the first rows are shown.

    Args:
        title: What it shows.
        titles: Titles of its columns.
        rows: Cells; as many per row as there are titles.
        left: Columns with text, which begin at the left; numbers end at the right.
    """
    shown = [titles, *rows[:ROWS]]
    widths = [max(len(row[column]) for row in shown) for column in range(len(titles))]
    lines = [
        "  ".join(
            f"{cell:<{width}}" if column in left else f"{cell:>{width}}"
            for column, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in shown
    ]
    more = [f"... and {len(rows) - ROWS} more; --csv FILE has all"] if len(rows) > ROWS else []
    return [title, *(f"  {line}" for line in [*lines, *more])]
