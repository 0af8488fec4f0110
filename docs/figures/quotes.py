"""What a page quotes of a program: the block after a comment with a name.

    <!-- name -->

    ```
    lines that the program has printed
    ```

The block may also be a paragraph or a table, up to the next empty line. Beside the pages, quotes.json keeps on what
machine each was made, and for numbers that take long, a fingerprint of a short run: it tells when they are out of date.
"""

from __future__ import annotations

import json
import platform
import re
import sys
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from pictures import drawn_on

RECORD = Path(__file__).with_name("quotes.json")
WIDTH = 120  # columns of a page
NUMBER = re.compile(r"\d[\d.,]*(?:e[+-]?\d+)?")


@dataclass(frozen=True)
class Quote:
    """A text for a page, and what it depends on."""

    lines: tuple[str, ...]
    data: str = ""  # fingerprint of a short run; empty: the text itself is compared


def paragraph(text: str) -> Quote:
    """Return a text in lines of a page's width."""
    return Quote(tuple(textwrap.wrap(text, WIDTH, break_on_hyphens=False, break_long_words=False)))


def block(name: str) -> re.Pattern[str]:
    """Match the comment, then a code block without its last line, or a paragraph."""
    return re.compile(
        rf"(?P<start><!-- {re.escape(name)} -->\n\n)"
        r"(?:(?P<fence>```\w*\n)(?P<code>(?:.*\n)*?)(?=```$)|(?P<text>(?:.+\n)+))",
        re.MULTILINE,
    )


def quoted(page: Path, name: str) -> list[str]:
    """Return the lines that a page quotes."""
    found = block(name).search(page.read_text(encoding="utf-8"))
    return (found["code"] if found["fence"] else found["text"]).splitlines() if found else []


def quote(page: Path, name: str, lines: Sequence[str]) -> None:
    """Replace what a page quotes."""
    written = page.read_text(encoding="utf-8")
    text, count = block(name).subn(
        lambda found: found["start"] + (found["fence"] or "") + "".join(f"{line}\n" for line in lines), written
    )
    if count != 1:
        sys.exit(f"{page}: expected one place for the numbers of {name}, found {count}")
    page.write_text(text, encoding="utf-8")


def recorded() -> dict[str, dict[str, str]]:
    """Return what is kept of each quote, by its name: "page: name"."""
    return json.loads(RECORD.read_text(encoding="utf-8")) if RECORD.is_file() else {}


def made_on(made: Quote) -> dict[str, str]:
    """Return what is to be kept of a quote that was made here."""
    here = {"Platform": drawn_on()["Platform"]}
    if made.data:  # the last bits of NumPy's functions depend on the instructions that the processor has
        machine = f"{processor()} with {vector_instructions()}"
        here = {"Data": made.data, "Platform": f"{here['Platform']}, {machine}, numpy {np.__version__}"}
    return here


def processor() -> str:
    """Return the name of the processor."""
    about = Path("/proc/cpuinfo")
    found = re.search(r"^model name\s*: (.*)$", about.read_text(), re.MULTILINE) if about.is_file() else None
    return found[1] if found else platform.processor()


def vector_instructions() -> str:
    """Return the widest vector instructions that NumPy has a code of its own for."""
    about = Path("/proc/cpuinfo")
    flags = about.read_text().split() if about.is_file() else []
    return "AVX-512" if "avx512f" in flags else "AVX2" if "avx2" in flags else platform.machine()


def keep_quote(name: str, page: Path, made: Quote) -> None:
    """Write a text into its page, and record on what it was made."""
    quote(page, name.partition(": ")[2], made.lines)
    record = recorded() | {name: made_on(made)}
    RECORD.write_text(json.dumps(dict(sorted(record.items())), indent=4) + "\n", encoding="utf-8")


def quote_difference(name: str, page: Path, today: Quote) -> str:
    """Tell in what a page differs from what a program says today; empty if in nothing.

    On another machine than the one that made the text, only what is no number is compared.
    """
    kept, here = recorded().get(name, {}), made_on(today)
    is_same_machine = kept.get("Platform") == here["Platform"]
    if today.data:
        changed = not kept or (is_same_machine and kept.get("Data") != today.data)
        return f"{name} is out of date: a short run gives other results than when it was made" if changed else ""
    was, is_now = quoted(page, name.partition(": ")[2]), list(today.lines)
    if not is_same_machine:
        was, is_now = without_numbers(was), without_numbers(is_now)
    return "" if was == is_now else "\n".join([f"{name} says", *was, "and would now say", *is_now])


def without_numbers(lines: Sequence[str]) -> list[str]:
    """Replace all numbers, and the blanks that align them."""
    return [re.sub(r" +", " ", NUMBER.sub("#", line)) for line in lines]
