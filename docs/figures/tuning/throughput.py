"""What share of the time of a search simulators run: the rest is Python's, and waiting at the end of generations."""

from __future__ import annotations

import os
from pathlib import Path

from pictures import ROOT

from .searches import Claim, Outcome, example, search

NAME = "throughput"
EVALUATIONS = 1000
QUICK_EVALUATIONS = 20
WORKERS = 2
ENOUGH = 0.9


def measure(folder: Path, quick: bool) -> Outcome:
    """Search for long, and add up."""
    options = ["--max-evals", str(QUICK_EVALUATIONS if quick else EVALUATIONS), "--final-runs", "0"]
    options += ["--workers", str(WORKERS)]
    path = ROOT / "conf" / "optim" / "phototaxis.yaml"
    summary = search(example("phototaxis"), path, folder / "search", options).summary
    wall_clock_s, simulator_s = summary["wall_clock_s"], summary["simulator_s"]
    share = simulator_s / (WORKERS * wall_clock_s)
    lines = (
        f"{summary['evaluations']} evaluations of {summary['runs']} runs, {WORKERS} workers: {wall_clock_s:.0f} s, "
        f"{100 * share:.0f} % of it in simulators; load {os.getloadavg()[1]:.1f}, {os.cpu_count()} processors",
    )
    claim = Claim(f"over {100 * ENOUGH:.0f} % of the time in simulators", share > ENOUGH)
    return Outcome(lines, () if quick else (claim,))
