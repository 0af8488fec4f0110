"""What the stages of a step cost compared with each other, in one run: no absolute times, and wide limits.

These notice a stage that has become several times as slow as it was; bench/table.py measures.
"""

from __future__ import annotations

import json
import subprocess
from functools import cache

import pytest
from running import ROOT

STAGES = ("light", "robots", "messages", "physics", "record")


@cache
def measured(program: str, robots: int) -> dict[str, float]:
    """Return what the driver of an example program says of a swarm."""
    driver = ROOT / "build" / "release" / "bench" / f"bench_{program}"
    done = subprocess.run(
        [str(driver), "--json", "--runs", "2", str(robots)], capture_output=True, text=True, check=True, timeout=300
    )
    result: dict[str, float] = json.loads(done.stdout)
    return result


@pytest.mark.parametrize(
    ("program", "stage", "least", "most"),
    [
        ("run_and_tumble", "physics", 0.6, 0.97),
        ("run_and_tumble", "robots", 0.03, 0.35),
        ("run_and_tumble", "messages", 0.0, 0.02),
        ("hanabi", "robots", 0.35, 0.85),
        ("hanabi", "messages", 0.12, 0.6),
        ("hanabi", "physics", 0.0, 0.12),
    ],
)
def test_stage_takes_its_share_of_a_step(program: str, stage: str, least: float, most: float) -> None:
    result = measured(program, 1000)
    assert least <= result[f"share_of_{stage}"] <= most
    assert sum(result[f"share_of_{name}"] for name in STAGES) == pytest.approx(1.0, abs=0.1)
    assert result["share_of_light"] + result["share_of_record"] < 0.05


@pytest.mark.parametrize("program", ["run_and_tumble", "hanabi"])
def test_robot_costs_hardly_more_in_a_larger_swarm(program: str) -> None:
    cost = [measured(program, robots)["us_per_robot_and_step"] for robots in (1000, 10_000)]
    assert cost[1] < 4.0 * cost[0]  # what takes the square of the time makes it ten times
