"""Does what docs/analysis_tour.md says, block by block, with its figure.

    .venv/bin/python docs/figures/all.py analysis_tour    # draws

The Python blocks of the page are one script.
"""

from __future__ import annotations

import os
import shlex
import sys
from pathlib import Path

from pages import code_blocks, run
from pictures import DOCS, ROOT, Picture, fingerprint
from pogosim.utils import load_dataframe

NAMES = ("analysis_tour.png",)
PAGE = DOCS / "analysis_tour.md"


def follow(folder: Path) -> str:
    """Do all that the page says, in a folder with examples, conf and arenas; return what its script printed."""
    blocks = code_blocks(PAGE)
    run("\n".join(text for language, text in blocks if language == "sh"), folder, os.environ, timeout_s=120)
    script = folder / "tour" / "tour.py"
    script.write_text("".join(text for language, text in blocks if language == "python"), encoding="utf-8")
    return run(shlex.join([sys.executable, "-W", "error", str(script)]), folder, os.environ, timeout_s=120)


def picture_in(folder: Path) -> Picture:
    """Return the figure that the page's script has drawn, and what from."""
    rows = load_dataframe(folder / "tour" / "vicsek.feather")[0]
    return Picture((folder / "tour" / "tour.png").read_bytes(), fingerprint(rows))


def draw(folder: Path) -> dict[str, Picture]:
    """Follow the page; return its figure."""
    for name in ("arenas", "conf", "examples"):
        (folder / name).symlink_to(ROOT / name)
    follow(folder)
    return {NAMES[0]: picture_in(folder)}
