"""Quality-diversity searches on a robot that drives an arc and stops: which cells they fill of those that can be.

The robot of docs/tuning/dash.c drives with the powers L and R of its motors, 0 to 1, for the time t up to T = 5 s. With
the greatest speed V, and W twice the greatest angular speed of the configuration, its path is s = V (L + R) t / 2 long,
its heading changes by h = W (L - R) t, and its displacement is the chord d = s sin(h / 2) / (h / 2). At the same change
of heading, paths are shortest if one motor alone turns the robot, and longest if the other one runs at full power all
the time:

    V |h| / (2 W)  <=  s  <=  V (T - |h| / (2 W))

Everything between can be had, so cells are reachable or not; and the least time in which a robot gets to (d, h) is
t = s / V + |h| / (2 W). Both bounds of d and this time are monotonic in |h| up to 3, and t grows with d, so in each
cell, what is best is at its least |h|.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import yaml
from matplotlib.figure import Figure
from pictures import DOCS
from pogosim.optimize.settings import Settings
from validation.experiment import compile_program

from .searches import Claim, Found, Outcome, search

NAME = "archive"
SOURCES = DOCS / "tuning"
ETA = "optimization.qd.eta"
CELLS = 10
LONGEST_MM, LARGEST_RAD = 500.0, 3.0  # ranges of the features
SPEED_MM_S, TURN_RAD_S, LONGEST_S = 100.0, 0.6, 5.0  # V, W, T
ENOUGH, QUICK_ENOUGH = 0.6, 0.4
EVALUATIONS = 600
QUICK_EVALUATIONS = 160

Floats = npt.NDArray[np.float64]


def chord(path_mm: Floats, heading_rad: Floats) -> Floats:
    """Return the displacement of a robot after an arc."""
    return np.asarray(path_mm * np.sinc(heading_rad / (2.0 * np.pi)))


def bounds(heading_rad: Floats) -> tuple[Floats, Floats]:
    """Return the least and the greatest displacement in mm at which a robot can have a heading."""
    turning_mm = SPEED_MM_S * np.abs(heading_rad) / (2.0 * TURN_RAD_S)
    return chord(turning_mm, heading_rad), chord(SPEED_MM_S * LONGEST_S - turning_mm, heading_rad)


def least_times() -> Floats:
    """Return the least time in s to get to each cell, NaN if none can get there, of shape (CELLS, CELLS)."""
    edges = np.linspace(-LARGEST_RAD, LARGEST_RAD, CELLS + 1)
    heading = np.where(edges[:-1] * edges[1:] <= 0.0, 0.0, np.minimum(np.abs(edges[:-1]), np.abs(edges[1:])))
    low, high = bounds(heading)
    start, end = (np.linspace(0.0, LONGEST_MM, CELLS + 1)[i : i + CELLS, None] for i in (0, 1))
    nearest = np.maximum(start, low)
    time_s = nearest / chord(np.ones(CELLS), heading) / SPEED_MM_S + np.abs(heading) / (2.0 * TURN_RAD_S)
    return np.where((low < end) & (high > start), time_s, np.nan)


def arcs(count: int, seed: int) -> tuple[Floats, Floats, Floats]:
    """Return displacement in mm, change of heading in rad and time in s of random candidates, of shape (count,)."""
    left, right, share = np.random.default_rng(seed).random((3, count))
    time_s = LONGEST_S * share
    heading_rad = TURN_RAD_S * (left - right) * time_s
    return chord(SPEED_MM_S * (left + right) / 2.0 * time_s, heading_rad), heading_rad, time_s


def random_share(candidates: int, repeats: int = 100) -> float:
    """Return the mean share of the reachable cells that random candidates fill."""
    counted = []
    for seed in range(repeats):
        displacement_mm, heading_rad, _ = arcs(candidates, seed)
        ranges = [(0.0, LONGEST_MM), (-LARGEST_RAD, LARGEST_RAD)]
        counted.append(np.count_nonzero(np.histogram2d(displacement_mm, heading_rad, CELLS, ranges)[0]))
    return float(np.mean(counted) / np.isfinite(least_times()).sum())


def times_of(found: Found) -> Floats:
    """Return the time in s of the elite of each cell, NaN where there is none."""
    table = pd.read_csv(found.folder / "archive.csv")
    times = np.full((CELLS, CELLS), np.nan)
    times[table["cell_1"], table["cell_2"]] = -table["fitness"]
    return times


def draw(times: dict[str, Floats]) -> Figure:
    """Draw the archives beside what can be reached."""
    panels = {"the fastest there is": least_times(), **times}
    figure = Figure(figsize=(2.6 * len(panels) + 1.0, 3.0), layout="constrained")
    axes = figure.subplots(1, len(panels), sharey=True)
    heading = np.linspace(-LARGEST_RAD, LARGEST_RAD, 301)
    for panel, (name, values) in zip(axes, panels.items(), strict=True):
        extent = (-LARGEST_RAD, LARGEST_RAD, 0.0, LONGEST_MM)
        image = panel.imshow(values, origin="lower", extent=extent, aspect="auto", vmin=0.0, vmax=LONGEST_S)
        for bound in bounds(heading):
            panel.plot(heading, bound, color="0.2", linewidth=1)
        panel.set(xlabel="heading (rad)", title=name, ylim=(0.0, LONGEST_MM))
    axes[0].set_ylabel("displacement (mm)")
    figure.colorbar(image, ax=axes, label="time (s)")
    return figure


def searches() -> dict[str, tuple[str, dict[str, object]]]:
    """Return the searches by what the page calls them: the optimiser, and what differs from dash.yaml."""
    written = yaml.safe_load((SOURCES / "dash.yaml").read_text(encoding="utf-8"))["optimization"]["qd"]["eta"]
    usual = Settings.qd_eta
    return {
        f"MAP-Elites with eta {written:g}": ("mapelites", {}),
        f"MAP-Elites with eta {usual:g}": ("mapelites", {ETA: usual}),
        "CMA-ME": ("cma_me", {}),
        "CMA-MAE": ("cma_mae", {}),
    }


def measure(folder: Path, quick: bool) -> Outcome:
    """Do all searches, a short one only the first, and count cells."""
    folder.mkdir(parents=True, exist_ok=True)
    program = compile_program("dash", folder, SOURCES)
    least = least_times()
    reachable = np.isfinite(least)
    evaluations, enough = (QUICK_EVALUATIONS, QUICK_ENOUGH) if quick else (EVALUATIONS, ENOUGH)
    lines = [
        f"{reachable.sum()} of {reachable.size} cells can be reached; {evaluations} random candidates fill "
        f"{100 * random_share(evaluations):.0f} % of these"
    ]
    claims: list[Claim] = []
    others = 0
    times: dict[str, Floats] = {}
    for label, (name, changes) in list(searches().items())[: 1 if quick else None]:
        options = ["--optimizer", name, "--max-evals", str(evaluations)]
        times[label] = times_of(search(program, SOURCES / "dash.yaml", folder / str(len(times)), options, changes))
        filled = np.isfinite(times[label])
        share = (filled & reachable).sum() / reachable.sum()
        late_s = np.nanmean(times[label] - least)
        right, wrong = (filled & reachable).sum(), (filled & ~reachable).sum()
        lines.append(
            f"{label}, {evaluations} evaluations: {right} of them filled ({100 * share:.0f} %), {late_s:.2f} s slower "
            "than the fastest there is, on average"
        )
        others += int(wrong)
        if not claims:
            claims.append(Claim(f"{label} fills {100 * enough:.0f} % of what can be reached", bool(share >= enough)))
    claims.append(Claim("no other cells are filled", others == 0))
    tables = tuple(pd.DataFrame(values).rename(columns=str) for values in times.values())
    return Outcome(tuple(lines), tuple(claims), draw(times), tables)
