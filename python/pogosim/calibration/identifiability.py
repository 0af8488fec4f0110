"""What tracks can tell of which parameter, from the sensitivities of their statistics.

With statistics s, their covariance C and sensitivities J = ds/dp, the Fisher information of the parameters is J^T
C^-1 J, and its inverse their covariance (Cramer-Rao). Columns of C^-1/2 J that are short have no effect; columns that
others nearly span cannot be told from those (D. A. Belsley, E. Kuh, R. E. Welsch, "Regression Diagnostics", Wiley,
1980, chapter 3; M. K. Transtrum, B. B. Machta, J. P. Sethna, "Geometry of nonlinear least squares", Phys. Rev. E 83,
036701, 2011).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pogosim.calibration.tracks import Floats

LEAST_EFFECT = 2.0  # standard errors of the statistics, for a parameter that changes by its scale
LEAST_OWN_SHARE = 0.25  # of the effect that others cannot imitate
MOST_ERROR = 0.5  # in scales of the parameter
LEAST_PART = 0.3  # of the direction that tracks show least, to be named


@dataclass(frozen=True)
class Verdict:
    """What tracks tell of a parameter.

    Attributes:
        name: Name of the parameter.
        effect: Change of the statistics in their standard errors, if the parameter changes by its scale.
        own_share: Part of the effect that no combination of the others has, 0 to 1.
        error: Standard error in scales of the parameter: relative, if it is logarithmic.
        like: Parameters that have nearly the same effect.
    """

    name: str
    effect: float
    own_share: float
    error: float
    like: tuple[str, ...] = ()

    @property
    def has_effect(self) -> bool:
        """The statistics depend on it."""
        return self.effect >= LEAST_EFFECT

    @property
    def is_distinct(self) -> bool:
        """Its effect is not one of the others'."""
        return self.own_share >= LEAST_OWN_SHARE

    @property
    def is_identified(self) -> bool:
        """Tracks determine it, alone or by a small effect of its own in many data."""
        return self.has_effect and self.error <= MOST_ERROR


def verdicts(sensitivity: Floats, names: Sequence[str]) -> dict[str, Verdict]:
    """Judge each parameter.

    Args:
        sensitivity: Change of the statistics, each in its standard errors, per scale of each parameter. Shape
            (statistics, parameters).
        names: Names of the parameters.
    """
    found = {}
    for column, name in enumerate(names):
        own, others = sensitivity[:, column], np.delete(sensitivity, column, axis=1)
        effect = float(np.linalg.norm(own))
        weights = np.linalg.lstsq(others, own, rcond=1e-6)[0] if others.size else np.zeros(0)
        rest = float(np.linalg.norm(own - others @ weights))
        shares = np.abs(weights) * np.linalg.norm(others, axis=0)
        rivals = [other for other in names if other != name]
        like = tuple(
            rival for rival, share in zip(rivals, shares, strict=True) if share > LEAST_PART * max(effect, 1e-9)
        )
        found[name] = Verdict(
            name, effect, rest / effect if effect else 0.0, 1.0 / rest if rest > 1e-9 else np.inf, like
        )
    return found


def without_own_effect(sensitivity: Floats, names: Sequence[str], last: Sequence[str]) -> list[str]:
    """Return which of some parameters add nothing to all others, so that they are better left as they are."""
    dropped: list[str] = []
    for name in last:
        if name not in names:
            continue
        kept = [other for other in names if other not in dropped]
        columns = [list(names).index(other) for other in kept]
        verdict = verdicts(sensitivity[:, columns], kept)[name]
        if not verdict.is_identified or not verdict.is_distinct:
            dropped.append(name)
    return dropped


def weakest_direction(sensitivity: Floats, names: Sequence[str]) -> tuple[float, dict[str, float]]:
    """Return the combination of parameters that tracks show least.

    Returns:
        Its singular value (1 / standard error), and the part of each parameter in it that has more than a little.
    """
    _, values, vectors = np.linalg.svd(sensitivity, full_matrices=False)
    part = vectors[-1] * np.sign(vectors[-1][np.argmax(np.abs(vectors[-1]))])
    named = {name: float(value) for name, value in zip(names, part, strict=True) if abs(value) > LEAST_PART}
    return float(values[-1]), named
