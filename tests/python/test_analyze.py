from __future__ import annotations

from pathlib import Path

import pytest
from matplotlib.figure import Figure
from pogosim.reports import figures
from pogosim.reports.command import ANALYSES, main


@pytest.mark.parametrize("arguments", [["--help"], ["-h"], ["help"]])
def test_help_lists_all_analyses(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(arguments) == 0
    printed = capsys.readouterr().out
    assert [line.split()[0] for line in printed.splitlines() if line.startswith("  ")] == list(ANALYSES.own)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "usage: pogosim analyze ANALYSIS"),
        (["--fast"], "pogosim analyze: there is no analysis '--fast'; pogosim analyze --help lists all analyses\n"),
        (["tea"], "pogosim analyze: there is no analysis 'tea'; pogosim analyze --help lists all analyses\n"),
    ],
)
def test_wrong_usage_says_what_there_is(arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(arguments) == 2
    assert capsys.readouterr().err.startswith(said)


def test_figures_of_arenas_with_dots_in_their_names_have_names_of_their_own(tmp_path: Path) -> None:
    for name in ("room1.5", "room1.6.pdf"):
        figures.save(Figure(), tmp_path / f"line__arena_{name}")
    names = {f"line__arena_room1.{end}" for end in ("5.pdf", "5.png", "6.pdf", "6.png")}
    assert {path.name for path in tmp_path.iterdir()} == names
