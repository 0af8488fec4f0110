"""The files of a run that its configuration names: those that it writes, and those that it reads beside it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

# What a run writes: the setting, a dotted path, and the name of the file where the configuration does not say it.
# Those that must be asked for are in a table of their own.
OUTPUTS = {"data_filename": "data.feather", "console_filename": "console.txt", "frames_name": "f{:010.4f}.png"}
OUTPUTS_ASKED_FOR = {"message_log": "messages.feather", "flash_state.output_file": "robots.flash"}
ALL_OUTPUTS = (*OUTPUTS, *OUTPUTS_ASKED_FOR)

FILES_BESIDE = ("arena_file", "formation_filename", "magnetometer.csv.file")
# The same in entries of maps: categories of objects, and links.
FILES_OF_ENTRIES = {
    "objects": ("robot_model", "brain", "brain.script", "brain.firmware", "function_costs"),
    "links": ("file",),
}
NO_FILES = {"brain": ("program", "host")}  # values that are none


def is_file_beside(setting: str) -> bool:
    """Tell whether a setting, a dotted path, is the name of a file that a run reads beside its configuration."""
    return setting in FILES_BESIDE or any(
        setting.startswith(f"{key}.") and setting.endswith(tuple(f".{own}" for own in settings))
        for key, settings in FILES_OF_ENTRIES.items()
    )


def is_nested(setting: str) -> bool:
    """Tell whether a setting stands in a map."""
    return "." in setting


def place_of(setting: str) -> str:
    """Return what stands in the configuration of a run for an output in a map, until the run has a folder."""
    return f"<pogobatch:{setting}>"


def value_at(entries: dict[str, Any], setting: str) -> Any:
    """Return the value of a setting; None if it is not there."""
    node: Any = entries
    for key in setting.split("."):
        node = node.get(key) if isinstance(node, dict) else None
    return node


def changed(entries: dict[str, Any], setting: str, value: Any = None) -> dict[str, Any]:
    """Return a configuration with another value of a setting that it has; None: without it."""
    key, _, below = setting.partition(".")
    if key not in entries:
        return entries
    if below:
        inner = entries[key]
        return {**entries, key: changed(inner, below, value)} if isinstance(inner, dict) else entries
    if value is None:
        return {name: own for name, own in entries.items() if name != key}
    return {**entries, key: value}


def without_outputs(entries: dict[str, Any]) -> dict[str, Any]:
    """Return a configuration without the names of the files that a run writes."""
    for setting in ALL_OUTPUTS:
        entries = changed(entries, setting)
    return entries


def outputs_of(entries: dict[str, Any]) -> dict[str, str]:
    """Return the settings of what a run writes, and the names of its files, without folders."""
    asked_for = {setting: name for setting, name in OUTPUTS_ASKED_FOR.items() if value_at(entries, setting)}
    return {setting: basename(value_at(entries, setting), name) for setting, name in (OUTPUTS | asked_for).items()}


def with_places(entries: dict[str, Any], outputs: Sequence[str]) -> dict[str, Any]:
    """Return a configuration without its outputs but those in maps, which keep their lines; see `place_of`."""
    for setting in ALL_OUTPUTS:
        entries = changed(entries, setting, place_of(setting) if is_nested(setting) and setting in outputs else None)
    return entries


def with_files_beside(entries: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return a configuration for another folder: with the paths of files that a single run finds beside it."""
    for setting in FILES_BESIDE:
        if (name := value_at(entries, setting)) is not None:
            entries = changed(entries, setting, found_beside(name, folder))
    for key, settings in FILES_OF_ENTRIES.items():
        if isinstance(described := entries.get(key), dict):
            entries = {**entries, key: with_own_files(described, settings, folder)}
    return entries


def with_own_files(node: Any, settings: Sequence[str], folder: Path) -> Any:
    """Return categories, links, or entries of one, with the paths of files that a single run finds in a folder."""
    if isinstance(node, list):
        return [with_own_files(own, settings, folder) for own in node]
    if not isinstance(node, dict):
        return node
    node = {name: with_own_files(own, settings, folder) for name, own in node.items()}
    for setting in settings:
        name = value_at(node, setting)
        if isinstance(name, str) and name not in NO_FILES.get(setting, ()):
            node = changed(node, setting, found_beside(name, folder))
    return node


def found_beside(name: Any, folder: Path) -> Any:
    """Return the path of a file that a single run would find beside the configuration; else the name as it is."""
    if not isinstance(name, str) or not name or Path(name).exists():
        return name
    beside = folder / name
    return str(beside) if beside.exists() else name


def basename(name: Any, default: str) -> str:
    """Return the last part of a path."""
    return (Path(name).name or default) if isinstance(name, str) else default
