"""Robots of several categories have their own sizes and speeds; an analysis that takes one for all says so."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from pogosim.analysis.motion import peclet_numbers, speed
from pogosim.analysis.neighbourhood import degrees
from pogosim.analysis.robot_sizes import DifferentRobotsWarning
from pogosim.analysis.trajectories import Trajectories, trajectories_of
from pogosim.periodic import AmbiguousStepsWarning
from pogosim.reports.command import main as analyze
from swarms import metadata_of, rows_of, write_rows

CATEGORIES: dict[str, Any] = {
    "preds": {"type": "pogobot", "radius": 50.0, "communication_radius": 200.0, "max_linear_speed": 10.0},
    "preys": {"type": "pogobot", "radius": 20.0, "communication_radius": 60.0, "max_linear_speed": 100.0},
}


def scene(objects: dict[str, Any] | None = None, periodic: bool = False) -> dict[str, Any]:
    """Metadata of a run with these objects."""
    metadata = metadata_of(periodic=periodic)
    metadata["configuration"]["objects"] = objects or CATEGORIES
    return metadata


def chase(period_s: float = 1.0, prey_mm_s: float = 20.0) -> pd.DataFrame:
    """A predator that moves at 10 mm/s, and two preys that go away from it."""
    time_s = period_s * np.arange(5)
    x = [100.0 + 10.0 * time_s, 300.0 + prey_mm_s * time_s, 350.0 + prey_mm_s * time_s]
    rows = rows_of(np.stack([np.column_stack([np.mod(own, 1000.0), own * 0 + 500.0]) for own in x], axis=1))
    return rows.assign(
        robot_category=np.tile(["preds", "preys", "preys"], 5), time=np.repeat(time_s, 3), angle=np.zeros(15)
    )


def of(rows: pd.DataFrame, metadata: dict[str, Any], **choice: Any) -> Trajectories:
    """Return the only run."""
    (run,) = trajectories_of(rows, metadata, **choice)
    return run


def test_each_robot_has_the_sizes_of_its_category() -> None:
    sizes = of(chase(), scene()).sizes
    assert sizes.radius_mm.tolist() == [50.0, 20.0, 20.0]
    assert sizes.reach_mm.tolist() == [300.0, 100.0, 100.0]
    assert sizes.top_speed_mm_s.tolist() == [10.0, 100.0, 100.0]


def test_one_reach_for_robots_that_differ_in_it_is_said() -> None:
    run = of(chase(), scene())
    with pytest.warns(DifferentRobotsWarning) as caught:
        degrees(run)
    assert str(caught[0].message) == (
        "robots differ in their reach of neighbours: 300 mm of preds, 100 mm of preys; this analysis takes 300 mm for "
        "all. Choose one category (--category, category=) or a reach (--rc, reach_mm=)"
    )
    with pytest.warns(DifferentRobotsWarning, match="differ in their radius: 50 mm of preds, 20 mm of preys"):
        assert run.radius_mm == 50.0


def test_nothing_is_said_where_it_makes_no_difference() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = of(chase(), scene())
        speed(run)
        degrees(run, 150.0)
        degrees(of(chase(), scene(), category="preys"))
        degrees(of(chase(), scene({name: {**own, **CATEGORIES["preys"]} for name, own in CATEGORIES.items()})))


def test_entries_of_one_category_that_differ_are_said() -> None:
    rows = chase().assign(robot_category="robots", robot_id=np.tile([0, 1, 2], 5))
    run = of(rows, scene({"robots": list(CATEGORIES.values())}))
    assert run.sizes.top_speed_mm_s.tolist() == [100.0] * 3
    with pytest.warns(DifferentRobotsWarning) as caught:
        assert run.reach_mm == 300.0
    assert str(caught[0].message) == (
        "the entries of objects.robots differ: radius 50 mm and reach 300 mm, radius 20 mm and reach 100 mm: this "
        "analysis takes the first entry for all. Give them categories of their own"
    )
    same = of(rows, scene({"robots": [CATEGORIES["preys"]] * 2}))
    assert (same.radius_mm, same.reach_mm) == (20.0, 100.0)


def test_peclet_numbers_take_the_diameter_of_each_robot() -> None:
    run = of(chase(), scene())
    own = peclet_numbers(run, 1.0)
    assert np.allclose(peclet_numbers(run), own * [100.0, 40.0, 40.0], equal_nan=True)
    assert np.isfinite(own).all()


def test_steps_of_slow_robots_are_not_judged_by_the_speed_of_fast_ones() -> None:
    # In 6 s, preys could cross half of the arena, and predators could not.
    run = of(chase(6.0, 80.0), scene(periodic=True))
    with pytest.warns(AmbiguousStepsWarning, match=r"robots drive up to 100 mm/s .* below 5 s"):
        speed(run)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        speed(of(chase(6.0, 80.0), scene(periodic=True), category="preds"))
    slow = {name: {**own, "max_linear_speed": 10.0} for name, own in CATEGORIES.items()}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        speed(of(chase(6.0, 80.0), scene(slow, periodic=True)))


def test_an_analysis_says_once_which_reach_it_took(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = pd.concat([chase().assign(run=run) for run in (0, 1)])
    data = write_rows(tmp_path / "chase.feather", rows, scene())
    options = ["-i", str(data), "-o", str(tmp_path / "out")]
    assert analyze(["neighbors", *options]) == 0
    assert capsys.readouterr().err.count("differ in their reach of neighbours") == 1
    assert analyze(["neighbors", *options, "--rc", "100"]) == 0
    assert "differ in" not in capsys.readouterr().err
