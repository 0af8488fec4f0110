"""What commands of pages print: the pages' own commands are run, and the lines that a page quotes are picked.

.venv/bin/python docs/figures/all.py printed
"""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from pathlib import Path

from pages import code_blocks, run
from pictures import DOCS, ROOT
from quotes import Quote


@dataclass(frozen=True)
class Printed:
    """A quote of what commands print.

    Attributes:
        page: In docs/.
        name: Name of the quote.
        commands: The pages' shell blocks whose text matches this are run.
        lines: Lines that match this are quoted, from where they begin to match.
        measured: What matches this in them depends on the machine; "..." stands for it. Empty: nothing does.
    """

    page: str
    name: str
    commands: str
    lines: str
    measured: str = ""


QUOTES = (
    Printed("optimization.md", "first_search", r"conf/optim/simple\.yaml", r"\[INFO\] (Done|Gain|Best values).*"),
    Printed("debugging.md", "overrun", r"overrun", r"\S+:\d+:\d+: runtime error: .*|.*\[warning\].*"),
    Printed(
        "command_line.md",
        "summary",
        r"conf/demo\.yaml -g$",
        r"\S+ s of \d+ robots simulated .*",
        r"(?<=simulated in )\S+|\S+(?= x real time)",
    ),
)
NAMES = tuple(f"{quote.page}: {quote.name}" for quote in QUOTES)
LINKS = (".venv", "arenas", "build", "conf", "examples", "tools", "docs")


def output(quote: Printed, folder: Path) -> list[str]:
    """Run the commands in a folder that looks like the project's; return what is quoted."""
    for name in LINKS:
        (folder / name).symlink_to(ROOT / name)
    (folder / "first").mkdir()
    chosen = [
        text
        for language, text in code_blocks(DOCS / quote.page)
        if language == "sh" and re.search(quote.commands, text, re.MULTILINE)
    ]
    printed = run("\n".join(chosen), folder, os.environ, timeout_s=300)
    lines = [found[0] for line in printed.splitlines() if (found := re.search(quote.lines, line))]
    return [re.sub(quote.measured, "...", line) if quote.measured else line for line in lines]


def draw(folder: Path) -> dict[str, Quote]:
    """Run all."""
    made = {}
    for name, quote in zip(NAMES, QUOTES, strict=True):
        (place := folder / quote.name).mkdir()
        made[name] = Quote(tuple(output(quote, place)))
    return made
