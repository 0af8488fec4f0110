"""How large robots are, how far they reach and how fast they drive: each as its own category says."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.analysis.arena import Floats
from pogosim.arguments import number
from pogosim.defaults import COMMUNICATION_RADIUS_MM, POGOBOT_RADIUS_MM

Setting = Callable[[str], Any]
Values = tuple[float, float, float]  # radius in mm, reach in mm, and top speed in mm/s, NaN if unknown


class DifferentRobotsWarning(RuntimeWarning):
    """An analysis takes one size or one reach for robots that differ in it."""


@dataclass(frozen=True)
class Sizes:
    """Sizes of N robots. They are in the order of their categories."""

    category: npt.NDArray[np.object_]  # (N,)
    radius_mm: Floats  # (N,)
    reach_mm: Floats  # (N,), communication_radius + 2 radius
    top_speed_mm_s: Floats  # (N,), NaN where the file does not say, or a robot does not drive
    lists: str = ""  # of categories that are lists of entries which differ in size or reach: what the entries say

    def with_reach(self, reach_mm: float) -> Sizes:
        """Return the sizes with one reach for all."""
        return replace(self, reach_mm=np.full(len(self.reach_mm), reach_mm))

    def one(self, name: str) -> float:
        """Return the value of all robots, `radius_mm` or `reach_mm`.

        Warns:
            DifferentRobotsWarning: They differ; it is that of the first category.
        """
        values: Floats = getattr(self, name)
        if self.lists:
            warnings.warn(
                f"{self.lists}: this analysis takes the first entry for all. Give them categories of their own",
                DifferentRobotsWarning,
                stacklevel=4,
            )
        if np.any(values != values[0]):
            _, places = np.unique(self.category.astype(str), return_index=True)
            each = ", ".join(f"{values[place]:g} mm of {self.category[place]}" for place in places)
            word, choice = {
                "radius_mm": ("radius", ""),
                "reach_mm": ("reach of neighbours", " or a reach (--rc, reach_mm=)"),
            }[name]
            warnings.warn(
                f"robots differ in their {word}: {each}; this analysis takes {values[0]:g} mm for all. Choose one "
                f"category (--category, category=){choice}",
                DifferentRobotsWarning,
                stacklevel=4,
            )
        return float(values[0])


def sizes_of(category: npt.NDArray[np.object_], setting: Setting) -> Sizes:
    """Return the sizes of robots; of pogobots where nothing is said.

    Args:
        category: Category of each robot, shape (N,).
        setting: Value of a configuration entry, by its dotted path; None if there is none.
    """
    names = list(dict.fromkeys(map(str, category)))
    known = {name: sizes_in(name, setting) for name in names}
    values = np.array([fastest_of(known[str(name)]) for name in category], dtype=float).reshape(len(category), 3)
    lists = "; ".join(filter(None, map(differences, known, known.values())))
    return Sizes(category, values[:, 0], values[:, 1], values[:, 2], lists)


def sizes_in(category: str, setting: Setting) -> list[Values]:
    """Return the values of the entry of a category, or of each entry if it is a list."""
    found: list[Values] = []
    while entry := entry_of(category, len(found), setting):
        found.append(entry)
    return found or [values_at(f"objects.{category}", setting)]


def fastest_of(entries: list[Values]) -> Values:
    """Return the values of the first entry, with the top speed of the fastest one."""
    return *entries[0][:2], max((speed for *_, speed in entries if math.isfinite(speed)), default=math.nan)


def differences(category: str, entries: list[Values]) -> str:
    """Return what entries of a category say of size and reach; empty if it is the same."""
    said = dict.fromkeys(f"radius {radius:g} mm and reach {reach:g} mm" for radius, reach, _ in entries)
    return f"the entries of objects.{category} differ: {', '.join(said)}" if len(said) > 1 else ""


def entry_of(category: str, place: int, setting: Setting) -> Values | None:
    """Return the values of an entry of a category that is a list of entries; None if there is no such entry."""
    path = f"objects.{category}.{place}"
    return None if setting(f"{path}.type") is None and setting(f"{path}.nb") is None else values_at(path, setting)


def values_at(path: str, setting: Setting) -> Values:
    """Return the values of the entry at a path."""
    radius_mm = number(setting(f"{path}.radius"), POGOBOT_RADIUS_MM)
    range_mm = number(setting(f"{path}.communication_radius"), COMMUNICATION_RADIUS_MM)
    speed = number(setting(f"{path}.max_linear_speed"), math.nan) if setting(f"{path}.type") == "pogobot" else math.nan
    return radius_mm, range_mm + 2.0 * radius_mm, speed if math.isfinite(speed) else math.nan
