"""The reception laws against the measurements on real robots.

    .venv/bin/python docs/figures/reception.py        # prints how well each law fits
    .venv/bin/python docs/figures/all.py reception    # draws

Bytes are those of the message: payload and header.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
from matplotlib.figure import Figure
from pictures import ROOT, Picture, from_figure

NAMES = ("reception.png",)
MEASUREMENTS = ROOT / "bench" / "ir_reception_profile.csv"
SHORT_HEADER_BYTES = 3
NEIGHBOURS = (1, 2, 6)
COLOURS = {3: "#1b6ca8", 20: "#d98200", 100: "#a8321b"}  # by bytes of payload


def reception_probability(
    message_bytes: npt.ArrayLike, send_probability: npt.ArrayLike, cluster_size: npt.ArrayLike
) -> npt.NDArray[np.float64]:
    """Return what `type: dynamic` computes with its defaults (src/comms/reception.cpp), 0 to 1. Takes arrays, too.

    It is the article's equation, and also what holds without `msg_success_rate`.
    """
    m, p, c = (np.asarray(x, dtype=float) for x in (message_bytes, send_probability, cluster_size))
    collisions = 0.00073859 * p**3.14782227 * c**3.52543753 * np.exp(0.05720136 * m)
    probability: npt.NDArray[np.float64] = np.minimum(1.0 / (1.03215183 + collisions + 0.001 * p * c), 1.0)
    return probability


def four_parameter_law(
    message_bytes: npt.ArrayLike, send_probability: npt.ArrayLike, cluster_size: npt.ArrayLike
) -> npt.NDArray[np.float64]:
    """Return what `type: realistic` computes, 0 to 1. Takes arrays, too."""
    m, p, c = (np.asarray(x, dtype=float) for x in (message_bytes, send_probability, cluster_size))
    probability: npt.NDArray[np.float64] = 1.0 / (1.0 + 4e-6 * m**2.8096 * p**2.3807 * c**1.2457)
    return probability


Law = Callable[[npt.ArrayLike, npt.ArrayLike, npt.ArrayLike], npt.NDArray[np.float64]]


def quality_of(law: Law, measured: pd.DataFrame) -> tuple[float, float]:
    """Return R2 and the mean absolute error of a law at the measured points."""
    message_bytes = SHORT_HEADER_BYTES + measured["payload_size"]
    error = measured["success_probability"] - law(message_bytes, measured["p_send"], 1 + measured["nb_neighbors"])
    spread = measured["success_probability"] - measured["success_probability"].mean()
    return float(1.0 - (error**2).sum() / (spread**2).sum()), float(error.abs().mean())


def predicted(rows: pd.DataFrame) -> npt.NDArray[np.float64]:
    """Return the article's equation at the measured points."""
    return reception_probability(SHORT_HEADER_BYTES + rows["payload_size"], rows["p_send"], 1 + rows["nb_neighbors"])


def draw_panels(measured: pd.DataFrame) -> Figure:
    """One panel per number of neighbours: dots measured, lines by the law."""
    figure = Figure(figsize=(9.0, 3.2), layout="constrained")
    panels = figure.subplots(1, len(NEIGHBOURS), sharey=True)
    p = np.linspace(0.0, 1.0, 201)
    for axes, neighbours in zip(panels, NEIGHBOURS, strict=True):
        for payload, colour in COLOURS.items():
            rows = measured[(measured["nb_neighbors"] == neighbours) & (measured["payload_size"] == payload)]
            axes.plot(p, reception_probability(SHORT_HEADER_BYTES + payload, p, 1 + neighbours), color=colour)
            axes.plot(rows["p_send"], rows["success_probability"], "o", color=colour, label=f"{payload} bytes")
        axes.set_title(f"{neighbours} neighbour{'s' if neighbours > 1 else ''}", fontsize=10)
        axes.set_xlabel("chance to send, per tick")
        axes.set_ylim(-0.03, 1.05)
        axes.grid(color="0.9")
    panels[0].set_ylabel("probability of reception")
    panels[0].legend(title="payload", fontsize=8, title_fontsize=8, loc="lower left")
    return figure


def draw(_folder: Path) -> dict[str, Picture]:
    """Draw the law and the measurements."""
    measured = pd.read_csv(MEASUREMENTS)
    drawn = measured.assign(predicted=predicted(measured).round(9))
    return {"reception.png": from_figure(draw_panels(measured), 110, drawn)}


def main() -> None:
    """Print R2 and mean absolute error of both laws."""
    measured = pd.read_csv(MEASUREMENTS)
    laws: dict[str, Law] = {"article's equation": reception_probability, "four-parameter law": four_parameter_law}
    for name, law in laws.items():
        r2, mean_absolute_error = quality_of(law, measured)
        print(f"{name}: R2 = {r2:.6f}, MAE = {mean_absolute_error:.6f}")


if __name__ == "__main__":
    main()
