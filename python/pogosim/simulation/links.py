"""Links between bodies of a run: what they are, making and cutting them."""

from __future__ import annotations

from ctypes import byref, c_size_t, c_void_p
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.arguments import shown
from pogosim.simulation.arrays import RunState, chosen_rows
from pogosim.simulation.errors import ConfigurationError, given
from pogosim.simulation.library import LinkState, check, library
from pogosim.simulation.objects import WorldObject

KINDS = ("spring", "rod", "hinge")
ARENA = -1
LINK = np.dtype(
    [
        ("kind", "U6"),
        ("a", np.int32),
        ("b", np.int32),
        ("robot_a", np.int32),
        ("robot_b", np.int32),
        ("end_a_mm", np.float64, (2,)),
        ("end_b_mm", np.float64, (2,)),
        ("rest_mm", np.float64),
        ("stiffness_n_m", np.float64),
        ("damping_n_s_m", np.float64),
        ("breaking_n", np.float64),
        ("least_rad", np.float64),
        ("most_rad", np.float64),
        ("length_mm", np.float64),
        ("tension_n", np.float64),
        ("is_cut", np.bool_),
    ]
)


def links_of(run: RunState) -> npt.NDArray[Any]:
    """Return all links of a run. Shape (links,), of type LINK; a copy."""
    found: npt.NDArray[Any] = np.zeros(0, dtype=np.dtype(LinkState))
    count = c_size_t(int(run.number("link_count")))
    while True:  # another thread may make links meanwhile
        found = np.zeros(count.value, dtype=found.dtype)
        check(library().pogosim_run_links(run.pointer, found.ctypes.data_as(c_void_p), len(found), byref(count)))
        if count.value <= len(found):
            break
    found = found[: count.value]
    links = np.zeros(len(found), dtype=LINK)
    for name in LINK.names or ():
        links[name] = np.array(KINDS)[found["kind"]] if name == "kind" else found[name]
    return links


def object_index(name: str, value: Any, count: int) -> int:
    """Return the index of an object, which is given by itself or by this index.

    Raises:
        ConfigurationError: It is none of the run.
    """
    index = given.integer(name, value.index if isinstance(value, WorldObject) else value)
    if not 0 <= index < count:
        raise ConfigurationError(f"{name}: there is no object {shown(index)}: the run has {count}")
    return index


def make_link(
    run: RunState,
    a: Any,
    b: Any,
    kind: Any,
    *,
    end_a: Any,
    end_b: Any,
    length: Any,
    stiffness: Any,
    damping: Any,
    breaking_force: Any,
    limits: Any,
) -> int:
    """Make a link, see `Simulation.link`. Returns its index."""
    if not isinstance(kind, str) or kind not in KINDS:
        raise given.refused("kind", "'spring', 'rod' or 'hinge'", kind)
    count = int(run.number("object_count"))
    first = object_index("a", a, count)
    is_place = not isinstance(b, WorldObject) and np.ndim(b) == 1
    second = ARENA if is_place else object_index("b", b, count)
    link = LinkState()
    check(library().pogosim_run_new_link(run.pointer, KINDS.index(kind), first, second, byref(link)))
    if is_place:
        if end_b is not None:
            raise ConfigurationError("end_b: b is a place, which has no end of its own")
        link.end_b_mm[:] = given.numbers("b", b, 2)
    for name, end, place in (("end_a", end_a, link.end_a_mm), ("end_b", end_b, link.end_b_mm)):
        if end is not None:
            place[:] = given.numbers(name, end, 2)
    if length is not None:
        link.rest_mm = given.finite("length", length)
    link.stiffness_n_m = given.finite("stiffness", stiffness)
    link.damping_n_s_m = given.finite("damping", damping)
    link.breaking_n = given.number("breaking_force", breaking_force)
    if limits is not None:
        link.least_rad, link.most_rad = given.numbers("limits", limits, 2)
    index = c_size_t()
    check(library().pogosim_run_add_link(run.pointer, byref(link), byref(index)))
    return index.value


def cut_links(run: RunState, links: Any) -> None:
    """Cut links, see `Simulation.cut`."""
    count = int(run.number("link_count"))
    chosen = chosen_rows("links", links, count, "link", "the run has")
    indices = np.ascontiguousarray(chosen, dtype=np.uint32)
    check(library().pogosim_run_cut_links(run.pointer, indices.ctypes.data_as(c_void_p), len(indices)))
