"""How many messages get through, from the rows of a message log: one per transmission and robot in reach."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy import special

from pogosim.analysis.arena import Floats
from pogosim.analysis.trajectories import need_columns, need_numbers

COLUMNS = ("message", "sender_category", "receiver", "distance", "cluster_size", "probability", "outcome")
LOST = "lost"
NOBODY = "nobody_in_reach"
OUTCOMES = ("heard", LOST, "queue_full")


def attempts(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the rows in which a robot was in reach: those that the law of reception decided about.

    Args:
        rows: Rows of a message log.

    Raises:
        AnalysisError: It is none.
    """
    need_columns(rows, COLUMNS)
    need_numbers(rows, ["distance", "cluster_size", "probability"])
    return rows[rows["outcome"] != NOBODY]


def wilson_interval(successes: npt.ArrayLike, trials: npt.ArrayLike, level: float = 0.95) -> tuple[Floats, Floats]:
    """Return the limits of the confidence interval of a share.

    Source: E. B. Wilson, "Probable inference, the law of succession, and statistical inference", Journal of the
    American Statistical Association 22 (1927).
    """
    z = float(special.ndtri((1.0 + level) / 2.0))
    n = np.asarray(trials, dtype=float)
    share = np.asarray(successes, dtype=float) / n
    middle = (share + z**2 / (2.0 * n)) / (1.0 + z**2 / n)
    half_width = z / (1.0 + z**2 / n) * np.sqrt(share * (1.0 - share) / n + z**2 / (4.0 * n**2))
    return middle - half_width, middle + half_width


def reception_rates(tried: pd.DataFrame, by: Sequence[str]) -> pd.DataFrame:
    """Return the rate of reception of groups of attempts, beside what the law says.

    What found a full queue was received nevertheless.

    Args:
        tried: As of `attempts`.
        by: Columns that tell groups apart.

    Returns:
        A row per group, sorted: the columns `by`; `attempts`; `received` of them; `rate`, their share, 0 to 1, with
        its 95 % confidence interval `rate_low` to `rate_high`; `law`, the mean of the probabilities with which the
        simulator drew; `z`, by how many standard deviations the number received exceeds its expectation (NaN where
        chance decides nothing).
    """
    p = tried["probability"].astype(float)
    values = tried.assign(received=tried["outcome"] != LOST, law=p, variance=p * (1.0 - p))
    groups = values.groupby(list(by), sort=True, dropna=False, observed=True)
    sums = groups[["received", "law", "variance"]].sum()
    count = groups.size()
    low, high = wilson_interval(sums["received"], count)
    deviation = np.sqrt(sums["variance"].where(sums["variance"] > 0.0))
    table = pd.DataFrame(
        {
            "attempts": count,
            "received": sums["received"].astype(int),
            "rate": sums["received"] / count,
            "rate_low": low,
            "rate_high": high,
            "law": sums["law"] / count,
            "z": (sums["received"] - sums["law"]) / deviation,
        }
    )
    return table.reset_index()


def outcomes(rows: pd.DataFrame, by: Sequence[str]) -> pd.DataFrame:
    """Count what became of the messages of groups of senders.

    Args:
        rows: Rows of a message log.
        by: Columns that tell groups apart; those that tell runs apart among them.

    Returns:
        A row per group, sorted: the columns `by`; `messages`, the number of transmissions; `nobody_in_reach` of them;
        `attempts`, one for each robot in reach; and how these ended: `heard`, `lost`, `queue_full`.
    """
    groups = rows.groupby(list(by), sort=True, dropna=False, observed=True)
    table = pd.DataFrame({"messages": groups["message"].nunique()})
    for name in (NOBODY, "attempts", *OUTCOMES):
        chosen = rows["outcome"] != NOBODY if name == "attempts" else rows["outcome"] == name
        table[name] = chosen.groupby([rows[column] for column in by], sort=True, dropna=False, observed=True).sum()
    return table.reset_index()
