"""How objects look in a view, as its program takes it."""

from __future__ import annotations

from typing import Any

import numpy as np

from pogosim.scene import Kind
from pogosim.shapes import Shape


def category_data(name: str, kind: Kind) -> dict[str, Any]:
    """How objects of a category look, and how far they are heard."""
    shape = kind.shape
    return {
        "name": name,
        "radius": shape.bounding_radius_mm,
        "reach": shape.reach_mm,
        "outline": outline_of(shape),
        "talks": kind.talks,
        "range": kind.communication_radius_mm,
        "passive": not kind.runs_program,
        "membrane": kind.is_membrane,
    }


def outline_of(shape: Shape) -> list[list[float]] | None:
    """Corners of a shape; None of a disk."""
    return None if shape.is_round else np.round(shape.outline(), 3).tolist()
