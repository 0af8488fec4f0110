"""tests/distributions/run.sh, which tries README on bare machines, says before it starts what it cannot do."""

from __future__ import annotations

import subprocess

import pytest
from running import ROOT

FOLDER = ROOT / "tests" / "distributions"
ROWS = [line.split() for line in (FOLDER / "table.txt").read_text().splitlines() if not line.startswith("#")]


def run(*arguments: str) -> tuple[int, str, str]:
    """Run the script; returns its exit code, output and errors."""
    command = [str(FOLDER / "run.sh"), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    return done.returncode, done.stdout, done.stderr


def test_each_distribution_has_a_name_a_suite_its_maker_and_components() -> None:
    assert {len(row) for row in ROWS} == {4}
    assert len({row[0] for row in ROWS}) == len({row[1] for row in ROWS}) == len(ROWS)
    code, output, errors = run("--help")
    assert (code, errors) == (0, "")
    assert [line.strip() for line in output.splitlines()[-len(ROWS) :]] == [row[0] for row in ROWS]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["debian-1"], 'run.sh: unknown distribution "debian-1"; expected one of:'),
        (["#"], 'run.sh: unknown distribution "#"; expected one of:'),
        (["debian-12", "--slow"], "run.sh: unknown option --slow; expected --quick or --roots FOLDER"),
        (["debian-12", "debian-13"], "run.sh: two names, debian-12 and debian-13; expected one"),
        (["debian-12", "--roots"], "run.sh: --roots: expected a folder after it"),
    ],
)
def test_mistake_is_one_line(arguments: list[str], message: str) -> None:
    code, output, errors = run(*arguments)
    assert (code, output) == (2, "")
    assert errors.splitlines()[0] == message
