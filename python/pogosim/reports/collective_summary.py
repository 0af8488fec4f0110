"""Summaries of `pogosim analyze collective`, as text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from pogosim.analysis.trajectories import Trajectories
from pogosim.lines import counted
from pogosim.reports.collective_metrics import METRICS
from pogosim.reports.collective_swarm import Settings
from pogosim.reports.groups import by_combination


def write_summaries(folder: Path, runs: Sequence[Trajectories], tables: Mapping[str, Sequence[pd.DataFrame]]) -> None:
    """Write what all runs have in common, and what the runs of each combination have."""
    numbers = [
        {
            (metric.key, name): value
            for metric in METRICS
            if not tables[metric.key][index].empty
            for name, value in metric.summary(tables[metric.key][index]).items()
        }
        for index in range(len(runs))
    ]
    write(folder / "SUMMARY_global.txt", [f"{'All ' * (len(runs) > 1)}{counted(len(runs), 'run')}", *lines(numbers)])
    per_arena: list[str] = []
    for name, members in by_combination(runs, numbers).items():
        per_arena += [f"{name}: {counted(len(members), 'run')}", *lines(members), ""]
    write(folder / "SUMMARY_per_arena.txt", per_arena[:-1])


def write_details(folder: Path, runs: Sequence[Trajectories], settings: Settings) -> None:
    """Write what the numbers mean."""
    write(folder / "SUMMARY_metric_details.txt", details(runs, settings))


def lines(numbers: Sequence[Mapping[tuple[str, str], float]]) -> list[str]:
    """Return a line for each number: mean over runs, standard deviation, and how many runs have it."""
    text = []
    for key, name in dict.fromkeys(entry for own in numbers for entry in own):
        values = np.array([own.get((key, name), np.nan) for own in numbers])
        values = values[np.isfinite(values)]
        if not len(values):
            text.append(f"  {key}: {name}: no value")
            continue
        spread = f" +- {values.std(ddof=1):.4g}" if len(values) > 1 else ""
        text.append(f"  {key}: {name} = {values.mean():.4g}{spread} ({counted(len(values), 'run')})")
    return text


def details(runs: Sequence[Trajectories], settings: Settings) -> list[str]:
    """Return what each metric is, and the settings it was computed with."""
    reach = ", ".join(f"{value:g}" for value in sorted({run.reach_mm for run in runs}))
    text = [
        "Values: mean over runs +- standard deviation over runs. Lengths in mm, times in s, y downwards.",
        f"Neighbours are at most {reach} mm apart. Directions: {settings.direction}.",
        f"v2_ref = {settings.v2_ref_mm2_s2 or float('nan'):g} mm2/s2; psi_k: k = {settings.psi_k}; "
        f"milling about {'the centre of mass' if settings.milling_centre == 'cm' else 'the centre of the arena'}; "
        f"C(r) of {'fluctuations' if settings.fluctuations else 'whole vectors'}.",
        "",
    ]
    return text + [f"{metric.key}: {metric.title}" for metric in METRICS]


def write(path: Path, text: Sequence[str]) -> None:
    """Write lines of text."""
    path.write_text("\n".join(text) + "\n", encoding="utf-8")
