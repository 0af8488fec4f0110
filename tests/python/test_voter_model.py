"""The example voter_model: robots imitate each other until all agree."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from running import run_shipped

NB_OPINIONS = 4


def run(folder: Path, settings: dict[str, object]) -> pd.DataFrame:
    folder.mkdir(exist_ok=True)
    return run_shipped("voter_model", folder, settings).frame()


def nb_with_opinion(frame: pd.DataFrame) -> pd.DataFrame:
    """One row per time, one column per opinion."""
    counts = frame.groupby(["time", "opinion"]).size().unstack(fill_value=0)
    return counts.reindex(columns=range(NB_OPINIONS), fill_value=0)


@pytest.fixture(scope="module", params=[2, 3, 4])
def swarm(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    return run(tmp_path_factory.mktemp("swarm"), {"seed": request.param})


def test_all_opinions_are_there_at_the_start(swarm: pd.DataFrame) -> None:
    counts = nb_with_opinion(swarm).iloc[0]
    assert counts.min() >= 60 / 4 - 3 * np.sqrt(60 * 3 / 16)


def test_one_opinion_wins_and_stays(swarm: pd.DataFrame) -> None:
    counts = nb_with_opinion(swarm)
    agreed = counts.max(axis=1) == 60
    assert agreed.iloc[-1]
    # For an instant messages of the last max_age may still bring up another one.
    first_time = float(agreed.index[agreed].min())
    assert agreed[first_time + 5.0 :].all()


def test_extinct_opinions_do_not_come_back(swarm: pd.DataFrame) -> None:
    counts = nb_with_opinion(swarm)
    # When they have been extinct for longer than max_age, no robot has heard of them any more.
    extinct = (counts.rolling(10).max() == 0).to_numpy()
    assert (counts.to_numpy()[1:][extinct[:-1]] == 0).all()


def test_ring_tells_local_consensus(swarm: pd.DataFrame) -> None:
    end = swarm[swarm["time"] == swarm["time"].max()]
    assert (end["local_consensus"] == (end["nb_neighbors"] > 0)).all()
    early = swarm[(swarm["time"] > 0) & (swarm["time"] < 1)]
    assert 0 < early["local_consensus"].mean() < 0.5


def test_an_opinion_wins_as_often_as_its_share_at_the_start_says(tmp_path: Path) -> None:
    # The share of an opinion is a martingale, so its mean over many runs stays what it was: 1 / 4 for each.
    settings: dict[str, object] = {"objects.robots.nb": 10, "arena_surface": 6.0e4}
    settings |= {"simulation_time": 20.0, "save_data_period": 20.0}
    start, end = np.zeros(NB_OPINIONS), np.zeros(NB_OPINIONS)
    nb_runs = 40
    for seed in range(nb_runs):
        counts = nb_with_opinion(run(tmp_path / str(seed), {**settings, "seed": seed}))
        start += counts.iloc[0].to_numpy() / 10
        end += counts.iloc[-1].to_numpy() / 10
    assert sum(end) == pytest.approx(nb_runs)
    # Three standard deviations of a binomial draw.
    assert np.abs(end - start).max() < 3 * np.sqrt(nb_runs * 3 / 16)


def test_robots_alone_keep_their_opinion(tmp_path: Path) -> None:
    frame = run(tmp_path, {"objects.robots.communication_radius": 0.0, "simulation_time": 5.0})
    assert (frame.groupby("robot_id")["opinion"].nunique() == 1).all()
