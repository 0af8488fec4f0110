"""Walls hold robots; periodic boundaries let robots and messages through."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
import yaml
from matplotlib.path import Path as Outline
from running import Run, example, run

SIDE = 1000.0  # mm, of the square arena of 1e6 mm^2
RADIUS = 26.5


def walk(folder: Path, **settings: object) -> Run:
    fast = {
        "simulation_time": 60.0,
        "objects.robots.nb": 20,
        "parameters.run_duration_max": 5000,
    }
    result = run(
        example("run_and_tumble"),
        folder,
        {"arena_file": "arenas/square.csv", **fast, **settings},
    )
    assert (result.code, result.errors) == (0, "")
    return result


def polygons(result: Run) -> list[npt.NDArray[np.float64]]:
    text = result.table().schema.metadata[b"arena_polygons"].decode()
    return [np.array([[p["x"], p["y"]] for p in corners]) for corners in yaml.safe_load(text)]


def distance_to_walls(points: npt.NDArray[np.float64], polygon: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    nearest = np.full(len(points), np.inf)
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        along = np.clip((points - a) @ (b - a) / np.dot(b - a, b - a), 0, 1)
        nearest = np.minimum(nearest, np.hypot(*(points - a - along[:, None] * (b - a)).T))
    return nearest


@pytest.mark.parametrize("arena", ["square", "disk", "star", "annulus", "squarewithHole", "H", "arena8"])
def test_no_robot_leaves_a_solid_arena_nor_enters_its_holes(tmp_path: Path, arena: str) -> None:
    result = walk(tmp_path, arena_file=f"arenas/{arena}.csv", arena_surface=5.0e5)
    points = result.frame()[["x", "y"]].to_numpy(dtype=np.float64)
    outer, *holes = polygons(result)
    assert Outline(outer).contains_points(points).all()
    for polygon in (outer, *holes):
        # The physics lets bodies overlap by some tenths of a mm for a moment.
        assert distance_to_walls(points, polygon).min() > RADIUS - 2.0
    for hole in holes:
        assert not Outline(hole).contains_points(points).any()


@pytest.mark.parametrize(("radius", "speed"), [(1.0, 3e3), (1.0, 1e4), (26.5, 1e6)])
def test_no_robot_leaves_however_small_and_fast(tmp_path: Path, radius: float, speed: float) -> None:
    # Robots among light bodies, heads and bars, and a membrane with small dots unless they are too fast for it.
    solid = {"geometry": "disk", "radius": 10.0}
    soft = {
        "type": "membrane",
        "geometry": "disk",
        "radius": 60.0,
        "num_dots": 40,
        "dot_radius": 4.0,
    }
    settings = {
        "arena_file": "arenas/annulusBarred.csv",
        "simulation_time": 2.0,
        "save_data_period": 0.02,
        "objects.robots.radius": radius,
        "objects.robots.max_linear_speed": speed,
        "objects.robots.linear_noise_stddev": speed / 1000.0,
        "objects.robots.nb": 10,
        "objects.light": {
            "type": "passive_object",
            "nb": 5,
            "body_density": 0.1,
            **solid,
        },
        "objects.heads": {"type": "pogobject", "nb": 5, **solid},
        "objects.bars": {"type": "passive_object", "nb": 3, "geometry": "rectangle"},
        "objects.bars.body_width": 60.0,
        "objects.bars.body_height": 4.0,
        "objects.soft": {**soft, "nb": 1 if speed <= 3e3 else 0, "serialize_dot_pose": True},
    }
    result = run(example("run_and_tumble"), tmp_path, settings)
    assert result.code == 0, result.text
    rows = result.frame().query("robot_category != 'soft' or subpart_id >= 0")
    points = rows[["x", "y"]].to_numpy(dtype=np.float64)
    assert len(points) > 2000
    outer, *holes = polygons(result)
    assert Outline(outer).contains_points(points).all()
    for hole in holes:
        assert not Outline(hole).contains_points(points).any()


def test_speeds_that_box2d_cannot_follow_are_refused_with_the_largest_that_it_can(
    tmp_path: Path,
) -> None:
    box2d = {"physics_engine": "box2d"}
    spin = "objects.robots.max_angular_speed"
    result = run(example("run_and_tumble"), tmp_path, {**box2d, spin: 1e4})
    assert result.code == 2
    assert (
        "objects.robots.max_angular_speed: at 10000 rad/s, robots turn up to 400 rad in a time_step of 0.01 s, more "
        "than the 156 rad that can be simulated. Use at most 3880 rad/s, or a time_step of at most 0.00388 s"
    ) in result.errors
    assert not (tmp_path / "data.feather").exists()
    for accepted in ({spin: 3.88e3}, {spin: 1e4, "time_step": 0.00388}):
        assert (
            run(
                example("run_and_tumble"),
                tmp_path,
                {**box2d, **accepted, "simulation_time": 0.1},
            ).code
            == 0
        )

    # A program of 5 Hz may have steps of 0.2 s.
    slow = {
        **box2d,
        "objects.robots.max_linear_speed": 1e6,
        "time_step": 0.2,
        "parameters.loop_dt": 0.2,
    }
    result = run(example("coverage_neighbors_novelty"), tmp_path, slow)
    assert result.code == 2
    assert "scene.yaml:" in result.errors
    assert "objects.robots.max_linear_speed: at 1000000 mm/s, robots move up to 200000 mm in a" in result.errors
    assert "Use at most 99000 mm/s, or a time_step of at most 0.0198 s" in result.errors


def test_disk_engine_follows_any_speed(tmp_path: Path) -> None:
    speeds = {"objects.robots.max_linear_speed": 1e6, "objects.robots.max_angular_speed": 1e4}
    result = run(example("run_and_tumble"), tmp_path, {**speeds, "simulation_time": 5})
    assert result.code == 0, result.text
    places = result.frame()[["x", "y"]].to_numpy(dtype=np.float64)
    outer, *_ = polygons(result)
    assert len(places) > 0
    assert Outline(outer).contains_points(places).all()


def test_speeds_that_a_membrane_cannot_hold_back_are_refused_with_the_largest_that_it_can(tmp_path: Path) -> None:
    speed = "objects.robots.max_linear_speed"
    settings = {
        speed: 3e4,
        "simulation_time": 0.5,
        "objects.robots.nb": 5,
        "objects.robots.area": {"x": 500, "y": 500, "radius": 150},
        "objects.soft": {
            "type": "membrane",
            "geometry": "disk",
            "radius": 250,
            "x": 500,
            "y": 500,
            "num_dots": 120,
            "serialize_dot_pose": True,
        },
    }
    result = run(example("run_and_tumble"), tmp_path, settings)
    assert result.code == 2
    assert (
        "objects.robots.max_linear_speed: at 30000 mm/s, robots move up to 300 mm in a time_step of 0.01 s, more than "
        "the 200 mm that a membrane can hold back. Use at most 20000 mm/s, or a time_step of at most 0.00666 s"
    ) in result.errors
    for accepted in ({speed: 2e4}, {"time_step": 0.00666}):
        result = run(example("run_and_tumble"), tmp_path, {**settings, **accepted})
        assert result.code == 0, result.text
        for _, rows in result.frame().groupby("time"):
            ring = Outline(rows.query("subpart_id >= 0")[["x", "y"]].to_numpy(dtype=np.float64))
            assert ring.contains_points(rows.query("robot_category == 'robots'")[["x", "y"]]).all()


def test_robots_leave_a_periodic_arena_on_one_side_and_come_back_on_the_other(
    tmp_path: Path,
) -> None:
    frame = walk(tmp_path, boundary_condition="periodic").frame()
    crossings = 0
    for column in ("x", "y"):
        path = frame.pivot(index="time", columns="robot_id", values=column).to_numpy(dtype=np.float64)
        assert path.min() >= 0
        assert path.max() <= SIDE
        step = np.diff(path, axis=0)
        crossings += int((np.abs(step) > SIDE / 2).sum())
        on_the_ring = np.abs((step + SIDE / 2) % SIDE - SIDE / 2)
        # 100 mm/s in 0.1 s. A robot that arrives on top of another is pushed aside: none touch across the seam.
        assert np.quantile(on_the_ring, 0.99) < 10.1
        assert on_the_ring.max() < 10.0 + 2 * RADIUS
    assert crossings > 20


@pytest.mark.parametrize("text", ["", "\n \n", "# an arena\n"])
def test_arena_file_without_polygons_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "none.csv").write_text(text)
    result = run(example("run_and_tumble"), tmp_path, {"arena_file": "none.csv"})
    assert result.code == 2
    assert "none.csv: the file has no polygon" in result.errors
    assert "boundary_condition: periodic" in result.errors
    assert not (tmp_path / "data.feather").exists()


@pytest.mark.parametrize("name", ["empty", "torus"])
def test_bundled_arena_empty_or_torus_is_a_periodic_square(tmp_path: Path, name: str) -> None:
    settings = {"arena_file": f"arenas/{name}.csv", "simulation_time": 30.0, "objects.robots.nb": 10}
    result = run(example("run_and_tumble"), tmp_path, settings)
    assert (result.code, result.errors) == (0, "")
    frame = result.frame()
    assert frame["x"].between(0, SIDE).all()
    assert frame.groupby("robot_id")["x"].agg(lambda x: x.diff().abs().max()).max() > SIDE / 2


@pytest.mark.parametrize(("boundary", "heard"), [("solid", False), ("periodic", True)])
@pytest.mark.parametrize("axis", [0, 1])
def test_messages_pass_the_seam_of_a_periodic_arena_only(tmp_path: Path, boundary: str, heard: bool, axis: int) -> None:
    # Two robots 60 mm apart across the seam, 940 mm within the arena.
    positions = np.array([[30.0, 500.0], [970.0, 500.0]])
    if axis == 1:
        positions = positions[:, ::-1]
    rows = "\n".join(f"{x},{y}" for x, y in positions)
    (tmp_path / "poses.csv").write_text(f"x,y\n{rows}\n")
    settings = {
        "arena_file": "arenas/square.csv",
        "boundary_condition": boundary,
        "initial_formation": "imported",
        "formation_filename": "poses.csv",
        "objects.robots.nb": 2,
        "objects.robots.msg_success_rate": {"type": "static", "rate": 1.0},
        "simulation_time": 10.0,
        "parameters.send_percent": 100,
    }
    result = run(example("probes"), tmp_path, settings)
    assert result.code == 0
    last = result.frame().query("time == 10")
    sent, received = last["sent"].tolist(), last["received"].tolist()
    assert sent[0] == 625
    assert received[1] == (pytest.approx(sent[0], abs=2) if heard else 0)


def test_speeds_that_rounding_changes_are_told(tmp_path: Path) -> None:
    """Coordinates have 24 binary digits: up to 2^20 mm, neighbouring ones are 2^-4 mm apart."""
    settings = {"arena_file": "arenas/square.csv", "arena_surface": 1e12, "simulation_time": 0.1}
    result = run(example("helloworld"), tmp_path, settings)
    assert result.errors.splitlines()[0].endswith(
        "time_step: in an arena of 1000000 mm, positions are rounded to 0.0625 mm, so that in steps of 0.01 s all "
        "speeds are rounded to multiples of 6.25 mm/s; 'robots' drive at up to 100 mm/s (max_linear_speed). Use a "
        "longer time_step, or a smaller arena"
    )
    for change in ({"arena_surface": 1e8}, {"objects.robots.max_linear_speed": 2000}, {"objects.robots.nb": 0}):
        assert "rounded" not in run(example("helloworld"), tmp_path, {**settings, **change}).errors, change
    short = {**settings, "arena_surface": 1e6, "time_step": 1e-5, "simulation_time": 0.001}
    assert "multiples of 6.1 mm/s" in run(example("helloworld"), tmp_path, short).errors
