"""Where robots gather below a lamp: the density of those that slow down in light, and of those that tumble more often.

Run-and-tumble walkers that tumble into any direction have, whatever their tumble rate, the stationary density

    rho(x) v(x) = const

if their speed v depends on where they are (orthokinesis): they gather where they are slow. If instead their tumble
rate depends on where they are at the same speed everywhere (klinokinesis), the density is uniform: they diffuse more
slowly there, but do not gather (Schnitzer, Physical Review E 48, 2553, 1993).

Robots turn a tick after they have measured the light, when they are elsewhere. With such a delay tau, the rate lambda
of a walker in the direction u is lambda(x) - tau v u grad lambda, which drives it towards light, and the density is not
uniform but proportional to exp(lambda tau), to first order in lambda tau (after de Gennes, European Biophysics Journal
33, 691, 2004): 2 % here.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
from matplotlib.figure import Figure

from .agreement import Comparison, Values, relative
from .experiment import Outcome, batch, compile_program

NAME, PROGRAM = "lamp", "persistent_walk"
RUNS, QUICK_RUNS = 16, 5
SIDE_MM, LAMP_RADIUS_MM = 2000.0, 900.0
SLOW_IN_LIGHT = 0.8
TUMBLE_RATE_S, TUMBLE_IN_LIGHT = 0.5, 2.0
TICK_S = 0.02
ROBOTS, TIME_S = 30, 500.0
START_S = 100.0  # until then, robots spread from where they were put
EDGES_MM = np.array([0.0, 150.0, 300.0, 450.0, 600.0, 750.0, 900.0, np.inf])
LABELS = {"orthokinesis": "slower in light", "klinokinesis": "more tumbles in light"}
COLOURS = {"orthokinesis": "#1b6ca8", "klinokinesis": "#d98200"}
MARGIN = 0.01  # relative: motors have whole steps of power, the light map has cells


def light(radius_mm: npt.ArrayLike) -> Values:
    """Light of the lamp, 0 to 1."""
    return np.asarray(np.clip(1.0 - np.asarray(radius_mm, dtype=float) / LAMP_RADIUS_MM, 0.0, 1.0))


def speed(radius_mm: npt.ArrayLike) -> Values:
    """Speed of robots that slow down, in units of that in the dark."""
    return np.asarray(1.0 - SLOW_IN_LIGHT * light(radius_mm))


def density(kind: str, radius_mm: npt.ArrayLike) -> Values:
    """What theory says of robots that slow down or tumble; up to a factor."""
    if kind == "orthokinesis":
        return np.asarray(1.0 / speed(radius_mm))
    return np.exp(TICK_S * TUMBLE_RATE_S * (1.0 + TUMBLE_IN_LIGHT * light(radius_mm)))


def grid_radius_mm() -> Values:
    """Distances from the lamp, of points on a grid over the arena. Shape (points,)."""
    centres = (np.arange(1000) + 0.5) / 1000.0 * SIDE_MM - SIDE_MM / 2.0
    return np.asarray(np.hypot(*np.meshgrid(centres, centres)).ravel())


def shares(radius_mm: Values, weight: Values | None = None) -> Values:
    """Share of all points in each ring around the lamp, and outside of the last."""
    counts, _ = np.histogram(radius_mm, EDGES_MM, weights=weight)
    return np.asarray(counts / counts.sum())


def shares_by_robot(rows: pd.DataFrame) -> Values:
    """Share of its time that each robot of each run spends in each ring. Shape (robots, rings)."""
    late = rows[rows["time"] >= START_S]
    radius = late.assign(radius=np.hypot(late["x"] - SIDE_MM / 2.0, late["y"] - SIDE_MM / 2.0))
    robots = radius.groupby(["run", "robot_id"])["radius"]
    return np.array([shares(np.asarray(values.to_numpy())) for _, values in robots])


def draw(frames: dict[str, pd.DataFrame], results: dict[str, Comparison], expected: dict[str, Values]) -> Figure:
    """Draw where robots were, and densities against the distance from the lamp."""
    figure = Figure(figsize=(9.0, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    late = frames["orthokinesis"][frames["orthokinesis"]["time"] >= START_S]
    left.hist2d(late["x"], late["y"], bins=50, range=[[0.0, SIDE_MM], [0.0, SIDE_MM]], cmap="inferno")
    left.set(aspect="equal", title="where robots were: slower in light", xlabel="x (mm)", ylabel="y (mm)")
    left.invert_yaxis()

    radius, cells = np.linspace(0.0, 1100.0, 400), grid_radius_mm()
    middle = np.append((EDGES_MM[:-2] + EDGES_MM[1:-1]) / 2.0, 1000.0)
    for kind, result in results.items():
        ring_density = expected[kind] / shares(cells)
        right.plot(radius, density(kind, radius) / density(kind, cells).mean(), color=COLOURS[kind], linewidth=1)
        right.errorbar(
            middle,
            ring_density * result.measured,
            ring_density * result.standard_error,
            fmt="o",
            color=COLOURS[kind],
            markersize=4,
            label=LABELS[kind],
        )
    right.set(xlabel="distance from the lamp (mm)", ylabel="density / mean density", ylim=(0.0, None))
    right.legend(fontsize=8)
    return figure


def measure(folder: Path, quick: bool) -> Outcome:
    """Run, compare, draw."""
    runs = QUICK_RUNS if quick else RUNS
    frames = batch(compile_program(PROGRAM, folder), NAME, runs)
    cells = grid_radius_mm()
    expected = {kind: shares(cells, density(kind, cells)) for kind in LABELS}
    results = {
        kind: relative(f"{LABELS[kind]}, density / theory", shares_by_robot(frames[kind]), theory, MARGIN)
        for kind, theory in expected.items()
    }
    tables = [pd.DataFrame({"radius": EDGES_MM[:-1], "ratio": result.measured}).round(9) for result in results.values()]
    counted = f"{runs} runs of {ROBOTS} robots for each behaviour, {TIME_S:g} s"
    return Outcome(counted, draw(frames, results, expected), tuple(tables), tuple(results.values()))
