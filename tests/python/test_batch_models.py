"""Batches of robots whose model is a file that names another one, a script: as single runs take them."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
from batches import batch, run_main, write_options
from running import example

NO_OPTIONS = {"objects.robots.nb": 2, "result_new_columns": [], "objects.robots.robot_model": "model.yaml"}


def write_robots(folder: Path, power: int) -> None:
    """Write a model that names a script, in which both motors have a power."""
    (folder / "model.yaml").write_text("brain: {script: dance.yaml}\n")
    (folder / "dance.yaml").write_text(f"script: [{{time_s: 0, motors: [{power}, {power}, 0]}}]\n")


def moved_mm(results: Path) -> float:
    """Return how far the first robot went along its heading."""
    frame = pd.read_feather(results / "result.feather")
    one = frame[(frame["robot_id"] == 0) & (frame["run"] == 0)]
    return float(((one["x"].iloc[-1] - one["x"].iloc[0]) ** 2 + (one["y"].iloc[-1] - one["y"].iloc[0]) ** 2) ** 0.5)


def test_run_whose_script_has_changed_is_done_again(tmp_path: Path) -> None:
    write_options(tmp_path, NO_OPTIONS)
    moved = []
    for power in (0, 1023, 1023):
        write_robots(tmp_path, power)
        done = batch(tmp_path, "-r", "2", "--keep-temp")
        assert done.code == 0, done.text
        moved.append(moved_mm(tmp_path / "results"))
    assert moved[0] < 1.0
    assert moved[1] > 50.0
    assert moved[2] == moved[1]
    assert "2 of 2 runs are done already" in done.output


def test_script_is_found_beside_the_configuration_from_any_folder(tmp_path: Path) -> None:
    conf = write_options(tmp_path / "conf", NO_OPTIONS)
    write_robots(conf.parent, 1023)
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    options = ["-c", str(conf), "-S", str(example("helloworld")), "-t", "tmp", "-o", "results", "-r", "1"]
    done = run_main(elsewhere, options)
    assert done.code == 0, done.text
    assert moved_mm(elsewhere / "results") > 50.0


def test_mistake_in_a_model_or_its_script_is_not_repeated(tmp_path: Path) -> None:
    write_options(tmp_path, NO_OPTIONS)
    for name, text, problem in (
        ("model.yaml", "faces: 7\n", "faces: expected a list"),
        ("dance.yaml", "script: [{time_s: -1}]\n", "time_s: expected"),
    ):
        write_robots(tmp_path, 0)
        (tmp_path / name).write_text(text)
        done = batch(tmp_path, "-r", "1")
        assert done.code == 3
        assert problem in done.errors
        assert "times" not in done.errors, done.errors
