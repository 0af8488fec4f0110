"""From simulation to reality: the motion parameters of robots, from their tracked trajectories."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pogosim.deferred import on_demand

if TYPE_CHECKING:
    from pogosim.calibration.intervals import intervals_of

__all__ = ["intervals_of"]

__getattr__, __dir__ = on_demand(__name__, {"intervals_of": "intervals"})
