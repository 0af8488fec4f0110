"""Categories say where their objects start, and obstacles stay there: whole runs of built examples."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
import yaml
from matplotlib.path import Path as Outline
from pogosim.utils import load_dataframe
from running import ROOT, Run, example, run, run_command

Floats = npt.NDArray[np.float64]

ROBOT: dict[str, Any] = {"type": "pogobot", "geometry": "disk", "radius": 10}
BAR: dict[str, Any] = {"type": "passive_object", "geometry": "rectangle", "body_width": 40, "body_height": 300}
SQUARE: dict[str, Any] = {"arena_file": "arenas/square.csv", "arena_surface": 1.0e6}


def simulate(folder: Path, **changes: object) -> Run:
    done = run(example("run_and_tumble"), folder, {**SQUARE, "simulation_time": 0.05, **changes})
    assert done.code == 0, done.text
    return done


def at_start(done: Run, category: str) -> pd.DataFrame:
    rows = done.frame()
    return rows[(rows["time"] == 0.0) & (rows["robot_category"] == category)]


def points(rows: pd.DataFrame) -> Floats:
    return rows[["x", "y"]].to_numpy(dtype=float)


def warnings(done: Run) -> list[str]:
    """All but that the program of this test has nothing to do for some categories."""
    lines = [line for line in done.text.splitlines() if "warning" in line.lower()]
    return [line for line in lines if "the program has no pogobot_start() for category" not in line]


def test_obstacles_are_not_moved_by_robots_at_high_speed(tmp_path: Path) -> None:
    light = {"body_density": 0.01, "body_fixed": True}
    changes = {
        "simulation_time": 5,
        "seed": 2,
        "objects.robots": {**ROBOT, "nb": 30, "max_linear_speed": 3000},
        "objects.bar": {**BAR, **light, "x": 300, "y": 500, "angle": 0.5},
        "objects.head": {"type": "pogobject", "geometry": "disk", "radius": 60, **light, "x": 700, "y": 500},
        "objects.free": {**BAR, "body_density": 0.01, "x": 500, "y": 200},
    }
    done = simulate(tmp_path, **changes)
    assert warnings(done) == []
    rows = done.frame()
    poses = {name: of[["x", "y", "angle"]].to_numpy() for name, of in rows.groupby("robot_category")}
    np.testing.assert_array_equal(poses["bar"], np.tile(poses["bar"][0], (len(poses["bar"]), 1)))
    np.testing.assert_allclose(poses["bar"][0], [300, 500, 0.5])
    np.testing.assert_array_equal(poses["head"], np.tile([700, 500, 0], (len(poses["head"]), 1)))
    assert np.ptp(poses["free"], axis=0).max() > 1  # which the same robots push
    # Robots come near the obstacles, and their centres never enter them.
    along, across = (np.array([np.cos(0.5), np.sin(0.5)]), np.array([-np.sin(0.5), np.cos(0.5)]))
    offset = poses["robots"][:, :2] - [300, 500]
    beyond = np.maximum(np.abs(np.stack([offset @ along, offset @ across], axis=1)) - [20, 150], 0)
    to_bar = np.hypot(*beyond.T)
    to_head = np.hypot(*(poses["robots"][:, :2] - [700, 500]).T) - 60
    assert 9 < to_bar.min() < 12
    assert 9 < to_head.min() < 12


def test_categories_stand_in_their_areas_and_others_between_them(tmp_path: Path) -> None:
    corner = [[0, 600], [400, 600], [400, 1000], [0, 1000]]
    changes = {
        "objects.robots": {**ROBOT, "nb": 60},
        "objects.nest": {**ROBOT, "nb": 12, "area": {"x": 800, "y": 300, "radius": 150}},
        "objects.prey": {**ROBOT, "nb": 20, "area": corner, "initial_formation": "aligned_random"},
    }
    for formation in ("random", "disk", "lloyd", "power_lloyd", "chessboard", "random_near_walls"):
        done = simulate(
            tmp_path / formation, initial_formation=formation, chessboard_distance_between_neighbors=40, **changes
        )
        assert warnings(done) == []
        nest, prey, robots = (at_start(done, category) for category in ("nest", "prey", "robots"))
        assert (len(nest), len(prey), len(robots)) == (12, 20, 60)
        assert np.hypot(*(points(nest) - [800, 300]).T).max() <= 140
        assert points(prey).min(axis=0)[1] >= 610
        assert points(prey).max(axis=0)[0] <= 390
        np.testing.assert_allclose(prey["angle"], np.pi / 2, rtol=1e-6)
        everyone = points(pd.concat([nest, prey, robots]))
        apart = np.hypot(*np.moveaxis(everyone[:, None] - everyone[None], -1, 0))
        assert apart[np.triu_indices(len(everyone), k=1)].min() >= 20


def test_area_that_reaches_beyond_the_arena_ends_at_its_walls(tmp_path: Path) -> None:
    for arena in ("arenas/disk.csv", "arenas/annulusBarred.csv"):
        area = {"x": 100, "y": 500, "radius": 400}
        nest = {**ROBOT, "nb": 40, "area": area, "initial_formation": "random"}
        done = simulate(tmp_path / Path(arena).stem, arena_file=arena, **{"objects.nest": nest})
        text = done.table().schema.metadata[b"arena_polygons"].decode()
        outer, *holes = ([(p["x"], p["y"]) for p in corners] for corners in yaml.safe_load(text))
        start = points(at_start(done, "nest"))
        assert len(start) == 40
        assert np.hypot(*(start - [100, 500]).T).max() <= 390
        assert Outline(outer).contains_points(start).all()
        assert not any(Outline(hole).contains_points(start).any() for hole in holes)


def test_poses_are_taken_in_their_order_and_count_the_objects(tmp_path: Path) -> None:
    poses: list[list[float]] = [[300, 400], [500, 400, 1.57], [500, 700, -2]]
    done = simulate(tmp_path, **{"objects.leaders": {**ROBOT, "poses": poses}})
    assert warnings(done) == []
    leaders = at_start(done, "leaders").sort_values("robot_id")
    expected = np.array([[300, 400, 0], [500, 400, 1.57], [500, 700, -2]])
    np.testing.assert_allclose(leaders[["x", "y", "angle"]], expected)


def test_angle_turns_all_objects_at_x_and_y(tmp_path: Path) -> None:
    changes = {"objects.one": {**ROBOT, "x": 300, "y": 400, "angle": -1.25}, "objects.bar": {**BAR, "angle": 1}}
    changes["objects.bar"] |= {"x": 700, "y": 700}
    done = simulate(tmp_path, **changes)
    assert at_start(done, "one")["angle"].item() == pytest.approx(-1.25)
    assert at_start(done, "bar")["angle"].item() == pytest.approx(1)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"angle": 1}, ".angle: angle without x and y; it is the heading of objects placed at x and y"),
        ({"nb": 3, "poses": [[1, 2]]}, ".nb: expected 1, the number of poses, found 3; nb may be omitted"),
        ({"poses": []}, ".poses: the list is empty; specify one pose per object, or omit the key"),
        ({"poses": {"x": 1}}, ".poses: expected a list of [x, y] or [x, y, angle] (mm, rad), found a map"),
        ({"poses": [[5, 5, 0, 1]]}, ".poses.0: expected [x, y] or [x, y, angle] (mm, rad), found a list"),
        ({"poses": [[500, "here"]]}, ".poses.0.1: expected a number from -1000000 to 1000000 (mm), found 'here'"),
        ({"poses": [[500, 5000]]}, ".poses: (500, 5000) is outside the arena, which extends from"),
        ({"poses": [[1, 2]], "x": 1, "y": 2}, ".poses: cannot be combined with 'x'; use one or the other"),
        ({"poses": [[1, 2]], "area": [[0, 0], [9, 0], [9, 9]]}, ".area: cannot be combined with 'poses'; use one"),
        ({"initial_formation": "disk", "x": 1, "y": 2}, ".initial_formation: cannot be combined with 'x'; use one"),
        ({"initial_formation": "imported"}, ".initial_formation: expected one of random,"),
        ({"area": 5}, ".area: expected a map of x, y and radius, or a list of at least 3 corners [x, y] (mm), found 5"),
        ({"area": [[0, 0], [9, 9]]}, ".area: expected a map of x, y and radius, or a list of at least 3 corners"),
        ({"area": [[0, 0], [9, 9], [9]]}, ".area.2: expected a corner [x, y] (mm), found a list"),
        ({"area": [[0, 0], [5, 5], [9, 9]]}, ".area: these corners enclose no area"),
        ({"area": [[0, 0], [10, 10], [20, 0], [0, 12]]}, ".area: the sides of this polygon cross or touch"),
        ({"area": {"x": 1, "y": 2}}, ".area: the key 'radius' is missing"),
        ({"area": {"x": 1, "y": 2, "radius": -1}}, ".area.radius: expected a number above 0, at most 1000000 (mm)"),
        ({"area": {"x": 5000, "y": 2, "radius": 9}}, ".area: it lies entirely outside the arena, which extends from"),
        (
            {"nb": 50, "area": {"x": 500, "y": 500, "radius": 40}},
            ".area: initial_formation: 'power_lloyd' cannot place 50 objects (largest radius 10 mm): they need "
            "16024 mm2 including spacing, but the area is only 5025 mm2; reduce nb or enlarge the area",
        ),
        ({"body_fixed": True}, ".body_fixed: a robot with wheels cannot be fixed; use a passive_object"),
        ({"body_fixed": 3}, ".body_fixed: expected true or false, found 3"),
    ],
    ids=lambda value: re.sub(r"\W+", "-", str(value))[:40],
)
def test_wrong_places_are_one_message(tmp_path: Path, keys: dict[str, Any], message: str) -> None:
    done = run(example("run_and_tumble"), tmp_path, {**SQUARE, "objects.it": {**ROBOT, **keys}})
    assert done.code == 2
    (line,) = done.errors.splitlines()
    assert "scene.yaml:" in line
    assert f"objects.it{message}" in line
    assert not (tmp_path / "data.feather").exists()


def test_membranes_are_no_obstacles_and_start_with_no_dot_in_a_hole(tmp_path: Path) -> None:
    membrane = {"type": "membrane", "geometry": "rectangle", "body_width": 300, "body_height": 300, "dot_radius": 5}
    done = run(example("run_and_tumble"), tmp_path, {"objects.it": {**membrane, "body_fixed": True}})
    assert done.code == 2
    assert "objects.it.body_fixed: a membrane cannot be fixed" in done.errors
    # One side of this membrane crosses the hole, with all corners in the arena.
    (tmp_path / "holed.csv").write_text("0,0\n1,0\n1,1\n0,1\n\n0.6,0.45\n0.7,0.45\n0.7,0.55\n0.6,0.55\n")
    changes = {**SQUARE, "arena_file": "holed.csv", "objects.it": {**membrane, "num_dots": 80, "x": 500, "y": 500}}
    done = run(example("run_and_tumble"), tmp_path, changes)
    assert done.code == 2
    assert "some dots of the object would start beyond the walls of the arena" in done.errors


def test_more_rows_than_objects_is_one_warning_and_rows_go_by_category(tmp_path: Path) -> None:
    tmp_path.joinpath("poses.csv").write_text("x,y\n100,100\n200,100\n300,100\n400,100\n")
    changes = {
        "initial_formation": "imported",
        "formation_filename": "poses.csv",
        "objects.robots": {**ROBOT, "nb": 1},
        "objects.fixed": {**ROBOT, "x": 800, "y": 800},
        "objects.others": {**ROBOT, "nb": 2},
    }
    done = simulate(tmp_path, **changes)
    np.testing.assert_allclose(points(at_start(done, "robots")), [[100, 100]])
    np.testing.assert_allclose(points(at_start(done, "others")), [[200, 100], [300, 100]])
    (warning,) = warnings(done)
    assert "poses.csv: has 4 poses (rows with the first time value) for 3 objects" in warning
    changes["objects.others"] = {**ROBOT, "nb": 3}
    assert warnings(simulate(tmp_path, **changes)) == []


LEADER = {"objects.leader": {**ROBOT, "x": 800, "y": 800}}
SWARM = {"objects.robots": {**ROBOT, "nb": 4}}
WALL = {"objects.walls": {"type": "pogowall", "geometry": "arena"}}
RING = {"type": "membrane", "geometry": "disk", "radius": 100, "num_dots": 20, "dot_radius": 8, "x": 800, "y": 300}
OF_THEIR_OWN = {
    "leader first": {**LEADER, **SWARM},
    "leader behind": {**SWARM, **LEADER},
    "walls first": {**WALL, **SWARM},
    "walls and leader between": {"objects.a": {**ROBOT, "nb": 2}, **WALL, **LEADER, **SWARM},
    "dots of a membrane": {"objects.ring": {**RING, "serialize_dot_pose": True}, **SWARM},
    "bars with a formation of their own": {
        "objects.bars": {**BAR, "body_height": 60, "nb": 2, "initial_formation": "random"},
        **SWARM,
    },
    "other order": {**SWARM, "objects.a": {**ROBOT, "nb": 2, "radius": 20}, "objects.b": {**ROBOT, "nb": 3}},
}


@pytest.mark.parametrize("ending", ["feather", "csv"])
@pytest.mark.parametrize("name", OF_THEIR_OWN)
def test_rows_of_a_run_go_to_the_objects_of_their_categories(name: str, ending: str, tmp_path: Path) -> None:
    scene = OF_THEIR_OWN[name]
    simulate(tmp_path / "first", **{"initial_formation": "random", "data_filename": f"d.{ending}"}, **scene)
    again = dict(reversed(scene.items())) if name == "other order" else scene
    file = str(tmp_path / "first" / f"d.{ending}")
    second = simulate(tmp_path / "second", initial_formation="imported", formation_filename=file, **again)
    assert [line for line in warnings(second) if "rows" in line or "row" in line] == []
    rows = load_dataframe(file)[0]
    for category in ("robots", "a", "b"):
        start = rows[(rows["time"] == 0.0) & (rows["robot_category"] == category)]
        own = at_start(second, category)
        np.testing.assert_allclose(points(own), points(start), atol=1e-3)
        np.testing.assert_allclose(own["angle"], start["angle"], atol=1e-3)


def test_rows_of_other_categories_are_taken_in_their_order_with_a_warning(tmp_path: Path) -> None:
    header = "time,robot_category,x,y\n"
    tmp_path.joinpath("poses.csv").write_text(header + "0,robots,100,100\n0,robots,200,100\n0,b,300,100\n0,b,400,100\n")
    scene = {"initial_formation": "imported", "formation_filename": "poses.csv"}
    done = simulate(tmp_path, **scene, **{"objects.robots": {**ROBOT, "nb": 3}, "objects.b": {**ROBOT, "nb": 1}})
    np.testing.assert_allclose(points(at_start(done, "robots")), [[100, 100], [200, 100], [300, 100]])
    (warning,) = warnings(done)
    assert "poses.csv:4: this position of 'b' is taken for an object of 'robots': the file has too few rows" in warning
    tmp_path.joinpath("poses.csv").write_text(header + "0,a,100,100\n0,a,200,100\n0,a,300,100\n0,a,400,100\n")
    one = simulate(tmp_path / "one", **{**scene, "formation_filename": str(tmp_path / "poses.csv")}, **SWARM)
    assert warnings(one) == []


def test_run_starts_where_another_one_with_a_root_object_did(tmp_path: Path) -> None:
    ring = {"type": "membrane", "geometry": "disk", "radius": 300, "num_dots": 80, "dot_radius": 10}
    scene = {
        "objects.robots": {**ROBOT, "nb": 8},
        "objects.ring": ring,
        "objects.others": {**ROBOT, "nb": 4},
        "initial_formation_root_object": "ring",
    }
    first = simulate(tmp_path / "first", **scene)
    names = ["robots", "ring", "others"]
    starts = [points(at_start(first, name)) for name in names]
    rows = np.concatenate(starts)
    rows[8] = [500, 500]  # the membrane's centre
    (tmp_path / "second").mkdir()
    np.savetxt(tmp_path / "second" / "poses.csv", rows, delimiter=",")
    again = {**scene, "initial_formation": "imported", "formation_filename": "poses.csv"}
    second = simulate(tmp_path / "second", **again)
    assert warnings(second) == []
    for name, start in zip(names, starts, strict=True):
        if name != "ring":
            np.testing.assert_allclose(points(at_start(second, name)), start, atol=1e-3)


def test_example_of_the_page_does_what_it_says(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "configuration.md").read_text()
    section = page[page.index("## Formations") :]
    text = re.findall(r"^```yaml\n(.*?)^```$", section, flags=re.DOTALL | re.MULTILINE)[0]
    (tmp_path / "placement.yaml").write_text(text)
    done = run_command(example("run_and_tumble"), tmp_path, ["-c", "placement.yaml", "-g", "--strict", "-q"])
    assert (done.code, warnings(done)) == (0, [])
    frame = done.frame(yaml.safe_load(text)["data_filename"])
    start = frame[frame["time"] == 0].groupby("robot_category")
    assert start.size().to_dict() == {"robots": 40, "leaders": 2, "nest": 6, "prey": 20, "pillar": 1}
    pillar = frame[frame["robot_category"] == "pillar"][["x", "y", "angle"]].to_numpy()
    np.testing.assert_allclose(pillar, np.tile([600, 700, 0.5], (len(pillar), 1)), rtol=1e-6)
