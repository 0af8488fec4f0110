"""Two models of the literature: Axelrod's cultures, and the flock of Toner and Tu.

    .venv/bin/python docs/figures/all.py models

Scenes of conf/axelrod.yaml and conf/toner_tu.yaml with some parameters changed, and the order of the flock against the
noise.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from pictures import ROOT, Picture, from_figure
from pogosim.picture.swarm import Swarm, read_recording
from pogosim.swarm_picture import INK, PAPER, draw_scene
from pogosim.utils import load_dataframe

NAMES = ("models.png",)
NB_TRAITS = (2, 8, 30)
MOMENTS_S = (3.0, 60.0)
NOISES = (10.0, 25.0, 40.0, 60.0, 80.0, 120.0, 200.0)
RUNS = 2  # for each noise
SETTLED_S = 60.0


def run(name: str, data: Path, *settings: str) -> None:
    """Run an example with its configuration."""
    command = [f"examples/{name}/{name}", "-c", f"conf/{name}.yaml", "-g", "-q"]
    for setting in (f"data_filename={data}", "enable_console_logging=false", *settings):
        command += ["--set", setting]
    subprocess.run(command, cwd=ROOT, check=True, timeout=120)


def show(axes: Axes, swarm: Swarm, tail_s: float, title: str) -> None:
    """Draw a scene."""
    draw_scene(axes, swarm, tail_s)
    axes.set_title(title, color=INK, fontsize=10)


def order_parameter(data: Path) -> float:
    """Mean of |sum of velocities| / sum of |velocities| once the flock has settled."""
    rows, _ = load_dataframe(data)
    rows = rows[rows["time"] >= SETTLED_S]
    velocity = pd.DataFrame({"time": rows["time"], "v": rows["velocity_x"] + 1j * rows["velocity_y"]})
    by_time = velocity.groupby("time")["v"]
    return float(np.mean([abs(v.sum()) / max(float(np.abs(v).sum()), 1e-9) for _, v in by_time]))


def orders(folder: Path) -> pd.DataFrame:
    """Order parameters, a row per noise and seed."""
    found = []
    for noise in NOISES:
        for seed in range(RUNS):
            data = folder / "run.feather"
            run("toner_tu", data, f"seed={seed}", f"parameters.noise={noise}")
            found.append({"noise": noise, "seed": seed, "order": round(order_parameter(data), 9)})
    return pd.DataFrame(found)


def draw_orders(axes: Axes, table: pd.DataFrame) -> None:
    """Draw the order parameter against the noise."""
    axes.plot(table["noise"], table["order"], "o", color="tab:purple", markersize=4, label=f"{RUNS} runs")
    mean = table.groupby("noise")["order"].mean()
    axes.plot(mean.index, mean, color="tab:purple", linewidth=1)
    independent = float(np.sqrt(np.pi / 4 / 100))
    axes.axhline(independent, color=INK, linestyle=":", linewidth=1, label="independent directions")
    axes.set(xlabel="noise (mm/s per $\\sqrt{s}$)", ylabel="order parameter", ylim=(0, 1.03))
    axes.set_title("toner_tu: the more noise, the less order", color=INK, fontsize=10)
    axes.legend(fontsize=8)


def draw(folder: Path) -> dict[str, Picture]:
    """Cultures above, the flock below."""
    figure = Figure(figsize=(11, 7.6), facecolor=PAPER, layout="constrained")
    grid = figure.subplots(2, 3)
    drawn = []
    for axes, nb_traits in zip(grid[0], NB_TRAITS, strict=True):
        data = folder / "axelrod.feather"
        run("axelrod", data, f"parameters.nb_traits={nb_traits}")
        swarm = read_recording(data).until()
        drawn.append(swarm.rows)
        cultures = len(
            swarm.rows[swarm.rows["time"] == swarm.end_s][["trait_0", "trait_1", "trait_2"]].drop_duplicates()
        )
        counted = "one culture" if cultures == 1 else f"{cultures} cultures"
        show(axes, swarm, 1.0, f"axelrod, {nb_traits} traits: {counted} after {swarm.end_s:.0f} s")
    data = folder / "toner_tu.feather"
    run("toner_tu", data)
    recording = read_recording(data)
    for axes, time_s in zip(grid[1], MOMENTS_S, strict=False):
        show(axes, recording.until(time_s), 3.0, f"toner_tu after {time_s:.0f} s")
    table = orders(folder)
    draw_orders(grid[1, 2], table)
    return {"models.png": from_figure(figure, 80, *drawn, recording.until().rows, table)}
