"""Every type of object and of light in one arena for five minutes, as a user runs it."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from conftest import Compile
from matplotlib.path import Path as Outline
from running import Run, run, write_scene

SIDE_MM = 2000.0
RADIUS_MM = 26.5
DOTS = 60
PUSHED = {"body_linear_damping": 5.0, "body_angular_damping": 5.0, "body_density": 5.0}
SOFT = {"num_dots": DOTS, "dot_radius": 10, "stiffness": 30, "cross_span": 3, "serialize_dot_pose": True}
ROBOT = {"type": "pogobot", "geometry": "disk", "radius": RADIUS_MM, "max_angular_speed": 2.0}

# In the order of creation. What has no x and y takes the next pose of the formation.
OBJECTS: dict[str, dict[str, Any]] = {
    "robots": {**ROBOT, "nb": 30},
    "walls": {"type": "pogowall", "geometry": "arena", "communication_radius": 60},
    "strip": {"type": "pogowall", "geometry": "disk", "radius": 100, "x": 1000, "y": 1000},
    "pogobjects": {"type": "pogobject", "nb": 2, "geometry": "disk", "radius": 60, **PUSHED},
    "membranes": {"type": "membrane", "geometry": "disk", "radius": 250, "x": 450, "y": 450, **SOFT},
    "bars": {"type": "passive_object", "geometry": "rectangle", "body_width": 160, "body_height": 60, **PUSHED},
    "wedges": {"type": "passive_object", "nb": 2, "geometry": "triangle", "side_length": 100, **PUSHED},
    "balls": {"type": "passive_object", "nb": 2, "geometry": "disk", "radius": 40, **PUSHED},
    "active": {"type": "active_object", "geometry": "disk", "radius": 60, **PUSHED},
    "rectmembranes": {
        "type": "rectmembrane",
        "geometry": "rectangle",
        "body_width": 450,
        "body_height": 400,
        "x": 1500,
        "y": 450,
        **SOFT,
    },
    "guards": {**ROBOT, "nb": 3, "linear_noise_stddev": 0.1, "angular_noise_stddev": 0.3},
    "sky": {"type": "static_light", "geometry": "global", "value": 20},
    "spot": {
        "type": "static_light",
        "light_mode": "gradient",
        "geometry": "disk",
        "radius": 300,
        "x": 500,
        "y": 1500,
        "value": 800,
        "edge_value": 10,
    },
    "orbiting": {
        "type": "orbiting_static_light",
        "geometry": "disk",
        "radius": 150,
        "value": 500,
        "center_x": 1000,
        "center_y": 1000,
        "orbit_radius": 600,
        "orbit_angular_speed": 0.3,
    },
    "rotating": {"type": "rotating_ray_of_light", "geometry": "global", "x": 1000, "y": 1000, "value": 400},
    "alternating": {"type": "alternating_rays_of_light", "geometry": "global", "value": 300},
}
# Robots 0 to 5 of them start in the membrane and 6 to 9 in the rectangular one.
IN_MEMBRANE, IN_RECTMEMBRANE = range(6), range(6, 10)


def poses() -> npt.NDArray[np.float64]:
    """Places, mm, of all that moves: ten robots in the membranes, everything else on a grid in the lower half."""
    turn = np.arange(6) * np.pi / 3
    ring = np.column_stack([450 + 120 * np.cos(turn), 450 + 120 * np.sin(turn)])
    box = np.array([[x, y] for x in (1430.0, 1570.0) for y in (380.0, 520.0)])
    grid = np.array([[x, y] for y in (1300.0, 1500.0, 1700.0, 1880.0) for x in np.linspace(130, 1870, 8)])
    return np.concatenate([ring, box, grid])[:41]  # one for each object


def settings(**more: object) -> dict[str, object]:
    return {
        "arena_file": "arenas/square.csv",
        "arena_surface": SIDE_MM**2,
        "initial_formation": "imported",
        "formation_filename": "poses.csv",
        "simulation_time": 300.0,
        "save_data_period": 1.0,
        "data_logger_flush_row_count": 1000,  # small batches, so that rows wait on disk and not in memory
        "objects": OBJECTS,
        **more,
    }


def write_poses(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    pd.DataFrame(poses(), columns=["x", "y"]).to_csv(folder / "poses.csv", index=False)


@pytest.fixture(scope="module")
def mixed(program: Compile, tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("mixed")
    write_poses(folder)
    result = run(program("crowd.c"), folder, settings())
    assert (result.code, result.errors) == (0, "")
    return result


def rows(result: Run, *, subparts: bool = False) -> pd.DataFrame:
    frame = result.frame()
    is_dot = frame["subpart_id"] >= 0
    return frame[is_dot if subparts else ~is_dot]


def path(frame: pd.DataFrame, robot: int) -> npt.NDArray[np.float64]:
    """Where an object was, shape (times, 2), mm."""
    return frame.loc[frame["robot_id"] == robot, ["x", "y"]].to_numpy(dtype=np.float64)


def outlines(result: Run, category: str) -> list[npt.NDArray[np.float64]]:
    """Dots of a membrane, one polygon of mm per time."""
    dots = rows(result, subparts=True)
    dots = dots[dots["robot_category"] == category]
    return [group[["x", "y"]].to_numpy(dtype=np.float64) for _, group in dots.groupby("time")]


def test_rows_stand_in_order_of_creation_at_every_time(mixed: Run) -> None:
    frame = mixed.frame()
    expected: list[tuple[str, int]] = []
    for name, entry in OBJECTS.items():
        if "light" not in entry["type"]:
            is_soft = "membrane" in entry["type"]
            for _ in range(entry.get("nb", 1)):
                expected += [(name, part) for part in ([-1, *range(DOTS)] if is_soft else [-1])]
    times = frame["time"].unique()
    np.testing.assert_array_equal(times, np.arange(301, dtype=np.float32))
    for _, now in frame.groupby("time"):
        assert list(zip(now["robot_category"], now["subpart_id"], strict=True)) == expected


def test_everything_has_a_place_and_what_bends_has_no_angle(mixed: Run) -> None:
    frame = mixed.frame()
    kind = frame["robot_category"].map({name: entry["type"] for name, entry in OBJECTS.items()})
    is_wall = kind == "pogowall"
    is_dot = frame["subpart_id"] >= 0
    assert (frame["angle"].isna() == kind.isin(["membrane", "rectmembrane"])).all()
    assert np.isfinite(frame[["x", "y"]]).all(axis=None)
    assert (frame.loc[is_wall, "angle"] == 0.0).all()
    ticks = mixed.table().column("pogobot_ticks").to_pandas(integer_object_nulls=True)
    has_none = np.array([tick is None for tick in ticks])
    assert (has_none == (kind == "passive_object")).all()
    heard = mixed.table().column("heard").to_pandas(integer_object_nulls=True)
    assert (np.array([count is None for count in heard]) == (has_none | is_dot)).all()


def test_nothing_leaves_the_arena(mixed: Run) -> None:
    frame = mixed.frame()
    # A rectangular membrane is half as thick as one of dots of the same size.
    radius = {"robots": RADIUS_MM, "guards": RADIUS_MM, "balls": 40.0, "active": 60.0, "rectmembranes": 5.0}
    margin = frame["robot_category"].map(radius).fillna(10.0)
    for column in ("x", "y"):
        outside = np.maximum(margin - frame[column], frame[column] - (SIDE_MM - margin))
        # The physics lets bodies overlap by some tenths of a mm for a moment.
        assert outside.max() < 2.0


def test_robots_stay_on_their_side_of_the_membranes(mixed: Run) -> None:
    frame = rows(mixed)
    robots = frame[frame["robot_category"].isin(["robots", "guards"])]
    paths = {robot: path(robots, robot) for robot in robots["robot_id"].unique()}
    for category, members in (("membranes", IN_MEMBRANE), ("rectmembranes", IN_RECTMEMBRANE)):
        for time, outline in enumerate(outlines(mixed, category)):
            ring = Outline(outline)
            within = {robot for robot, places in paths.items() if ring.contains_point(places[time])}
            assert within == set(members), (category, time)


def test_everything_takes_part(mixed: Run) -> None:
    frame = rows(mixed)
    end = frame[frame["time"] == frame["time"].max()]
    talkers = end[end["heard"].notna()].groupby("robot_category")["heard"].sum()
    assert (talkers > 0).all(), talkers
    # The sky alone gives 20; lamps pass over nearly all robots in five minutes.
    assert (end[end["robot_category"] == "robots"]["brightest"] > 500).mean() > 0.8
    movable = {name for name, entry in OBJECTS.items() if "light" not in entry["type"]} - {"walls", "strip"}
    for category in movable:
        places = frame[frame["robot_category"] == category].groupby("robot_id")[["x", "y"]]
        extent = (places.max() - places.min()).to_numpy(dtype=np.float64)
        assert extent.max() > 20.0, category


def test_membranes_keep_their_area(mixed: Run) -> None:
    for category in ("membranes", "rectmembranes"):
        areas = []
        for outline in outlines(mixed, category):
            x, y = outline.T
            areas.append(abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2)
        assert np.abs(np.array(areas) / areas[0] - 1).max() < 0.1, category


def peak_memory_kb(program: Path, folder: Path, **more: object) -> int:
    """Run a program and return the largest memory that it held, kB."""
    write_poses(folder)
    write_scene(folder, settings(**more))
    with (folder / "out.txt").open("wb") as output:
        process = subprocess.Popen([str(program), "-c", "scene.yaml", "-g", "-q"], cwd=folder, stdout=output)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 0
    return usage.ru_maxrss


def test_same_seed_same_bytes_and_memory_does_not_grow(mixed: Run, program: Compile, tmp_path: Path) -> None:
    again = peak_memory_kb(program("crowd.c"), tmp_path / "again")
    assert (tmp_path / "again" / "data.feather").read_bytes() == (mixed.folder / "data.feather").read_bytes()
    assert again - peak_memory_kb(program("crowd.c"), tmp_path / "short", simulation_time=30.0) < 2000


def test_categories_choose_rows_of_walls_membranes_and_passive_objects(program: Compile, tmp_path: Path) -> None:
    write_poses(tmp_path)
    wanted = ["strip", "membranes", "balls"]
    result = run(program("crowd.c"), tmp_path, settings(simulation_time=2.0, data_logger_category=wanted))
    counts = result.frame()["robot_category"].value_counts().to_dict()
    assert counts == {"strip": 3, "membranes": 3 * (1 + DOTS), "balls": 3 * 2}


def test_subpart_column_is_there_for_serialized_dots_only(program: Compile, tmp_path: Path) -> None:
    write_poses(tmp_path)
    silent = {name: {k: v for k, v in entry.items() if k != "serialize_dot_pose"} for name, entry in OBJECTS.items()}
    result = run(program("crowd.c"), tmp_path, settings(simulation_time=1.0, objects=silent))
    assert "subpart_id" not in result.frame().columns
    assert len(result.frame()) == 2 * sum(e.get("nb", 1) for e in OBJECTS.values() if "light" not in e["type"])
