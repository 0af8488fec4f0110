"""The two columns of the article's table of programs, as examples: heartbeat and heartbeat_sdk do the same."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from running import example, run_shipped

SEEDS = range(4)
SECONDS = 20


def final_rows(name: str, folder: Path, seed: int) -> pd.DataFrame:
    settings = {"seed": seed, "simulation_time": SECONDS}
    frame = run_shipped(name, folder / f"{name}_{seed}", settings, "heartbeat").frame()
    last: pd.DataFrame = frame[frame.time == frame.time.max()]
    return last


def test_program_for_robots_has_the_statistics_of_the_one_for_the_main_loop(tmp_path: Path) -> None:
    rates: dict[str, list[float]] = {"heartbeat": [], "heartbeat_sdk": []}
    for name, heard_per_message in rates.items():
        for seed in SEEDS:
            last = final_rows(name, tmp_path, seed)
            # 62.5 turns per second, of which every second one sends.
            sent = last.sent / (62.5 * SECONDS)
            assert sent.mean() == pytest.approx(0.5, abs=4 * np.sqrt(0.25 / (62.5 * SECONDS * len(last))) + 0.001)
            heard_per_message.append(float(last.heard.sum() / last.sent.sum()))
    # The same positions and the same random numbers; the law of reception takes the measured rate of sending for one,
    # the percentage for the other.
    assert rates["heartbeat_sdk"] == pytest.approx(rates["heartbeat"], rel=0.02)
    assert len(set(rates["heartbeat"])) == len(SEEDS)


def test_program_for_robots_needs_no_main_loop() -> None:
    source = (example("heartbeat_sdk").parent / "main.c").read_text()
    assert "pogobase.h" not in source
    assert "USERDATA" not in source
