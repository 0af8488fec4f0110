"""The equations of the laws of reception, for arrays. Arguments as in the laws; all shapes are broadcast."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def dynamic(
    message_bytes: npt.ArrayLike,
    send_probability: npt.ArrayLike,
    cluster_size: npt.ArrayLike,
    alpha: npt.ArrayLike,
    beta: npt.ArrayLike,
    gamma: npt.ArrayLike,
    delta: npt.ArrayLike,
    zeta: npt.ArrayLike,
    theta: npt.ArrayLike,
) -> Floats:
    """Return 1 / (alpha + beta p^gamma c^delta exp(zeta m) + theta p c), within [0, 1]."""
    m, p, c = as_arrays(message_bytes, send_probability, cluster_size)
    a, b, g, d, z, t = as_arrays(alpha, beta, gamma, delta, zeta, theta)
    with np.errstate(over="ignore", invalid="ignore"):
        return clamped_inverse(a + b * p**g * c**d * np.exp(z * m) + t * p * c)


def power(
    message_bytes: npt.ArrayLike,
    send_probability: npt.ArrayLike,
    cluster_size: npt.ArrayLike,
    alpha: npt.ArrayLike,
    beta: npt.ArrayLike,
    gamma: npt.ArrayLike,
    delta: npt.ArrayLike,
) -> Floats:
    """Return 1 / (1 + alpha m^beta p^gamma c^delta), within [0, 1]."""
    m, p, c = as_arrays(message_bytes, send_probability, cluster_size)
    a, b, g, d = as_arrays(alpha, beta, gamma, delta)
    with np.errstate(over="ignore", invalid="ignore"):
        return clamped_inverse(1.0 + a * m**b * p**g * c**d)


def as_arrays(*values: npt.ArrayLike) -> list[Floats]:
    """Return numbers as arrays."""
    return [np.asarray(value, dtype=float) for value in values]


def clamped_inverse(denominator: Floats) -> Floats:
    """Return 1 / denominator within [0, 1]; 0 where it is no positive number, as unusual parameters make it."""
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1.0 / denominator
        return np.where(inverse > 0.0, np.minimum(inverse, 1.0), 0.0)
