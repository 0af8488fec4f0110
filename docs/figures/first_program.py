"""Does what docs/first_program.md says, block by block, with its two pictures.

    .venv/bin/python docs/figures/first_program.py FOLDER    # leaves the project in FOLDER
    .venv/bin/python docs/figures/all.py first_program       # draws

A C program becomes main.c, YAML conf/crowds.yaml, Python plot.py; shell commands are run, and what the page says that
they print must be in their output. `make bin` is left out unless POGO_SDK says where the SDK is.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

try:
    from pages import check_printed, code_blocks, run
    from pictures import DOCS, ROOT, Picture, fingerprint
    from pogosim.utils import load_dataframe
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"first_program.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

PLACES = {"~/pogosim": str(ROOT), "~/pogobot-sdk": os.environ.get("POGO_SDK", "")}
FILES = {"c": "main.c", "yaml": "conf/crowds.yaml", "python": "plot.py"}
NAMES = ("first_program_run.png", "first_program_plot.png")


def commanded(commands: str, folder: Path) -> str:
    """Run shell commands of the page; return what they printed."""
    for place, here in PLACES.items():
        commands = commands.replace(place, here)
    return run(commands, folder, {**os.environ, "POGOSIM_DIR": str(ROOT)}, timeout_s=120)


def follow(page: Path, folder: Path) -> None:
    """Do all that the page says, in a folder."""
    project = folder / "crowds"
    output = ""
    for language, text in code_blocks(page):
        if language == "sh" and ("POGO_SDK" not in text or "POGO_SDK" in os.environ):
            output = commanded(text, project if project.exists() else folder)
        elif language == "":
            check_printed(text, output)
        elif language in FILES and (language != "c" or "int main(void)" in text):
            (project / FILES[language]).write_text(text, encoding="utf-8")


def pictures_in(project: Path) -> dict[str, Picture]:
    """Return the pictures that the page's commands have made in a project."""
    results = project / "results"
    runs = [load_dataframe(path)[0] for path in sorted(results.glob("*.feather"))]
    return {
        "first_program_run.png": Picture((results / "run.png").read_bytes(), fingerprint(runs[0])),
        "first_program_plot.png": Picture((results / "neighbours.png").read_bytes(), fingerprint(*runs)),
    }


def draw(folder: Path) -> dict[str, Picture]:
    """Follow the page; return the pictures that it made."""
    follow(DOCS / "first_program.md", folder)
    return pictures_in(folder / "crowds")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path, help="folder to follow the page in")
    options = parser.parse_args()
    if not options.folder.is_dir():
        parser.error(f"there is no folder {options.folder}")
    follow(DOCS / "first_program.md", options.folder)
