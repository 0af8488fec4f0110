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
from quotes import Quote

NAMES = ("parameter_study.png", "parameter_study.md: results")
PAGE = DOCS / "parameter_study.md"
PARAMETERS = ("objects.robots.nb", "objects.robots.communication_radius", "parameters.power")
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


def size_in(folder: Path) -> Quote:
    """Return how much the results of the page's batch are."""
    results = folder / "rumour" / "results" / "rumour.feather"
    runs = len(load_dataframe(results)[0][["run", *PARAMETERS]].drop_duplicates())
    return Quote((f"The results of the {runs} runs take {results.stat().st_size / 1e6:.1f} MB of disk space.",))


def draw(folder: Path) -> dict[str, Picture | Quote]:
    """Follow the page; return its figure, and the size of its results."""
    for name in (".venv", "arenas", "build"):
        (folder / name).symlink_to(ROOT / name)
    follow(folder)
    return dict(zip(NAMES, (picture_in(folder), size_in(folder)), strict=True))
