"""Runs with several threads, as users start them: the same bytes, and one line when something goes wrong."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from running import Run, example, run

Compile = Callable[[str], Path]

SWARMS: dict[str, dict[str, object]] = {
    "run_and_tumble": {"physics_engine": "disk"},
    "moving_oscillators": {},
    "push_sum": {"message_log": "messages.feather"},
    "phototaxis": {"boundary_condition": "periodic"},
}


def run_with(threads: object, name: str, folder: Path) -> Run:
    folder.mkdir()
    large = {"objects.robots.nb": 5000, "arena_surface": 4e7, "simulation_time": 3.0, "save_data_period": 0.5}
    result = run(example(name), folder, {**large, **SWARMS[name], "threads": threads})
    assert result.code == 0, result.text
    return result


@pytest.mark.parametrize("name", SWARMS)
def test_any_number_of_threads_gives_the_same_bytes(name: str, tmp_path: Path) -> None:
    expected = run_with(1, name, tmp_path / "1")
    files = sorted(path.name for path in expected.folder.glob("*.feather"))
    assert len(expected.frame()) == 7 * 5000
    for threads in (2, 3, "auto"):
        result = run_with(threads, name, tmp_path / str(threads))
        for file in files:
            assert (result.folder / file).read_bytes() == (expected.folder / file).read_bytes(), (threads, file)


@pytest.mark.skipif(sys.platform != "linux", reason="finds its threads in /proc")
def test_crash_of_a_worker_ends_the_run_soon_with_its_data(program: Compile, tmp_path: Path) -> None:
    began_s = time.monotonic()
    result = run(
        program("crash_of_other_threads.c"),
        tmp_path,
        {"threads": 3, "objects.robots.nb": 3000, "arena_surface": 3e7, "initial_formation": "disk"},
    )
    assert time.monotonic() - began_s < 20.0
    assert result.code == 3
    (line,) = result.errors.splitlines()
    assert "the simulator crashed while it was working on a step (segmentation fault" in line
    assert line.endswith("The data file 'data.feather' contains all rows up to that point")
    assert 0.4 < float(result.frame()["time"].max()) < 1.5
