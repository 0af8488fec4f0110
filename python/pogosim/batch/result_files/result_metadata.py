"""The metadata of a file of results: what its runs have in common, and what tells its combinations apart."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa

from pogosim.batch.errors import BatchError
from pogosim.batch.result_files.parts import Part
from pogosim.batch.runs.run_files import without_outputs
from pogosim.run_columns import NUMBERS
from pogosim.table_metadata import parse_configuration, parse_facts
from pogosim.varied import MISSING, OBJECTS, facts_in_common, in_common
from pogosim.yaml_1_2 import WRONG_VALUES, dump_yaml, parse_yaml, problem_of

RESOLVED = "resolved_configuration"
POLYGONS = "arena_polygons"
COMBINATIONS = "combinations"
MANIFEST = "pogobatch_manifest"


@dataclass(frozen=True)
class Earlier:
    """A file of results whose rows stay when others are appended.

    Attributes:
        path: The file.
        schema: Its columns and metadata.
        combinations: What it says of its combinations.
    """

    path: Path
    schema: pa.Schema
    combinations: list[dict[str, Any]]

    @property
    def metadata(self) -> dict[bytes, bytes]:
        """The metadata of the file."""
        return self.schema.metadata or {}

    def has_columns(self, text: str) -> bool:
        """Tell whether a combination has these constant columns, see `columns_as_text`."""
        return any(columns_as_text(entry["columns"]) == text for entry in self.combinations)


def columns_as_text(columns: Mapping[str, Any]) -> str:
    """Return columns as a text, which is the same for the same columns."""
    return json.dumps(columns, sort_keys=True, default=str)


def manifest(parts: Sequence[Part], earlier: Earlier | None) -> bytes:
    """Return the metadata entry `pogobatch_manifest`, in JSON: how many runs there are, and of which configurations."""
    known = json.loads(earlier.metadata.get(MANIFEST.encode(), b"{}")) if earlier else {}
    hashes = [*known.get("config_hashes", []), *(part.config_hash for part in parts if part.runs)]
    entries = {
        "schema_version": 1,
        "task_count": known.get("task_count", 0) + sum(len(part.runs) for part in parts),
        "config_hashes": sorted(set(hashes)),
    }
    return json.dumps(entries).encode()


def metadata_of(parts: Sequence[Part], text: str, earlier: Earlier | None) -> dict[str, bytes]:
    """Return the metadata of a file of results.

    They are what all runs have in common, with `configuration`, the configuration with all its options, and
    `resolved_configuration` and `objects`, the entries that are the same in all runs. `summary` adds what differs.
    """
    before = [] if earlier is None else [[earlier.metadata]]
    of_parts = [*before, *([run.metadata for run in part.runs] for part in parts if part.runs)]
    all_metadata = [metadata for part in of_parts for metadata in part]
    first = all_metadata[0]
    skipped = (b"configuration", RESOLVED.encode())
    common = {
        key: value
        for key, value in first.items()
        if key not in skipped and all(metadata.get(key) == value for metadata in all_metadata)
    }
    metadata = {key.decode(errors="replace"): value for key, value in common.items()}
    metadata["configuration"] = text.encode()
    if OBJECTS not in metadata and (facts := facts_in_common([facts_in(part[0]) for part in of_parts])):
        metadata[OBJECTS] = json.dumps(facts).encode()
    shared = in_common([configuration_in(part[0]) for part in of_parts])
    if shared not in (MISSING, {}):
        metadata[RESOLVED] = dump_yaml(shared).encode()
    return metadata


def configuration_in(metadata: dict[bytes, bytes]) -> dict[str, Any]:
    """Return the configuration with all defaults of a run, without what only that run has."""
    entries = parse_configuration(metadata.get(RESOLVED.encode(), b"").decode(errors="replace"))
    return {key: value for key, value in without_outputs(entries).items() if key != "seed"}


def facts_in(metadata: dict[bytes, bytes]) -> Any:
    """Return what the metadata of a run say of its objects; None if they do not."""
    return parse_facts(metadata.get(OBJECTS.encode(), b"null").decode(errors="replace"))


def summary(parts: Sequence[Part]) -> list[dict[str, Any]]:
    """Return the metadata entry `combinations`.

    A list with the columns of each combination, its number of runs and rows, the runs that failed, the seeds of the
    others if they are not their numbers, those numbers if they are not 0, 1, ... without the runs that failed, and the
    polygons of its arena if they are not the same everywhere.
    """
    polygons = [part.runs[0].metadata.get(POLYGONS.encode()) if part.runs else None for part in parts]
    differ = len({text for text in polygons if text is not None}) > 1
    entries = []
    for part, text in zip(parts, polygons, strict=True):
        entry = {"columns": part.columns, "runs": len(part.runs), "rows": part.rows, "failed_runs": list(part.failed)}
        numbers = [run for run in range(len(part.runs) + len(part.failed)) if run not in part.failed]
        if any(run.seed != number for run, number in zip(part.runs, numbers, strict=True)):
            entry["seeds"] = [run.seed for run in part.runs]
        if [run.run for run in part.runs] != numbers:
            entry[NUMBERS] = [run.run for run in part.runs]
        if differ and text is not None:
            try:
                entry[POLYGONS] = parse_yaml(text.decode())
            except WRONG_VALUES as error:
                raise BatchError(f"{part.runs[0].path} is damaged: {POLYGONS}: {problem_of(error)}") from None
        entries.append(entry)
    return entries
