from __future__ import annotations

import pytest
from pogosim.reports.command import ANALYSES, main


@pytest.mark.parametrize("arguments", [["--help"], ["-h"], ["help"]])
def test_help_lists_all_analyses(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(arguments) == 0
    printed = capsys.readouterr().out
    assert [line.split()[0] for line in printed.splitlines() if line.startswith("  ")] == list(ANALYSES)


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
