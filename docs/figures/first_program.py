"""Does what docs/first_program.md says, block by block, and keeps its two pictures.

    .venv/bin/python docs/figures/first_program.py [FOLDER]

Works in FOLDER (default: a temporary one), in which pictures stay; without FOLDER they go to docs/. A C program becomes
main.c, YAML conf/crowds.yaml, Python plot.py; shell commands are run, and what the page says that they print must be in
their output. `make bin` is left out unless POGO_SDK says where the SDK is.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", flags=re.DOTALL | re.MULTILINE)
PLACES = {"~/pogosim": str(ROOT), "~/pogobot-sdk": os.environ.get("POGO_SDK", "")}
FILES = {"c": "main.c", "yaml": "conf/crowds.yaml", "python": "plot.py"}
PICTURES = {"results/run.png": "first_program_run.png", "results/neighbours.png": "first_program_plot.png"}


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


def main() -> None:
    """Follow the page and keep the pictures."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(temporary)
        follow(ROOT / "docs/first_program.md", folder)
        if len(sys.argv) == 1:
            for made, picture in PICTURES.items():
                shutil.copy(folder / "crowds" / made, ROOT / "docs" / picture)


if __name__ == "__main__":
    main()
