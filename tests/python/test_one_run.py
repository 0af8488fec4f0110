"""Whose columns a table has: those of the single run that wrote it, or of the tool that joined several."""

from __future__ import annotations

from typing import Any

import pandas as pd
import pytest
from pogosim.run_columns import is_one_run

ROWS = pd.DataFrame({"time": [0.0, 0.0, 1.0], "robot_category": "robots", "robot_id": [0, 1, 0]})
OURS: dict[str, Any] = {"program_version": "0.11.0", "configuration": {"seed": 1}}


def test_file_of_a_run_is_one_run() -> None:
    assert is_one_run(ROWS, OURS)


@pytest.mark.parametrize(
    "more",
    [
        {"files": ["a.feather", "b.feather"]},
        {"files": []},
        {"combinations": [{"seed": 1}]},
        {"configuration": {"result_new_columns": ["seed"]}},
    ],
)
def test_table_of_several_runs_is_not(more: dict[str, Any]) -> None:
    assert not is_one_run(ROWS, OURS | more)


def test_table_without_our_version_or_with_an_object_twice_at_a_time_is_not() -> None:
    assert not is_one_run(ROWS, {})
    assert not is_one_run(pd.concat([ROWS, ROWS[:1]]), OURS)
