"""Parts of C: numbers, arrays and how many bytes they take."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

WIDTH = 116  # of the lines of an array, without their indentation
BYTES = {"int8_t": 1, "uint8_t": 1, "int16_t": 2, "int32_t": 4, "float": 4}


def filled(words: Sequence[str]) -> list[str]:
    """Return words in lines of up to WIDTH characters, as textwrap does, which takes minutes for a megabyte."""
    made: list[str] = []
    line = ""
    for word in words:
        if line and len(line) + 1 + len(word) > WIDTH:
            made.append(line)
            line = ""
        line = f"{line} {word}" if line else word
    return [*made, line]


def literal(value: Any, kind: str) -> str:
    """Return a number as C of this type writes it."""
    if kind != "float":
        return str(int(value))
    text = f"{float(np.float32(value)):.9g}"
    return f"{text}f" if any(letter in text for letter in ".e") else f"{text}.0f"


@dataclass(frozen=True)
class Array:
    """A constant array.

    Attributes:
        kind: Type of its elements.
        name: Its name.
        values: One or two dimensions; at least one element.
        comment: What stands above it; empty: nothing.
    """

    kind: str
    name: str
    values: npt.NDArray[Any]
    comment: str = ""

    @property
    def size(self) -> int:
        """Bytes that it takes."""
        return int(self.values.size * BYTES[self.kind])

    def lines(self) -> list[str]:
        """Return its definition."""
        dimensions = "".join(f"[{size}]" for size in self.values.shape)
        made = [f"// {self.comment}"] if self.comment else []
        made.append(f"static {self.kind} const {self.name}{dimensions} = {{")
        for row in self.values.reshape(-1, self.values.shape[-1]):
            numbers = [f"{literal(value, self.kind)}," for value in row]
            if self.values.ndim == 2:
                numbers[0] = f"{{{numbers[0]}"
                numbers[-1] = f"{numbers[-1][:-1]}}},"  # of one column, that is the same word
            made += [f"    {line}" for line in filled(numbers)]
        return [*made, "};"]
