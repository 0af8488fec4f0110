"""What keeps a run from being drawn."""

from __future__ import annotations


class PictureError(Exception):
    """The file holds nothing that can be drawn, or the picture cannot be made; says why."""
