"""Share of messages received, in whole runs, against the article's equation and measurements on real robots.

Cazenille, Macabre and Bredeche, "Pogosim - a Simulator for Pogobot robots", equation 1: 45 settings, by payload, number
of neighbours and chance to send. bench/reception_profile.py does the runs.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from pictures import ROOT

from .agreement import Comparison
from .experiment import Outcome

sys.path.append(str(ROOT / "bench"))
from reception_profile import (
    Count,
    Setting,
    equation,
    read_measurements,
    read_parameters,
    simulate_all,
)

NAME = "messages"
SEEDS, QUICK_SEEDS = 6, 1
TIME_S, QUICK_TIME_S = 60.0, 20.0
PERCENTS = np.arange(5, 101)
COLOURS = {3: "#1b6ca8", 20: "#d98200", 100: "#a8321b"}  # by bytes of payload


def table(counts: dict[Setting, Count]) -> pd.DataFrame:
    """One row per setting: what robots, the equation and the simulator give."""
    measured, parameters = read_measurements(), read_parameters()
    rows = [
        {
            "payload": setting.payload_size,
            "neighbours": setting.neighbors,
            "p": setting.send_percent / 100.0,
            "robots": measured[setting],
            "equation": equation(setting, parameters),
            "runs": count.share,
            "error": count.standard_error(equation(setting, parameters)),
        }
        for setting, count in counts.items()
    ]
    return pd.DataFrame(rows).sort_values(["payload", "neighbours", "p"], ignore_index=True)


def draw(rows: pd.DataFrame) -> Figure:
    """Draw a panel per number of neighbours, and a map of simulated minus measured shares."""
    figure = Figure(figsize=(9.0, 6.4), layout="constrained")
    parameters = read_parameters()
    grid = figure.add_gridspec(2, 3, height_ratios=(3, 2))
    for column, neighbours in enumerate(sorted(rows["neighbours"].unique())):
        group = rows[rows["neighbours"] == neighbours]
        axes = figure.add_subplot(grid[0, column])
        for payload, colour in COLOURS.items():
            points = group[group["payload"] == payload]
            law = [equation(Setting(payload, int(neighbours), int(percent)), parameters) for percent in PERCENTS]
            axes.plot(PERCENTS / 100.0, law, color=colour, linewidth=1)
            axes.plot(points["p"], points["robots"], "x", color=colour)
            axes.plot(points["p"], points["runs"], "o", color=colour, markersize=4, label=f"{payload} bytes")
        axes.set(xlabel="chance to send, per tick", ylim=(-0.03, 1.05))
        axes.set_title(f"{neighbours} neighbour{'s' if neighbours != 1 else ''}", fontsize=10)
        if column == 0:
            axes.set_ylabel("share of messages received")
            axes.legend(
                fontsize=8, loc="lower left", title="dots: runs, lines: equation,\ncrosses: robots", title_fontsize=8
            )
    axes = figure.add_subplot(grid[1, :])
    difference = (rows["runs"] - rows["robots"]).to_numpy()
    settings = rows[["payload", "neighbours"]].drop_duplicates()
    labels = [f"{payload} bytes, {neighbours}" for payload, neighbours in settings.to_numpy()]
    chances = sorted(rows["p"].unique())
    cells = difference.reshape(len(labels), len(chances))
    image = axes.imshow(cells, cmap="RdBu_r", vmin=-0.4, vmax=0.4, aspect="auto")
    for (row, column), value in np.ndenumerate(cells):
        axes.text(column, row, f"{round(value, 2) + 0.0:+.2f}", ha="center", va="center", fontsize=7)
    axes.set_yticks(range(len(labels)), labels, fontsize=8)
    axes.set_xticks(range(len(chances)), [f"{chance:g}" for chance in chances])
    axes.set(xlabel="chance to send, per tick", ylabel="payload, neighbours", title="simulated minus measured")
    figure.colorbar(image, ax=axes)
    return figure


def measure(folder: Path, quick: bool) -> Outcome:  # noqa: ARG001
    """Run, compare, draw."""
    seeds, time_s = (QUICK_SEEDS, QUICK_TIME_S) if quick else (SEEDS, TIME_S)
    rows = table(simulate_all(read_measurements(), range(seeds), time_s))
    runs, expected, error = (rows[name].to_numpy(dtype=float) for name in ("runs", "equation", "error"))
    many = 10**6  # messages, not runs, are the samples: their variance is known
    on_equation = Comparison("runs against the equation", runs, expected, error, many, np.zeros(len(rows)))
    counted = f"{seeds} runs of {time_s:g} s for each of {len(rows)} settings"
    return Outcome(counted, draw(rows), (rows.round(9),), (on_equation,))
