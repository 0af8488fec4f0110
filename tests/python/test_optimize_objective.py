"""The user's objective and feature functions: what they return, what they raise, and where they are."""

from __future__ import annotations

import math
from pathlib import Path

import pandas as pd
import pytest
from pogosim.errors import OptimizeError
from pogosim.optimize.objective import Objective, load_objective
from pogosim.pogoptim import fd_fn, objective_fn

# As the article prints it, without imports.
LISTING = '''
def objective_fn(df: pd.DataFrame) -> float:
    """Return the mean of per-agent MSD across *all* runs and arenas."""
    msd_df = compute_msd_per_agent(df)
    if msd_df.empty:
        logger.warning("Default MSD objective: empty input produced no MSD values; returning -inf")
        return float('-inf')
    return float(msd_df['MSD'].mean())

def fd_fn(df: pd.DataFrame) -> np.ndarray:
    """Return default 2-D features for QD: (max MSD, stddev MSD)."""
    msd_df = compute_msd_per_agent(df)
    if msd_df.empty:
        return np.array([0.0, 0.0], dtype=float)
    vals = np.asarray(msd_df["MSD"], dtype=float)
    return np.array([float(np.max(vals)), float(np.std(vals, ddof=0))], dtype=float)
'''
NO_FEATURES = "the objective returned no features; write fd_fn(df), or return (fitness, features)"
ROWS = pd.DataFrame({"time": [0.0, 1.0], "x": [1.0, 3.0]})


def written(folder: Path, lines: str) -> str:
    """Write obj.py; returns its path."""
    path = folder / "obj.py"
    path.write_text(lines)
    return str(path)


def judged(folder: Path, lines: str, with_features: bool = False) -> tuple[float | None, dict[str, float], str]:
    """Return what functions in a file say of ROWS."""
    said = load_objective(written(folder, lines), None, None).judge(ROWS, with_features)
    return said.fitness, dict(said.features), said.problem.replace(str(folder), "")


def moved(*steps: float) -> pd.DataFrame:
    """Return the rows of robots that go straight, each with its own speed in mm/s, at 0, 1 and 2 s."""
    rows = [
        {"time": t, "robot_category": "robots", "robot_id": i, "x": step * t, "y": 0.0, "angle": 0.0, "run": 0}
        for t in (0.0, 1.0, 2.0)
        for i, step in enumerate(steps)
    ]
    return pd.DataFrame(rows)


def test_default_objective_is_the_mean_over_robots_of_their_mean_squared_displacement() -> None:
    # (1 + 4) / 2 v^2 for each robot.
    assert objective_fn(moved(10.0, 20.0)) == pytest.approx((250.0 + 1000.0) / 2)
    assert list(fd_fn(moved(10.0, 20.0)).values()) == pytest.approx([1000.0, 375.0])
    assert objective_fn(moved(10.0)[:0]) == -math.inf
    assert list(fd_fn(moved(10.0)[:0]).values()) == [0.0, 0.0]


def test_listing_of_the_article_is_an_objective_as_it_stands(tmp_path: Path) -> None:
    said = load_objective(written(tmp_path, LISTING), None, None).judge(moved(10.0, 20.0), with_features=True)
    assert said.fitness == pytest.approx(625.0)
    assert list(said.features.values()) == pytest.approx([1000.0, 375.0])


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        ("def objective_fn(df): return df['x'].mean()", (2.0, {}, "")),
        ("def compute_objective(df): return 3", (3.0, {}, "")),
        ("def objective_fn(df): return 1\ndef compute_objective(df): return 2", (1.0, {}, "")),
        ("def objective_fn(df): return 1.0, [5.0, 6.0]", (1.0, {}, "")),
        ("def objective_fn(df): return True", (1.0, {}, "")),
        ("import numpy as np\ndef objective_fn(df): return np.array(4.0)", (4.0, {}, "")),
        ("def objective_fn(df): return None", (None, {}, "the objective returned NoneType, not a number")),
        ("def objective_fn(df): return '1'", (None, {}, "the objective returned str, not a number")),
        ("def objective_fn(df): return [1, 2]", (None, {}, "the objective returned list, not a number")),
        ("def objective_fn(df): return float('nan')", (None, {}, "the objective returned nan")),
        ("def objective_fn(df): return float('-inf')", (None, {}, "the objective returned -inf")),
        ("\ndef objective_fn(df): return df['y']", (None, {}, "the objective raised KeyError: 'y' (/obj.py:2)")),
        (
            "def helper(df):\n    return 1 / 0\ndef objective_fn(df):\n    return helper(df)",
            (None, {}, "the objective raised ZeroDivisionError: division by zero (/obj.py:2)"),
        ),
        ("def objective_fn(df): raise ValueError", (None, {}, "the objective raised ValueError (/obj.py:1)")),
        ("import sys\ndef objective_fn(df): sys.exit(1)", (None, {}, "the objective raised SystemExit: 1 (/obj.py:2)")),
    ],
)
def test_objective_is_a_number_or_a_problem(
    lines: str, expected: tuple[float | None, dict[str, float], str], tmp_path: Path
) -> None:
    assert judged(tmp_path, lines) == expected


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        ("def objective_fn(df): return 1.0, [5.0, 6]", (1.0, {"feature 1": 5.0, "feature 2": 6.0}, "")),
        ("def objective_fn(df): return 1.0, {'a': 5.0}", (1.0, {"a": 5.0}, "")),
        (
            "def objective_fn(df): return 1.0\ndef fd_fn(df): return (1, 2)",
            (1.0, {"feature 1": 1.0, "feature 2": 2.0}, ""),
        ),
        ("def objective_fn(df): return 1.0\ndef fd_fn(df): return 0.5", (1.0, {"feature 1": 0.5}, "")),
        ("def objective_fn(df): return 1.0, [9]\ndef fd_fn(df): return {'own': 2}", (1.0, {"own": 2.0}, "")),
        (
            "def objective_fn(df): return 1.0",
            (None, {}, NO_FEATURES),
        ),
        (
            "def objective_fn(df): return 1.0\ndef fd_fn(df): return []",
            (None, {}, "the feature function returned no features"),
        ),
        (
            "def objective_fn(df): return 1.0\ndef fd_fn(df): return [1, float('nan')]",
            (None, {}, "the feature function returned nan for feature 2"),
        ),
        (
            "def objective_fn(df): return 1.0\ndef fd_fn(df): return 'ab'",
            (None, {}, "the feature function returned str, not a list of numbers"),
        ),
        (
            "def objective_fn(df): return 1.0\ndef fd_fn(df): return df['z']",
            (None, {}, "the feature function raised KeyError: 'z' (/obj.py:2)"),
        ),
    ],
)
def test_features_are_named_numbers_or_a_problem(
    lines: str, expected: tuple[float | None, dict[str, float], str], tmp_path: Path
) -> None:
    assert judged(tmp_path, lines, with_features=True) == expected


def test_modules_beside_the_file_can_be_imported(tmp_path: Path) -> None:
    (tmp_path / "beside_the_objective.py").write_text("VALUE = 7")
    lines = "from beside_the_objective import VALUE\ndef objective_fn(df): return VALUE"
    assert judged(tmp_path, lines) == (7.0, {}, "")


def test_functions_of_other_names_are_found_by_option(tmp_path: Path) -> None:
    path = written(tmp_path, "def mine(df): return 4\ndef also(df): return [1]\ndef objective_fn(df): return 0")
    said = load_objective(path, "mine", "also").judge(ROWS, with_features=True)
    assert (said.fitness, said.features) == (4.0, {"feature 1": 1.0})


@pytest.mark.parametrize(
    ("lines", "names", "message"),
    [
        (None, (None, None), "does not exist; expected a Python file with a function objective_fn(df)"),
        ("x = 1", (None, None), "has no function objective_fn or compute_objective; write 'def objective_fn(df): ...'"),
        ("objective_fn = 5", (None, None), "has no function objective_fn or compute_objective"),
        ("def objective_fn(df): return 1", ("mine", None), "has no function mine; write 'def mine(df): ...'"),
        ("def objective_fn(df): return 1", (None, "mine"), "has no function mine"),
        ("def f(:", (None, None), "obj.py:1: invalid syntax"),
        ("import no_such_module", (None, None), "cannot be imported: it raised ModuleNotFoundError: No module named"),
        ("\n1 / 0", (None, None), "cannot be imported: it raised ZeroDivisionError: division by zero ("),
    ],
)
def test_file_that_is_no_objective_is_one_line(
    lines: str | None, names: tuple[str | None, str | None], message: str, tmp_path: Path
) -> None:
    path = written(tmp_path, lines) if lines is not None else str(tmp_path / "none.py")
    with pytest.raises(OptimizeError) as error:
        load_objective(path, *names)
    assert message in str(error.value)
    assert "\n" not in str(error.value)
    assert str(error.value).startswith("--")


def test_digest_of_the_objective_changes_with_its_file(tmp_path: Path) -> None:
    first = load_objective(written(tmp_path, "def objective_fn(df): return 1"), None, None).digests
    second = load_objective(written(tmp_path, "def objective_fn(df): return 2"), None, None).digests
    assert first != second != Objective().digests
