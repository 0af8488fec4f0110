"""What the objects of each entry of `objects` have, the ids of their objects, and how they are drawn.

A data file says it in its metadata `objects`, so nothing here depends on the types of objects and lamps that there are.
Only files without that entry, and configurations that no run has read, need `told_by_type`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pogosim.arguments import number
from pogosim.defaults import COMMUNICATION_RADIUS_MM
from pogosim.several_files import configuration_of
from pogosim.varied import OBJECTS as OBJECTS
from pogosim.varied import is_facts

TYPES: dict[str, dict[str, Any]] = {
    "pogobot": {"has": ["body", "robot", "motors"]},
    "pogobject": {"has": ["body", "robot"]},
    "active_object": {"has": ["body", "robot"]},
    "passive_object": {"has": ["body"]},
    "pogowall": {"has": ["robot"]},
    "membrane": {"has": ["body", "membrane", "robot"], "segments": False},
    "rectmembrane": {"has": ["body", "membrane", "robot"], "segments": True},
    "static_light": {"has": ["lamp"], "drawn_as": "spot"},
    "orbiting_static_light": {"has": ["lamp"], "drawn_as": "spot"},
    "orbiting_light": {"has": ["lamp"], "drawn_as": "spot"},
    "rotating_ray_of_light": {"has": ["lamp"], "drawn_as": "beam"},
    "alternating_rays_of_light": {"has": ["lamp"], "drawn_as": "beam"},
}


@dataclass(frozen=True)
class Entry:
    """One entry of `objects`."""

    category: str
    settings: dict[str, Any]  # its keys
    has: frozenset[str]  # body, membrane, robot (it runs a program), motors, lamp
    drawn_as: str = ""  # of a lamp: spot (by its keys), beam or nothing
    segments: bool = False  # of a membrane
    half_thickness_mm: float = 0.0  # of a membrane
    infrared_range_mm: float = 0.0  # of what runs a program; from an emitter to the edge of a listener
    top_speed_mm_s: float = math.nan  # of what has motors; NaN: unknown
    position_mm: tuple[float, float] | None = None  # of a wall, where it has one
    count: int | None = None  # how many objects there are; None: the file does not say
    first_id: int | None = None  # ids of its objects follow each other; None: unknown, or there are none

    @property
    def is_robot(self) -> bool:
        """Whether its objects run a program and have a rigid body; their ids are 0, 1, ..."""
        return {"robot", "body"} <= self.has and "membrane" not in self.has

    @property
    def is_wall(self) -> bool:
        """Whether its objects run a program and have no body."""
        return "robot" in self.has and "body" not in self.has

    @property
    def knows_ids(self) -> bool:
        """Whether the file says which ids its objects have."""
        return self.count is not None and (self.count == 0 or self.first_id is not None)


def type_of(settings: Mapping[str, Any]) -> str:
    """Type of an entry in lower case."""
    return str(settings.get("type", "pogobot")).lower()


def told_by_type(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return what an entry of a file without metadata `objects` has: of the types that there were without them."""
    return TYPES.get(type_of(settings), TYPES["passive_object"])


def entry_of(category: str, settings: dict[str, Any], told: Mapping[str, Any] | None = None) -> Entry:
    """Return an entry from its keys.

    Args:
        category: Its name.
        settings: Its keys.
        told: What the metadata say of it. What they do not, such as what differs between the runs of a file, is taken
            from the keys. None: nothing.
    """
    told = told_by_type(settings) if told is None else told
    has = frozenset(map(str, told["has"]))
    segments = told.get("segments") is True

    def value(fact: str, key: str, default: float) -> float:
        return number(told.get(fact), number(settings.get(key), default))

    dot_radius_mm = number(settings.get("dot_radius"), 10.0)
    thickness_mm = number(settings.get("rect_thickness"), dot_radius_mm)
    half_thickness_mm = thickness_mm / 2.0 if segments else dot_radius_mm
    count, first_id = (told.get(name) for name in ("count", "first_id"))
    return Entry(
        category=category,
        settings=settings,
        has=has,
        drawn_as=str(told.get("drawn_as", "")),
        segments=segments,
        half_thickness_mm=number(told.get("half_thickness_mm"), half_thickness_mm) if "membrane" in has else 0.0,
        infrared_range_mm=value("infrared_range_mm", "communication_radius", COMMUNICATION_RADIUS_MM)
        if "robot" in has
        else 0.0,
        top_speed_mm_s=value("top_speed_mm_s", "max_linear_speed", math.nan) if "motors" in has else math.nan,
        position_mm=position_in(told, settings) if has == {"robot"} else None,
        count=count if isinstance(count, int) else None,
        first_id=first_id if isinstance(first_id, int) else None,
    )


def position_in(told: Mapping[str, Any], settings: Mapping[str, Any]) -> tuple[float, float] | None:
    """Return the x and y of an entry, mm; None unless it has both."""
    given = told.get("position_mm")
    pair = given if isinstance(given, list) and len(given) == 2 else [settings.get("x"), settings.get("y")]
    x, y = (number(value, math.nan) for value in pair)
    return (x, y) if math.isfinite(x) and math.isfinite(y) else None


def entries_in(configuration: Mapping[str, Any], told: Any = None) -> list[Entry]:
    """Return the entries of `objects` that are maps, in their order; a category may be a list of several.

    Args:
        configuration: That of a run.
        told: The metadata `objects`; None: there are none.
    """
    objects = configuration.get(OBJECTS)
    entries = []
    for name, value in objects.items() if isinstance(objects, dict) else ():
        own = value if isinstance(value, list) else [value]
        facts = facts_of(told, str(name), len(own))
        entries += [
            entry_of(str(name), settings, fact)
            for settings, fact in zip(own, facts, strict=True)
            if isinstance(settings, dict)
        ]
    return entries


def entries_of(metadata: Mapping[str, Any]) -> list[Entry]:
    """Return the entries of a data file, by its metadata as `load_dataframe` returns them."""
    return entries_in(configuration_of(dict(metadata)), metadata.get(OBJECTS))


def facts_of(told: Any, category: str, count: int) -> Sequence[Mapping[str, Any] | None]:
    """Return what metadata `objects` say of each of so many entries of a category; None: nothing."""
    found = told.get(category) if isinstance(told, Mapping) else None
    if not isinstance(found, list) or len(found) != count or not all(map(is_facts, found)):
        return [None] * count
    return found
