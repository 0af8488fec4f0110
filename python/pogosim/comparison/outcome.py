"""What is said of two files: in one line, as text, and as JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pogosim.comparison.batches import Distributions, NumberDifference, as_map
from pogosim.comparison.configurations import KeyDifference, Source
from pogosim.comparison.rows import FirstDifference, RowsCompared
from pogosim.lines import counted, printable
from pogosim.run_report.facts import shortened
from pogosim.varied import MISSING

LONGEST = 60  # characters of a value
MOST_NAMES = 6  # in the line that says whether files differ
TESTS = {"mann-whitney": "Mann-Whitney", "permutation": "permutations"}


@dataclass(frozen=True)
class Outcome:
    """All that was compared."""

    sources: tuple[Source, Source]
    keys: list[KeyDifference]
    rows: RowsCompared | None  # None: not compared
    distributions: Distributions | None  # None: not compared
    level: float
    test: str
    tolerance: float
    notes: list[str]  # why something was not compared

    @property
    def differ(self) -> bool:
        """Whether the results differ: the rows, or else the distributions."""
        if self.rows is not None:
            return not self.rows.is_equal
        assert self.distributions is not None
        return bool(self.distributions.significant(self.level)) or any(self.distributions.only_in)

    @property
    def verdict(self) -> str:
        """Whether they differ, in one line."""
        parts = [] if self.rows is None else [rows_verdict(self.rows, self.tolerance, self.sources)]
        if self.distributions is not None and (self.rows is None or not self.rows.is_equal):
            parts.append(numbers_verdict(self.distributions, self.level, self.test))
        text = "; ".join(part for part in parts if part)
        if not self.differ and self.keys:
            text += f"; configurations differ in {counted(len(self.keys), 'key')}"
        return f"{'differ' if self.differ else 'equal' if self.rows else 'no difference found'}: {text}"


def rows_verdict(rows: RowsCompared, tolerance: float, sources: tuple[Source, Source]) -> str:
    """Say whether rows are equal."""
    if rows.is_equal:
        within = f" within the tolerance {tolerance:g}" if tolerance else ""
        return f"all {counted(rows.rows[0], 'row')} are the same{within}"
    if rows.first is not None:
        return f"rows differ from {where(rows.first)} on, in {names([own.name for own in rows.columns])}"
    for which, columns in enumerate(rows.only_in):
        if columns:
            what = "the column" if len(columns) == 1 else "the columns"
            return f"only {sources[which].name} has {what} {names(columns)}"
    return f"one has {counted(rows.rows[0], 'row')}, the other {rows.rows[1]}; those that both have are the same"


def numbers_verdict(found: Distributions, level: float, test: str) -> str:
    """Say whether distributions differ."""
    if any(found.only_in):
        return "they are of different combinations of options"
    if found.tests == 0:
        is_known = any(min(own.runs) > 1 for own in found.numbers)
        return f"all {counted(len(found.numbers), 'number')} are equal in all runs" if is_known else ""
    significant = found.significant(level)
    how = f"at the level {level:g} ({TESTS[test]}, Holm)"
    if not significant:
        few = "; so few runs cannot show any difference at this level" if found.least > level else ""
        return f"none of {counted(found.tests, 'number')} differs {how}{few}"
    of = [f"{own.name}{f' ({own.combination})' if own.combination else ''}" for own in significant]
    verb = "differs" if len(significant) == 1 else "differ"
    return f"{len(significant)} of {counted(found.tests, 'number')} {verb} {how}: {names(of, '; ')}"


def names(of: Sequence[str], between: str = ", ") -> str:
    """Return a list of names in a line."""
    more = len(of) - MOST_NAMES
    return between.join(of[:MOST_NAMES]) + (f" and {more} more" if more > 0 else "")


def where(first: FirstDifference) -> str:
    """Say which row it is: "row 17 (time 0.5 s, robots 3)"."""
    place = dict(first.place)
    parts = []
    if "run" in place:
        parts.append(f"run {place['run']}")
    if isinstance(place.get("time"), (int, float)):
        parts.append(f"time {place['time']:.9g} s")
    if "robot_id" in place or "robot_category" in place:
        parts.append(f"{place.get('robot_category') or 'robot'} {place.get('robot_id', '')}".strip())
    if place.get("subpart_id", -1) not in (None, -1):
        parts.append(f"dot {place['subpart_id']}")
    return f"row {first.row} ({', '.join(parts)})" if parts else f"row {first.row}"


def value(of: Any) -> str:
    """Return a value in a line."""
    if of is MISSING:
        return "not there"
    if of is None:
        return "null"
    text = printable(repr(of) if isinstance(of, float) else str(of))
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


def lines(outcome: Outcome, most: int) -> list[str]:
    """Return what is said of the outcome, the verdict first; lists have at most so many lines."""
    said = [outcome.verdict, ""]
    for letter, source in zip("ab", outcome.sources, strict=True):
        seeds = f", seed{'s' if len(source.seeds) > 1 else ''} {shortened(source.seeds)}" if source.seeds else ""
        version = f", {source.version}" if source.version else ""
        program = f", program {source.program}" if source.program else ""
        said.append(f"{letter}: {source.name}: {counted(source.runs, 'run')}{seeds}{version}{program}")
    if not all(source.program for source in outcome.sources):
        said.append("programs: not compared, since data files do not say which program ran")
    elif outcome.sources[0].program != outcome.sources[1].program:
        said.append("programs: they differ")
    said += key_lines(outcome, most)
    if outcome.rows is not None:
        said += row_lines(outcome.rows, most)
    if outcome.distributions is not None:
        said += number_lines(outcome.distributions, outcome.level, most)
    return [*said, *([""] if outcome.notes else []), *outcome.notes]


def key_lines(outcome: Outcome, most: int) -> list[str]:
    """Return how configurations differ."""
    if not any(source.metadata.get("configuration") for source in outcome.sources):
        return ["", "configurations: not in the files"]
    if not outcome.keys:
        return ["", "configurations: equal"]
    rows = [("configurations", "a", "b")] + [(own.key, value(own.a), value(own.b)) for own in outcome.keys[:most]]
    return ["", *table(rows), *left_out(len(outcome.keys) - most, "key")]


def row_lines(rows: RowsCompared, most: int) -> list[str]:
    """Return how rows differ."""
    said = [""]
    if rows.rows[0] != rows.rows[1]:
        said.append(f"rows: {rows.rows[0]} in a, {rows.rows[1]} in b")
    for letter, columns in zip("ab", rows.only_in, strict=True):
        if columns:
            said.append(f"columns only in {letter}: {', '.join(columns[:most])}")
            said += left_out(len(columns) - most, "column")
    said += [f"type of {name}: {one} in a, {other} in b" for name, (one, other) in list(rows.types.items())[:most]]
    if rows.first is None:
        return said if len(said) > 1 else ["", "rows: equal"]
    said.append(f"first difference: {where(rows.first)}")
    values = list(rows.first.values.items())[:most]
    first = [("column", "a", "b"), *((name, value(x), value(y)) for name, (x, y) in values)]
    said += [*table(first), "", "all differences:"]
    listed = [("column", "rows", "first row", "largest difference")]
    listed += [
        (own.name, str(own.rows), str(own.first_row), "" if own.largest is None else f"{own.largest:.6g}")
        for own in rows.columns[:most]
    ]
    return [*said, *table(listed), *left_out(len(rows.columns) - most, "column")]


def number_lines(found: Distributions, level: float, most: int) -> list[str]:
    """Return how distributions differ, the most certain differences first."""
    said = [""]
    for letter, combinations in zip("ab", found.only_in, strict=True):
        said += [f"combination only in {letter}: {name}" for name in combinations[:most]]
        said += left_out(len(combinations) - most, "combination")
    if not found.numbers:
        return [*said, "no number is in both files"]
    several = any(own.combination for own in found.numbers)
    ordered = sorted(found.numbers, key=lambda own: own.p if math.isfinite(own.p) else 2.0)
    head = (
        "number",
        *(("combination",) if several else ()),
        "runs",
        "a",
        "b",
        "b - a",
        "95 % interval",
        "p",
        "p (Holm)",
    )
    said += table([head, *(number_row(own, several) for own in ordered[:most])])
    said += left_out(len(ordered) - most, "number")
    if found.tests and found.least > level:
        least = f"p is at least {found.least:.2g} after the correction, above {level:g}"
        said.append(f"So few runs cannot show a difference: {least}.")
    return said


def number_row(own: NumberDifference, several: bool) -> tuple[str, ...]:
    """Return the cells of a number."""
    low, high = own.interval
    interval = f"{low:.4g} to {high:.4g}" if math.isfinite(low) else ""
    probabilities = [f"{p:.3g}" if math.isfinite(p) else "" for p in (own.p, own.corrected)]
    runs = f"{own.runs[0]}, {own.runs[1]}"
    means = [f"{mean:.5g}" for mean in own.means]
    combination = (own.combination,) if several else ()
    return (own.name, *combination, runs, *means, f"{own.difference:.4g}", interval, *probabilities)


def left_out(count: int, what: str) -> list[str]:
    """Return a line on what a list does not have; none if it has all."""
    return [f"... and {counted(count, f'more {what}')}; --most N lists more"] if count > 0 else []


def table(rows: Sequence[tuple[str, ...]]) -> list[str]:
    """Return rows of cells as lines, indented below the first one."""
    cells = [[printable(text) for text in row] for row in rows]
    widths = [max(len(row[column]) for row in cells) for column in range(len(cells[0]))]
    return ["  ".join(text.ljust(width) for text, width in zip(row, widths, strict=True)).rstrip() for row in cells]


def as_json(outcome: Outcome) -> str:
    """Return the outcome as JSON; numbers that are not finite are null."""
    rows, found = outcome.rows, outcome.distributions
    entries = {
        "differ": outcome.differ,
        "verdict": outcome.verdict,
        "files": [
            {
                "name": own.name,
                "version": own.version or None,
                "program_hash": own.program or None,
                "seeds": own.seeds,
                "runs": own.runs,
            }
            for own in outcome.sources
        ],
        "configurations": [
            {"key": own.key} | ({} if own.a is MISSING else {"a": own.a}) | ({} if own.b is MISSING else {"b": own.b})
            for own in outcome.keys
        ],
        "rows": None
        if rows is None
        else {
            "equal": rows.is_equal,
            "counts": list(rows.rows),
            "only_in": list(rows.only_in),
            "types": {name: list(own) for name, own in rows.types.items()},
            "first": None
            if rows.first is None
            else {
                "row": rows.first.row,
                "place": rows.first.place,
                "values": {name: list(own) for name, own in rows.first.values.items()},
            },
            "columns": [
                {"name": own.name, "rows": own.rows, "first_row": own.first_row, "largest": own.largest}
                for own in rows.columns
            ],
        },
        "distributions": None
        if found is None
        else {
            "test": outcome.test,
            "level": outcome.level,
            "tests": found.tests,
            "least_p_corrected": found.least,
            "only_in": list(found.only_in),
            "numbers": [as_map(own) for own in found.numbers],
        },
        "notes": outcome.notes,
    }
    return json.dumps(plain(entries), allow_nan=False)


def plain(of: Any) -> Any:
    """Return a value with the types that JSON has; what it does not have as text."""
    if isinstance(of, Mapping):
        return {str(key): plain(item) for key, item in of.items()}
    if isinstance(of, (list, tuple)):
        return [plain(item) for item in of]
    if isinstance(of, np.generic):
        of = of.item()
    if isinstance(of, float):
        return of if math.isfinite(of) else None
    return of if of is None or isinstance(of, (bool, int, str)) else str(of)
