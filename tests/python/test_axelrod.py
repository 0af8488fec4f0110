"""The example axelrod: similar robots become equal, different ones stay different."""

from __future__ import annotations

from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from running import run_shipped

SIDE = 9  # robots along each side of the grid
PITCH = 95.0  # mm, of the grid
LONG = {"simulation_time": 400.0, "save_data_period": 2.0}  # until nothing can change any more


def run(folder: Path, settings: dict[str, object]) -> pd.DataFrame:
    return run_shipped("axelrod", folder, settings).frame()


def cultures(frame: pd.DataFrame) -> npt.NDArray[np.int64]:
    """Traits of all robots at all times. Shape (times, robots, features)."""
    columns = [name for name in frame if str(name).startswith("trait_")]
    rows = frame.sort_values(["time", "robot_id"])
    return rows[columns].to_numpy(dtype=np.int64).reshape(frame["time"].nunique(), -1, len(columns))


def nb_cultures(traits: npt.NDArray[np.int64]) -> int:
    return len(np.unique(traits, axis=0))


def neighbour_overlaps(frame: pd.DataFrame) -> npt.NDArray[np.int64]:
    """Number of features in which neighbours agree in the end, of each pair side by side on the grid."""
    end = frame[frame["time"] == frame["time"].max()].sort_values("robot_id")
    place = np.rint(end[["x", "y"]].to_numpy() / PITCH)
    traits = cultures(end)[0]
    beside = np.abs(place[:, None] - place[None]).sum(axis=2) == 1
    first, second = np.nonzero(np.triu(beside))
    assert len(first) == 2 * SIDE * (SIDE - 1)
    overlaps: npt.NDArray[np.int64] = (traits[first] == traits[second]).sum(axis=1)
    return overlaps


@pytest.fixture(scope="module", params=[0, 1])
def settled(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    return run(tmp_path_factory.mktemp("settled"), {**LONG, "seed": request.param})


def test_robots_hear_their_neighbours_on_the_grid(settled: pd.DataFrame) -> None:
    end = settled[settled["time"] == settled["time"].max()]
    assert end["nb_neighbors"].value_counts().to_dict() == {4: (SIDE - 2) ** 2, 3: 4 * (SIDE - 2), 2: 4}


def test_in_the_end_neighbours_are_equal_or_have_nothing_in_common(settled: pd.DataFrame) -> None:
    assert settled[settled["time"] == settled["time"].max()]["is_settled"].all()
    overlaps = neighbour_overlaps(settled)
    assert set(overlaps) == {0, 3}
    equal = settled[settled["time"] == settled["time"].max()]["nb_equal_neighbors"].sum()
    assert equal == 2 * (overlaps == 3).sum()  # robots know it


def test_what_is_settled_stays(settled: pd.DataFrame) -> None:
    is_settled = settled.groupby("time")["is_settled"].all().to_numpy()
    last_talk = np.flatnonzero(~is_settled).max()
    after = cultures(settled)[last_talk + 1 :]
    assert len(after) > 5
    assert (after == after[0]).all()


def test_no_trait_is_invented(settled: pd.DataFrame) -> None:
    traits = cultures(settled)
    for feature in range(traits.shape[2]):
        for before, after in pairwise(traits[:, :, feature]):
            assert set(after) <= set(before)


def test_few_traits_lead_to_one_culture_and_many_to_many(tmp_path: Path) -> None:
    end = {}
    for nb_traits in (2, 8, 30):
        frames = [
            run(tmp_path / f"{nb_traits}_{seed}", {"seed": seed, "parameters.nb_traits": nb_traits})
            for seed in range(3)
        ]
        end[nb_traits] = np.mean([nb_cultures(cultures(frame)[-1]) for frame in frames])
    assert end[2] < 2  # or two opposite ones
    assert end[2] + 5 < end[8] < end[30] - 20
    # With so many traits, two neighbours have nothing in common in nine of ten pairs, and hardly ever talk.
    assert end[30] > 0.7 * SIDE**2


def test_more_features_lead_to_fewer_cultures(tmp_path: Path) -> None:
    # The more features, the more probable it is that neighbours have anything in common to begin with.
    end = [
        nb_cultures(cultures(run(tmp_path / str(nb), {**LONG, "parameters.nb_features": nb}))[-1]) for nb in (2, 3, 8)
    ]
    assert end[0] > end[1] > end[2]
    assert end[2] == 1


def test_neighbours_with_nothing_in_common_never_talk(tmp_path: Path) -> None:
    # One feature: neighbours are equal or have nothing in common from the start.
    traits = cultures(run(tmp_path, {"parameters.nb_features": 1, "simulation_time": 20.0}))
    assert (traits == traits[0]).all()


@pytest.mark.parametrize("seed", [0, 1])
def test_among_walking_robots_all_cultures_have_nothing_in_common(tmp_path: Path, seed: int) -> None:
    # Sooner or later each robot meets each other one: there are at most as many cultures as traits.
    settings: dict[str, object] = {
        **LONG,
        "seed": seed,
        "parameters.moving_robots": True,
        "objects.robots.nb": 36,
        "arena_surface": 6.0e5,
    }
    end = np.unique(cultures(run(tmp_path, settings))[-1], axis=0)
    assert 1 < len(end) <= 8
    for one, other in combinations(end, 2):
        assert (one != other).all()


def test_robots_alone_keep_their_culture(tmp_path: Path) -> None:
    frame = run(tmp_path, {"objects.robots.communication_radius": 0.0, "simulation_time": 5.0})
    traits = cultures(frame)
    assert (traits == traits[0]).all()
    assert nb_cultures(traits[0]) > 60  # of 81 robots, drawn out of 8^3
