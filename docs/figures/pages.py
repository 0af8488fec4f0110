"""What the scripts share that follow a page of docs/ word for word: its code blocks, and running commands."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", flags=re.DOTALL | re.MULTILINE)


def code_blocks(page: Path) -> list[tuple[str, str]]:
    """Return the code blocks of a page: language (empty: what a command prints) and text."""
    return BLOCK.findall(page.read_text(encoding="utf-8"))


def run(commands: str, folder: Path, environment: Mapping[str, str], timeout_s: float) -> str:
    """Run shell commands; return what they printed. The first that fails ends the script."""
    done = subprocess.run(
        ["bash", "-euc", commands],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=timeout_s,
        check=False,
    )
    if done.returncode != 0:
        sys.exit(f"{commands}\n{done.stdout}")
    return done.stdout


def check_printed(quoted: str, output: str) -> None:
    """End the script if a line that the page quotes was not printed."""
    if not set(quoted.splitlines()) <= set(output.splitlines()):
        sys.exit(f"The page says\n{quoted}but this was printed:\n{output}")
