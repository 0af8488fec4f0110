"""Formations place objects around what has a fixed place: whole runs of a built example, looked at at time 0."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import pyarrow as pa
import pytest
from running import Run, example, run

Floats = npt.NDArray[np.float64]

RADIUS_MM = 26.5
DOT_RADIUS_MM = 10.0
FORMATIONS = [
    "random",
    "aligned_random",
    "random_near_walls",
    "aligned_random_near_walls",
    "disk",
    "aligned_disk",
    "lloyd",
    "power_lloyd",
    "chessboard",
    "aligned_chessboard",
    "lattice",
    "aligned_lattice",
]

MEMBRANE: dict[str, Any] = {
    "type": "membrane",
    "nb": 1,
    "geometry": "disk",
    "radius": 250,
    "num_dots": 80,
    "dot_radius": DOT_RADIUS_MM,
    "serialize_dot_pose": True,
    "x": 400,
    "y": 420,
}
BOX: dict[str, Any] = {
    "type": "passive_object",
    "nb": 1,
    "geometry": "rectangle",
    "body_width": 240,
    "body_height": 140,
    "body_density": 1000,
    "x": 900,
    "y": 800,
}
SCENE: dict[str, Any] = {
    "arena_file": "arenas/square.csv",
    "arena_surface": 1.44e6,
    "simulation_time": 0.02,
    "chessboard_distance_between_neighbors": 60,
    "objects.robots.nb": 100,
    "objects.membranes": MEMBRANE,
    "objects.box": BOX,
}


def simulate(folder: Path, **changes: object) -> Run:
    done = run(example("walls"), folder, {**SCENE, **changes})
    assert done.code == 0, done.text
    return done


def positions(rows: pd.DataFrame) -> Floats:
    return rows[["x", "y"]].to_numpy(dtype=float)


def at_start(done: Run) -> tuple[Floats, Floats, pd.DataFrame]:
    """Robots and the membrane's dots at time 0, shape (n, 2), and all rows of that time."""
    rows = done.frame()
    rows = rows[rows["time"] == 0.0]
    dots = rows[rows["subpart_id"] >= 0].sort_values("subpart_id")
    return positions(rows[rows["robot_category"] == "robots"]), positions(dots), rows


def distance_to_line(points: Floats, corners: Floats) -> Floats:
    """Distance of each point to a closed line."""
    along = np.roll(corners, -1, axis=0) - corners
    offset = points[:, None, :] - corners
    share = np.clip((offset * along).sum(axis=-1) / (along**2).sum(axis=-1), 0.0, 1.0)
    return np.asarray(np.linalg.norm(offset - share[..., None] * along, axis=-1).min(axis=1))


def distance_to_box(points: Floats, box: dict[str, Any]) -> Floats:
    beyond = np.abs(points - [box["x"], box["y"]]) - np.array([box["body_width"], box["body_height"]]) / 2
    return np.asarray(np.linalg.norm(np.maximum(beyond, 0.0), axis=1))


def warnings(done: Run) -> list[str]:
    return [line for line in done.text.splitlines() if "warning" in line.lower()]


@pytest.mark.parametrize("formation", FORMATIONS)
def test_no_robot_starts_in_a_membrane_s_band_or_in_a_box(tmp_path: Path, formation: str) -> None:
    done = simulate(tmp_path, initial_formation=formation)
    robots, dots, _ = at_start(done)
    assert len(robots) == 100
    assert len(dots) == 80
    assert distance_to_line(robots, dots).min() >= RADIUS_MM + DOT_RADIUS_MM
    assert distance_to_box(robots, BOX).min() >= RADIUS_MM
    assert warnings(done) == []


@pytest.mark.parametrize("formation", FORMATIONS)
def test_robots_inside_a_membrane_keep_off_what_else_stands_there(tmp_path: Path, formation: str) -> None:
    box = {**BOX, "x": 420, "y": 450, "body_height": 80}
    changes = {"initial_formation": formation, "initial_formation_root_object": "membranes"}
    robots, dots, _ = at_start(simulate(tmp_path, **changes, **{"objects.robots.nb": 25, "objects.box": box}))
    assert len(robots) == 25
    assert np.linalg.norm(robots - [400, 420], axis=1).max() < 250
    assert distance_to_line(robots, dots).min() >= RADIUS_MM + DOT_RADIUS_MM
    assert distance_to_box(robots, box).min() >= RADIUS_MM


def test_nothing_that_the_formation_places_starts_in_a_robot_with_a_place(tmp_path: Path) -> None:
    changes = {
        f"objects.leader_{i}": {"type": "pogobot", "geometry": "disk", "radius": RADIUS_MM, "x": x, "y": 900}
        for i, x in enumerate((100, 154, 208, 700))
    }
    _, _, rows = at_start(simulate(tmp_path, **changes))
    points = positions(rows[rows["robot_category"].str.startswith(("robots", "leader"))])
    assert len(points) == 104
    apart = np.linalg.norm(points[:, None] - points[None], axis=-1)
    assert apart[np.triu_indices(104, k=1)].min() >= 2 * RADIUS_MM


def test_file_of_poses_rules_and_clashes_are_one_warning(tmp_path: Path) -> None:
    (tmp_path / "poses.csv").write_text("1100,100\n900,800\n655,420\n1100,300\n")
    done = simulate(tmp_path, initial_formation="imported", formation_filename="poses.csv", **{"objects.robots.nb": 4})
    robots, _, _ = at_start(done)
    np.testing.assert_allclose(robots, [[1100, 100], [900, 800], [655, 420], [1100, 300]])
    (warning,) = warnings(done)
    assert "poses.csv: 2 pairs of objects overlap: first robots 2 at (655, 420) and membranes 65535 at" in warning
    assert "; physics pushes them apart" in warning


def test_table_with_a_column_twice_is_refused_and_degrees_are_told_once(tmp_path: Path) -> None:
    settings: dict[str, object] = {"initial_formation": "imported", "formation_filename": "poses.feather"}
    settings |= {"arena_file": "arenas/square.csv", "arena_surface": 1e6, "objects.robots.nb": 2}
    names = ["x", "y", "angle"]
    columns = [pa.array([100.0, 200.0]), pa.array([100.0, 100.0]), pa.array([90.0, 180.0])]
    for twice in range(3):
        table = pa.Table.from_arrays([*columns, columns[twice]], [*names, names[twice]])
        write_table(tmp_path / "poses.feather", table)
        done = run(example("helloworld"), tmp_path, settings)
        assert done.code == 2
        assert f"poses.feather': it has several columns '{names[twice]}'; rename or remove all but one" in done.errors
    write_table(tmp_path / "poses.feather", pa.Table.from_arrays(columns, names))
    done = run(example("helloworld"), tmp_path, settings)
    assert done.code == 0
    assert done.errors.count("poses.feather:0: the angle 90 rad is unusually large, like that of another row") == 1


def write_table(path: Path, table: pa.Table) -> None:
    with pa.ipc.new_file(str(path), table.schema) as file:
        file.write_table(table)


def test_fixed_objects_deep_in_each_other_or_in_a_wall_are_named(tmp_path: Path) -> None:
    sunk = {**BOX, "x": 1180, "y": 200}  # 100 mm of it are beyond the wall
    across = {**BOX, "x": 650, "y": 420}  # on the membrane
    twins = {**BOX, "nb": 2, "x": 200, "y": 1000}
    changes = {"objects.sunk": sunk, "objects.across": across, "objects.twins": twins, "objects.robots.nb": 5}
    changes["initial_formation"] = "power_lloyd"  # not a chessboard, whose pitch the scene has
    sunk_line, *others = sorted(warnings(simulate(tmp_path, **changes)), key=lambda line: "sunk" not in line)
    assert "objects.sunk.x: 'sunk' at (1180, 200) extends 100.0 mm into an arena wall" in sunk_line
    across_line, twins_line = sorted(others, key=lambda line: "twins" in line)
    assert "objects.across.x: 'across' at (650, 420) overlaps 'membranes' by " in across_line
    assert "objects.twins.x: 'twins' at (200, 1000) has all 2 objects on top of each other" in twins_line


def test_fixed_objects_that_touch_are_no_mistake(tmp_path: Path) -> None:
    beside = {**BOX, "x": 1080 + 0.5, "y": 200}  # into the wall by half a millimetre
    below = {**BOX, "y": 800 + 139.5}  # and into the other box
    changes = {"objects.beside": beside, "objects.below": below, "initial_formation": "power_lloyd"}
    assert warnings(simulate(tmp_path, **changes)) == []


@pytest.mark.parametrize("engine", ["disk", "box2d"])
def test_objects_at_the_same_place_part(tmp_path: Path, engine: str) -> None:
    (tmp_path / "poses.csv").write_text("x,y\n300,500\n700,500\n700,500\n700,500\n")
    settings = {
        "initial_formation": "imported",
        "formation_filename": "poses.csv",
        "physics_engine": engine,
        "objects.robots.nb": 4,
        "simulation_time": 20.0,
        "save_data_period": 20.0,
    }
    result = run(example("helloworld"), tmp_path, settings)
    assert result.code == 0
    assert "3 pairs of objects overlap" in result.errors
    last = result.frame().groupby("robot_id").last()[["x", "y"]].to_numpy()
    apart = [math.dist(a, b) for i, a in enumerate(last) for b in last[:i]]
    assert min(apart) > 2 * 26.0


def test_run_begins_where_an_earlier_one_was(tmp_path: Path) -> None:
    program = example("run_and_tumble")
    earlier = run(program, tmp_path / "earlier", {"objects.robots.nb": 8}).frame()
    settings = {
        "objects.robots.nb": 8,
        "initial_formation": "imported",
        "formation_filename": str(tmp_path / "earlier" / "data.feather"),
    }
    for time, expected in (("last", 2.0), (0.55, 0.5), (1.2, 1.2), (0, 0.0), (2.0, 2.0)):
        result = run(program, tmp_path / "later", {**settings, "formation_time": time, "simulation_time": 0.1})
        assert result.code == 0, result.text
        now = result.frame().query("time == 0").set_index("robot_id")[["x", "y", "angle"]]
        then = earlier[(earlier.time - expected).abs() < 1e-9].set_index("robot_id")[["x", "y", "angle"]]
        pd.testing.assert_frame_equal(now, then, atol=1e-4)
    late = run(program, tmp_path / "late", {**settings, "formation_time": 3})
    assert late.code == 2
    assert "formation_time: " in late.errors
    assert "has no rows of t = 3 s: its 21 times are from 0 to 2 s; 'last' takes the last one" in late.errors
    assert run(program, tmp_path / "late", {**settings, "formation_time": "first"}).code == 2
