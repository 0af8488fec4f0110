"""The example neighbor_counter, against the robots in range by geometry."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from running import run_shipped

RADIUS = 26.5  # of a robot, mm
RANGE = 80.0  # from an emitter to the border of the receiver, mm
NORMALS = np.exp(0.5j * np.pi * np.arange(4))  # of the faces front, right, back and left; complex: x + iy
FACES = [f"dir{face}_neighbors" for face in range(4)]


def run(folder: Path, **settings: object) -> pd.DataFrame:
    folder.mkdir(exist_ok=True)
    changes = {"objects.robots.msg_success_rate": {"type": "static", "rate": 1.0}, **settings}
    return run_shipped("neighbor_counter", folder, changes).frame()


def write_jittered_grid(path: Path) -> None:
    """49 robots about 115 mm apart: some neighbours are in reach, some are not, and none hides another."""
    rng = np.random.default_rng(5)
    column, row = np.meshgrid(np.arange(7), np.arange(7))
    places = 150 + 115 * np.stack([column.ravel(), row.ravel()], axis=1) + rng.uniform(-12, 12, (49, 2))
    angles = rng.uniform(-np.pi, np.pi, 49)
    pd.DataFrame({"x": places[:, 0], "y": places[:, 1], "angle": angles}).to_csv(path, index=False)


def faces_that_hear(frame: pd.DataFrame, listener: int, speaker: int) -> set[int]:
    """Faces of a listener that receive what a speaker says, if no robot stands between them."""
    place = frame["x"].to_numpy() + 1j * frame["y"].to_numpy()
    axis = np.exp(1j * frame["angle"].to_numpy())
    emitters = place[speaker] + RADIUS * NORMALS * axis[speaker]
    offset = place[listener] - emitters
    in_front = (offset * np.conj(NORMALS * axis[speaker])).real >= 0
    in_reach = in_front & (np.abs(offset) <= RANGE + RADIUS)
    if not in_reach.any():
        return set()
    nearest = emitters[in_reach][np.argmin(np.abs(offset[in_reach]))]
    from_faces = nearest - (place[listener] + RADIUS * NORMALS * axis[listener])
    seen = ((from_faces * np.conj(NORMALS * axis[listener])).real >= 0) & (np.abs(from_faces) <= RANGE)
    if seen.any():
        return {int(face) for face in np.flatnonzero(seen)}
    return {int(np.argmax(((nearest - place[listener]) * np.conj(NORMALS * axis[listener])).real))}


@pytest.fixture(scope="module")
def still(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    folder = tmp_path_factory.mktemp("still")
    write_jittered_grid(folder / "places.csv")
    settings = {
        "arena_file": "arenas/square.csv",
        "arena_surface": 1.0e6,
        "initial_formation": "imported",
        "formation_filename": str(folder / "places.csv"),
        "objects.robots.nb": 49,
    }
    return run(folder, **settings)


def test_counts_are_those_of_geometry(still: pd.DataFrame) -> None:
    end = still[still["time"] == 10].sort_values("robot_id").reset_index()
    one_way = 0
    for robot, (_, row) in enumerate(end.iterrows()):
        heard = {other: faces_that_hear(end, robot, other) for other in range(49) if other != robot}
        neighbors = {other for other, faces in heard.items() if faces}
        one_way += sum(not faces_that_hear(end, other, robot) for other in neighbors)
        listed = {int(text) for text in row["neighbors_list"].split(",") if text}
        assert listed == neighbors
        assert row["total_neighbors"] == len(neighbors)
        assert list(row[FACES]) == [sum(face in faces for faces in heard.values()) for face in range(4)]
    # The scene has all there is: robots at the limit of reach, of which one hears the other only.
    assert one_way > 0
    assert end["total_neighbors"].nunique() >= 3


def test_neighbours_stand_within_the_range_and_two_radii(tmp_path: Path) -> None:
    end = run(tmp_path).query("time == 10").sort_values("robot_id").reset_index()
    place = end["x"] + 1j * end["y"]
    farthest = RANGE + 2 * RADIUS
    for robot, (_, row) in enumerate(end.iterrows()):
        distance = np.abs(place - place[robot]).drop(robot)
        listed = [int(text) for text in row["neighbors_list"].split(",") if text]
        assert (distance[listed] <= farthest).all()
        # Nothing hides the nearest robot, and up to 120 mm away it is in reach of an emitter at any heading.
        assert distance.idxmin() in listed or distance.min() > 120


def test_counts_do_not_change_while_robots_stand_still(still: pd.DataFrame) -> None:
    for column in ["total_neighbors", *FACES]:
        assert (still[still["time"] >= 1].groupby("robot_id")[column].nunique() == 1).all()


def test_all_neighbours_are_forgotten_when_nothing_arrives(tmp_path: Path) -> None:
    settings = {"objects.robots.msg_success_rate": {"type": "static", "rate": 0.0}}
    assert (run(tmp_path, **settings)["total_neighbors"] == 0).all()


def test_neighbours_are_forgotten_after_max_age(tmp_path: Path) -> None:
    # One heartbeat a second, remembered for 0.3 s.
    steady = run(tmp_path / "steady")
    brief = run(
        tmp_path / "brief", **{"parameters.heartbeat_hz": 1, "parameters.max_age": 300, "save_data_period": 0.02}
    )
    share = brief[brief["time"] > 1]["total_neighbors"].mean() / steady[steady["time"] > 1]["total_neighbors"].mean()
    assert share == pytest.approx(0.3, abs=0.03)
