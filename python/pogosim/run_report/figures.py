"""The figures of a report: each quantity over time, with bands; as SVG that is readable on light and on dark pages."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from pogosim.analysis.quantities import Quantity
from pogosim.analysis.trajectories import Trajectories
from pogosim.fonts import any_characters
from pogosim.picture.palette import INK
from pogosim.reports.figures import draw_bands, drawn_by_combination, name_curves
from pogosim.reports.groups import by_combination

WIDTH = 4.6  # inches
MOST_POINTS = 400  # of a curve
# Paul Tol's bright colours, which are seen on white and on black, and are told apart by the colour-blind.
COLOURS = ("#4477aa", "#ee6677", "#228833", "#aa3377", "#ccbb44", "#66ccee")

# Ink in a dark page. In the SVG, it replaces the colour of the letters, which stands nowhere else.
STYLE = (
    "<style>:root{{--ink:{ink}}}@media (prefers-color-scheme:dark){{:root{{--ink:#dfe3ea}}}}"
    "@media print{{:root{{--ink:{ink}}}}}</style>"
)
INKED: Any = dict.fromkeys(
    ("text.color", "axes.labelcolor", "axes.edgecolor", "axes.titlecolor", "xtick.color", "ytick.color"), INK
)


@dataclass(frozen=True)
class Shown:
    """A figure and what it shows."""

    title: str
    svg: bytes
    alt: str  # in words, for those who cannot see it


def figure_of(runs: Sequence[Trajectories], quantities: Sequence[Quantity]) -> Shown:
    """Draw a quantity of some runs: with a curve for each combination, and bands.

    Bands are the confidence intervals (95 %) of means over runs; of a single run, the middle half of its robots.
    """
    first = quantities[0]
    stride = max(-(-max(len(run.time_s) for run in runs) // MOST_POINTS), 1)
    curves = [
        pd.Series(own.over_time[::stride], index=run.time_s[::stride])
        for run, own in zip(runs, quantities, strict=True)
    ]

    def draw(axes: Axes, groups: dict[str, list[Any]], colours: Mapping[str, Any] | None) -> None:
        if len(runs) == 1:
            draw_one(axes, curves[0], first, stride)
        else:
            draw_bands(axes, groups, colours or palette(list(groups)))
            if colours is None:
                name_curves(axes, len(groups))
        axes.set_xlabel("time (s)")
        axes.spines[["top", "right"]].set_visible(False)
        axes.grid(alpha=0.25, linewidth=0.6)

    with mpl.rc_context({**INKED, "svg.hashsalt": "pogosim", "svg.fonttype": "path", "font.size": 10.0}):
        figure = drawn_by_combination(runs, curves, [draw], palette=palette)
        if len(figure.axes) == 1:
            figure.set_size_inches(WIDTH, 3.0 + figure.get_figheight() - 4.0)  # a legend below has made it higher
        else:
            figure.set_size_inches(WIDTH, figure.get_figheight() * WIDTH / figure.get_figwidth())
        content = io.BytesIO()
        with any_characters():
            figure.savefig(content, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    return Shown(first.label, with_ink(content.getvalue()), told(runs, quantities))


def draw_one(axes: Axes, curve: pd.Series[Any], quantity: Quantity, stride: int) -> None:
    """Draw a quantity of a single run, with its quartiles."""
    time_s = curve.index.to_numpy(dtype=float)
    axes.plot(time_s, curve.to_numpy(), color=COLOURS[0], marker="o" if len(time_s) == 1 else "")
    if quantity.low is not None and quantity.high is not None:
        axes.fill_between(
            time_s, quantity.low[::stride], quantity.high[::stride], color=COLOURS[0], alpha=0.25, linewidth=0
        )


def palette(names: Sequence[str]) -> dict[str, Any]:
    """Return colours of curves that are seen on light and on dark pages."""
    if len(names) <= len(COLOURS):
        return dict(zip(names, COLOURS, strict=False))
    shades = mpl.colormaps["turbo"](np.linspace(0.08, 0.92, len(names)))
    return dict(zip(names, shades, strict=True))


def with_ink(svg: bytes) -> bytes:
    """Let the colour of letters and axes follow the page."""
    text = svg.decode("utf-8")
    begin = text.index("<svg")
    end = text.index(">", begin) + 1
    return (text[begin:end] + STYLE.format(ink=INK) + text[end:].replace(INK, "var(--ink)")).encode("utf-8")


def told(runs: Sequence[Trajectories], quantities: Sequence[Quantity]) -> str:
    """Describe a figure in words."""
    parts: list[str] = []
    for name, own in by_combination(runs, list(quantities)).items():
        begin = np.nanmean([first_of(quantity) for quantity in own])
        end = np.nanmean([quantity.final for quantity in own])
        of = "" if len(parts) == 0 and len(own) == len(runs) else f"{name}: "
        parts.append(f"{of}from {begin:.4g} to {end:.4g}")
    return f"{quantities[0].label} over time: {'; '.join(parts[:12])}{'; ...' if len(parts) > 12 else ''}"


def first_of(quantity: Quantity) -> float:
    """Return the first value of a quantity; NaN without any."""
    known = quantity.over_time[np.isfinite(quantity.over_time)]
    return float(known[0]) if len(known) else float("nan")
