"""A search begins with the initial values, and says at its end whether it has gained anything on them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from pogosim.confidence import mean_over_runs
from pogosim.optimize.optimizers.table import OPTIMIZERS
from pogosim.utils import load_dataframe
from searches import OBJECTIVE, history, search, summary, write_search

INIT = {"parameters.a": -0.5, "parameters.b": 3, "parameters.c": "red"}
FEW = ("--qd-init-samples", "4", "--qd-batch", "3", "--qd-shape", "4,4")
# The fitness of a run: how good the values are, and chance, which the seed alone decides.
NOISY = (
    OBJECTIVE.replace("def objective_fn", "def quality")
    + """
def objective_fn(df):
    return quality(df) + 0.01 * float(df["x"].iloc[0])
"""
)


@pytest.mark.parametrize("name", OPTIMIZERS.own)
def test_initial_values_are_the_first_evaluation_whatever_the_optimizer(name: str, tmp_path: Path) -> None:
    write_search(tmp_path)
    result = search(tmp_path, "--optimizer", name, "--max-evals", "8", "--final-runs", "0", *FEW)
    assert result.code == 0
    assert json.loads(history(tmp_path)["values"][0]) == INIT
    assert summary(tmp_path)["initial_values"] == INIT
    assert summary(tmp_path)["initial_fitness"] == history(tmp_path)["fitness"][0]
    assert f"[INFO] Evaluation 1, the initial values: {json.dumps(INIT)}\n" in result.errors
    assert "with the first choice: parameters.c\n" in result.errors


def test_one_evaluation_is_that_of_the_initial_values(tmp_path: Path) -> None:
    write_search(tmp_path)
    result = search(tmp_path, "--max-evals", "1", "--final-runs", "2")
    assert result.code == 0
    assert summary(tmp_path)["best_values"] == INIT
    assert "[WARNING] the best values are the initial ones: no candidate was better\n" in result.errors
    assert summary(tmp_path)["initial_fresh"] == summary(tmp_path)["best_fresh"]
    assert summary(tmp_path)["gain"]["fitness"] == [0.0, 0.0]


def test_initial_values_are_those_of_the_configuration_to_the_last_digit(tmp_path: Path) -> None:
    domains: list[dict[str, Any]] = [
        {"type": "float", "min": -0.3, "max": 1.1, "init": 0.1},
        {"type": "float", "min": 0.007, "max": 9.3, "init": 0.3, "log": True},
        {"type": "int", "min": 3, "max": 10**6, "init": 12345, "log": True},
    ]
    parameters = {name: {"optimization_domain": domain} for name, domain in zip("abc", domains, strict=True)}
    write_search(tmp_path, {"parameters": parameters}, "def objective_fn(df): return 1.0")
    assert search(tmp_path, "--max-evals", "1", "--final-runs", "0").code == 0
    assert summary(tmp_path)["initial_values"] == {
        f"parameters.{name}": domain["init"] for name, domain in zip("abc", domains, strict=True)
    }


def test_gain_is_the_mean_difference_on_the_same_fresh_seeds_with_its_interval(tmp_path: Path) -> None:
    write_search(tmp_path, objective=NOISY)
    result = search(tmp_path, "--max-evals", "30", "-r", "2", "--final-runs", "6")
    assert result.code == 0
    entries = summary(tmp_path)
    best, initial, gain = entries["best_fresh"], entries["initial_fresh"], entries["gain"]
    assert best["seeds"] == initial["seeds"] == gain["seeds"] == [2, 3, 4, 5, 6, 7]
    difference = np.subtract(best["fitness"], initial["fitness"])
    np.testing.assert_allclose(gain["fitness"], difference)
    row = mean_over_runs(pd.DataFrame([difference])).iloc[0]
    assert (gain["mean"], gain["low_95"], gain["high_95"]) == pytest.approx((row["mean"], row["low"], row["high"]))
    # The places where robots begin are those of the seeds, and cancel out.
    assert np.std(initial["fitness"]) > 0.01
    np.testing.assert_allclose(difference, difference[0])
    assert "[INFO] Initial values: " in result.errors
    assert f"[INFO] Gain: {gain['mean']:.6g}, the mean difference seed by seed (95 % interval " in result.errors
    assert "the interval of the gain" not in result.errors
    rows, _ = load_dataframe(tmp_path / "opt_out" / "best_results.feather")
    assert rows["run"].nunique() == 6


def test_luck_of_the_search_is_no_gain(tmp_path: Path) -> None:
    """Each candidate has its own seeds, and values make no difference: the best one is the luckiest."""
    write_search(tmp_path, objective="def objective_fn(df): return float(df['x'].iloc[0])")
    result = search(tmp_path, "--max-evals", "20", "--seeds", "fresh", "--final-runs", "5")
    entries = summary(tmp_path)
    assert entries["best_fitness"] > entries["initial_fitness"]
    assert entries["gain"]["fitness"] == [0.0] * 5
    assert "[WARNING] the interval of the gain contains 0: tuning may have gained nothing; " in result.errors


def test_gain_of_one_fresh_run_has_no_interval_and_says_so(tmp_path: Path) -> None:
    write_search(tmp_path)
    result = search(tmp_path, "--max-evals", "12", "--final-runs", "1")
    assert summary(tmp_path)["gain"]["low_95"] is None
    assert (
        "[WARNING] one fresh run says nothing of chance: --final-runs 10 gives an interval of the gain" in result.errors
    )


def test_best_values_that_are_worse_than_the_initial_ones_on_fresh_seeds_are_told(tmp_path: Path) -> None:
    """The objective prefers other values on the seed of the search, and the initial ones on all others."""
    lines = """
def objective_fn(df):
    resolved = df.attrs.get("combinations") or [{}]
    seeds = resolved[0].get("seeds", [0])
    a = df.attrs["resolved_configuration"]["parameters"]["a"]
    return float(a if seeds == [0] else -a + 0.001 * df["x"].iloc[0])
"""
    write_search(tmp_path, objective=lines)
    result = search(tmp_path, "--max-evals", "12", "--final-runs", "4")
    assert summary(tmp_path)["gain"]["high_95"] < 0.0
    assert "[WARNING] the best values are worse than the initial ones: " in result.errors


def test_initial_values_that_fail_are_told_and_the_search_goes_on(tmp_path: Path) -> None:
    lines = OBJECTIVE.replace(
        "def objective_fn(df):", "def objective_fn(df):\n    if parameters(df)['a'] == -0.5: raise ValueError('start')"
    )
    write_search(tmp_path, objective=lines)
    result = search(tmp_path, "--max-evals", "9", "--final-runs", "2")
    assert result.code == 0
    entries = summary(tmp_path)
    assert (entries["initial_fitness"], entries["initial_fresh"], entries["gain"]) == (None, None, None)
    assert entries["best_fresh"] is not None
    assert (
        "[WARNING] the initial values have failed, so there is nothing to compare the best ones with" in result.errors
    )
