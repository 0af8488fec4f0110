"""A complete picture: the arena with a heading, a scale bar, notes, and what its colours mean."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from pogosim.fonts import literal
from pogosim.picture import layers
from pogosim.picture.colouring import MAX_LABELS, Colouring, Legend, Scale
from pogosim.picture.palette import EDGE, INK, PAPER
from pogosim.picture.swarm import OBJECT, Swarm
from pogosim.scene import bounds
from pogosim.shapes import Floats

MAX_COLUMNS = 4  # of panels
PANEL = 4.0  # inches, its longer side
MAX_LABEL = 24  # characters of a name in a legend


def round_length(width_mm: float) -> float:
    """Return the largest of 1, 2, 5 times a power of ten that is at most a quarter of the width."""
    power = 10.0 ** math.floor(math.log10(width_mm / 4.0))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= width_mm / 4.0)


def draw_scale_bar(axes: Axes, low: Floats, high: Floats) -> None:
    """Draw a bar of a round length under the lower left corner of the arena."""
    length = round_length(high[0] - low[0])
    pad = 0.03 * (high[1] - low[1])
    y = high[1] + pad
    axes.plot(
        [low[0], low[0] + length],
        [y, y],
        color=INK,
        linewidth=2.5,
        solid_capstyle="butt",
        clip_on=False,
    )
    axes.text(
        low[0] + length / 2,
        y + 0.35 * pad,
        f"{length:g} mm",
        color=INK,
        ha="center",
        va="top",
        fontsize=9,
    )


def notes(swarm: Swarm) -> str:
    """Return what the picture does not show, though it was there."""
    unseen = list(swarm.unseen_light)
    marked = layers.marked_membranes(swarm)["robot_category"].unique()
    unseen += [f"the shape of {name} (serialize_dot_pose)" for name in marked]
    return f"not drawn: {', '.join(unseen)}" if unseen else ""


def draw_notes(axes: Axes, text: str, low: Floats, high: Floats) -> None:
    """Write the notes under the lower right corner of the arena."""
    y = high[1] + 0.03 * (high[1] - low[1])
    axes.text(high[0], y, literal(text), color=INK, ha="right", va="top", fontsize=9)


def counted(category: str, count: int) -> str:
    """Return the name of a category as words behind a number: one robot, two active objects."""
    words = category.replace("_", "\u00a0").strip()
    is_plural = words.endswith("s") and not words.endswith("ss")
    return words[:-1] if count == 1 and is_plural else words


def title(swarm: Swarm, width_inches: float) -> str:
    """Return what the picture shows, in lines that fit into it: objects by category, and the time."""
    counts = swarm.rows.groupby("robot_category")[OBJECT].nunique()
    parts = [f"{count}\u00a0{counted(str(category), int(count))}" for category, count in counts.items()]
    text = ", ".join(parts) + f" after {swarm.end_s:.9g} s"
    return textwrap.fill(text, width=max(int(8.5 * width_inches), 20), break_long_words=False)


def draw(swarm: Swarm, tail_s: float | None = None, links: bool = False) -> Figure:
    """Draw a run, with a heading and a scale bar; with what colours mean, if a column gives them.

    Arguments as in layers.draw_scene().
    """
    low, high = bounds(swarm.polygons)
    extent = high - low
    size = 8.0 * extent / extent.max()

    heading = title(swarm, size[0])
    beside_scale_bar = max(int(9.0 * size[0]), 20)  # characters
    below = textwrap.fill(notes(swarm), width=beside_scale_bar, break_long_words=False)
    height = size[1] + 0.9  # with one line of heading and one of notes
    more_above = 0.22 * heading.count("\n")
    more_below = 0.15 * below.count("\n")
    total = height + more_above + more_below
    width = size[0] + 0.3
    beside = width_of_key(swarm.colouring)
    figure = Figure(figsize=(width + beside, total), facecolor=PAPER)
    share = width / (width + beside)
    axes = figure.add_axes((0.0, (0.07 * height + more_below) / total, share, 0.86 * height / total))
    layers.draw_scene(axes, swarm, tail_s, links)
    draw_scale_bar(axes, low, high)
    draw_notes(axes, below, low, high)
    axes.set_title(literal(heading), color=INK, fontsize=13, pad=8)
    if swarm.colouring:
        draw_key(figure, swarm.colouring, share, beside)
    return figure


def draw_series(swarms: Sequence[Swarm], tail_s: float | None = None, links: bool = False) -> Figure:
    """Draw a run at several times, a panel for each, in rows of at most four.

    Args:
        swarms: One run up to several times, at least one.
        tail_s: As in layers.draw_scene().
        links: As there.
    """
    last = max(swarms, key=lambda swarm: swarm.end_s)
    columns = math.ceil(len(swarms) / math.ceil(len(swarms) / MAX_COLUMNS))
    lines = math.ceil(len(swarms) / columns)
    extent = layers.extent_of(last)
    panel = PANEL * extent / extent.max() + (0.1, 0.45)  # with the time above it
    heading = title(last, columns * panel[0] * 0.9).rsplit(" after ", 1)[0]
    below = textwrap.fill(notes(last), width=max(int(9.0 * columns * panel[0]), 20), break_long_words=False)
    above_height, below_height = 0.3 + 0.22 * (heading.count("\n") + 1), 0.35 + 0.15 * (below.count("\n") + 1)
    beside = width_of_key(last.colouring)
    width, height = columns * panel[0] + beside, lines * panel[1] + above_height + below_height
    figure = Figure(figsize=(width, height), facecolor=PAPER)
    low, high = bounds(last.polygons)
    for i, swarm in enumerate(swarms):
        left = (i % columns) * panel[0] + 0.05
        bottom = height - above_height - (i // columns + 1) * panel[1]
        axes = figure.add_axes((left / width, bottom / height, (panel[0] - 0.1) / width, (panel[1] - 0.45) / height))
        layers.draw_scene(axes, swarm, tail_s, links)
        axes.set_title(f"{swarm.end_s:.9g} s", color=INK, fontsize=12, pad=4)
        if i % columns == 0 and i // columns == lines - 1:
            draw_scale_bar(axes, low, high)
    middle = (width - beside) / 2 / width
    figure.text(middle, 1.0 - 0.15 / height, literal(heading), color=INK, fontsize=13, ha="center", va="top")
    if below:
        figure.text(
            1.0 - (beside + 0.1) / width, 0.1 / height, literal(below), color=INK, fontsize=9, ha="right", va="bottom"
        )
    if last.colouring:
        draw_key(figure, last.colouring, 1.0 - beside / width, beside)
    return figure


def width_of_key(colouring: Colouring | None) -> float:
    """Width of the strip, in inches, that says what colours mean."""
    if colouring is None:
        return 0.0
    if isinstance(colouring, Scale):
        return 1.2
    longest = max(map(len, [*listed(colouring), colouring.name]), default=0)
    return 0.75 + 0.085 * min(longest, MAX_LABEL)


def listed(legend: Legend) -> list[str]:
    """Return the names that a legend shows."""
    return [shortened(label) for label in legend.labels[:MAX_LABELS]] or ["no values"]


def shortened(text: str) -> str:
    """Return a name as a legend has room for it."""
    return text if len(text) <= MAX_LABEL else text[: MAX_LABEL - 1] + "\u2026"


def draw_key(figure: Figure, colouring: Colouring, left: float, inches: float) -> None:
    """Draw a colour bar or a legend at the right side.

    Args:
        figure: Where to.
        colouring: What colours mean.
        left: Where the strip begins, as a share of the figure.
        inches: Its width.
    """
    if isinstance(colouring, Scale):
        width = (1.0 - left) / inches
        axes = figure.add_axes((left + 0.1 * width, 0.25, 0.18 * width, 0.5))
        span = Normalize(colouring.low, colouring.high)
        bar = figure.colorbar(ScalarMappable(span, colouring.colour_map), cax=axes)
        if colouring.low >= colouring.high:
            bar.set_ticks([colouring.low])
        bar.set_label(literal(colouring.name), color=INK)
        bar.outline.set_edgecolor(INK)
        bar.ax.tick_params(color=INK, labelcolor=INK, labelsize=9)
        return
    style: dict[str, Any] = {"marker": "o", "linestyle": "", "markersize": 8, "markeredgecolor": EDGE}
    marks = [
        Line2D([], [], color=tuple(colour), label=literal(label), **style)
        for label, colour in zip(listed(colouring), colouring.swatches, strict=False)
    ]
    more = len(colouring.labels) - len(marks)
    name = literal(shortened(colouring.name)) + (f"\n({more} more)" if more else "")
    figure.legend(
        handles=marks, title=name, loc="center left", bbox_to_anchor=(left, 0.5), frameon=False, labelcolor=INK
    )
