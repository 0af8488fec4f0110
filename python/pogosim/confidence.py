"""Means over runs, with confidence intervals: the bands of a figure."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd


def mean_over_runs(runs: pd.DataFrame, level: float = 0.95) -> pd.DataFrame:
    """Average independent runs, with the confidence interval of each mean.

    The interval is that of Student's t: mean -+ t s / sqrt(n), for n values with the standard deviation s (with n - 1
    in its denominator), where t is the quantile (1 + level) / 2 of Student's distribution with n - 1 degrees of
    freedom. It is exact for independent, normal values, and holds for each row on its own, not for all rows at once.

    Args:
        runs: One column per run, one row per time (or whatever the runs are compared at); any unit. Missing values
            (NaN) are left out, so n may differ from row to row.
        level: Probability that the interval contains the mean of all possible runs, between 0 and 1.

    Returns:
        The columns `mean`, `low` and `high` in the unit of the values, and `runs`, the number n. Same index. NaN where
        there is nothing to compute from: no run for a mean, fewer than two for an interval.

    Raises:
        ValueError: The level is not between 0 and 1.
    """
    if not 0.0 < level < 1.0:
        raise ValueError(f"level: expected a number between 0 and 1, such as 0.95; found {level}")
    count = runs.notna().sum(axis=1)
    quantile = {n: student_t_quantile((1.0 + level) / 2.0, n - 1) if n > 1 else np.nan for n in set(count)}
    mean = runs.mean(axis=1)
    half_width = count.map(quantile) * runs.std(axis=1) / np.sqrt(count)
    return pd.DataFrame({"mean": mean, "low": mean - half_width, "high": mean + half_width, "runs": count})


def student_t_quantile(probability: float, degrees_of_freedom: int) -> float:
    """Return the value below which Student's t lies with a probability.

    Args:
        probability: At least 0.5 and below 1.
        degrees_of_freedom: At least 1.

    Raises:
        ValueError: An argument is out of range.
    """
    if not 0.5 <= probability < 1.0 or degrees_of_freedom < 1:
        raise ValueError(f"no quantile {probability} of Student's t with {degrees_of_freedom} degrees of freedom")
    # t = sqrt(degrees of freedom) tan(angle) grows with the angle: bisect it to the last bit.
    low, high = 0.0, math.pi / 2.0
    while low < (angle := (low + high) / 2.0) < high:
        if central_probability(angle, degrees_of_freedom) < 2.0 * probability - 1.0:
            low = angle
        else:
            high = angle
    return math.sqrt(degrees_of_freedom) * math.tan(low)


def central_probability(angle_rad: float, degrees_of_freedom: int) -> float:
    """Return the probability that |t| < sqrt(degrees of freedom) tan(angle).

    Source: M. Abramowitz, I. A. Stegun, "Handbook of Mathematical Functions", 26.7.3 and 26.7.4.
    """
    is_odd = degrees_of_freedom % 2 == 1
    cosine, sine = math.cos(angle_rad), math.sin(angle_rad)
    term = cosine if is_odd else 1.0
    total = 0.0
    for k in range(2 + is_odd, degrees_of_freedom + 1, 2):
        total += term
        term *= cosine * cosine * (k - 1) / k
    return 2.0 / math.pi * (angle_rad + sine * total) if is_odd else sine * total
