"""`pogosim docs`: the pages that messages and helps name, without a network and without the source tree."""

from __future__ import annotations

import pydoc
import sys
from collections.abc import Sequence
from pathlib import Path

from pogosim.command.parser import Parser, complain
from pogosim.errors import ToolError
from pogosim.installation import Installation, find_installation
from pogosim.lines import say, say_text
from pogosim.nearest_name import listed, unknown

ENDING = ".md"


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
    return {file.relative_to(folder).as_posix().removesuffix(ENDING): file for file in files}


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
    if name not in pages:
        raise PageError(unknown("page", name, pages, "pogosim docs lists all pages"))
    return pages[name]


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim docs") -> int:
    """Run the command. Returns its exit code: 0 done, 2 there is no such page."""
    parser = Parser(
        prog=prog,
        description="Shows a page of the documentation, such as those that messages name: pogosim docs porting. On a "
        "terminal, a pager shows it. Without a name, it lists all pages.",
    )
    parser.add_argument("page", metavar="PAGE", nargs="?", help="name of the page: porting, or docs/porting.md")
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
        elif sys.stdout.isatty():
            pydoc.pager(file.read_text(encoding="utf-8"))
        else:
            say_text(file.read_text(encoding="utf-8").rstrip("\n"))
    except ToolError as error:
        return complain(prog, error)
    return 0
