"""The page on parameter studies does what it says: its program, its batch of 540 runs, its figure and its claims."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from parameter_study import NAMES, PAGE, follow, picture_in, size_in
from pictures import DOCS, difference, drawn_on
from PIL import Image
from pogosim.confidence import mean_over_runs
from pogosim.utils import load_dataframe
from quotes import quote_difference
from running import ROOT, build_folder

NUMBER, RANGE, POWER = PARAMETERS = ["objects.robots.nb", "objects.robots.communication_radius", "parameters.power"]
RUNS = 20


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder like the project's."""
    folder = tmp_path_factory.mktemp("tree")
    (folder / "build").mkdir()
    (folder / "build" / "release").symlink_to(build_folder())
    for name in (".venv", "arenas"):
        (folder / name).symlink_to(ROOT / name)
    return folder


@pytest.fixture(scope="module")
def printed(folder: Path) -> str:
    """What the plot printed, after everything else that the page says was done."""
    return follow(folder)


@pytest.fixture(scope="module")
def rows(folder: Path, printed: str) -> pd.DataFrame:
    assert "failed" not in printed
    return load_dataframe(folder / "rumour" / "results" / "rumour.feather")[0]


@pytest.fixture(scope="module")
def informed(rows: pd.DataFrame) -> pd.DataFrame:
    """Share of informed robots, but for the one that knew the rumour before. One column per run."""
    others = rows[rows["robot_id"] > 0]
    return others.groupby([*PARAMETERS, "run", "time"])["informed"].mean().unstack("run")


def test_figure_is_the_one_on_the_page(folder: Path, rows: pd.DataFrame) -> None:
    assert len(rows) > 0
    assert difference(DOCS / NAMES[0], picture_in(folder)) == ""
    assert quote_difference(NAMES[1], PAGE, size_in(folder)) == ""


def test_script_prints_what_the_page_quotes_where_its_figure_was_drawn(printed: str) -> None:
    quoted = re.findall(r"^power .*$", PAGE.read_text(), re.MULTILINE)
    lines = printed.splitlines()
    assert len(lines) == len(quoted) == 3
    assert [line.partition(":")[0] for line in lines] == [line.partition(":")[0] for line in quoted]
    with Image.open(DOCS / NAMES[0]) as image:
        if image.info["Platform"] == drawn_on()["Platform"]:
            assert lines == quoted


def test_every_combination_has_all_runs_with_the_same_times(rows: pd.DataFrame, informed: pd.DataFrame) -> None:
    assert informed.shape == (27 * 61, RUNS)
    assert not informed.isna().any(axis=None)
    assert len(rows) == 9 * RUNS * 61 * (10 + 20 + 40)


@pytest.mark.parametrize("parameter", PARAMETERS)
def test_more_of_each_parameter_spreads_the_rumour_faster(parameter: str, informed: pd.DataFrame) -> None:
    at_half_time = informed.mean(axis=1).xs(30, level="time").unstack(parameter).to_numpy()
    assert at_half_time.shape == (9, 3)
    assert (np.diff(at_half_time) >= 0.0).all()

    # In the panel of the figure, by more than four standard errors from the first to the last value.
    panel = informed.reset_index().query("time == 30")
    for other, reference in zip(PARAMETERS, (20, 60, 50), strict=True):
        panel = panel[(panel[other] == reference) | (other == parameter)]
    first, _, last = panel[list(range(RUNS))].to_numpy()
    error = np.sqrt((first.var(ddof=1) + last.var(ddof=1)) / RUNS)
    assert last.mean() - first.mean() > 4.0 * error


def test_speed_changes_nothing_but_the_scale_of_time(informed: pd.DataFrame) -> None:
    at_time = informed.reset_index(["time", POWER])
    slow, middle, fast = (
        at_time[(at_time["time"] == time) & (at_time[POWER] == power)].drop(columns=["time", POWER])
        for power, time in ((25, 60), (50, 30), (100, 15))
    )
    for one, other in ((slow, middle), (middle, fast), (slow, fast)):
        difference_of_means = mean_over_runs(pd.DataFrame(one - other), level=0.999)
        assert len(difference_of_means) == 9
        assert (difference_of_means["low"] <= 0.0).all()
        assert (difference_of_means["high"] >= 0.0).all()


def test_robots_taken_as_independent_would_make_bands_less_than_half_as_wide(informed: pd.DataFrame) -> None:
    band = mean_over_runs(informed.loc[[(20, 60, 50, 30)]]).iloc[0]
    samples = RUNS * (20 - 1)
    half_width = 1.96 * np.sqrt(band["mean"] * (1.0 - band["mean"]) / samples)
    assert half_width < (band["high"] - band["mean"]) / 2.0
