"""The categories of objects in a file without the column robot_category: by their ids.

The metadata `objects` say which ids each entry has. Where they do not, as in older files and in those of several runs
with different numbers of objects, the configuration does: objects with a program and a rigid body have the ids 0, 1,
... in its order, all others 65535, 65534, ..., or from the number of objects on downwards if there are more than 65536
(ObjectMaker in src/sim/build_world.cpp).
"""

from __future__ import annotations

import copy
from collections.abc import Mapping
from itertools import combinations
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.arguments import number
from pogosim.batch.configurations.paths import set_in_dict
from pogosim.deferred import pandas as pd
from pogosim.object_facts import OBJECTS, Entry, entries_in, entries_of
from pogosim.run_columns import is_one_run
from pogosim.scene import Kind, bodies_of, read_periodic
from pogosim.several_files import configuration_of

IDS_ON_AIR = 65536


class UnknownCategoriesError(ValueError):
    """Nothing says which rows are those of robots."""


def with_categories(rows: pd.DataFrame, metadata: Mapping[str, Any]) -> pd.DataFrame:
    """Return rows with the column robot_category: from the ids of objects and the configuration, if it is not there.

    Where there is no configuration, all are robots.

    Raises:
        UnknownCategoriesError: There are several categories, and the configuration does not say whose an id is.
    """
    if "robot_category" in rows:
        return rows
    configuration = configuration_of(dict(metadata))
    varied = [str(name) for name in rows.columns if str(name).startswith(f"{OBJECTS}.")]
    if not varied or is_one_run(rows, metadata):
        return rows.assign(robot_category=categories_of(rows, configuration, metadata))
    names = np.empty(len(rows), dtype=object)
    for values, place in rows.groupby(varied, dropna=False, observed=True).indices.items():
        settings = dict(zip(varied, values if isinstance(values, tuple) else (values,), strict=True))
        names[place] = categories_of(rows.iloc[place], changed(configuration, settings), metadata)
    return rows.assign(robot_category=names)


def changed(configuration: dict[str, Any], settings: dict[str, Any]) -> dict[str, Any]:
    """Return a configuration with some settings of objects, by their dotted path.

    Raises:
        UnknownCategoriesError: A category is not in it, so that its place among the others is unknown.
    """
    result = copy.deepcopy(configuration)
    for path, value in settings.items():
        if path.split(".")[1] not in (result.get(OBJECTS) or {}):
            raise unknown("its runs have different categories of objects")
        set_in_dict(result, path, value)
    return result


def categories_of(rows: pd.DataFrame, configuration: dict[str, Any], metadata: Mapping[str, Any]) -> Any:
    """Return the categories of the objects of rows, of one configuration: an array, or one name for all."""
    entries = entries_in(configuration, metadata.get(OBJECTS))
    bodies = bodies_of(entries)
    recorded = recorded_categories(configuration) or {own.category for own in bodies} or {"robots"}
    if len(recorded) == 1:
        return next(iter(recorded))
    if "robot_id" not in rows:
        raise unknown("no column robot_id")
    if given := metadata.get("configuration"):
        check_categories(given, {own.category for own in entries})
    ids = rows["robot_id"].to_numpy()
    names = np.full(len(ids), None, dtype=object)
    for name, first, last in ids_of(bodies, read_periodic(configuration)):
        names[(ids >= first) & (ids <= last)] = name
    if any(name is None for name in names):
        raise unknown(f"none of its objects has the id {ids[[name is None for name in names]][0]}")
    return names


def last_kinds(rows: pd.DataFrame, kinds: list[Kind]) -> npt.NDArray[np.int64]:
    """Return the place of the last kind of the category of each row, shape (rows,); -1: there is none."""
    last = {kind.category: place for place, kind in enumerate(kinds)}
    return np.array(rows["robot_category"].map(last).fillna(-1), dtype=np.int64)


def kinds_of(rows: pd.DataFrame, metadata: Mapping[str, Any], kinds: list[Kind]) -> npt.NDArray[np.int64]:
    """Return which of the entries of the configuration (`pogosim.scene.bodies_of`) the object of each row is of.

    Args:
        rows: Those of one run, with the column robot_category.
        metadata: Those of the run.
        kinds: What `pogosim.scene.kinds_in` makes of its entries.

    Returns:
        Shape (rows,), integers; -1: of a category that is not in the configuration.

    Raises:
        UnknownCategoriesError: The entries of a category differ, and nothing says which objects are whose.
    """
    names = rows["robot_category"]
    numbers = last_kinds(rows, kinds)
    differ = {one.category for one, other in combinations(kinds, 2) if one.category == other.category and one != other}
    is_told_by_id = np.asarray(names.isin(differ))
    if not is_told_by_id.any():
        return numbers
    if "robot_id" not in rows:
        raise unknown("no column robot_id")
    ids = rows["robot_id"].to_numpy()
    is_periodic = read_periodic(configuration_of(dict(metadata)))
    for place, (name, first, final) in enumerate(ids_of(bodies_of(entries_of(metadata)), is_periodic)):
        is_own = is_told_by_id & (names == name).to_numpy() & (ids >= first) & (ids <= final)
        numbers[is_own] = place
        is_told_by_id = is_told_by_id & ~is_own
    if is_told_by_id.any():
        raise unknown("its configuration does not say how many objects each entry has")
    return numbers


def recorded_categories(configuration: dict[str, Any]) -> set[str]:
    """Return the categories that data_logger_category names; empty: all."""
    names = configuration.get("data_logger_category")
    return set(map(str, names if isinstance(names, list) else [names] if isinstance(names, str) else []))


def check_categories(given: Any, known: set[str]) -> None:
    """Raise UnknownCategoriesError if a batch has combinations with other categories than all have in common."""
    objects = given.get(OBJECTS) if isinstance(given, dict) else None
    names = [name for name, own in objects.items() if own is not None] if isinstance(objects, dict) else []
    lamps = {own.category for own in entries_in({OBJECTS: objects}) if "lamp" in own.has}
    if any(str(name) not in known | lamps for name in names):
        raise unknown("its runs have different categories of objects")


def ids_of(bodies: list[Entry], is_periodic: bool) -> list[tuple[str, int, int]]:
    """Return the first and the last id of the objects of each entry, in the order of the configuration."""
    if all(own.knows_ids for own in bodies):
        return [(own.category, own.first_id or 0, (own.first_id or 0) + (own.count or 0) - 1) for own in bodies]
    counts = [0.0 if is_periodic and own.is_wall else number(own.settings.get("nb"), -1.0) for own in bodies]
    if any(count < 0.0 or count != int(count) for count in counts):
        raise unknown("its configuration does not say how many objects of each category there are")
    up, down = 0, max(int(sum(counts)), IDS_ON_AIR) - 1
    ids = []
    for own, count in zip(bodies, map(int, counts), strict=True):
        if own.is_robot:
            ids.append((own.category, up, up + count - 1))
            up += count
        else:
            ids.append((own.category, down - count + 1, down))
            down -= count
    return ids


def unknown(reason: str) -> UnknownCategoriesError:
    """Return the error of rows whose categories are unknown."""
    return UnknownCategoriesError(
        f"it has no column robot_category, and {reason}, so nothing says which rows are those of robots; record "
        "robot_category, too (data_logger_fields)"
    )
