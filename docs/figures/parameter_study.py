"""Does what docs/parameter_study.md says, block by block, with its figure.

    .venv/bin/python docs/figures/all.py parameter_study    # draws; takes a minute

Files and commands are those of the page, in a folder that looks like the project's: the C program becomes
rumour/main.c, YAML rumour/rumour.yaml, Python rumour/plot.py.
"""

from __future__ import annotations

import os
from pathlib import Path

from pages import code_blocks, run
from pictures import DOCS, ROOT, Picture, fingerprint
from pogosim.utils import load_dataframe

NAMES = ("parameter_study.png",)
PAGE = DOCS / "parameter_study.md"
FILES = {"c": "main.c", "yaml": "rumour.yaml", "python": "plot.py"}


def follow(folder: Path) -> str:
    """Do all that the page says, in a folder with .venv, arenas and build/release; return what was printed last."""
    study = folder / "rumour"
    study.mkdir()
    output = ""
    for language, text in code_blocks(PAGE):
        if language in FILES:
            (study / FILES[language]).write_text(text, encoding="utf-8")
        elif language == "sh":
            output = run(text, folder, os.environ, timeout_s=600)
    return output


def picture_in(folder: Path) -> Picture:
    """Return the figure that the page's commands have drawn, and what from."""
    rows = load_dataframe(folder / "rumour" / "results" / "rumour.feather")[0]
    return Picture((folder / "rumour" / "rumour.png").read_bytes(), fingerprint(rows))


def draw(folder: Path) -> dict[str, Picture]:
    """Follow the page; return its figure."""
    for name in (".venv", "arenas", "build"):
        (folder / name).symlink_to(ROOT / name)
    follow(folder)
    return {NAMES[0]: picture_in(folder)}
