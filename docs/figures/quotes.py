"""What a page of docs/ quotes of a scene: a code block after a comment with the scene's name."""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from pathlib import Path


def block(name: str) -> re.Pattern[str]:
    """Match the comment and the code block."""
    return re.compile(rf"(<!-- {name} -->\n\n```\n)(.*?)^```$", re.DOTALL | re.MULTILINE)


def quoted(page: Path, name: str) -> list[str]:
    """Return the lines that a page quotes of a scene."""
    found = block(name).search(page.read_text(encoding="utf-8"))
    return found[2].splitlines() if found else []


def quote(page: Path, name: str, lines: Sequence[str]) -> None:
    """Replace what a page quotes of a scene."""
    written = page.read_text(encoding="utf-8")
    text, count = block(name).subn(lambda found: "\n".join((found[1] + lines[0], *lines[1:], "```")), written)
    if count != 1:
        sys.exit(f"{page}: expected one place for the numbers of {name}, found {count}")
    page.write_text(text, encoding="utf-8")
