#!/usr/bin/env python3
"""Draw the arenas that come with the simulator as CSV outlines.

Every arena is a list of polygons: first the outer one, then its holes. The simulator scales an outline to the area that
the configuration asks for, so units mean nothing here; most outlines are about 1000 wide. x runs to the right, y down.

    python3 scripts/draw_arenas.py [--output arenas]

writes the same bytes each time. A new arena is one line in ``arenas()``.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from pathlib import Path

Point = tuple[float, float]
Polygon = list[Point]
Arena = list[Polygon]


def arc(centre: Point, radius: float, start_deg: float, end_deg: float, count: int) -> Polygon:
    """Return ``count`` points evenly spaced in angle on a circle, the first at the start, the last at the end.

    Angles are in degrees from +x, clockwise on the screen (y down).
    """
    angles = [math.radians(start_deg + (end_deg - start_deg) * i / (count - 1)) for i in range(count)]
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]


def circle(radius: float, corners: int) -> Polygon:
    """Return a regular polygon around the origin, its first corner on +x."""
    return arc((0.0, 0.0), radius, 0.0, 360.0, corners + 1)[:-1]


def rectangle(left: float, top: float, width: float, height: float) -> Polygon:
    """Return an axis-aligned rectangle."""
    return [(left, top), (left + width, top), (left + width, top + height), (left, top + height)]


def room_with_recess(width: float, height: float, recess_width: float, recess_depth: float) -> Polygon:
    """Return a room with a recess in the middle of its upper wall, from which a partition may slide."""
    left, right = (width - recess_width) / 2, (width + recess_width) / 2
    room = rectangle(0, recess_depth, width, height)
    return [room[0], (left, recess_depth), (left, 0.0), (right, 0.0), (right, recess_depth), *room[1:]]


def star(points: int, inner: float, turn_deg: float = -90.0) -> Polygon:
    """Return a star of outer radius 1000; its notches are at ``inner`` times that.

    ``turn_deg`` is the direction of the first point; -90 is up on the screen.
    """
    corners: Polygon = []
    for i in range(2 * points):
        angle = math.radians(turn_deg + 180.0 * i / points)
        radius = 1000.0 if i % 2 == 0 else 1000.0 * inner
        corners.append((radius * math.cos(angle), radius * math.sin(angle)))
    return corners


def two_lobes(neck: float, widening: float) -> Polygon:
    """Return two lobes, one above the other, joined by a neck with rounded flanks.

    ``neck`` is the width of the neck as a fraction of the width of the lobes; ``widening`` stretches the whole outline
    along x. Before stretching, the lobes are circles of radius 500, and the flanks are arcs of radius 250 that touch
    both of them.
    """
    lobe, flank = 500.0, 250.0
    half_neck = neck * lobe
    offset = math.sqrt((lobe + flank) ** 2 - (half_neck + flank) ** 2)
    # Angle, seen from the lower lobe's centre, of the point where the right flank touches it.
    contact = math.degrees(math.atan2(-offset, half_neck + flank))
    lower = arc((0.0, offset), lobe, contact, 180.0 - contact, 72)
    left = arc((-half_neck - flank, 0.0), flank, -contact, contact, 24)
    upper = arc((0.0, -offset), lobe, 180.0 + contact, 360.0 - contact, 72)
    right = arc((half_neck + flank, 0.0), flank, 180.0 - contact, 180.0 + contact, 24)
    # Where two arcs meet they share a point.
    return [(widening * x, y) for x, y in lower + left[1:-1] + upper + right[1:-1]]


def barred_annulus(outer: float, inner: float, bar: float, corners: int) -> Polygon:
    """Return a ring that a bar from the hole to the top of the outer wall closes; one polygon around both.

    ``bar`` is the width of the bar.
    """
    outer_gap = math.degrees(math.asin(0.5 * bar / outer))
    inner_gap = math.degrees(math.asin(0.5 * bar / inner))
    around = arc((0.0, 0.0), outer, -90.0 + outer_gap, 270.0 - outer_gap, corners)
    back = arc((0.0, 0.0), inner, 270.0 - inner_gap, -90.0 + inner_gap, corners // 2)
    return around + back


def mirrored(polygon: Polygon) -> Polygon:
    """Return the polygon turned over: left becomes right."""
    return [(-x, y) for x, y in polygon]


def arenas() -> dict[str, Arena]:
    """Return every arena by the name of its file."""
    arrow: Polygon = [(0, 0), (500, 500), (250, 500), (250, 1100), (-250, 1100), (-250, 500), (-500, 500)]
    double_arrow: Polygon = [
        (0, 0), (500, 450), (230, 450), (230, 850), (500, 850),
        (0, 1300), (-500, 850), (-230, 850), (-230, 450), (-500, 450),
    ]  # fmt: skip
    letter_h: Polygon = [
        (0, 0), (350, 0), (350, 375), (650, 375), (650, 0), (1000, 0),
        (1000, 1000), (650, 1000), (650, 625), (350, 625), (350, 1000), (0, 1000),
    ]  # fmt: skip
    letter_l: Polygon = [(0, 0), (450, 0), (450, 550), (1000, 550), (1000, 1000), (0, 1000)]
    letter_u: Polygon = [(0, 0), (350, 0), (350, 650), (650, 650), (650, 0), (1000, 0), (1000, 1000), (0, 1000)]
    letter_t: Polygon = [(0, 0), (1000, 0), (1000, 400), (700, 400), (700, 1000), (300, 1000), (300, 400), (0, 400)]
    letter_z: Polygon = [(0, 0), (700, 0), (700, 600), (1000, 600), (1000, 1000), (300, 1000), (300, 400), (0, 400)]
    cross: Polygon = [
        (333, 0), (667, 0), (667, 333), (1000, 333), (1000, 667), (667, 667),
        (667, 1000), (333, 1000), (333, 667), (0, 667), (0, 333), (333, 333),
    ]  # fmt: skip
    square_and_triangle: Polygon = [(0, 0), (600, 0), (1200, 300), (600, 600), (0, 600)]
    triangle: Polygon = [(500, 0), (1000, 500 * math.sqrt(3)), (0, 500 * math.sqrt(3))]
    return {
        "H": [letter_h],
        "annulus": [circle(750, 192), circle(495, 128)],
        "annulusBarred": [barred_annulus(750, 375, 60, 160)],
        "arena1": [letter_l],
        "arena2": [letter_u],
        "arena3": [letter_t],
        "arena4": [cross],
        "arena5": [letter_z],
        "arena6": [circle(600, 6)],
        "arena7": [rectangle(0, 0, 1600, 800), rectangle(780, 270, 40, 260)],
        "arena8": [two_lobes(neck=0.28, widening=1.4)],
        "arena9": [rectangle(0, 0, 1200, 1200)]
        + [rectangle(x, y, 150, 150) for y in (262.5, 787.5) for x in (262.5, 787.5)],
        "arrow": [arrow],
        "arrow2": [double_arrow],
        "disk": [circle(564, 192)],
        "empty": [rectangle(0, 0, 1000, 1000)],
        "line": [rectangle(0, 0, 450, 2215)],
        "sqtriangle": [square_and_triangle],
        "sqtriangle2": [mirrored(square_and_triangle)],
        "sqtriangle3": [[(y, -x) for x, y in square_and_triangle]],
        "recess": [room_with_recess(width=1300, height=600, recess_width=74, recess_depth=600)],
        "square": [rectangle(0, 0, 1000, 1000)],
        "squarewithHole": [rectangle(0, 0, 1155, 1155), rectangle(288.75, 288.75, 577.5, 577.5)],
        "star": [star(5, inner=math.cos(math.radians(72)) / math.cos(math.radians(36)), turn_deg=0.0)],
        "star4": [star(4, inner=0.45)],
        "star6": [star(6, inner=1.0 / math.sqrt(3.0))],
        "star7": [star(7, inner=0.6)],
        "star8": [star(8, inner=0.65)],
        "torus": [rectangle(0, 0, 1000, 1000)],
        "triangle": [triangle],
    }


# Squares whose opposite sides are one. Earlier simulators had empty files of these names for them.
PERIODIC = ("empty", "torus")


def as_text(arena: Sequence[Polygon], *, periodic: bool = False) -> str:
    """Return the CSV text: a line ``x,y`` for each corner, a blank line between polygons."""
    # Adding zero turns a rounded -0.0 into 0.0.
    blocks = ["".join(f"{round(x, 3) + 0.0:.3f},{round(y, 3) + 0.0:.3f}\n" for x, y in polygon) for polygon in arena]
    return ("# boundary_condition: periodic\n" if periodic else "") + "\n".join(blocks)


def main() -> None:
    """Write all arenas into the folder asked for."""
    parser = argparse.ArgumentParser(description="Draw the arenas that come with the simulator.")
    default = Path(__file__).resolve().parent.parent / "arenas"
    parser.add_argument("--output", type=Path, default=default, help="folder for the csv files (default: arenas)")
    folder: Path = parser.parse_args().output
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, arena in arenas().items():
            (folder / f"{name}.csv").write_bytes(as_text(arena, periodic=name in PERIODIC).encode("ascii"))
    except OSError as error:
        parser.error(f"cannot write to {folder}: {error.strerror}")


if __name__ == "__main__":
    main()
