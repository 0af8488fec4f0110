"""What docs/messages.md says of mistakes in the first program of the README: they are made, and run.

.venv/bin/python docs/figures/all.py mistakes
"""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable
from pathlib import Path

from pages import code_blocks
from pictures import ROOT
from quotes import Quote
from validation.experiment import compiler_flags

CRASH = "    if (pogobot_helper_getid() == 7 && pogobot_ticks == 100) { *(int volatile*)0 = 1; }\n"
ENDLESS = "    for (;;) {}\n"
TIMEOUT_S = 1  # of user code; the page shows the default
DEFAULT_TIMEOUT_S = 10

Change = Callable[[str], str]


def replaced(before: str, after: str) -> Change:
    """Change a text that must be there."""

    def change(text: str) -> str:
        assert before in text, before
        return text.replace(before, after)

    return change


def unchanged(text: str) -> str:
    """Change nothing."""
    return text


def with_step(line: str) -> Change:
    """Put a line at the start of user_step()."""
    return lambda text: re.sub(r"void user_step\(.*\n", lambda start: start[0] + line, text)


# By the quote: changes of the program and of the configuration, a run for each.
MISTAKES: dict[str, list[tuple[Change, Change]]] = {
    "unknown_key": [(unchanged, replaced("nb: 30", "nb: 30, raduis: 26.5"))],
    "wrong_values": [
        (unchanged, replaced("nb: 30", "nb: thirty")),
        (unchanged, replaced("nb: 30", "nb: 300")),
    ],
    "crash": [(with_step(CRASH), unchanged)],
    "endless_step": [(with_step(ENDLESS), unchanged)],
}
NAMES = tuple(f"messages.md: {name}" for name in MISTAKES)


def said(program: str, configuration: str, folder: Path) -> list[str]:
    """Compile and run a program without debug information; return its messages as the page shows them."""
    (folder / "first").mkdir(parents=True)
    (folder / "first" / "main.c").write_text(program, encoding="utf-8")
    (folder / "first" / "first.yaml").write_text(configuration, encoding="utf-8")
    command = ["cc", "-std=c11", "-w", "first/main.c", "-o", "first/first", *compiler_flags()]
    subprocess.run(command, cwd=folder, check=True)
    settings = [f"user_code_timeout={TIMEOUT_S}", "simulation_time=2"]
    command = ["first/first", "-c", "first/first.yaml", "-g", "-q", *(f"--set={setting}" for setting in settings)]
    done = subprocess.run(command, cwd=folder, stderr=subprocess.PIPE, text=True, timeout=60, check=False)
    lines = [re.sub(r"^\[\d[^]]*\] ", "", line) for line in done.stderr.splitlines()]
    return [line.replace(f"within {TIMEOUT_S} s", f"within {DEFAULT_TIMEOUT_S} s") for line in lines]


def draw(folder: Path) -> dict[str, Quote]:
    """Make all mistakes."""
    blocks = code_blocks(ROOT / "README.md")
    program, configuration = (next(text for language, text in blocks if language == name) for name in ("c", "yaml"))
    made = {}
    for name, mistakes in MISTAKES.items():
        lines: list[str] = []
        for number, (of_program, of_configuration) in enumerate(mistakes):
            lines += said(of_program(program), of_configuration(configuration), folder / f"{name}{number}")
        made[f"messages.md: {name}"] = Quote(tuple(lines))
    return made
