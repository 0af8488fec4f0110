"""What a data file says of its runs, without reading its rows, and where two of them differ in that."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pogosim.batch.result_files.manifests import TASK
from pogosim.row_batches import row_batches
from pogosim.run_report.facts import is_batch, seeds_of
from pogosim.several_files import configuration_of, is_pattern
from pogosim.table_metadata import metadata_of, parse_configuration
from pogosim.utils import load_dataframe, parse_combinations
from pogosim.varied import MISSING, NO_PARAMETERS, differ, leaves

CONFIGURATIONS = ("configuration", "resolved_configuration")
POLYGONS = "arena_polygons"
OUTLINE = "outline of the arena"


@dataclass(frozen=True)
class Source:
    """A file, or several by a pattern."""

    name: str
    metadata: Mapping[str, Any]
    seeds: list[Any]  # empty: unknown
    runs: int
    program: str = ""  # hash of the program, where a batch has kept it beside the file; empty: unknown

    @property
    def is_one_file(self) -> bool:
        """Whether its rows can be read one after the other."""
        return not is_pattern(self.name)

    @property
    def version(self) -> str:
        """Version of the simulator; empty: unknown."""
        return str(self.metadata.get("program_version", ""))


@dataclass(frozen=True)
class KeyDifference:
    """A key of configurations whose values differ; MISSING where a file does not have it."""

    key: str
    a: Any
    b: Any


def source_of(name: str) -> Source:
    """Look into a file.

    Raises:
        OSError, ValueError: It cannot be read.
    """
    if is_pattern(name):
        rows, metadata = load_dataframe(name)
        seeds = rows["seed"].dropna().unique().tolist() if "seed" in rows else []
        runs = int(rows["run"].nunique()) if "run" in rows else 1
        return Source(name, metadata, [int(seed) for seed in seeds], runs)
    found = metadata_of(row_batches(Path(name)).schema)
    for key in CONFIGURATIONS:
        if key in found:
            found[key] = parse_configuration(found[key])
    if "combinations" in found:
        found["combinations"] = parse_combinations(found["combinations"])
    runs = 1
    if is_batch(found):
        counts = [entry.get("runs") for entry in found["combinations"] if isinstance(entry, dict)]
        runs = sum(count for count in counts if isinstance(count, int))
    return Source(name, found, seeds_of(found, []), runs, program_hash(Path(name)))


def program_hash(data: Path) -> str:
    """Return the hash of the program of a run, of the manifest that a batch has kept in its folder; empty: unknown.

    The data file is in the folder below, see `pogosim.batch.result_files.manifests`.
    """
    try:
        entries = json.loads((data.resolve().parent.parent / TASK).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return ""
    found = entries.get("program_hash") if isinstance(entries, dict) else None
    return found if isinstance(found, str) else ""


def differences(a: Source, b: Source) -> list[KeyDifference]:
    """Return the keys in which configurations differ, with all defaults where both files have those.

    Names of outputs, and the seed, do not count. Batches have what is common to all their runs, and their options.
    """
    has_resolved = all(own.metadata.get("resolved_configuration") for own in (a, b))
    one, other = (settings_of(own, has_resolved) for own in (a, b))
    keys = list(dict.fromkeys([*one, *other]))
    return [
        KeyDifference(key, one.get(key, MISSING), other.get(key, MISSING))
        for key in keys
        if key not in NO_PARAMETERS and differ_or_missing(one.get(key, MISSING), other.get(key, MISSING))
    ]


def settings_of(source: Source, resolved: bool) -> dict[str, Any]:
    """Return the values of a configuration by their dotted paths, with the options of a batch, and the arena."""
    metadata = source.metadata
    entries = configuration_of(dict(metadata)) if resolved else metadata.get("configuration")
    settings = dict(leaves(entries)) if isinstance(entries, dict) else {}
    if is_batch(metadata):
        columns = [entry.get("columns") for entry in metadata["combinations"] if isinstance(entry, dict)]
        for name in dict.fromkeys(name for own in columns if isinstance(own, dict) for name in own):
            settings[name] = [own.get(name) for own in columns if isinstance(own, dict)]
    if isinstance(metadata.get(POLYGONS), str):
        settings[OUTLINE] = metadata[POLYGONS].strip()
    return settings


def differ_or_missing(a: Any, b: Any) -> bool:
    """Tell whether two values differ, or one is missing."""
    if a is MISSING or b is MISSING:
        return a is not b
    return differ(a, b)
