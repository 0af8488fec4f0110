"""Textbook results that the simulator must give: the scenes of docs/validation.md."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from pictures import Picture, from_figure

from . import kuramoto_order, lamp_density, reception_runs, vicsek_order, voter_consensus, walks
from .experiment import Outcome

Scene = Callable[[Path, bool], Outcome]

SCENES: dict[str, Scene] = {
    module.NAME: module.measure
    for module in (walks, vicsek_order, kuramoto_order, voter_consensus, reception_runs, lamp_density)
}


def picture_of(outcome: Outcome) -> Picture:
    """Draw a scene's figure."""
    return from_figure(outcome.figure, 110, *outcome.tables)
