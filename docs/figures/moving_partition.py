"""A swarm that a partition divides, and what its halves have in common.

    .venv/bin/python docs/figures/all.py moving_partition

The scenes are those of conf/moving_partition.yaml, the curves means over runs with other seeds.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from pictures import ROOT, Picture, from_figure
from pogosim.picture.swarm import read_recording
from pogosim.swarm_picture import INK, PAPER, draw_scene
from pogosim.utils import load_dataframe

NAMES = ("moving_partition.png",)
MOMENTS_S = (59.0, 70.0, 295.0, 420.0)
RUNS = 12
SHUT_S = 120.0  # in all runs
REJOIN_S = 300.0
INVENTION_PERIOD_S = 300.0


def run(data: Path, *settings: str) -> None:
    """Run the example."""
    command = ["examples/moving_partition/moving_partition", "-c", "conf/moving_partition.yaml", "-g", "-q"]
    for setting in (f"data_filename={data}", "enable_console_logging=false", *settings):
        command += ["--set", setting]
    subprocess.run(command, cwd=ROOT, check=True, timeout=120)


def means(folder: Path) -> pd.DataFrame:
    """Shares of equal pairs, one row per time: means over runs."""
    measured = []
    for seed in range(RUNS):
        data = folder / "run.feather"
        run(data, f"seed={seed}")
        rows, _ = load_dataframe(data)
        robots = rows[rows["robot_category"] == "robots"]
        measured.append(robots.groupby("time")[["shut", "same_within", "same_across"]].first())
    assert all((one.loc[SHUT_S : REJOIN_S - 1, "shut"] == 1).all() for one in measured)
    table: pd.DataFrame = sum(measured[1:], measured[0]) / RUNS
    return table.iloc[1:]


def draw_curves(axes: Axes, table: pd.DataFrame) -> None:
    """Draw both shares against time, with the law of the second while the swarm is divided."""
    axes.axvspan(SHUT_S, REJOIN_S, color="0.92", label="divided in all runs")
    axes.plot(table.index, table["same_within"], color="tab:green", label="robots of one half")
    axes.plot(table.index, table["same_across"], color="tab:purple", label="robots of different halves")
    time_s = np.linspace(SHUT_S, REJOIN_S, 100)
    law = table["same_across"][SHUT_S] * np.exp(-2 * (time_s - SHUT_S) / INVENTION_PERIOD_S)
    axes.plot(time_s, law, color=INK, linestyle="--", label="exp(-2 t / invention_period)")
    axes.set(xlabel="time (s)", ylabel="share of pairs with the same word", ylim=(0, 1), xlim=(0, table.index.max()))
    axes.legend(fontsize=8)


def draw(folder: Path) -> dict[str, Picture]:
    """Run all, and draw four moments above the curves."""
    figure = Figure(figsize=(10, 5.6), facecolor=PAPER, layout="constrained")
    grid = figure.add_gridspec(2, 4)
    data = folder / "shown.feather"
    run(data)
    recording = read_recording(data)
    for column, time_s in enumerate(MOMENTS_S):
        axes = figure.add_subplot(grid[0, column])
        draw_scene(axes, recording.until(time_s), 3.0)
        axes.set_title(f"{time_s:.0f} s", color=INK, fontsize=10)
    table = means(folder)
    draw_curves(figure.add_subplot(grid[1, :]), table)
    return {"moving_partition.png": from_figure(figure, 90, recording.until().rows, table)}
