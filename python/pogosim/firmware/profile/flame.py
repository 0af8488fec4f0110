"""A flame graph in SVG: each box is a function in a path of calls, as wide as what it takes with all that it calls."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

from pogosim.firmware.profile.costs import functions_of_library, total_cycles
from pogosim.firmware.profile.numbers import percent, plain
from pogosim.firmware.profile.raw import Profile, ProfileError
from pogosim.firmware.profile.routines import PRINTING, family_of
from pogosim.lines import counted

PALETTE: dict[str, Any] = json.loads((Path(__file__).parents[2] / "palette.json").read_text(encoding="utf-8"))
PAPER: str = PALETTE["paper"]
INK: str = PALETTE["ink"]
ALL_TICKS: str = PALETTE["link_by_all_emitters"]
# What a box can be, and its colour.
PROGRAM, LIBRARY, ARITHMETIC, PRINTS = "program", "robots' library", "arithmetic and math.h", "printing"
COLOURS: dict[str, str] = dict(zip((PROGRAM, LIBRARY, ARITHMETIC, PRINTS), PALETTE["link_by_emitter"], strict=True))

WIDTH = 1200  # px, of the picture
MARGIN = 10
HEAD = 62  # above the boxes: title and legend
BOX = 18  # height of a box, with the gap of a pixel
FONT = 12  # px
LETTER = 0.602 * FONT  # width of a letter of DejaVu Sans Mono and of Courier
LEAST = 0.05  # px; narrower boxes cannot be seen


@dataclass
class Node:
    """A function in a path of calls.

    Attributes:
        function: Place in Profile.functions; None for all ticks together.
        total: Cycles with all that it calls, and with those that go by in the robots' library.
        own: Those of its own.
        calls: How often it was called along this path.
        inner: What it calls, by place in Profile.functions.
    """

    function: int | None
    total: float = 0.0
    own: float = 0.0
    calls: float = 0.0
    inner: dict[int, Node] = field(default_factory=dict)


@dataclass(frozen=True)
class Box:
    """A node and its place, px: x from the left edge of the boxes, and the row above the lowest one."""

    node: Node
    x: float
    width: float
    row: int


def tree_of(profile: Profile) -> Node:
    """Return all paths of calls as one tree."""
    root = Node(None)
    for stack in profile.stacks:
        node, cost = root, profile.cost(stack)
        for function in stack.frames:
            node.total += cost
            node = node.inner.setdefault(function, Node(function))
        node.total += cost
        node.own += cost
        node.calls += stack.calls
    return root


def boxes_of(root: Node, width: float) -> list[Box]:
    """Return the boxes of a tree that can be seen, within a width, px: what takes most is on the left."""
    scale = width / root.total
    found = []
    waiting = [Box(root, 0.0, width, 0)]
    while waiting:
        box = waiting.pop()
        found.append(box)
        x = box.x
        for node in sorted(box.node.inner.values(), key=lambda one: -one.total):
            if (wide := node.total * scale) < LEAST:
                break
            waiting.append(Box(node, x, wide, box.row + 1))
            x += wide
    return found


def flame_of(profile: Profile) -> str:
    """Return the flame graph as a file of SVG.

    Raises:
        ProfileError: The profile has no cycles.
    """
    root = tree_of(profile)
    if root.total <= 0:
        raise ProfileError("the profile has no cycles in 'stacks', so there is no flame graph")
    boxes = boxes_of(root, WIDTH - 2 * MARGIN)
    height = HEAD + (1 + max(box.row for box in boxes)) * BOX + MARGIN
    of_library = functions_of_library(profile)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" '
        f'font-family="DejaVu Sans Mono, monospace" font-size="{FONT}" fill="{INK}">',
        f'<rect width="{WIDTH}" height="{height}" fill="{PAPER}"/>',
        *head_of(profile),
        *(drawn(profile, box, height, of_library) for box in boxes),
        "</svg>",
    ]
    return "\n".join(parts) + "\n"


def head_of(profile: Profile) -> list[str]:
    """Return the title, and the legend."""
    name = Path(profile.firmware).name
    title = f"{name}: {plain(total_cycles(profile) / len(profile.ticks))} cycles per tick"
    parts = [text_at(MARGIN, 24, f"{title}, mean of {counted(len(profile.ticks), 'tick')}", FONT + 4)]
    x = float(MARGIN)
    for what, colour in COLOURS.items():
        parts.append(f'<rect x="{x:.1f}" y="36" width="12" height="12" rx="2" fill="{colour}"/>')
        parts.append(text_at(x + 18, 46, what))
        x += 18 + len(what) * LETTER + 24
    return parts


def drawn(profile: Profile, box: Box, height: int, of_library: frozenset[int]) -> str:
    """Return a box with its text, as far as it fits in, and what is told of it when the mouse is over it."""
    function = box.node.function
    name = "all ticks" if function is None else profile.functions[function]
    colour = ALL_TICKS if function is None else COLOURS[kind_of(name, function in of_library)]
    x, y = MARGIN + box.x, height - MARGIN - (box.row + 1) * BOX
    label = fitting(name, box.width)
    gap = 0.5 if box.width > 2 else 0.0  # between boxes
    return "".join(
        [
            f"<g><title>{escape(tooltip(profile, box.node, name))}</title>",
            f'<rect class="box" x="{x:.3f}" y="{y}" width="{box.width:.3f}" height="{BOX - 1}" rx="2" fill="{colour}" '
            f'stroke="{PAPER}" stroke-width="{gap}"/>',
            text_at(x + 4, y + 13, label) if label else "",
            "</g>",
        ]
    )


def kind_of(name: str, is_of_library: bool) -> str:
    """Return what a function is for, by its name."""
    family = family_of(name)
    if family is None:
        return LIBRARY if is_of_library else PROGRAM
    return PRINTS if family is PRINTING else ARITHMETIC


def tooltip(profile: Profile, node: Node, name: str) -> str:
    """Return what is told of a box."""
    ticks, total = len(profile.ticks), node.total
    calls = "" if node.function is None else f"; calls per tick: {plain(node.calls / ticks)}"
    return (
        f"{name}: {plain(total / ticks)} cycles per tick, {percent(total / total_cycles(profile))}; "
        f"{plain(node.own / ticks)} of its own{calls}"
    )


def fitting(name: str, width_px: float) -> str:
    """Return a name, or its beginning, as it fits into a box; "" if less than three letters do."""
    room = int((width_px - 8) / LETTER)
    if len(name) <= room:
        return name
    return f"{name[: room - 1]}\u2026" if room >= 3 else ""


def text_at(x: float, y: float, text: str, size: int = FONT) -> str:
    """Return a text; y is that of its base line."""
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}">{escape(text)}</text>'


def write_flame(profile: Profile, file: Path) -> None:
    """Write the flame graph.

    Raises:
        ProfileError: The profile has no cycles.
        OSError: It cannot be written.
    """
    file.write_text(flame_of(profile), encoding="utf-8")
