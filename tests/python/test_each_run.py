"""Work for each run of an analysis, in one process or several."""

from __future__ import annotations

import argparse
import os
import warnings
from pathlib import Path

import numpy as np
import pytest
from pogosim.errors import AmbiguousStepsWarning
from pogosim.reports.command import analyze
from pogosim.reports.each_run import for_each_run
from swarms import brownian_walk, metadata_of, rows_of, write_rows


def square_of(number: int) -> tuple[int, int]:
    """A number's square, with a warning, and the process that has computed it."""
    warnings.warn(f"{number} is squared", AmbiguousStepsWarning, stacklevel=1)
    return number * number, os.getpid()


def test_several_processes_return_results_in_order_and_their_warnings() -> None:
    with pytest.warns(AmbiguousStepsWarning) as told:
        found = for_each_run(square_of, [3, 1, 2], argparse.Namespace(jobs=2), "squares")
    assert [square for square, _ in found] == [9, 1, 4]
    assert os.getpid() not in {process for _, process in found}
    assert [str(warning.message) for warning in told] == ["3 is squared", "1 is squared", "2 is squared"]


@pytest.mark.filterwarnings("ignore::pogosim.errors.AmbiguousStepsWarning")
@pytest.mark.parametrize("options", [argparse.Namespace(), argparse.Namespace(jobs=1), argparse.Namespace(jobs=8)])
def test_one_process_is_this_one(options: argparse.Namespace) -> None:
    assert for_each_run(square_of, [5], options, "squares") == [(25, os.getpid())]


@pytest.mark.parametrize("name", ["locomotion", "network", "collective"])
def test_tables_do_not_depend_on_the_number_of_processes(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pogosim.reports.figures.FORMATS", ())
    for seed in range(3):
        position = np.clip(500.0 + brownian_walk(6, 9, 60.0, seed), 30.0, 970.0)
        write_rows(tmp_path / f"{seed}.feather", rows_of(position), metadata_of())
    tables = []
    for jobs in ("1", "2"):
        folder = tmp_path / f"jobs{jobs}"
        assert analyze(name, ["-i", str(tmp_path / "*.feather"), "-o", str(folder), "-j", jobs], "analyze") == 0
        tables.append({path.name: path.read_bytes() for path in folder.rglob("*.csv")})
    assert tables[0]
    assert tables[0] == tables[1]
