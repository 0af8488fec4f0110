"""How large robots are, how far they reach and how fast they drive: each as its own category says."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.analysis.arena import Floats
from pogosim.arguments import number
from pogosim.defaults import COMMUNICATION_RADIUS_MM, POGOBOT_RADIUS_MM
from pogosim.object_facts import entry_of, facts_of

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


def sizes_of(category: npt.NDArray[np.object_], setting: Setting, told: Any = None) -> Sizes:
    """Return the sizes of robots; of pogobots where nothing is said.

    Args:
        category: Category of each robot, shape (N,).
        setting: Value of a configuration entry, by its dotted path; None if there is none.
        told: The metadata `objects`; None: there are none.
    """
    names = list(dict.fromkeys(map(str, category)))
    known = {name: sizes_in(name, setting, told) for name in names}
    values = np.array([fastest_of(known[str(name)]) for name in category], dtype=float).reshape(len(category), 3)
    lists = "; ".join(filter(None, map(differences, known, known.values())))
    return Sizes(category, values[:, 0], values[:, 1], values[:, 2], lists)


def sizes_in(category: str, setting: Setting, told: Any) -> list[Values]:
    """Return the values of the entry of a category, or of each entry if it is a list."""
    path = f"objects.{category}"
    paths: list[str] = []
    while any(setting(f"{path}.{len(paths)}.{key}") is not None for key in ("type", "nb")):
        paths.append(f"{path}.{len(paths)}")
    paths = paths or [path]
    return [
        values_at(own, setting, facts) for own, facts in zip(paths, facts_of(told, category, len(paths)), strict=True)
    ]


def fastest_of(entries: list[Values]) -> Values:
    """Return the values of the first entry, with the top speed of the fastest one."""
    return *entries[0][:2], max((speed for *_, speed in entries if math.isfinite(speed)), default=math.nan)


def differences(category: str, entries: list[Values]) -> str:
    """Return what entries of a category say of size and reach; empty if it is the same."""
    said = dict.fromkeys(f"radius {radius:g} mm and reach {reach:g} mm" for radius, reach, _ in entries)
    return f"the entries of objects.{category} differ: {', '.join(said)}" if len(said) > 1 else ""


def values_at(path: str, setting: Setting, told: Mapping[str, Any] | None) -> Values:
    """Return the values of the entry at a path, of which the metadata say what is told."""
    keys = ("type", "communication_radius", "max_linear_speed")
    given = {key: value for key in keys if (value := setting(f"{path}.{key}")) is not None}
    # Where nothing says what they are, their speed is unknown.
    own = entry_of(path, given if "type" in given else {"type": "active_object", **given}, told)
    radius_mm = number(setting(f"{path}.radius"), POGOBOT_RADIUS_MM)
    range_mm = own.infrared_range_mm if "robot" in own.has else COMMUNICATION_RADIUS_MM
    return radius_mm, range_mm + 2.0 * radius_mm, own.top_speed_mm_s
