"""A figure of the numbers of two files over time: a panel for each, with bands over runs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from pogosim.comparison.batches import Distributions, Numbers, pairs_of
from pogosim.fonts import any_characters, literal, rendered, without_tex
from pogosim.outputs import partial_output
from pogosim.reports.figures import draw_bands, new_figure

MOST_PANELS = 24
MOST_COLUMNS = 4
MOST_POINTS = 400
COLOURS = ("#4477aa", "#ee6677")  # of the first and of the second file
DPI = 150.0


def panels_of(a: Numbers, b: Numbers) -> list[tuple[str, list[list[pd.Series[float]]]]]:
    """Return titles, and the curves of all runs of both files."""
    found = []
    for name, (key_a, key_b) in pairs_of(a, b)[0].items():
        for label in a.curves.get(key_a, {}):
            if label not in b.curves.get(key_b, {}):
                continue
            curves = [a.curves[key_a][label], b.curves[key_b][label]]
            longest = max(len(time_s) for own in curves for time_s, _ in own)
            stride = max(-(-longest // MOST_POINTS), 1)
            title = f"{label}\n{name}" if name else label
            found.append(
                (
                    title,
                    [[pd.Series(values[::stride], index=time_s[::stride]) for time_s, values in own] for own in curves],
                )
            )
    return found


@without_tex()
def draw(a: Numbers, b: Numbers, names: tuple[str, str], found: Distributions | None) -> Figure | None:
    """Draw the numbers that both files have; None if there is none. Panels tell the corrected p of mean and end."""
    panels = panels_of(a, b)[:MOST_PANELS]
    if not panels:
        return None
    columns = min(len(panels), MOST_COLUMNS)
    figure, axes = new_figure(columns, -(-len(panels) // columns), width=3.6, height=3.0)
    corrected = {} if found is None else {(own.combination, own.name): own.corrected for own in found.numbers}
    colours = dict(zip("ab", COLOURS, strict=True))
    for own, (title, curves) in zip(axes.flat, panels, strict=False):
        draw_bands(own, dict(zip("ab", curves, strict=True)), colours)
        label, _, combination = title.partition("\n")
        own.set_title(literal(title) + probabilities(corrected, combination, label), fontsize="medium")
        own.set_xlabel("time (s)")
    for own in axes.flat[len(panels) :]:
        own.set_axis_off()
    handles = axes.flat[0].get_lines()
    told = [literal(f"{letter}: {name}") for letter, name in zip("ab", names, strict=True)]
    figure.legend(handles, told, frameon=False, ncols=2, loc="outside lower center")
    return figure


def probabilities(corrected: Mapping[tuple[str, str], float], combination: str, label: str) -> str:
    """Return a line with what tests say of a quantity; nothing without a test."""
    name = label if (combination, f"{label}, mean") in corrected else label.rpartition(" (")[0]
    found = [corrected.get((combination, f"{name}, {when}"), np.nan) for when in ("mean", "final")]
    if not all(map(math.isfinite, found)):
        return ""
    return f"\np = {found[0]:.2g} (mean), {found[1]:.2g} (end)"


def write(figure: Figure, path: Path) -> None:
    """Write a figure in the format that the name says.

    Raises:
        OSError: It cannot be written.
    """
    with any_characters():
        content = rendered(figure, path.suffix[1:].lower(), DPI)
    with partial_output(path) as partial:
        partial.write_bytes(content)
