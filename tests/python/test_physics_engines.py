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


RINGS: dict[str, object] = {
    "objects.rings": {"type": "rectmembrane", "nb": 1, "geometry": "disk", "radius": 200, "x": 500, "y": 500}
}
BARS: dict[str, object] = {
    "objects.bars": {"type": "passive_object", "nb": 1, "geometry": "rectangle", "body_width": 50, "body_height": 20,
                     "x": 300, "y": 300}
}  # fmt: skip


def test_robots_push_a_bar_across_the_seam_with_equal_bytes(tmp_path: Path) -> None:
    settings: dict[str, object] = {
        **BARS,
        "boundary_condition": "periodic",
        "arena_file": "arenas/square.csv",
        "arena_surface": 2.5e5,
        "objects.robots.nb": 40,
        "simulation_time": 60.0,
        "save_data_period": 1.0,
    }
    results = []
    for threads in (1, 2):
        (tmp_path / str(threads)).mkdir()
        result = run(example("run_and_tumble"), tmp_path / str(threads), {**settings, "threads": threads})
        assert result.code == 0, result.text
        results.append(result)
    rows, metadata = load_dataframe(results[0].folder / "data.feather")
    assert metadata["resolved_configuration"]["physics_engine"] == "disk"
    assert rows.equals(load_dataframe(results[1].folder / "data.feather")[0])
    bar = rows[rows["robot_category"] == "bars"]
    assert np.ptp(bar["angle"]) > 0.1
    # It was pushed, and no robot stands in it.
    assert len(bar[["x", "y"]].drop_duplicates()) > 10
    size_mm = np.sqrt(settings["arena_surface"])  # type: ignore[call-overload]
    for time, frame in rows[rows["time"] > 0].groupby("time"):
        (x, y, angle) = bar[bar["time"] == time][["x", "y", "angle"]].to_numpy()[0]
        way = (frame[frame["robot_category"] == "robots"][["x", "y"]].to_numpy() - (x, y) + size_mm / 2) % size_mm
        way -= size_mm / 2
        along = np.abs(way @ (np.cos(angle), np.sin(angle)))
        across = np.abs(way @ (-np.sin(angle), np.cos(angle)))
        gap = np.hypot(np.maximum(along - 25, 0), np.maximum(across - 10, 0)) - RADIUS_MM
        assert gap.min() > -0.5, time


@pytest.mark.parametrize("boundary", ["solid", "periodic"])
def test_everything_is_moved_by_our_own_engine(boundary: str, tmp_path: Path) -> None:
    settings = {"simulation_time": 0.1, "arena_file": "arenas/square.csv", "boundary_condition": boundary}
    result = run(example("run_and_tumble"), tmp_path, {**settings, **RINGS, **BARS})
    assert result.code == 0, result.text
    assert "physics_engine" not in result.output
    metadata = load_dataframe(tmp_path / "data.feather")[1]
    assert metadata["resolved_configuration"]["physics_engine"] == "disk"
