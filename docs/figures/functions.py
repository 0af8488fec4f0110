"""The tables of docs/api.md: each function of a robot and of the simulator in one line, from the headers' comments.

    .venv/bin/python docs/figures/all.py functions

A line has the declaration, the unit and range that its comment gives after `@range`, and the comment's first sentence.
Needs doxygen.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Sequence
from itertools import takewhile
from pathlib import Path

from pictures import ROOT
from quotes import Quote

sys.path.append(str(ROOT / "scripts" / "site"))

from doxygen_pages import Header, Member, grouped, read_headers

# Headers of both tables, in the order of the page.
TABLES = {
    "robot": (
        "pogolib/motors.h",
        "pogolib/leds.h",
        "pogolib/infrared.h",
        "pogolib/sensors.h",
        "pogolib/flash.h",
        "pogolib/magnetometer.h",
        "pogolib/timers.h",
        "pogolib/helper.h",
        "pogolib/console.h",
        "pogosim.h",
        "userdata.h",
        "colormaps.h",
    ),
    "simulator": ("simulation.h", "world.h", "version.h"),
}
NAMES = tuple(f"api.md: {table}" for table in TABLES)
LONGEST = 100  # characters of a sentence; a longer one loses its brackets, and ends at its first colon or semicolon
RANGE = re.compile(r"\s*\bRange: (.*)", re.DOTALL)
UNITS = {"milliseconds": "ms", "microseconds": "us", "seconds": "s", "_mm": "mm", "_rad": "rad", "_deg": "degrees"}


def headers(folder: Path) -> dict[str, Header]:
    """Read the headers, by their paths below include/pogosim; files of doxygen are left in a folder."""
    found = read_headers(["@INCLUDE = docs/Doxyfile"], ROOT, folder)
    return {file.removeprefix("pogosim/"): header for file, header in found.items()}


def is_called(member: Member) -> bool:
    """Tell functions, macros with arguments and variables of a program from constants and types."""
    return not member.declaration.startswith(("#define", "enum", "typedef")) or (
        member.declaration.startswith("#define") and "(" in member.declaration
    )


def arguments(member: Member) -> list[tuple[str, str]]:
    """Return type and name of each argument; no types in macros."""
    inner = member.declaration.partition(f"{member.name}(")[2].rpartition(")")[0]
    if not inner or inner == "void":
        return []
    found = []
    for part in re.sub(r"\(\*\s*(\w+)\s*\)\s*\([^)]*\)", r" \1", inner).split(","):
        kind, _, name = part.strip().rpartition(" ")
        found.append((kind, name.lstrip("*").partition("[")[0]))
    return found


def call(member: Member) -> str:
    """Return a call with the names of the arguments; of a variable, its name alone."""
    name = str(member.name)
    if f"{name}(" not in member.declaration:
        return name
    return f"{name}({', '.join(word for _, word in arguments(member))})"


def folded(calls: Sequence[str]) -> str:
    """Write calls that differ in one word as one: `data_add_column_{int8, int16}(name)`."""
    start = common_start(calls)
    start = start[: start.rfind("_") + 1]
    end = common_start([text[::-1] for text in calls])[::-1]
    end = end[end.find("_") if "_" in end.partition("(")[0] else end.find("(") :]
    middles = [text[len(start) : len(text) - len(end)] for text in calls]
    if len(calls) > 2 and start and end and all(re.fullmatch(r"\w+", middle) for middle in middles):
        return f"`{start}{{{', '.join(middles)}}}{end}`"
    return ", ".join(f"`{text}`" for text in calls)


def common_start(texts: Sequence[str]) -> str:
    """Return what all texts begin with."""
    columns = zip(*texts, strict=False)
    return "".join(letters[0] for letters in takewhile(lambda letters: len(set(letters)) == 1, columns))


def sentence(text: str) -> str:
    """Return the first sentence of a description, or the first part of a long one."""
    first = re.split(r"(?<=\.)\s+(?=[A-Z0-9`])", " ".join(text.split()))[0].rstrip(".:")
    if len(first) > LONGEST:
        first = re.sub(r" \([^)]*\)", "", first)
    return re.split(r"(?<=[^:;]{20})[:;] ", first, maxsplit=1)[0] if len(first) > LONGEST else first


def split(member: Member) -> tuple[str, str]:
    """Return the description of a member, and its units and ranges."""
    text = re.sub(r"(?<=\w)\\_(?=\w)", "_", member.text)
    found = RANGE.search(text)
    description, ranges = (text[: found.start()], " ".join(found[1].split())) if found else (text, "")
    units = [f"{name}: {unit}" for _, name in arguments(member) if (unit := unit_of(name)) and name not in ranges]
    return description, "; ".join([*units, *([ranges] if ranges else [])])


def unit_of(name: str) -> str:
    """Return the unit that an argument's name ends, or begins, with; empty if none."""
    return next((unit for word, unit in UNITS.items() if name.startswith(word) or name.endswith(word)), "")


def rows(found: dict[str, Header], names: Sequence[str]) -> Iterator[str]:
    """Yield the lines of a table."""
    yield "| function | unit, range | what it does |"
    yield "|---|---|---|"
    for name in names:
        header = found[name]
        yield f"| **{sentence(header.text)}** | | [{name}](../include/pogosim/{name}) |"
        for group in grouped(member for member in header.members if is_called(member)):
            description, unit = split(group[0])
            yield f"| {folded([call(member) for member in group])} | {unit} | {sentence(description)} |"


def draw(folder: Path) -> dict[str, Quote]:
    """Return both tables."""
    found = headers(folder)
    return {f"api.md: {table}": Quote(tuple(rows(found, names))) for table, names in TABLES.items()}
