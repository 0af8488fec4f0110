"""How objects look in a view, as its program takes it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from pogosim.scene import Kind, Lamp
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


def lamp_places(lamps: Sequence[Lamp]) -> list[dict[str, Any]]:
    """Return the places of lamps that shine on a part of the arena."""
    return [
        {
            "centre": list(lamp.centre_mm),
            "orbit": [lamp.orbit_radius_mm, lamp.orbit_speed_rad_s, lamp.orbit_phase_rad],
        }
        for lamp in lamps
        if lamp.has_place
    ]
