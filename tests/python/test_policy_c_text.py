"""Numbers and arrays of C are what they were in NumPy, in lines that are not too long."""

from __future__ import annotations

import textwrap

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pogosim.policy.c_text import BYTES, WIDTH, Array, filled, literal


@pytest.mark.parametrize(
    ("value", "kind", "text"),
    [
        (1, "float", "1.0f"),
        (-0.5, "float", "-0.5f"),
        (0.1, "float", "0.100000001f"),
        (3e38, "float", "3.00000001e+38f"),
        (1e20, "float", "1.00000002e+20f"),
        (16777217, "float", "16777216.0f"),
        (-0.0, "float", "-0.0f"),
        (7.0, "int8_t", "7"),
        (np.int64(-32767), "int16_t", "-32767"),
    ],
)
def test_number_is_a_constant_of_its_type(value: float, kind: str, text: str) -> None:
    assert literal(value, kind) == text


@given(st.floats(width=32, allow_nan=False, allow_infinity=False))
def test_floats_are_read_as_the_same_bits(value: float) -> None:
    text = literal(value, "float")
    assert text.endswith("f")
    assert np.float32(text[:-1]).tobytes() == np.float32(value).tobytes()
    assert any(letter in text for letter in ".e")  # 1f is no constant of C


@given(st.lists(st.text("0123456789.,-f", min_size=1, max_size=20), min_size=1, max_size=60))
def test_words_fill_lines_as_textwrap_does(words: list[str]) -> None:
    expected = textwrap.wrap(" ".join(words), WIDTH, break_long_words=False, break_on_hyphens=False)
    assert filled(words) == expected


def test_array_has_its_size_comment_and_lines() -> None:
    made = Array("int16_t", "table", np.arange(1000, 1040), "Counts")
    assert made.size == 40 * BYTES["int16_t"]
    first, head, *rows, last = made.lines()
    assert (first, head, last) == ("// Counts", "static int16_t const table[40] = {", "};")
    assert len(rows) == 3
    assert max(map(len, rows)) <= 4 + WIDTH
    assert " ".join(row.strip() for row in rows) == " ".join(f"{number}," for number in range(1000, 1040))


@pytest.mark.parametrize(("columns", "row"), [(1, "    {1},"), (2, "    {1, 1},"), (3, "    {1, 1, 1},")])
def test_rows_of_arrays_have_their_braces(columns: int, row: str) -> None:
    made = Array("int8_t", "a", np.ones((2, columns))).lines()
    assert made == [f"static int8_t const a[2][{columns}] = {{", row, row, "};"]
