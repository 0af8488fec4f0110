"""Arenas from drawings: SVG files, read with the package `svgelements` and flattened to polygons.

SVG 1.1 and 2 (W3C): y runs down, as in arena files. One user unit is 1 mm; units such as mm, cm and in, the viewBox and
all transforms are applied.
"""

from __future__ import annotations

import io
import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from pogosim.geometry.arena_file import ArenaError, Floats, Outline, digits_for, signed_area, without_repetitions
from pogosim.geometry.validity import THINNEST

SVG = "{http://www.w3.org/2000/svg}"
# Elements whose content is not drawn where it stands.
NOT_DRAWN = ("clipPath", "mask", "marker", "pattern")
# svgelements takes 1 mm for 0.0393701 inch; with this resolution, it is exactly one unit.
UNITS_PER_INCH = 1.0 / 0.0393701
# How far corners may be from a curve, as a fraction of the diagonal of the drawing.
TOLERANCE = 1.0e-4
DEEPEST = 14  # bisections of a curve


def read_svg(
    path: str | Path, *, element: str | None = None, first_path: bool = False, tolerance: float = TOLERANCE
) -> tuple[Outline, list[str]]:
    """Read the closed shapes of a drawing as an arena: the largest is the outer wall, the others are its holes.

    Paths, rectangles, circles, ellipses and polygons are shapes, and each sub-path is one. Curves become polygons.

    Args:
        path: SVG file.
        element: Take only the element of this id, and what is in it. None: all that is drawn.
        first_path: Take only the first <path>.
        tolerance: Largest distance of corners from a curve, as a fraction of the diagonal of the drawing, above 0.

    Returns:
        The outline, in mm, and warnings about what was left out or closed.

    Raises:
        ArenaError: It is no SVG file, or has no such shape.
        OSError: It cannot be read.
    """
    root = parsed(Path(path))
    choose(root, str(path), element, first_path)
    shapes = drawn_shapes(root, str(path))
    extent = extent_of(shapes)
    warnings: list[str] = []
    polygons = []
    for number, shape in enumerate(shapes, start=1):
        for name, corners, is_closed in flattened_shapes(shape, number, tolerance * extent, str(path)):
            size = np.ptp(corners, axis=0) if len(corners) else np.zeros(2)
            if len(corners) < 3 or not abs(signed_area(corners)) > THINNEST * float((size**2).sum()):
                warnings.append(f"{path}: {name} encloses no area, and is left out")
                continue
            if not is_closed:
                warnings.append(f"{path}: {name} is open; a straight wall closes it")
            polygons.append(corners)
    if not polygons:
        raise ArenaError(
            f"{path} has no shape with an area; expected a closed path, rectangle, circle, ellipse or polygon"
        )
    outer = max(range(len(polygons)), key=lambda i: abs(signed_area(polygons[i])))
    return Outline((polygons[outer], *polygons[:outer], *polygons[outer + 1 :]), str(path)), warnings


def parsed(path: Path) -> ElementTree.Element:
    """Return the root of an SVG file, without what is not drawn.

    Raises:
        ArenaError: It is none.
        OSError: It cannot be read.
    """
    if path.exists() and not path.is_file():
        raise ArenaError(f"{path} is not a file; expected an SVG file")
    content = path.read_bytes()
    if b"<!ENTITY" in content:
        raise ArenaError(f"{path} declares XML entities, which are not read; save it as plain SVG")
    try:
        root = ElementTree.fromstring(content)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise ArenaError(f"{path} is not an SVG file: {error}") from None
    if root.tag not in ("svg", f"{SVG}svg"):
        raise ArenaError(f"{path} is not an SVG file: its root is <{kind(root)}>, expected <svg>")
    for parent in list(root.iter()):
        for child in list(parent):
            if kind(child) in NOT_DRAWN:
                parent.remove(child)
    return root


def drawn_shapes(root: ElementTree.Element, source: str) -> list[Any]:
    """Return the shapes of a drawing, with all transforms applied.

    Raises:
        ArenaError: The drawing cannot be understood.
    """
    import svgelements

    text = io.BytesIO(ElementTree.tostring(root))
    try:
        drawing = svgelements.SVG.parse(text, ppi=UNITS_PER_INCH, reify=True)
        shapes = [shape for shape in drawing.elements() if isinstance(shape, svgelements.Shape)]
    except (ValueError, TypeError, AttributeError, IndexError, KeyError, ZeroDivisionError, RecursionError) as error:
        raise ArenaError(f"{source} cannot be read: {error}; save it as plain SVG") from None
    return [shape for shape in shapes if shape.values.get("visibility") not in ("hidden", "collapse")]


def keep_only(root: ElementTree.Element, chosen: ElementTree.Element) -> None:
    """Take out of a drawing what is not in an element; what is referred to and styles stay."""
    kept = set(chosen.iter())
    parents = {child: parent for parent in root.iter() for child in parent}
    node: ElementTree.Element | None = chosen
    while node is not None:
        kept.add(node)
        node = parents.get(node)
    kept |= {inner for child in root.iter() if kind(child) in ("defs", "style", "symbol") for inner in child.iter()}
    for child, parent in parents.items():
        if child not in kept:
            parent.remove(child)


def kind(element: ElementTree.Element) -> str:
    """Return the name of an element without its namespace; nothing for comments."""
    return element.tag.rpartition("}")[2] if isinstance(element.tag, str) else ""


def choose(root: ElementTree.Element, source: str, element: str | None, first_path: bool) -> None:
    """Leave only what is asked for in a drawing. Arguments as in read_svg().

    Raises:
        ArenaError: There is no such element.
    """
    if element is not None:
        found = next((node for node in root.iter() if node.get("id") == element), None)
        if found is None:
            ids = [str(node.get("id")) for node in root.iter() if node.get("id")]
            there_are = f"; there are {', '.join(ids[:10])}{' ...' if len(ids) > 10 else ''}" if ids else ""
            raise ArenaError(f"{source} has no element with the id '{element}'{there_are}")
        keep_only(root, found)
    if first_path:
        defined = {inner for node in root.iter() if kind(node) in ("defs", "symbol") for inner in node.iter()}
        found = next((node for node in root.iter() if kind(node) == "path" and node not in defined), None)
        if found is None:
            raise ArenaError(f"{source} has no <path>")
        keep_only(root, found)


def extent_of(shapes: list[Any]) -> float:
    """Return the diagonal of the bounding box of shapes."""
    boxes = [box for shape in shapes if (box := shape.bbox()) is not None]
    if not boxes:
        return 0.0
    low, high = np.min(boxes, axis=0)[:2], np.max(boxes, axis=0)[2:]
    return float(np.hypot(*(high - low)))


def flattened_shapes(shape: Any, number: int, tolerance: float, source: str) -> Iterator[tuple[str, Floats, bool]]:
    """Yield the name, the corners and whether it is closed of each sub-path of a shape.

    Raises:
        ArenaError: A coordinate is no number.
    """
    import svgelements

    name = f"'{shape.id}'" if shape.id else f"shape {number} (<{type(shape).__name__.lower()}>)"
    # abs() applies what is left of a transform: a turned rectangle that is stretched is no rectangle any more.
    sub_paths = list(abs(svgelements.Path(shape)).as_subpaths())
    for place, sub_path in enumerate(sub_paths, start=1):
        points: list[complex] = []
        is_closed = False
        for segment in sub_path:
            if isinstance(segment, svgelements.Close):
                is_closed = True
            elif isinstance(segment, svgelements.Move):
                points = [complex(segment.end)]
            elif isinstance(segment, svgelements.Line):
                points.append(complex(segment.end))
            else:
                points += curve_points(segment, tolerance)
        if not all(math.isfinite(abs(point)) for point in points):
            raise ArenaError(f"{source}: {name} has coordinates that are not finite numbers")
        corners = without_repetitions([(point.real, point.imag) for point in points])
        ends_at_start = len(points) > 1 and abs(points[0] - points[-1]) <= max(tolerance, 1e-9)
        part = f"part {place} of {name}" if len(sub_paths) > 1 else name
        yield part, corners, is_closed or ends_at_start


def curve_points(segment: Any, tolerance: float) -> list[complex]:
    """Return points on a curve, without its start: its quarters, each halved until it is straight enough."""

    def at(t: float) -> complex:
        point = segment.point(t)
        return complex(float(point.x), float(point.y))

    def refined(t0: float, p0: complex, t1: float, p1: complex, depth: int) -> list[complex]:
        inner = [at(t0 + (t1 - t0) * share) for share in (0.25, 0.5, 0.75)]
        if depth >= DEEPEST or max(distance_to_chord(point, p0, p1) for point in inner) <= tolerance:
            return [p1]
        middle = 0.5 * (t0 + t1)
        return refined(t0, p0, middle, inner[1], depth + 1) + refined(middle, inner[1], t1, p1, depth + 1)

    ends = [complex(segment.start), at(0.25), at(0.5), at(0.75), complex(segment.end)]
    if not all(math.isfinite(abs(point)) for point in ends):
        return ends[1:]
    pieces = [refined(0.25 * i, ends[i], 0.25 * (i + 1), ends[i + 1], 0) for i in range(4)]
    return [point for piece in pieces for point in piece]


def distance_to_chord(point: complex, start: complex, end: complex) -> float:
    """Return the distance of a point from a line segment."""
    chord = end - start
    length2 = abs(chord) ** 2
    share = 0.0 if length2 == 0.0 else ((point - start) * chord.conjugate()).real / length2
    return abs(point - start - min(max(share, 0.0), 1.0) * chord)


def as_svg(outline: Outline) -> str:
    """Return an SVG drawing of an outline in mm: one path, its holes left out of the fill."""
    digits = digits_for(outline)
    low, high = outline.bounds
    width, height = high - low
    data = " ".join(
        "M " + " L ".join(f"{x:.{digits}f},{y:.{digits}f}" for x, y in (polygon - low).tolist()) + " Z"
        for polygon in outline.polygons
    )
    line = 0.003 * max(width, height)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.{digits}f}mm" height="{height:.{digits}f}mm" '
        f'viewBox="0 0 {width:.{digits}f} {height:.{digits}f}">\n'
        f'  <path fill="#e8edf1" fill-rule="evenodd" stroke="#29343d" stroke-width="{line:.{digits}f}" d="{data}"/>\n'
        "</svg>\n"
    )
