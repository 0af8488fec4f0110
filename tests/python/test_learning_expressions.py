"""Expressions of rewards and ends: what they are for each robot, and where a text is wrong."""

from __future__ import annotations

import copy
import os
from typing import Any

import numpy as np
import pogosim
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pogosim.learning.expression import Expression

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
    assert Expression("end", "1", list(VALUES)).names == ()


def test_values_of_any_type_and_layout_are_read() -> None:
    values = np.arange(12).reshape(3, 4)
    for array in (values, values.T, values[:, ::2], values[::-1].astype(np.float64), values > 5):
        found = Expression("reward", "2 * x", ["x"]).numbers({"x": array}.__getitem__)
        assert np.array_equal(found, 2 * array.astype(np.float32))


def test_expressions_outlive_a_child_of_the_process() -> None:
    expression = Expression("reward", "2 * x", ["x"])
    child = os.fork()
    if not child:
        del expression
        os._exit(0)
    os.waitpid(child, 0)
    assert expression.numbers(lambda _name: np.ones(1)).tolist() == [2.0]


VALUE = st.sampled_from(["x", "y", "1.5", "2", "-x", "abs(y)"]).map(lambda text: (text, text))
# Our operators, and functions of NumPy.
OPERATORS = {
    "+": "add", "-": "subtract", "*": "multiply", "/": "divide", "<": "less", ">=": "greater_equal", "==": "equal",
    "and": "both", "or": "either",
}  # fmt: skip


def joined(parts: tuple[tuple[str, str], str, tuple[str, str]]) -> tuple[str, str]:
    """Return an operation on two expressions, as ours and as one of NumPy, in which truth values are numbers, too."""
    (ours_a, theirs_a), sign, (ours_b, theirs_b) = parts
    return f"({ours_a} {sign} {ours_b})", f"(1.0 * {OPERATORS[sign]}({theirs_a}, {theirs_b}))"


def is_true(value: Any) -> Any:
    return (value != 0) & ~np.isnan(value)


TEXTS = st.recursive(
    VALUE, lambda inner: st.tuples(inner, st.sampled_from(sorted(OPERATORS)), inner).map(joined), max_leaves=8
)


@given(TEXTS)
@settings(max_examples=300, deadline=None)
def test_numbers_are_those_that_numpy_computes(texts: tuple[str, str]) -> None:
    names = {
        **{name: getattr(np, name) for name in OPERATORS.values() if hasattr(np, name)},
        "both": lambda a, b: is_true(a) & is_true(b),
        "either": lambda a, b: is_true(a) | is_true(b),
        "abs": np.abs,
        **{name: VALUES[name] for name in "xy"},
    }
    text = texts[1].replace("1.5", "f(1.5)").replace("1.0", "f(1.0)").replace("2", "f(2)")
    with np.errstate(all="ignore"):
        expected = eval(text, {"__builtins__": {}}, names | {"f": np.float32})
    assert np.array_equal(numbers(texts[0]), np.asarray(expected, np.float32), equal_nan=True), texts[0]


WRONG = [
    ("x >", "'x >', character 4: expected a value or a number"),
    ("x > 1 > 2", "character 7: expected 'and', 'or', an operator or the end"),
    ("(x", "character 3: expected ')'"),
    ("x)", "character 2: expected 'and'"),
    ("nothing", "character 1: there is no value 'nothing': expected one of x, y"),
    ("orage", "did you mean 'orange'?"),
    ("1..2", "character 3: expected 'and'"),
    ("not", "character 4: expected a value or a number"),
    ("\u00e4", "character 1: expected a value or a number"),
    ("", "character 1: expected a value or a number"),
    ("x" + "+1" * 500, "character 1: an expression has at most 1000 characters, found 1001"),
    ("-" * 200 + "x", "there are too many brackets"),
]


@pytest.mark.parametrize(("text", "message"), WRONG, ids=range(len(WRONG)))
def test_wrong_text_is_told_with_its_argument_and_its_place(text: str, message: str) -> None:
    with pytest.raises(pogosim.ConfigurationError) as error:
        Expression("end", text, list(VALUES))
    assert str(error.value).startswith("end: ")
    assert message in str(error.value)


def test_a_hundred_brackets_and_long_sums_are_read_from_deep_below() -> None:
    def below(depth: int) -> list[float]:
        if depth:
            return below(depth - 1)
        return [numbers("(" * 99 + "1" + ")" * 99), numbers("1" + "+1" * 499)]

    assert below(700) == [1.0, 500.0]


def test_values_of_other_shapes_are_broadcast_as_by_numpy() -> None:
    values = {"x": np.arange(6.0).reshape(2, 3), "y": np.array([10.0, 20.0, 30.0])}
    expression = Expression("reward", "x + y", ("x", "y"))
    assert (expression.numbers(values.__getitem__) == values["x"] + values["y"]).all()
    with pytest.raises(ValueError, match="shape mismatch"):
        expression.numbers({"x": np.ones(2), "y": np.ones(3)}.__getitem__)


def test_expressions_are_not_copied() -> None:
    with pytest.raises(TypeError, match="cannot be copied"):
        copy.copy(Expression("reward", "1", ()))
