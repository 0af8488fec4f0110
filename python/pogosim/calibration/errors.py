"""What goes wrong in a calibration by the user's files or options."""

from __future__ import annotations


class CalibrationError(Exception):
    """Robots cannot be calibrated so; says what, where, and what to do."""
