"""Expressions of rewards and ends are those of the window's breakpoints."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pogosim
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pogosim.learning.expression import Expression
from running import write_scene

VALUES = {
    "x": np.array([[1.0, 2.0], [3.0, np.nan]], np.float32),
    "y": np.array([[0.0, -2.0], [0.5, 4.0]], np.float32),
    "a b": np.ones((2, 2), np.float32),
    "orange": np.zeros((2, 2), np.float32),
}


def numbers(text: str) -> Any:
    return Expression("reward", text, list(VALUES)).numbers(VALUES.__getitem__).tolist()


def test_operators_have_their_usual_precedence() -> None:
    nan = pytest.approx(np.nan, nan_ok=True)
    for text, expected in (
        ("1 + 2 * 3 - 4 / 2", 5.0),
        ("-(1 + 2) * -2", 6.0),
        ("2 - 3 - 4", -5.0),
        ("abs(1 - 3) + .5e1", 7.0),
        ("1 < 2 and 2 <= 2 and 3 >= 4 or not 1 != 1", 1.0),
        ("not 1 == 1 or 0", 0.0),
        ("not not 5", 1.0),
        ("y", [[0.0, -2.0], [0.5, 4.0]]),
        ("x * y", [[0.0, -4.0], [1.5, nan]]),
        ("x < 2.5 or y > 3", [[1.0, 1.0], [0.0, 1.0]]),
        ("x == x", [[1.0, 1.0], [1.0, 0.0]]),
        ("x != x", [[0.0, 0.0], [0.0, 0.0]]),
        ("not x", [[0.0, 0.0], [0.0, 1.0]]),
        ("a b + orange", [[1.0, 1.0], [1.0, 1.0]]),
        ("y / 0 > 1", [[0.0, 0.0], [1.0, 1.0]]),
    ):
        assert numbers(text) == expected, text


def test_names_are_those_that_are_used() -> None:
    assert Expression("end", "x > 1 and (y < x or orange)", list(VALUES)).names == ("x", "y", "orange")


VALUE = st.sampled_from(["x", "y", "1.5", "2", "-x", "abs(y)"]).map(lambda text: (text, text))
OPERATOR = st.sampled_from(["+", "-", "*", "<", ">="])


def joined(parts: tuple[tuple[str, str], str, tuple[str, str]]) -> tuple[str, str]:
    """Return an operation on two expressions, as ours and as one of Python, in which truth values are numbers, too."""
    (ours_a, theirs_a), sign, (ours_b, theirs_b) = parts
    return f"({ours_a} {sign} {ours_b})", f"(1.0 * ({theirs_a} {sign} {theirs_b}))"


TEXTS = st.recursive(VALUE, lambda inner: st.tuples(inner, OPERATOR, inner).map(joined), max_leaves=8)


@given(TEXTS)
@settings(max_examples=200, deadline=None)
def test_numbers_are_those_that_python_computes(texts: tuple[str, str]) -> None:
    names = {"abs": np.abs, **{name: VALUES[name].astype(np.float64) for name in "xy"}}
    expected = np.asarray(eval(texts[1], {"__builtins__": {}}, names), dtype=np.float64)
    assert np.allclose(numbers(texts[0]), expected, rtol=1e-4, atol=1e-4, equal_nan=True)


WRONG = [
    "x >",
    "x > 1 > 2",
    "(x",
    "x)",
    "nothing",
    "x y",
    "1..2",
    "and",
    "not",
    "abs(",
    "",
    "x" + "+1" * 500,
    "-" * 200 + "x",
]


@pytest.mark.parametrize("text", WRONG, ids=range(len(WRONG)))
def test_what_breakpoints_refuse_is_refused_at_the_same_character(text: str, tmp_path: Path) -> None:
    scene = {"objects.robots.brain": "host", "view.pause_when": text or " "}
    with pytest.raises(pogosim.ConfigurationError) as theirs:
        pogosim.Simulation(None, write_scene(tmp_path, scene))
    with pytest.raises(pogosim.ConfigurationError) as ours:
        Expression("end", text or " ", ["x", "y", "speed", "angle", "light"])
    if "at most 1000 characters" not in str(theirs.value):
        number = str(theirs.value).partition("character ")[2].partition(":")[0]
        assert f"character {number}:" in str(ours.value)
    else:
        assert "at most 1000 characters" in str(ours.value)
