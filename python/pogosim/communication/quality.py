"""How well a law of reception fits measurements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import pandas as pd

from pogosim.communication.measurements import Measurements
from pogosim.communication.reception_law import Law

# Shapiro and Wilk's test needs at least three values, and some spread.
LEAST_FOR_NORMALITY = 3


@dataclass(frozen=True)
class Quality:
    """How well a law fits. What is not defined is None: R2 of equal measurements, for instance.

    Attributes:
        r2: Coefficient of determination, 1 - sum of squared residuals / sum of squared deviations from the mean.
        mae: Mean absolute error.
        rmse: Root mean square error.
        mape_percent: Mean absolute error relative to the measurement, in %, where that is not 0.
        shapiro_w: Shapiro and Wilk's W of the residuals, at most 1: how normal they look.
        shapiro_p: Probability of at most this W with normal residuals.
    """

    r2: float | None
    mae: float
    rmse: float
    mape_percent: float | None
    shapiro_w: float | None
    shapiro_p: float | None


def compare(law: Law, measurements: Measurements) -> pd.DataFrame:
    """Return the rows of the measurements with the columns predicted and residual (measured - predicted)."""
    predicted = law.probability(measurements.message_bytes, measurements.send_probability, measurements.cluster_size)
    return measurements.rows.assign(predicted=predicted, residual=measurements.success - predicted)


def quality(compared: pd.DataFrame) -> Quality:
    """Return how well a law fits; `compared` is what compare() returns, with at least one row."""
    measured = compared["success_probability"].to_numpy(dtype=float)
    residual = compared["residual"].to_numpy(dtype=float)
    spread = float(((measured - measured.mean()) ** 2).sum())
    positive = measured > 0.0
    relative = np.abs(residual[positive] / measured[positive])
    w, p = normality(residual)
    return Quality(
        r2=1.0 - float((residual**2).sum()) / spread if spread > 0.0 else None,
        mae=float(np.abs(residual).mean()),
        rmse=float(np.sqrt((residual**2).mean())),
        mape_percent=100.0 * float(relative.mean()) if len(relative) else None,
        shapiro_w=w,
        shapiro_p=p,
    )


def normality(residual: npt.NDArray[np.float64]) -> tuple[float | None, float | None]:
    """Return W and p of S. S. Shapiro and M. B. Wilk's test of normality (Biometrika 52, 1965), if it is defined."""
    if len(residual) < LEAST_FOR_NORMALITY or np.ptp(residual) < 1e-12:
        return None, None
    from scipy.stats import shapiro

    tested = shapiro(residual)
    return float(tested.statistic), float(tested.pvalue)
