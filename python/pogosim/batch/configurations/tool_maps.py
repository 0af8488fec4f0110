"""The maps `pogobatch` and `_rundr` of a configuration: for the batch tools, and never seen by a simulator.

    pogobatch:
        result_filename_format: "result_{objects.robots.nb}.feather"
        result_new_columns: [arena_file]
    _rundr: {version: 1, seeds: "0:99"}

What is in the first one may also stand at the top level, and takes precedence over what stands there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from pogosim.batch.configurations.names import COLUMNS, FORMAT
from pogosim.batch.configurations.option_words import CombinationsError, is_slip_of, shown
from pogosim.batch.configurations.seeds import seeds_between, seeds_up_to
from pogosim.batch.errors import BatchError
from pogosim.nearest_name import advice

POGOBATCH = "pogobatch"
RUNDR = "_rundr"
RESULT_KEYS = (FORMAT, COLUMNS)
SCHEDULER = "rundra"  # settings of a scheduler that is not used here
VERSION = 1

Path = tuple[str, ...]
Warn = Callable[[Path, str], None]  # with a path in the configuration, and what is wrong there


@dataclass(frozen=True)
class ToolMaps:
    """What the maps say.

    Attributes:
        entries: The configuration without them; what they say of results is at the top level.
        moved: Where in the file the keys at the top level stand that come from a map.
        seeds: Seeds of `_rundr`; None: it has none.
    """

    entries: dict[str, Any]
    moved: dict[str, Path] = field(default_factory=dict)
    seeds: range | None = None


def without_tool_maps(entries: dict[str, Any], warn: Warn) -> ToolMaps:
    """Return a configuration without these maps, and what they say.

    Raises:
        CombinationsError: One of them is wrong.
    """
    for key in entries:
        if is_slip_of(POGOBATCH, str(key)):
            raise CombinationsError((), f"unknown key {shown(str(key))}; did you mean '{POGOBATCH}'?", str(key))
    kept = {key: value for key, value in entries.items() if key not in (POGOBATCH, RUNDR)}
    moved: dict[str, Path] = {}
    for key, value in map_at(entries, POGOBATCH, (*RESULT_KEYS, SCHEDULER), warn).items():
        if key not in RESULT_KEYS or value is None:
            continue
        if kept.get(key) is not None:
            warn((key,), f"is not used: {POGOBATCH}.{key} comes first; remove one of them")
        kept[key] = value
        moved[key] = (POGOBATCH, key)
    return ToolMaps(kept, moved, seeds_in(map_at(entries, RUNDR, ("version", "seeds"), warn)))


def map_at(entries: dict[str, Any], name: str, keys: tuple[str, ...], warn: Warn) -> dict[str, Any]:
    """Return one of the maps; empty if there is none.

    Raises:
        CombinationsError: It is no map, or misspells one of its keys.
    """
    found = entries.get(name)
    if found is None:
        return {}
    if not isinstance(found, dict):
        raise CombinationsError((name,), f"expected a map with {' and '.join(keys)}, found {shown(found)}")
    for key in found:
        if slip := next((word for word in keys if is_slip_of(word, str(key))), None):
            raise CombinationsError((name,), f"unknown key {shown(str(key))}; did you mean '{slip}'?", str(key))
        if key not in keys:
            warn((name, str(key)), f"unknown key, which has no effect{advice(str(key), keys)}")
    return found


def seeds_in(found: dict[str, Any]) -> range | None:
    """Return the seeds that `_rundr` asks for: a number of them, or the first and the last one.

    Raises:
        CombinationsError: It is of another version, or they are wrong.
    """
    version, seeds = found.get("version", VERSION), found.get("seeds")
    if version != VERSION or isinstance(version, bool):
        raise CombinationsError((RUNDR, "version"), f"expected {VERSION}, found {shown(version)}")
    if seeds is None:
        return None
    try:
        if isinstance(seeds, int) and not isinstance(seeds, bool):
            return seeds_up_to(int(seeds), "seeds")
        if isinstance(seeds, str):
            return seeds_between(seeds, "seeds")
    except BatchError as error:
        raise CombinationsError((RUNDR, "seeds"), str(error).removeprefix("seeds: ")) from None
    raise CombinationsError((RUNDR, "seeds"), f'expected a number of seeds, or "A:B", found {shown(seeds)}')
