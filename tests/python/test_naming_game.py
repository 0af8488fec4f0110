"""The example naming_game: robots agree on a word."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest
from running import run_shipped

NB = 60


def run(folder: Path, settings: dict[str, object]) -> pd.DataFrame:
    folder.mkdir(exist_ok=True)
    return run_shipped("naming_game", folder, settings).frame()


@pytest.fixture(scope="module", params=[1, 2, 3])
def swarm(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    return run(tmp_path_factory.mktemp("swarm"), {"seed": request.param})


def test_one_word_remains(swarm: pd.DataFrame) -> None:
    words = swarm.groupby("time")["word"]
    nb_words = swarm.groupby("time")["nb_words"]
    agreed = (words.nunique() == 1) & (words.count() == NB) & (nb_words.max() == 1)
    assert agreed.iloc[-1]
    assert agreed[agreed.idxmax() :].all()


def test_vocabularies_grow_before_they_shrink(swarm: pd.DataFrame) -> None:
    total = swarm.groupby("time")["nb_words"].sum()
    assert total.iloc[0] == 0
    # Baronchelli et al. 2006: a peak above one word per robot, then down to exactly that.
    assert total.max() > 1.5 * NB
    assert total[total.index < 5.0].max() == total.max()
    assert total.iloc[-1] == NB


def test_several_words_are_invented(swarm: pd.DataFrame) -> None:
    assert swarm[swarm["time"] < 2.0].groupby("time")["word"].nunique().max() >= 5


def test_in_the_end_all_neighbours_agree(swarm: pd.DataFrame) -> None:
    share = swarm.groupby("time")["nb_agreeing_neighbors"].sum() / swarm.groupby("time")["nb_neighbors"].sum()
    assert share.iloc[5] < 0.8
    assert share.iloc[-1] == 1.0


def test_robots_out_of_reach_keep_words_of_their_own(tmp_path: Path) -> None:
    end = run(tmp_path, {"objects.robots.communication_radius": 0.0, "simulation_time": 5.0}).query("time == 5")
    assert (end["nb_words"] == 1).all()
    # 60 draws of 256 words: 53.6 different ones on average.
    assert end["word"].nunique() > 45


def test_a_robot_that_stands_between_two_faces_learns_a_word_but_once(tmp_path: Path) -> None:
    # Two robots; both hear each other at one or two faces. Two hearings of a speech would teach and settle it at once,
    # so that a listener would never know two words.
    settings: dict[str, object] = {
        "objects.robots.nb": 2,
        "initial_formation": "chessboard",
        "chessboard_distance_between_neighbors": 60.0,
        "parameters.moving_robots": False,
        "simulation_time": 3.0,
        "save_data_period": 0.02,
    }
    most = [run(tmp_path / str(seed), {**settings, "seed": seed})["nb_words"].max() for seed in range(8)]
    assert max(most) == 2
