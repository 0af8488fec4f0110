"""Does what docs/first_program.md says, block by block, with its two pictures.

    .venv/bin/python docs/figures/first_program.py FOLDER    # leaves the project in FOLDER
    .venv/bin/python docs/figures/all.py first_program       # draws

A C program becomes main.c, YAML conf/crowds.yaml, Python plot.py; shell commands are run, and what the page says that
they print must be in their output. `make bin` is left out unless POGO_SDK says where the SDK is.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

from pictures import DOCS, ROOT, Picture, fingerprint
from pogosim.utils import load_dataframe

BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", flags=re.DOTALL | re.MULTILINE)
PLACES = {"~/pogosim": str(ROOT), "~/pogobot-sdk": os.environ.get("POGO_SDK", "")}
FILES = {"c": "main.c", "yaml": "conf/crowds.yaml", "python": "plot.py"}
NAMES = ("first_program_run.png", "first_program_plot.png")


def run(commands: str, folder: Path) -> str:
    """Run shell commands; return what they printed."""
    for place, here in PLACES.items():
        commands = commands.replace(place, here)
    environment = {**os.environ, "POGOSIM_DIR": str(ROOT)}
    done = subprocess.run(
        ["bash", "-euc", commands],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=120,
        check=False,
    )
    if done.returncode != 0:
        sys.exit(f"{commands}\n{done.stdout}")
    return done.stdout


def follow(page: Path, folder: Path) -> None:
    """Do all that the page says, in a folder."""
    project = folder / "crowds"
    output = ""
    for language, text in BLOCK.findall(page.read_text(encoding="utf-8")):
        if language == "sh" and ("POGO_SDK" not in text or "POGO_SDK" in os.environ):
            output = run(text, project if project.exists() else folder)
        elif language == "" and not set(text.splitlines()) <= set(output.splitlines()):
            sys.exit(f"The page says\n{text}but this was printed:\n{output}")
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
    follow(DOCS / "first_program.md", Path(sys.argv[1]))
