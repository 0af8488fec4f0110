"""The example question: robots that wait for an answer get one from those who hear them."""

from __future__ import annotations

from pathlib import Path

from running import run_shipped


def test_robots_that_are_heard_get_answers_after_a_moment(tmp_path: Path) -> None:
    result = run_shipped("question", tmp_path)
    rows = result.frame()
    last = rows[rows.time == rows.time.max()].set_index("robot_id")
    even = last[last.index % 2 == 0]
    odd = last[last.index % 2 == 1]
    assert (even.asked > 20).all()
    assert not odd.asked.any()
    reach_mm = 120.0 + 2 * 26.5

    def hears_somebody(robot: object) -> bool:
        place = last.loc[robot]
        distance = ((odd.x - place.x) ** 2 + (odd.y - place.y) ** 2) ** 0.5
        return bool((distance < 0.7 * reach_mm).any())

    near = even[[hears_somebody(robot) for robot in even.index]]
    assert len(near) >= 5
    assert (near.answered > 0.4 * near.asked).all()
    # A robot that answers takes 80 ms, and looks at its clock every 20 ms; a message takes a step.
    assert near.waited_ms.between(80, 500).all()
    assert near.waited_ms.median() < 125
    lonely = even[even.answered == 0]
    assert (lonely.asked < near.asked.min()).all(), "they wait in vain for half a second"
