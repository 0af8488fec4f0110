"""Arrays of a run, where the simulator has them."""

from __future__ import annotations

from ctypes import byref, c_void_p
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.simulation.library import ArrayPlace, check, library


class Memory:
    """Memory of a run, for NumPy. The array made of it keeps `owner` alive."""

    def __init__(self, place: ArrayPlace, owner: object) -> None:
        self.owner = owner
        shape = tuple(place.shape[: place.dimensions])
        self.__array_interface__: dict[str, Any] = {
            "version": 3,
            "shape": shape,
            "typestr": place.type.decode(),
            "data": (place.data or 0, True),  # read-only
            "strides": tuple(place.stride_bytes[: place.dimensions]),
        }


def array_of(handle: c_void_p, name: str, owner: object) -> npt.NDArray[Any]:
    """Return an array of a run as a read-only view.

    Args:
        handle: The run.
        name: As in pogosim/host.h, such as "bodies.position".
        owner: Keeps the run as long as the array exists.
    """
    place = ArrayPlace()
    check(library().pogosim_run_array(handle, name.encode(), byref(place)))
    if not place.data:
        return np.zeros(tuple(place.shape[: place.dimensions]), dtype=place.type.decode())
    return np.asarray(Memory(place, owner))
