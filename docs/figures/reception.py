"""Reception law against the measurements on real robots.

    .venv/bin/python docs/figures/reception.py        # prints the quality of the fit
    .venv/bin/python docs/figures/all.py reception    # draws

Bytes are those of the message: payload and header.
"""

from __future__ import annotations

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
    """Return what `type: dynamic` computes with its defaults (src/comms/reception.cpp), 0 to 1. Takes arrays, too."""
    m, p, c = (np.asarray(x, dtype=float) for x in (message_bytes, send_probability, cluster_size))
    collisions = 0.00073859 * p**3.14782227 * c**3.52543753 * np.exp(0.05720136 * m)
    probability: npt.NDArray[np.float64] = np.minimum(1.0 / (1.03215183 + collisions + 0.001 * p * c), 1.0)
    return probability


def predicted(rows: pd.DataFrame) -> npt.NDArray[np.float64]:
    """Return the law at the measured points."""
    message_bytes = SHORT_HEADER_BYTES + rows["payload_size"]
    return reception_probability(message_bytes, rows["p_send"], 1 + rows["nb_neighbors"])


def draw_panels(measured: pd.DataFrame) -> Figure:
    """One panel per number of neighbours: dots measured, lines by the law."""
    figure = Figure(figsize=(9.0, 3.2), layout="constrained")
    panels = figure.subplots(1, len(NEIGHBOURS), sharey=True)
    p = np.linspace(0.0, 1.0, 201)
    for axes, neighbours in zip(panels, NEIGHBOURS):
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
    """Print R2 and mean absolute error."""
    measured = pd.read_csv(MEASUREMENTS)
    error = measured["success_probability"] - predicted(measured)
    spread = measured["success_probability"] - measured["success_probability"].mean()
    print(f"R2 = {1.0 - (error**2).sum() / (spread**2).sum():.6f}, MAE = {error.abs().mean():.6f}")


if __name__ == "__main__":
    main()
