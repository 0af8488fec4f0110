"""Colours for the values of a column: a colour map for numbers, one colour each for names and truth values.

Colour maps: viridis (Smith and van der Walt, 2015), without its darkest part, which is hardly seen on the floor; for
angles the circle of hues, whose ends meet. Colours of names: matplotlib's tab10 and tab20.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import matplotlib as mpl
import numpy as np
from matplotlib.colors import Colormap, ListedColormap

from pogosim.deferred import pandas as pd
from pogosim.errors import PictureError
from pogosim.nearest_name import nearest_name
from pogosim.picture.palette import NO_LED
from pogosim.picture.speed import SPEED
from pogosim.shapes import Floats
from pogosim.usable_numbers import usable

MAX_LABELS = 20  # in a legend
ANGLES = ("angle",)
SHADES = 256


@dataclass(frozen=True)
class Scale:
    """Colours of numbers from `low` to `high`."""

    name: str
    low: float
    high: float
    shades: Floats  # shape (256, 3), 0 to 1

    def colours(self, values: pd.Series[Any]) -> Floats:
        """Colours of n numbers. Shape (n, 3), 0 to 1; blue-grey where there is no number."""
        numbers = numbers_of(values)
        share = (numbers - self.low) / (self.high - self.low) if self.high > self.low else np.full(len(numbers), 0.5)
        known = np.isfinite(numbers)
        shade = np.clip(np.where(known, share, 0.0) * SHADES, 0, SHADES - 1).astype(int)
        return np.asarray(np.where(known[:, None], self.shades[shade], NO_LED))

    @property
    def colour_map(self) -> Colormap:
        """The colours as matplotlib's colour bars need them."""
        return ListedColormap([tuple(map(float, shade)) for shade in self.shades])


@dataclass(frozen=True)
class Legend:
    """One colour for each of the names that a column holds, in alphabetical order."""

    name: str
    labels: tuple[str, ...]
    swatches: Floats  # shape (labels, 3), 0 to 1

    def colours(self, values: pd.Series[Any]) -> Floats:
        """Colours of n names. Shape (n, 3), 0 to 1; blue-grey where there is none."""
        number = {label: i for i, label in enumerate(self.labels)}
        code = np.array([number.get(label, len(self.labels)) for label in labels_of(values)], dtype=int)
        return np.asarray(np.vstack([self.swatches.reshape(-1, 3), NO_LED])[code])


Colouring: TypeAlias = Scale | Legend


def holds_numbers(values: pd.Series[Any]) -> bool:
    """Tell whether a column holds real numbers, which truth values are not."""
    types = pd.api.types
    return bool(types.is_integer_dtype(values) or types.is_float_dtype(values))


def numbers_of(values: pd.Series[Any]) -> Floats:
    """Usable values of a column of numbers, NaN where there is none. Shape (n,)."""
    return usable(values)


def labels_of(values: pd.Series[Any]) -> list[str]:
    """Values of a column of names as text; "" where there is none."""
    present = values.notna().to_numpy()
    return [label_of(value) if there else "" for value, there in zip(values, present, strict=True)]


def label_of(value: object) -> str:
    """Return a value as legends show it."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    return str(value)


def is_internal(name: object) -> bool:
    """Tell whether a column is one that pictures add to those of the file."""
    return str(name).startswith("\0")


def checked_column(rows: pd.DataFrame, name: str) -> pd.Series[Any]:
    """Return a column whose values can be told apart.

    Raises:
        PictureError: There is none of this name, or several, or it holds lists, maps or the like.
    """
    found = [own for own in rows.columns if own == name and not is_internal(own)]
    if not found:
        there = [str(own) for own in rows.columns if not is_internal(own)]
        nearest = nearest_name(name, {*there, SPEED})
        known = f"did you mean '{nearest}'?" if nearest else f"it has {', '.join(there)}"
        raise PictureError(f"it has no column {name}; {known}")
    if len(found) > 1:
        raise PictureError(f"it has several columns {name}")
    values = rows[name]
    if not holds_numbers(values):
        kind = pd.api.types.infer_dtype(values, skipna=True)
        if kind in ("mixed", "complex", "bytes"):
            raise PictureError(f"its column {name} holds neither numbers nor names nor truth values")
    return values


def colouring_of(rows: pd.DataFrame, name: str) -> Colouring:
    """Return what colours mean if a column gives them; numbers span the colours from the least to the greatest."""
    values = checked_column(rows, name)
    if holds_numbers(values):
        return scale_of(name, numbers_of(values))
    labels = sorted(set(labels_of(values)) - {""})
    return Legend(name, tuple(labels), swatches_of(len(labels)))


def legend_of_categories(categories: pd.Series[Any]) -> Legend:
    """Return the colours of categories, for a file without LEDs: matplotlib's Set2, repeated after eight."""
    names = sorted(categories.unique())
    palette = np.asarray(mpl.colormaps["Set2"].colors)  # type: ignore[attr-defined]
    return Legend("robot_category", tuple(names), palette[np.arange(len(names)) % len(palette)])


def scale_of(name: str, numbers: Floats) -> Scale:
    """Return the colours of a column of numbers; those of an angle go once around."""
    if name in ANGLES:
        return Scale(name, -np.pi, np.pi, mpl.colormaps["hsv"](np.linspace(0.0, 1.0, SHADES))[:, :3])
    known = numbers[np.isfinite(numbers)]
    low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 0.0)
    return Scale(name, low, high, mpl.colormaps["viridis"](np.linspace(0.15, 1.0, SHADES))[:, :3])


def swatches_of(count: int) -> Floats:
    """Colours of names; those of more than 20 repeat. Shape (count, 3), 0 to 1."""
    palette = np.asarray(mpl.colormaps["tab10" if count <= 10 else "tab20"].colors)  # type: ignore[attr-defined]
    return palette[np.arange(count) % len(palette)]
