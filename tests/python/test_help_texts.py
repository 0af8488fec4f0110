"""Help texts name the defaults that are used, and none that was written beside them."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest
from running import ROOT

SOURCES = sorted(
    path
    for folder in ("python/pogosim", "bench", "docs/figures", "examples/learning")
    for path in (ROOT / folder).rglob("*.py")
)
WRITTEN = re.compile(r"(?:\((?:default:? )?|default:? )\d[\d.e+_-]*(?: \w+)?\)?$")


def options(path: Path) -> list[tuple[int, str]]:
    """Return line and help text of each option that has a default."""
    calls = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Call)]
    named = [(call.lineno, {word.arg: word.value for word in call.keywords}) for call in calls]
    return [
        (line, text.value)
        for line, words in named
        if "default" in words and isinstance(text := words.get("help"), ast.Constant) and isinstance(text.value, str)
    ]


def test_no_default_is_written_into_a_help_text() -> None:
    found = [
        f"{path.relative_to(ROOT)}:{line}: {text!r}: say %(default)s"
        for path in SOURCES
        for line, text in options(path)
        if WRITTEN.search(text)
    ]
    assert found == []


@pytest.mark.parametrize(
    "text", ["runs (3)", "ticks per second, main_loop_hz (30)", "robots, default 10000", "window (2 s)"]
)
def test_written_defaults_are_found(text: str) -> None:
    assert WRITTEN.search(text)


def test_options_are_read() -> None:
    assert sum(len(options(path)) for path in SOURCES) > 60
