"""`pogosim docs`: the pages that messages and helps name, without a network and without the source tree."""

from __future__ import annotations

import os
import pydoc
import re
import shutil
import sys
from collections.abc import Sequence
from pathlib import Path

from pogosim.command.parser import Parser, complain
from pogosim.errors import ToolError
from pogosim.installation import Installation, find_installation
from pogosim.lines import say, say_text
from pogosim.nearest_name import listed, unknown

ENDING = ".md"
CHANGES = "changelog"  # which pages name as ../CHANGELOG.md


class PageError(ToolError):
    """There is no such page; says which one is near."""


def folder_of_pages(found: Installation) -> Path:
    """Return the folder of the pages, which is beside the template in an installation and in a source tree."""
    return found.template.parent / "docs"


def pages_in(folder: Path) -> dict[str, Path]:
    """Return the files of pages by name, such as "porting" and "decisions/walls", in the order of the alphabet.

    Raises:
        PageError: There are none.
    """
    files = sorted(folder.rglob(f"*{ENDING}"))
    if not files:
        raise PageError(f"there are no pages in {folder}: this Pogosim is not complete, install it again")
    pages = {file.relative_to(folder).as_posix().removesuffix(ENDING): file for file in files}
    return pages | {CHANGES: folder.parent / "CHANGELOG.md"}


def title_of(file: Path) -> str:
    """Return the title of a page: its first heading."""
    lines = file.read_text(encoding="utf-8").splitlines()
    return next((line.removeprefix("# ") for line in lines if line.startswith("# ")), "")


def page_named(typed: str, pages: dict[str, Path]) -> Path:
    """Return the file of a page as messages name it: `porting`, `porting.md`, `docs/porting.md` or with #a-section.

    Raises:
        PageError: There is no such page.
    """
    name = typed.partition("#")[0].removeprefix("./").removeprefix("docs/").removesuffix(ENDING)
    found = pages.get(name) or pages.get(name.lower())
    if found is None:
        raise PageError(unknown("page", name, pages, "pogosim docs lists all pages"))
    return found


def section_of(text: str, anchor: str) -> str:
    """Return a section of a page with those in it, by the end of a link to it, such as "an-x-server-in-windows".

    Raises:
        PageError: There is no such section.
    """
    begins: dict[str, tuple[int, int]] = {}  # of each section, its line and its level
    lines, is_code = text.splitlines(), False
    for number, line in enumerate(lines):
        is_code ^= line.lstrip().startswith("```")
        if not is_code and (found := re.match(r"(#+) (.+)", line)):
            begins.setdefault(anchor_of(found[2]), (number, len(found[1])))
    if anchor not in begins:
        raise PageError(unknown("section", anchor, begins, f"there are {', '.join(begins)}"))
    begin, level = begins[anchor]
    ends = (number for number, other in begins.values() if number > begin and other <= level)
    return "\n".join(lines[begin : min(ends, default=len(lines))])


def anchor_of(heading: str) -> str:
    """Return how links name a heading, as forges make it: small letters, no punctuation, hyphens for blanks."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def show(text: str) -> None:
    """Print a text; on a terminal, through the pager of the environment if it is there."""
    pager = (os.environ.get("MANPAGER") or os.environ.get("PAGER") or "").split()
    if sys.stdout is not None and sys.stdout.isatty() and (not pager or shutil.which(pager[0])):
        pydoc.pager(text)
    else:
        say_text(text.rstrip("\n"))


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim docs") -> int:
    """Run the command. Returns its exit code: 0 done, 2 there is no such page."""
    parser = Parser(
        prog=prog,
        description="Shows a page of the documentation, such as those that messages name: pogosim docs porting. On a "
        "terminal, a pager shows it. Without a name, it lists all pages.",
    )
    parser.add_argument(
        "page",
        metavar="PAGE",
        nargs="?",
        help="name of the page: porting, docs/porting.md or, from a section, porting#waiting",
    )
    parser.add_argument("--path", action="store_true", help="print where the file is; without a name, the folder")
    options = parser.parse_args(arguments)
    try:
        folder = folder_of_pages(find_installation())
        pages = pages_in(folder)
        file = page_named(options.page, pages) if options.page is not None else None
        if options.path:
            say(str(file or folder))
        elif file is None:
            say(*listed({name: title_of(page) for name, page in pages.items()}))
        else:
            text, anchor = file.read_text(encoding="utf-8"), options.page.partition("#")[2]
            show(section_of(text, anchor) if anchor else text)
    except ToolError as error:
        return complain(prog, error)
    return 0
