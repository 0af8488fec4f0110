"""The reception laws against the measurements on real robots: how well each law fits, and a figure.

    .venv/bin/python docs/figures/all.py reception

Bytes are those of the message: payload and header.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
from matplotlib.figure import Figure
from pictures import Picture, from_figure
from pogosim.communication.measurements import ROBOTS_OWN, read_measurements
from pogosim.communication.quality import compare, quality
from pogosim.communication.reception_law import SHORT_HEADER_BYTES, DynamicLaw, Law, PowerLaw
from quotes import Quote

NAMES = ("reception.png", "communication.md: quality")
NEIGHBOURS = (1, 2, 6)
COLOURS = {3: "#1b6ca8", 20: "#d98200", 100: "#a8321b"}  # by bytes of payload


def predicted(rows: pd.DataFrame) -> npt.NDArray[np.float64]:
    """Return the article's equation at the measured points."""
    return DynamicLaw().probability(SHORT_HEADER_BYTES + rows["payload_size"], rows["p_send"], 1 + rows["nb_neighbors"])


def draw_panels(measured: pd.DataFrame) -> Figure:
    """One panel per number of neighbours: dots measured, lines by the law."""
    figure = Figure(figsize=(9.0, 3.2), layout="constrained")
    panels = figure.subplots(1, len(NEIGHBOURS), sharey=True)
    p = np.linspace(0.0, 1.0, 201)
    for axes, neighbours in zip(panels, NEIGHBOURS, strict=True):
        for payload, colour in COLOURS.items():
            rows = measured[(measured["nb_neighbors"] == neighbours) & (measured["payload_size"] == payload)]
            axes.plot(p, DynamicLaw().probability(SHORT_HEADER_BYTES + payload, p, 1 + neighbours), color=colour)
            axes.plot(rows["p_send"], rows["success_probability"], "o", color=colour, label=f"{payload} bytes")
        axes.set_title(f"{neighbours} neighbour{'s' if neighbours > 1 else ''}", fontsize=10)
        axes.set_xlabel("chance to send, per tick")
        axes.set_ylim(-0.03, 1.05)
        axes.grid(color="0.9")
    panels[0].set_ylabel("probability of reception")
    panels[0].legend(title="payload", fontsize=8, title_fontsize=8, loc="lower left")
    return figure


def table() -> Quote:
    """Return R2 and mean absolute error of both laws."""
    laws: dict[str, Law] = {"article's equation": DynamicLaw(), "four-parameter law": PowerLaw()}
    lines = ["| law | R2 | mean absolute error |", "|---|---|---|"]
    for name, law in laws.items():
        found = quality(compare(law, read_measurements()))
        lines.append(f"| {name} | {found.r2:.6f} | {found.mae:.6f} |")
    return Quote(tuple(lines))


def draw(_folder: Path) -> dict[str, Picture | Quote]:
    """Draw the law and the measurements."""
    measured = pd.read_csv(ROBOTS_OWN)
    drawn = measured.assign(predicted=predicted(measured).round(9))
    return {"reception.png": from_figure(draw_panels(measured), 110, drawn), "communication.md: quality": table()}
