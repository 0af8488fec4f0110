"""Two samples: the difference of their means with an interval, a test, and a correction for many tests."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

RESAMPLES = 10_000
PERMUTATIONS = 9_999
SEED = 20_000  # of resampling: the same data have the same interval
CONFIDENCE = 0.95
MOST_NUMBERS = 4_000_000  # that are drawn at once


def difference_interval(a: Floats, b: Floats, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """Return a bootstrap interval of mean(b) - mean(a), by the percentiles of resampled differences.

    It is too narrow for samples of a few values. Source: Efron, Tibshirani, "An Introduction to the Bootstrap", 1993,
    chapter 13.

    Args:
        a: Sample, finite.
        b: Sample, finite.
        confidence: Between 0 and 1.

    Returns:
        Low and high; NaN for a sample of fewer than two values.
    """
    if min(len(a), len(b)) < 2:
        return float("nan"), float("nan")
    generator = np.random.default_rng(SEED)
    differences = resampled_means(b, generator) - resampled_means(a, generator)
    low, high = np.quantile(differences, [(1.0 - confidence) / 2.0, (1.0 + confidence) / 2.0])
    return float(low), float(high)


def resampled_means(sample: Floats, generator: np.random.Generator) -> Floats:
    """Return means of samples that are drawn from a sample with replacement. Shape (RESAMPLES,)."""
    block = max(min(RESAMPLES, MOST_NUMBERS // len(sample)), 1)
    parts = []
    for start in range(0, RESAMPLES, block):
        drawn = generator.integers(len(sample), size=(min(block, RESAMPLES - start), len(sample)))
        parts.append(sample[drawn].mean(axis=1))
    return np.concatenate(parts)


def two_sample_p(a: Floats, b: Floats, test: str) -> float:
    """Return the probability of samples that differ at least so much, if both are of one distribution (two-sided).

    Args:
        a: Sample, finite.
        b: Sample, finite.
        test: "mann-whitney": of ranks; exact for small samples without equal values. "permutation": of the difference
            of means.

    Returns:
        0 to 1; NaN for a sample of fewer than two values.
    """
    if min(len(a), len(b)) < 2:
        return float("nan")
    if np.ptp(np.concatenate([a, b])) == 0.0:
        return 1.0
    if test == "permutation":
        return permutation_p(a, b)
    from scipy import stats  # takes a while

    return float(stats.mannwhitneyu(a, b, alternative="two-sided").pvalue)


def permutation_p(a: Floats, b: Floats) -> float:
    """Return the share of permutations whose means are at least as far apart: of all, or of 9999 random ones and this.

    Source: Phipson, Smyth, "Permutation p-values should never be zero", Statistical Applications in Genetics and
    Molecular Biology 9, 2010.
    """
    pooled = np.concatenate([a, b])
    scale = float(np.abs(pooled).max())
    pooled = (pooled - pooled.mean()) / (scale or 1.0)
    size, total = len(a), len(a) + len(b)
    observed = abs(pooled[:size].mean() - pooled[size:].mean())
    is_exact = math.comb(total, size) <= PERMUTATIONS
    if is_exact:
        chosen = np.array(list(itertools.combinations(range(total), size)))
        sums = pooled[chosen].sum(axis=1)
    else:
        generator = np.random.default_rng(SEED)
        sums = np.array([generator.permutation(pooled)[:size].sum() for _ in range(PERMUTATIONS)])
    apart = np.abs(sums / size + sums / (total - size))  # the sum of all is 0
    as_far = int(np.count_nonzero(apart >= observed * (1.0 - 1e-9) - 1e-12))
    return as_far / len(sums) if is_exact else (as_far + 1) / (len(sums) + 1)


def least_p(count_a: int, count_b: int, test: str) -> float:
    """Return the least probability that two_sample_p() can have for samples of these sizes."""
    ways = math.comb(count_a + count_b, count_a)
    if test == "permutation" and ways > PERMUTATIONS:
        return 1.0 / (PERMUTATIONS + 1)
    if test == "permutation" and count_a != count_b:
        return 1.0 / ways
    return min(2.0 / ways, 1.0)


def holm(probabilities: Sequence[float]) -> list[float]:
    """Correct probabilities of several tests, so that all errors together have the level of one test.

    Source: Holm, "A simple sequentially rejective multiple test procedure", Scandinavian Journal of Statistics 6, 1979.

    Returns:
        In the order of the tests, at most 1. NaN stays, and does not count as a test.
    """
    known = [place for place, p in enumerate(probabilities) if math.isfinite(p)]
    known.sort(key=lambda place: probabilities[place])
    corrected = [float("nan")] * len(probabilities)
    greatest = 0.0
    for number, place in enumerate(known):
        greatest = max(greatest, min((len(known) - number) * probabilities[place], 1.0))
        corrected[place] = greatest
    return corrected
