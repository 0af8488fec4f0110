"""The choice of the physics engine, as a user makes it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from pogosim.utils import load_dataframe
from running import Run, example, run

CROWD = {"objects.robots.nb": 150, "arena_surface": 1.2e6, "simulation_time": 10.0, "save_data_period": 0.5}
RADIUS_MM = 26.5


def data(result: Run) -> bytes:
    return (result.folder / "data.feather").read_bytes()


def test_crowd_of_the_disk_engine_keeps_apart_and_in_its_arena_with_equal_bytes(tmp_path: Path) -> None:
    results = []
    for name in ("first", "second"):
        (tmp_path / name).mkdir()
        result = run(example("run_and_tumble"), tmp_path / name, {**CROWD, "physics_engine": "disk"})
        assert result.code == 0, result.text
        results.append(result)
    assert data(results[0]) == data(results[1])

    rows, metadata = load_dataframe(results[0].folder / "data.feather")
    assert metadata["resolved_configuration"]["physics_engine"] == "disk"
    arena_radius_mm = np.sqrt(CROWD["arena_surface"] / np.pi)
    for _, frame in rows[rows["time"] > 0].groupby("time"):
        places = frame[["x", "y"]].to_numpy()
        apart = np.hypot(*(places[:, None] - places[None, :]).T)[np.triu_indices(len(places), 1)]
        assert apart.min() > 2 * RADIUS_MM - 0.5
        # The arena is a polygon with as many sides as a circle needs.
        assert np.hypot(*(places - arena_radius_mm).T).max() < arena_radius_mm - RADIUS_MM + 1.5


SHAPES = pytest.mark.parametrize(
    ("settings", "reason"),
    [
        ({"objects.bars": {"type": "passive_object", "nb": 1, "geometry": "rectangle", "body_width": 50,
                           "body_height": 20, "x": 300, "y": 300}}, "'bars' has another shape and can move"),
        ({"objects.rings": {"type": "rectmembrane", "nb": 1, "geometry": "disk", "radius": 200, "x": 500, "y": 500}},
         "'rings' is a membrane of segments"),
    ],
)  # fmt: skip


@SHAPES
def test_disk_engine_refuses_what_is_no_disk(tmp_path: Path, settings: dict[str, object], reason: str) -> None:
    result = run(example("run_and_tumble"), tmp_path, {"physics_engine": "disk", **settings})
    line = next(
        number
        for number, text in enumerate((tmp_path / "scene.yaml").read_text().splitlines(), 1)
        if text.startswith("physics_engine")
    )
    expected = f"Error: scene.yaml:{line}: physics_engine: disk moves disks only, but {reason}; use auto or box2d\n"
    assert (result.code, result.errors) == (2, expected)


@SHAPES
def test_automatic_choice_of_box2d_is_explained(tmp_path: Path, settings: dict[str, object], reason: str) -> None:
    short = {"simulation_time": 0.1, "arena_file": "arenas/square.csv", **settings}
    for boundary, more in (("solid", ""), ("periodic", "; bodies do not meet across the borders of the arena")):
        result = run(example("run_and_tumble"), tmp_path, {**short, "boundary_condition": boundary})
        assert result.code == 0, result.text
        (line,) = [line for line in result.output.splitlines() if "physics_engine: " in line]
        assert line.endswith(f"[info] physics_engine: box2d, since disk moves disks only, but {reason}{more}")
    assert "physics_engine: " not in run(example("run_and_tumble"), tmp_path, {"simulation_time": 0.1}).output
