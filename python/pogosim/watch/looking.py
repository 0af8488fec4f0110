"""What a viewer shows of a run: its objects at one moment."""

from __future__ import annotations

import ctypes
from ctypes import byref, c_double, c_int64, c_void_p
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from pogosim.simulation.arrays import RunState
from pogosim.simulation.library import check, library

NO_LED = 2**32 - 1  # of what runs no program


class View(ctypes.Structure):
    """`struct pogosim_view`."""

    _fields_ = (
        ("time_s", c_double),
        ("step", c_int64),
        ("poses", c_void_p),
        ("led_rgb", c_void_p),
        ("parts_mm", c_void_p),
        ("parts_of", c_void_p),
    )


@dataclass(frozen=True)
class Look:
    """Objects (n) and the parts of membranes (m) at one moment.

    Attributes:
        time_s: Simulated time.
        step: Time steps since the beginning.
        poses: x and y, mm; heading, rad, NaN of membranes. Shape (n, 3).
        leds: Head LEDs, 0xRRGGBB; `NO_LED`: the object runs no program. Shape (n,).
        parts_mm: x and y of the parts of membranes. Shape (m, 2).
        columns: Other values of the objects by name, NaN where there is none. Shape (n,) each.
    """

    time_s: float
    step: int
    poses: npt.NDArray[np.float32]
    leds: npt.NDArray[np.uint32]
    parts_mm: npt.NDArray[np.float32]
    columns: dict[str, npt.NDArray[np.float32]] = field(default_factory=dict)


def look_at(run: RunState, columns: dict[str, npt.NDArray[np.float32]] | None = None) -> Look:
    """Look at a run between two time steps."""
    objects, parts = int(run.number("object_count")), int(run.number("part_count"))
    poses = np.empty((objects, 3), np.float32)
    leds = np.empty(objects, np.uint32)
    parts_mm = np.empty((parts, 2), np.float32)
    view = View(poses=poses.ctypes.data, led_rgb=leds.ctypes.data, parts_mm=parts_mm.ctypes.data)
    check(library().pogosim_run_look(run.pointer, byref(view)))
    return Look(view.time_s, view.step, poses, leds, parts_mm, columns or {})


def owners_of_parts(run: RunState) -> npt.NDArray[np.uint32]:
    """Return the index of the object that each part of a membrane belongs to. Shape (m,)."""
    owners = np.empty(int(run.number("part_count")), np.uint32)
    view = View(parts_of=owners.ctypes.data)
    check(library().pogosim_run_look(run.pointer, byref(view)))
    return owners
