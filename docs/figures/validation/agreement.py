"""Comparing what was measured with what theory says, value by value, with a tolerance that statistics give."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy import special

Values = npt.NDArray[np.float64]

FALSE_ALARM = 1e-3  # probability that a comparison fails although theory holds for every value


@dataclass(frozen=True)
class Comparison:
    """Means of independent samples, and what they should be.

    Attributes:
        name: What is compared, as the page says it.
        measured: Means over samples. Shape (values,).
        expected: What theory says. Same shape and unit.
        standard_error: Standard deviations of the means, estimated from the samples. Same shape and unit.
        degrees: Degrees of freedom of the standard errors, at least 1: samples less one, or less two of two groups.
        margin: How far theory may be wrong, because it holds only in a limit. Same shape and unit.
    """

    name: str
    measured: Values
    expected: Values
    standard_error: Values
    degrees: int
    margin: Values

    @property
    def errors_allowed(self) -> float:
        """Standard errors allowed at each value: Bonferroni's correction for FALSE_ALARM in all, normal samples."""
        return float(special.stdtrit(self.degrees, 1.0 - FALSE_ALARM / (2.0 * len(self.measured))))

    @property
    def tolerance(self) -> Values:
        """Largest difference allowed at each value. Same shape and unit."""
        return self.errors_allowed * self.standard_error + self.margin

    @property
    def difference(self) -> Values:
        """Measured minus expected."""
        return self.measured - self.expected

    @property
    def agrees(self) -> bool:
        """Whether every difference is within its tolerance. NaN is not."""
        return bool((np.abs(self.difference) <= self.tolerance).all())

    @property
    def used(self) -> float:
        """Largest share of a tolerance that a difference uses; above 1, or NaN, if they do not agree."""
        difference = np.abs(self.difference)
        return float(np.where(difference == 0.0, 0.0, difference / np.maximum(self.tolerance, 1e-300)).max())

    @property
    def line(self) -> str:
        """One line for the page: differences, and how much of the tolerance they use."""
        if len(self.measured) == 1:
            values = f"{self.measured[0]:.4f}, expected {self.expected[0]:.4f}"
        else:
            rms, largest = np.sqrt((self.difference**2).mean()), np.abs(self.difference).max()
            values = f"{len(self.measured)} values, rms difference {rms:.4f}, largest {largest:.4f}"
        verdict = "agrees" if self.agrees else "DISAGREES"
        return f"{self.name}: {values}; {100 * self.used:.0f} % of the tolerance: {verdict}"


def relative(name: str, samples: npt.ArrayLike, expected: npt.ArrayLike, margin: float = 0.0) -> Comparison:
    """Compare the mean of samples with theory, both divided by what theory says.

    Args:
        name: What is compared.
        samples: One row per independent sample, one column per value; any unit.
        expected: One per column, not 0. Same unit.
        margin: Relative error of theory, such as 0.01.

    Returns:
        The comparison of ratios with 1.
    """
    ratio = np.asarray(samples, dtype=float) / np.asarray(expected, dtype=float)
    return absolute(name, ratio, np.ones(ratio.shape[1]), margin)


def absolute(name: str, samples: npt.ArrayLike, expected: npt.ArrayLike, margin: float = 0.0) -> Comparison:
    """Compare the mean of samples with theory.

    Args:
        name: What is compared.
        samples: One row per independent sample, one column per value; any unit.
        expected: One per column. Same unit.
        margin: Error of theory, in the same unit.

    Returns:
        The comparison.
    """
    rows, theory = np.asarray(samples, dtype=float), np.asarray(expected, dtype=float)
    error = rows.std(axis=0, ddof=1) / np.sqrt(len(rows))
    return Comparison(name, rows.mean(axis=0), theory, error, len(rows) - 1, np.full(len(theory), margin))


def two_samples(name: str, ours: npt.ArrayLike, theirs: npt.ArrayLike, margin: float = 0.0) -> Comparison:
    """Compare the means of two groups of samples from what should be one distribution (Student, pooled variance).

    Args:
        name: What is compared.
        ours: One row per independent sample, one column per value; any unit.
        theirs: As many columns. Same unit.
        margin: Difference that is none, in the same unit.

    Returns:
        The comparison.
    """
    one, other = np.asarray(ours, dtype=float), np.asarray(theirs, dtype=float)
    degrees = len(one) + len(other) - 2
    squares = sum(((group - group.mean(axis=0)) ** 2).sum(axis=0) for group in (one, other))
    error = np.sqrt(squares / degrees * (1.0 / len(one) + 1.0 / len(other)))
    return Comparison(name, one.mean(axis=0), other.mean(axis=0), error, degrees, np.full(one.shape[1], margin))
