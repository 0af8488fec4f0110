"""Means over runs, with confidence intervals."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd
import pytest
from pogosim.confidence import mean_over_runs


# Tables of Student's distribution; for 1 and 2 degrees of freedom there are closed forms.
@pytest.mark.parametrize(
    ("level", "degrees_of_freedom", "expected"),
    [
        (0.95, 1, math.tan(math.pi * 0.475)),
        (0.95, 2, 0.95 / math.sqrt(2 * 0.975 * 0.025)),
        (0.95, 3, 3.182446),
        (0.95, 19, 2.093024),
        (0.99, 19, 2.860935),
        (0.9, 30, 1.697261),
        (0.95, 100, 1.983972),
    ],
)
def test_half_width_is_that_of_the_tables(level: float, degrees_of_freedom: int, expected: float) -> None:
    values = np.arange(degrees_of_freedom + 1.0)
    band = mean_over_runs(pd.DataFrame([values]), level).iloc[0]
    standard_error = np.std(values, ddof=1) / math.sqrt(len(values))
    assert (band["high"] - band["mean"]) / standard_error == pytest.approx(expected, abs=1e-6)
    assert band["mean"] - band["low"] == pytest.approx(band["high"] - band["mean"])


def test_interval_of_four_runs_is_the_one_computed_by_hand() -> None:
    # Mean 3; squares of the differences 4 + 1 + 1 + 4 = 10, so s = sqrt(10 / 3); t = 3.182446 for 3 degrees of freedom.
    band = mean_over_runs(pd.DataFrame([[1.0, 2.0, 4.0, 5.0]], index=[0.5]))
    half_width = 3.182446 * math.sqrt(10 / 3) / 2
    assert band.index.tolist() == [0.5]
    assert band.iloc[0].tolist() == pytest.approx([3.0, 3.0 - half_width, 3.0 + half_width, 4], abs=1e-5)


def test_runs_that_ended_before_are_left_out() -> None:
    band = mean_over_runs(pd.DataFrame([[1.0, 2.0, 6.0], [1.0, 3.0, np.nan], [7.0, np.nan, np.nan], [np.nan] * 3]))
    assert band["runs"].tolist() == [3, 2, 1, 0]
    assert band["mean"].tolist() == pytest.approx([3.0, 2.0, 7.0, math.nan], nan_ok=True)
    # Two values, 1 degree of freedom: t = 12.706205, s / sqrt(2) = 1.
    assert band.loc[1, "high"] == pytest.approx(2.0 + 12.706205)
    assert band.loc[2:, ["low", "high"]].isna().all(axis=None)


def test_runs_without_variance_have_an_interval_without_width() -> None:
    assert mean_over_runs(pd.DataFrame([[5.0] * 3])).iloc[0].tolist() == [5.0, 5.0, 5.0, 3]


@pytest.mark.parametrize("level", [0.5, 0.95])
def test_intervals_contain_the_true_mean_as_often_as_they_say(level: float) -> None:
    samples = np.random.default_rng(1).normal(10.0, 3.0, size=(4000, 5))
    band = mean_over_runs(pd.DataFrame(samples), level)
    share = ((band["low"] < 10.0) & (band["high"] > 10.0)).mean()
    assert share == pytest.approx(level, abs=4 * math.sqrt(level * (1 - level) / 4000))


@pytest.mark.parametrize("level", [0.0, 1.0, 95.0, math.nan])
def test_levels_that_are_no_probabilities_are_refused(level: float) -> None:
    with pytest.raises(ValueError, match="between 0 and 1"):
        mean_over_runs(pd.DataFrame([[1.0, 2.0]]), level)


def test_series_is_refused_with_what_was_expected() -> None:
    with pytest.raises(TypeError, match=r"one column per run, as of unstack\('run'\); found Series"):
        mean_over_runs(pd.Series([1.0, 2.0]))  # type: ignore[arg-type]
