"""Vicsek's transition: order against noise, beside a plain implementation of the model.

Vicsek, Czirok, Ben-Jacob, Cohen and Shochet, Physical Review Letters 75, 1226 (1995), figure 2a: at a density of 4 per
square of the range, the order parameter |mean of exp(i theta)| falls from 1 to that of N independent directions, about
sqrt(pi / (4 N)) (Rayleigh's random walk), the lower the more robots there are. Where nearly all agree, only the noise
of the last step is left: sin(eta / 2) / (eta / 2).
"""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.spatial import cKDTree

from .agreement import Comparison, Values, absolute, two_samples
from .experiment import Outcome, batch, compile_program

NAME = "vicsek"
DENSITY = 4.0  # per square of the range
SPEED = 0.03  # ranges per step
STEPS, STEPS_PER_RECORD, STEPS_LEFT_OUT = 1000, 10, 400
STEP_S = 0.2
ETAS = (0.1, 1.0, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 6.2831853)
FEW_ETAS = (0.1, 2.0, 3.0, 4.0, 6.2831853)
SIZES = {40: (8, ETAS), 100: (8, ETAS), 400: (6, FEW_ETAS)}  # runs, noises
LINE_ETAS, LINE_RUNS = tuple(np.linspace(0.1, 2.0 * np.pi, 22).tolist()), 4  # of the model alone, for its line
QUICK_SIZES = {40: (4, FEW_ETAS)}
COLOURS = {40: "#1b6ca8", 100: "#d98200", 400: "#a8321b"}
MARGIN = 0.01  # robots are 2 % as wide as their range, and push each other


def model_order(robots: int, eta: float, seed: int) -> float:
    """Run the model of the paper with points; return the mean order parameter over the recorded steps."""
    random = np.random.default_rng([robots, int(1000 * eta), seed])
    side = np.sqrt(robots / DENSITY)
    position = random.uniform(0.0, side, (robots, 2))
    heading = random.uniform(-np.pi, np.pi, robots)
    order = []
    for step in range(STEPS + 1):
        direction = np.exp(1j * heading)
        if step % STEPS_PER_RECORD == 0 and step >= STEPS_LEFT_OUT:
            order.append(abs(direction.mean()))
        first, second = cKDTree(position, boxsize=side).query_pairs(1.0, output_type="ndarray").T
        total = direction.copy()
        np.add.at(total, first, direction[second])
        np.add.at(total, second, direction[first])
        position = np.mod(position + SPEED * np.column_stack((direction.real, direction.imag)), side)
        position[position >= side] = 0.0  # by rounding
        heading = np.angle(total) + random.uniform(-eta / 2.0, eta / 2.0, robots)
    return float(np.mean(order))


def model_orders(robots: int, etas: tuple[float, ...], runs: int) -> Values:
    """Run the model of the paper on all processors. Shape (runs, noises)."""
    tasks = list(product([robots], etas, range(runs)))
    with ProcessPoolExecutor() as pool:
        orders = list(pool.map(model_order, *zip(*tasks, strict=True)))
    return np.array(orders).reshape(len(etas), runs).T


def robot_orders(folder: Path, robots: int, etas: tuple[float, ...], runs: int) -> Values:
    """Run robots. Returns each run's mean order parameter. Shape (runs, noises)."""
    changes = {
        "objects.robots.nb": robots,
        "arena_surface": robots / DENSITY * 1e4,
        "simulation_time": STEPS * STEP_S,
        "parameters.noise_eta": {"batch_options": list(etas)},
    }
    rows = batch(compile_program(NAME, folder), NAME, runs, changes)[NAME]
    late = rows["time"] >= STEPS_LEFT_OUT * STEP_S - 1e-6
    angle = rows["angle"].astype(float)
    directions = rows[late].assign(x=np.cos(angle), y=np.sin(angle))
    means = directions.groupby(["parameters.noise_eta", "run", "time"])[["x", "y"]].mean()
    order = means.assign(r=np.hypot(means["x"], means["y"])).groupby(level=[0, 1])["r"].mean()
    return np.asarray(order.unstack(0)[list(etas)].to_numpy())


def independent_order(robots: int) -> float:
    """Return the mean order parameter of independent directions: sqrt(pi / (4 N)), up to a relative error of 1 / N."""
    return float(np.sqrt(np.pi / (4.0 * robots)))


def measure(folder: Path, quick: bool) -> Outcome:
    """Run, compare, draw."""
    figure = Figure(figsize=(6.5, 4.2), layout="constrained")
    axes = figure.subplots()
    comparisons: list[Comparison] = []
    tables = []
    sizes = QUICK_SIZES if quick else SIZES
    counted = ", ".join(f"{runs} runs of {robots} robots" for robots, (runs, _) in sizes.items())
    for robots, (runs, etas) in sizes.items():
        ours, theirs = robot_orders(folder, robots, etas, runs), model_orders(robots, etas, runs)
        against_model = two_samples(f"{robots} robots, against the model", ours, theirs, MARGIN)
        noise_only = absolute(
            f"{robots} robots at 2 pi, against independent directions",
            ours[:, -1:],
            [independent_order(robots)],
            MARGIN,
        )
        comparisons += [against_model, noise_only]
        colour = COLOURS[robots]
        line = etas if quick else LINE_ETAS
        model = against_model.expected if quick else model_orders(robots, line, LINE_RUNS).mean(axis=0)
        axes.plot(line, model, color=colour, linewidth=1, label=f"model, N = {robots}")
        axes.errorbar(
            etas,
            against_model.measured,
            against_model.standard_error,
            fmt="o",
            color=colour,
            markersize=4,
            label=f"robots, N = {robots}",
        )
        table = {"eta": np.array(etas), "robots": against_model.measured, "model": against_model.expected}
        tables.append(pd.DataFrame(table).round(9))
    eta = np.linspace(1e-3, 2.0 * np.pi, 200)
    axes.plot(eta, np.sin(eta / 2.0) / (eta / 2.0), color="0.6", linestyle=":", label="noise of one step alone")
    axes.set(xlabel=r"noise $\eta$ (rad)", ylabel="order parameter", ylim=(0.0, 1.03))
    axes.legend(fontsize=8)
    return Outcome(f"for each noise, {counted}, {STEPS} steps", figure, tuple(tables), tuple(comparisons))
