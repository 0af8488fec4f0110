"""The profile as one tidy table: functions and lines, in CSV."""

from __future__ import annotations

import csv
from pathlib import Path

from pogosim.firmware.profile.costs import function_costs, total_cycles
from pogosim.firmware.profile.raw import Profile

COLUMNS = (
    "kind",
    "function",
    "file",
    "line",
    "self_cycles_per_tick",
    "total_cycles_per_tick",
    "calls_per_tick",
    "share",
)


def rows_of(profile: Profile) -> list[tuple[str | int | float, ...]]:
    """Return the rows: functions, then lines, each by falling cycles. What a line does not have is "".

    `share` is that of the own cycles in all cycles of the ticks, 0 to 1.
    """
    ticks, whole = len(profile.ticks), total_cycles(profile) or 1.0
    functions = [
        (
            "function",
            cost.name,
            cost.file,
            "",
            cost.own / ticks,
            cost.total / ticks,
            cost.calls / ticks,
            cost.own / whole,
        )
        for cost in function_costs(profile)
    ]
    lines = [
        (
            "line",
            profile.functions[line.function],
            line.file,
            line.number or "",
            line.cycles / ticks,
            "",
            "",
            line.cycles / whole,
        )
        for line in sorted(profile.lines, key=lambda line: -line.cycles)
    ]
    return [*functions, *lines]


def write_table(profile: Profile, file: Path) -> None:
    """Write the table.

    Raises:
        OSError: It cannot be written.
    """
    with file.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(rows_of(profile))
