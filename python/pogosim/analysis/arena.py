"""The arena of a run: its walls, its area, and distances across periodic borders."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from pogosim.periodic import minimum_image

if TYPE_CHECKING:
    import shapely

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Arena:
    """Where robots move. Lengths in mm, y downwards."""

    name: str = ""
    polygons: list[Floats] = field(default_factory=list)  # (corners, 2) each; the outer wall, then holes; may be empty
    is_periodic: bool = False  # what leaves the bounding box comes back on the other side

    @property
    def bounds_mm(self) -> tuple[Floats, Floats]:
        """Corners (x, y) of the bounding box of the outer wall: least and greatest."""
        return self.polygons[0].min(axis=0), self.polygons[0].max(axis=0)

    @property
    def size_mm(self) -> Floats:
        """Width and height of the bounding box."""
        low, high = self.bounds_mm
        return np.asarray(high - low)

    @property
    def period_mm(self) -> Floats | None:
        """Width and height after which a periodic arena repeats; None if it has walls."""
        return self.size_mm if self.is_periodic else None

    def shape(self) -> shapely.Polygon:
        """Floor of the arena as a shapely polygon, with holes; self-crossing outlines are mended as GEOS does it."""
        import shapely

        if self.is_periodic:
            return shapely.box(*np.concatenate(self.bounds_mm))
        polygon = shapely.Polygon(self.polygons[0], self.polygons[1:])
        return polygon if polygon.is_valid else polygon.buffer(0)

    @property
    def area_mm2(self) -> float:
        """Area of the floor, without holes; of a periodic arena, that of the bounding box."""
        return float(self.shape().area)

    def minimum_image(self, offset_mm: npt.ArrayLike) -> Floats:
        """Return the shortest of all images of an offset. Shape (..., 2) to the same; unchanged unless periodic."""
        return minimum_image(offset_mm, self.period_mm)

    def wrap(self, position_mm: Floats) -> Floats:
        """Return positions in the box of a periodic arena, lower borders included. Others stay. Shape (..., 2), mm."""
        if not self.is_periodic:
            return position_mm
        offset = np.mod(position_mm - self.bounds_mm[0], self.size_mm)
        # For a tiny negative number, mod gives the size itself.
        return np.asarray(self.bounds_mm[0] + np.where(offset < self.size_mm, offset, 0.0))
