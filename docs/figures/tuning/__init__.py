"""What searches of pogoptim must do: the scenes of the section "How well it works" of docs/optimization.md."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from . import archive, longest_runs, phototaxis, throughput
from .searches import Outcome

Scene = Callable[[Path, bool], Outcome]

SCENES: dict[str, Scene] = {module.NAME: module.measure for module in (longest_runs, phototaxis, archive, throughput)}

DRAWN = frozenset({archive.NAME, phototaxis.NAME})  # scenes with a picture
TIMES = frozenset({throughput.NAME})  # scenes whose numbers are those of a clock
