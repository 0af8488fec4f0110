"""The first picture of a film's page looks like those that the page draws."""

from __future__ import annotations

import re

import pytest
from pogosim.film.first_picture import is_bright
from running import ROOT


@pytest.fixture(scope="module")
def weights_and_limit() -> list[float]:
    """Weights of red, green and blue in colours.js, and the limit."""
    script = (ROOT / "python" / "pogosim" / "view" / "colours.js").read_text()
    (weights,) = re.findall(r"const luma = .* => ([\d.]+) \* red \+ ([\d.]+) \* green \+ ([\d.]+) \* blue;", script)
    (limit,) = re.findall(r"luma\(channelsOf\(colour\)\) > ([\d.]+)", script)
    return [*map(float, weights), float(limit)]


def test_colours_are_as_bright_as_in_the_script(weights_and_limit: list[float]) -> None:
    *weights, limit = weights_and_limit
    found = set()
    for red in range(0, 256, 5):
        for green in range(0, 256, 5):
            for blue in range(0, 256, 5):
                expected = sum(w * c for w, c in zip(weights, (red, green, blue), strict=True)) > limit
                assert is_bright(f"#{red:02x}{green:02x}{blue:02x}") == expected, (red, green, blue)
                found.add(expected)
    assert found == {True, False}
