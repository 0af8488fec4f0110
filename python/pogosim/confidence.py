"""Means over runs, with confidence intervals: the bands of a figure."""

from __future__ import annotations

import numpy as np
import pandas as pd
from scipy import special

from pogosim.arguments import Arguments


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
        TypeError: It is not a dataframe.
        ValueError: The level is not between 0 and 1.
    """
    if not isinstance(runs, pd.DataFrame):
        raise TypeError(
            f"expected a dataframe with one column per run, as of unstack('run'); found {type(runs).__name__}"
        )
    level = Arguments().number("level", level, "a number between 0 and 1, such as 0.95")
    if not 0.0 < level < 1.0:
        raise ValueError(f"level: expected a number between 0 and 1, such as 0.95; found {level}")
    count = runs.notna().sum(axis=1)
    mean = runs.mean(axis=1)
    quantile = special.stdtrit(count.where(count > 1) - 1, (1.0 + level) / 2.0)
    half_width = quantile * runs.std(axis=1) / np.sqrt(count)
    return pd.DataFrame({"mean": mean, "low": mean - half_width, "high": mean + half_width, "runs": count})
