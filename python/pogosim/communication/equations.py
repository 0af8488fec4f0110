"""The equations of the laws of reception, for arrays: P = 1 / denominator, within [0, 1]."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def dynamic(
    m: Floats,
    p: Floats,
    c: Floats,
    *,
    alpha: Floats,
    beta: Floats,
    gamma: Floats,
    delta: Floats,
    zeta: Floats,
    theta: Floats,
) -> Floats:
    """Return the denominator of the article's equation."""
    return alpha + beta * p**gamma * c**delta * np.exp(zeta * m) + theta * p * c


def power(m: Floats, p: Floats, c: Floats, *, alpha: Floats, beta: Floats, gamma: Floats, delta: Floats) -> Floats:
    """Return the denominator of the four-parameter law."""
    return 1.0 + alpha * m**beta * p**gamma * c**delta


DENOMINATORS: dict[str, Callable[..., Floats]] = {"dynamic": dynamic, "power": power}


def probability(
    law: str,
    message_bytes: npt.ArrayLike,
    send_probability: npt.ArrayLike,
    cluster_size: npt.ArrayLike,
    **parameters: npt.ArrayLike,
) -> Floats:
    """Return the probability of reception by a law; arguments as in the laws, and all shapes are broadcast."""
    arrays = [np.asarray(value, dtype=float) for value in (message_bytes, send_probability, cluster_size)]
    own = {name: np.asarray(value, dtype=float) for name, value in parameters.items()}
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        inverse = 1.0 / DENOMINATORS[law](*arrays, **own)
        # A denominator that is no positive number, as unusual parameters make it, lets nothing through.
        return np.where(inverse > 0.0, np.minimum(inverse, 1.0), 0.0)
