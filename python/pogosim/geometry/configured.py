"""The arena of a configuration, found and scaled as the simulator does it."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pogosim.batch.configurations.configuration import Configuration
from pogosim.batch.errors import BatchError
from pogosim.defaults import AREA_MM2
from pogosim.geometry.arena_file import ArenaError, Outline, read_arena, scaled
from pogosim.installation import InstallationError, find_installation
from pogosim.outputs import check_readable
from pogosim.yaml_1_2 import plain


def read_entries(path: Path) -> dict[str, Any]:
    """Return the entries of a configuration file, as a single run takes them.

    Raises:
        ToolError: It is none, or its options have other keys.
        OSError: It cannot be read.
    """
    check_readable([str(path)])
    try:
        configuration = Configuration(path)
    except BatchError as error:
        text = str(error)
        raise ArenaError(
            text if text.startswith(f"{path} is not a configuration") else f"{path} is not a configuration: {text}"
        ) from None
    return configuration.of_one_run()


def find_arena(name: str, configuration: Path) -> Path:
    """Return an arena file, looked for as the simulator does: here, next to the configuration, in Pogosim's own folder.

    Raises:
        ArenaError: There is none.
    """
    places = [Path(), configuration.parent]
    with contextlib.suppress(InstallationError):
        places.append(find_installation().template.parent)
    found = next((place / name for place in places if (place / name).is_file()), None)
    if found is None:
        raise ArenaError(f"there is no arena file {name} here, in {configuration.parent} or with Pogosim")
    return found


def area_of(value: Any, path: Path) -> float | None:
    """Return the area that a configuration asks for in mm2; None if the arena file is in mm."""
    if value == "file":
        return None
    if value is None:
        return AREA_MM2
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < float("inf"):
        raise ArenaError(f"{path}: arena_surface is {value}; expected a number above 0 (mm2), or 'file'")
    return float(value)


def arena_of(entries: Mapping[str, Any], path: Path, file: Path | None = None) -> tuple[Outline, Outline]:
    """Return the arena of a configuration as in its file, and in mm.

    Args:
        entries: The configuration, as a single run takes it.
        path: Its file, for messages, and beside which the arena is looked for.
        file: The arena file; None: what `arena_file` says.

    Raises:
        ArenaError: There is none, or it is wrong.
        OSError: It cannot be read.
    """
    outline = read_arena(find_arena(entries["arena_file"], path) if file is None else file)
    area_mm2 = area_of(entries.get("arena_surface"), path)
    return outline, scaled(outline, area_mm2, stretch=plain(entries.get("arena_stretch")) is True)
