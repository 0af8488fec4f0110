"""The simulator's painter, which draws the window, for recorded runs (include/pogosim/painter.h)."""

from __future__ import annotations

import ctypes
import json
import re
from ctypes import byref, c_char_p, c_double, c_float, c_int, c_size_t, c_uint32, c_void_p
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.errors import PictureError
from pogosim.shapes import Floats
from pogosim.simulation.errors import SimulationError
from pogosim.simulation.library import check, library

Numbers = npt.NDArray[np.uint32]
Picture = npt.NDArray[np.uint8]

# Pairs of objects of which the first is heard by the second; the third number tells whether that one is heard, too.
HEARD = np.dtype([("sender", "<u4"), ("listener", "<u4"), ("is_mutual", "<i4")])
LINK = np.dtype([("kind", "<i4"), ("is_pinned", "<i4"), ("from_mm", "<f4", 2), ("to_mm", "<f4", 2), ("load", "<f4")])
LINK_KINDS = ("spring", "rod", "hinge")  # by number


class StageData(ctypes.Structure):
    """`struct pogosim_stage`."""

    _fields_ = (
        ("description", c_char_p),
        ("corners_mm", c_void_p),
        ("corner_counts", c_void_p),
        ("polygon_count", c_size_t),
        ("kinds", c_void_p),
        ("ids", c_void_p),
        ("part_counts", c_void_p),
        ("object_count", c_size_t),
    )


class MomentData(ctypes.Structure):
    """`struct pogosim_moment`."""

    _fields_ = (
        ("time_s", c_double),
        ("poses", c_void_p),
        ("rgb", c_void_p),
        ("parts_mm", c_void_p),
        ("lamps_mm", c_void_p),
        ("light", c_void_p),
        ("trail_mm", c_void_p),
        ("trail_rgb", c_void_p),
        ("trail_counts", c_void_p),
        ("trail_fading", c_uint32),
        ("infrared_links", c_void_p),
        ("infrared_link_count", c_size_t),
        ("body_links", c_void_p),
        ("body_link_count", c_size_t),
        ("velocity_mm_s", c_void_p),
        ("heat", c_void_p),
        ("heat_low", c_float),
        ("heat_high", c_float),
    )


@dataclass(frozen=True)
class Stage:
    """What does not change during a run. Lengths in mm."""

    description: dict[str, Any]  # as the header says
    polygons: list[Floats]  # each of shape (corners, 2), the outer wall first
    kinds: Numbers  # shape (n,): index into the kinds of the description, of each object
    ids: Numbers  # shape (n,): as in the data file
    part_counts: Numbers  # shape (n,): parts of membranes, 0 of everything else


@dataclass(frozen=True)
class Trails:
    """Where objects have been. Lengths in mm."""

    places: npt.NDArray[np.float32]  # shape (points, 2), one object after the other, oldest first
    rgb: Numbers  # shape (points,): 0xRRGGBB
    counts: Numbers  # shape (n,): points of each object
    fading: int  # trails fade over so many points, at least 1


@dataclass(frozen=True)
class Moment:
    """A run at one time. Lengths in mm."""

    time_s: float  # that the picture says
    poses: npt.NDArray[np.float32]  # shape (n, 3): x, y, heading (rad); NaN: there is none
    rgb: Numbers  # shape (n,): 0xRRGGBB
    parts: npt.NDArray[np.float32]  # shape (parts, 2): of membranes, in the order of objects
    lamps: npt.NDArray[np.float32]  # shape (lamps, 2)
    light: npt.NDArray[np.int16] | None = None  # shape (rows, columns), 0 to 32767; None: as in the moment before
    trails: Trails | None = None
    heard: npt.NDArray[Any] | None = None  # of HEARD, shape (pairs,)
    links: npt.NDArray[Any] | None = None  # of LINK, shape (links,)
    velocities: npt.NDArray[np.float32] | None = None  # shape (n, 2), mm/s; NaN: it has none
    heat: npt.NDArray[np.float32] | None = None  # shape (n,): what the heat map shows, if that is a value; NaN: none
    heat_span: tuple[float, float] = (0.0, 0.0)  # the values at which its colours begin and end


def fits(name: str, values: npt.NDArray[Any], kind: npt.DTypeLike, shape: tuple[int, ...]) -> int:
    """Return the address of an array that the library reads.

    Raises:
        ValueError: It has another type, shape or order.
    """
    if values.dtype != np.dtype(kind) or values.shape != shape or not values.flags.c_contiguous:
        raise ValueError(
            f"{name}: expected an array of {np.dtype(kind)} of shape {shape}, row by row; "
            f"found {values.dtype} of shape {values.shape}"
        )
    return int(values.ctypes.data)


def picture_error(error: SimulationError) -> PictureError:
    """Return an error of the library in words for those that have a data file, and no configuration."""
    return PictureError(re.sub(r"\bdescription:\d+: | \(--strict\)", "", str(error)))


class Painter:
    """Draws the moments of one run. Not for several threads at the same time."""

    def __init__(self, stage: Stage) -> None:
        """Take over what stands still.

        Raises:
            PictureError: There is no library, or it cannot draw this.
            ValueError: Arrays do not belong together.
        """
        description = stage.description
        self.objects = len(stage.kinds)
        self.parts = int(stage.part_counts.sum())
        self.lamps = len(description["lamps"])
        self.cells = (int(description["light_map"]["rows"]), int(description["light_map"]["columns"]))
        corners = np.ascontiguousarray(np.concatenate(stage.polygons), dtype=np.float32)
        counts = np.array([len(polygon) for polygon in stage.polygons], dtype=np.uint32)
        data = StageData(
            json.dumps(description, allow_nan=False).encode(),
            corners.ctypes.data,
            counts.ctypes.data,
            len(counts),
            fits("kinds", stage.kinds, np.uint32, (self.objects,)),
            fits("ids", stage.ids, np.uint32, (self.objects,)),
            fits("part_counts", stage.part_counts, np.uint32, (self.objects,)),
            self.objects,
        )
        self.pointer = c_void_p()
        try:
            self.library = library()
            check(self.library.pogosim_painter_open(byref(data), byref(self.pointer)))
        except SimulationError as error:
            raise picture_error(error) from error

    def __del__(self) -> None:
        if getattr(self, "pointer", None):
            self.library.pogosim_painter_close(self.pointer)
            self.pointer = c_void_p()

    def shows(self, part: str) -> bool:
        """Tell whether pictures show "trails", "light_levels", "links" (infrared) or "velocities"."""
        is_shown = c_int()
        check(self.library.pogosim_painter_shows(self.pointer, part.encode(), byref(is_shown)))
        return bool(is_shown.value)

    def draw(self, moment: Moment, picture: Picture) -> None:
        """Draw a moment. Other threads of Python go on meanwhile.

        Args:
            moment: With as many objects, parts and lamps as the stage.
            picture: Red, green and blue, shape (height, width, 3), to be filled; may be a part of a larger one.

        Raises:
            ValueError: An array has the wrong shape.
            PictureError: It cannot be drawn.
        """
        height, width = picture.shape[:2]
        if picture.dtype != np.uint8 or picture.shape[2:] != (3,) or picture.strides[1:] != (3, 1):
            raise ValueError("picture: expected bytes of shape (height, width, 3), row by row")
        data = self.data_of(moment)
        drawn = self.library.pogosim_painter_draw(
            self.pointer, byref(data), width, height, picture.ctypes.data, picture.strides[0]
        )
        try:
            check(drawn)
        except SimulationError as error:
            raise picture_error(error) from error

    def data_of(self, moment: Moment) -> MomentData:
        """Return where the arrays of a moment are."""
        data = MomentData(
            time_s=moment.time_s,
            poses=fits("poses", moment.poses, np.float32, (self.objects, 3)),
            rgb=fits("rgb", moment.rgb, np.uint32, (self.objects,)),
            parts_mm=fits("parts", moment.parts, np.float32, (self.parts, 2)),
            lamps_mm=fits("lamps", moment.lamps, np.float32, (self.lamps, 2)),
        )
        if moment.light is not None:
            data.light = fits("light", moment.light, np.int16, self.cells)
        if (trails := moment.trails) is not None:
            data.trail_counts = fits("trails.counts", trails.counts, np.uint32, (self.objects,))
            points = int(trails.counts.sum(dtype=np.int64))
            data.trail_mm = fits("trails.places", trails.places, np.float32, (points, 2))
            data.trail_rgb = fits("trails.rgb", trails.rgb, np.uint32, (points,))
            data.trail_fading = trails.fading
        if moment.heard is not None:
            data.infrared_links = fits("heard", moment.heard, HEARD, (len(moment.heard),))
            data.infrared_link_count = len(moment.heard)
        if moment.links is not None:
            data.body_links = fits("links", moment.links, LINK, (len(moment.links),))
            data.body_link_count = len(moment.links)
        if moment.velocities is not None:
            data.velocity_mm_s = fits("velocities", moment.velocities, np.float32, (self.objects, 2))
        if moment.heat is not None:
            data.heat = fits("heat", moment.heat, np.float32, (self.objects,))
            data.heat_low, data.heat_high = moment.heat_span
        return data
