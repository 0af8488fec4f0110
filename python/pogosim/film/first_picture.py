"""The first picture of a replay as SVG, shown before the page's script runs, and where scripts are blocked."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.film.packing import hex_colour
from pogosim.picture.body_links import PlacedLinks
from pogosim.picture.images import Box, lines_between, seen_places
from pogosim.picture.palette import palette_of, tension_colours

BRIGHT = 64.0  # luminance, 0 to 255, from which on headings are dark; as in colours.js


def number(value: float) -> str:
    """Write a coordinate, mm."""
    return f"{value:.2f}".rstrip("0").rstrip(".")


def path_of(points: Sequence[Sequence[float]]) -> str:
    """Return a closed path through points."""
    return "M" + "L".join(f"{number(x)} {number(y)}" for x, y in points) + "Z"


def is_bright(colour: str) -> bool:
    """Tell whether a colour (#rrggbb) is bright."""
    red, green, blue = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
    return 0.299 * red + 0.587 * green + 0.114 * blue > BRIGHT


def body(category: dict[str, Any], x: float, y: float, angle: float) -> str:
    """Return the outline of an object."""
    if category["outline"] is None:
        return f'<circle cx="{number(x)}" cy="{number(y)}" r="{number(category["radius"])}"/>'
    turn = 0.0 if math.isnan(angle) else angle
    cos, sin = math.cos(turn), math.sin(turn)
    corners = [(x + cos * px - sin * py, y + sin * px + cos * py) for px, py in category["outline"]]
    return f'<path d="{path_of(corners)}"/>'


def heading(category: dict[str, Any], x: float, y: float, angle: float) -> str:
    """Return the mark of a heading, as a part of a path."""
    cos, sin = math.cos(angle) * category["reach"], math.sin(angle) * category["reach"]
    start, end = (x + 0.25 * cos, y + 0.25 * sin), (x + 0.95 * cos, y + 0.95 * sin)
    return f"M{number(start[0])} {number(start[1])}L{number(end[0])} {number(end[1])}"


def link_paths(links: PlacedLinks, box: Box | None, palette: dict[str, Any]) -> list[str]:
    """Return links between bodies as lines and dots, with an edge each."""
    colours = [hex_colour(colour) for colour in tension_colours(links.load, palette)]
    line = 'stroke-linecap="round" vector-effect="non-scaling-stroke"'
    paths = []
    for kind, width in (("rod", 3.0), ("spring", 2.0), ("hinge", 7.2)):
        of_kind = np.flatnonzero(links.kind == kind)
        segments, which = lines_between(links.start[of_kind], links.end[of_kind], box)
        for (start, end), i in zip(segments, of_kind[which], strict=True):
            path = f"M{number(start[0])} {number(start[1])}L{number(end[0])} {number(end[1])}"
            for colour, extra in ((palette["edge"], 1.2), (colours[i], 0.0)):
                paths.append(f'<path d="{path}" stroke="{colour}" stroke-width="{width + extra:g}" {line}/>')
    return paths


def first_picture(
    head: dict[str, Any],
    poses: npt.NDArray[np.float64],
    colours: Sequence[str],
    links: PlacedLinks | None = None,
) -> str:
    """Draw the arena and its objects.

    Args:
        head: What the page knows of the run, see replay_data().
        poses: x, y (mm) and angle (rad) of each object, shape (n, 3). NaN: there is none yet.
        colours: Colours of each object.
        links: Links between bodies.
    """
    palette = palette_of(head["view"])
    (left, top), (right, bottom) = head["low"], head["high"]
    box = (np.array(head["low"]), np.array(head["high"])) if head["periodic"] else None
    floor = "".join(path_of(polygon) for polygon in head["polygons"])
    shapes: dict[str, list[str]] = {}
    headings: dict[str, list[str]] = {}
    for (number_of_category, _), (x, y, angle), colour in zip(head["objects"], poses, colours, strict=True):
        category = head["categories"][number_of_category]
        if not (math.isfinite(x) and math.isfinite(y)) or category["membrane"]:
            continue
        ink = palette["edge"] if is_bright(colour) else palette["paper"]
        for px, py in seen_places(np.array([[x, y]]), category["radius"], box)[1]:
            shapes.setdefault(colour, []).append(body(category, px, py, angle))
            if math.isfinite(angle):
                headings.setdefault(ink, []).append(heading(category, px, py, angle))
    line = 'vector-effect="non-scaling-stroke"'
    parts = [
        f'<svg id="first" aria-hidden="true" viewBox="{number(left)} {number(top)} {number(right - left)} '
        f'{number(bottom - top)}" stroke-linejoin="round">',
        f'<path d="{floor}" fill="{palette["floor"]}" fill-rule="evenodd"/>',
        f'<clipPath id="inside"><path d="{floor}" clip-rule="evenodd"/></clipPath><g clip-path="url(#inside)">'
        if box
        else "<g>",
        *(f'<g fill="{colour}" stroke="{palette["edge"]}">{"".join(own)}</g>' for colour, own in shapes.items()),
        *(link_paths(links, box, palette) if links else ()),
        *(f'<path d="{"".join(own)}" stroke="{ink}" stroke-width="2" {line}/>' for ink, own in headings.items()),
        "</g>",
        f'<path d="{floor}" fill="none" stroke="{palette["wall"]}" stroke-width="3" {line}/>',
        "</svg>",
    ]
    return "".join(parts)
