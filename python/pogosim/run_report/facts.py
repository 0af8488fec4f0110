"""What was run, in a few lines: objects, arena, time, seeds, versions, and the command that repeats it."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pogosim.analysis.trajectories import Trajectories
from pogosim.lines import counted
from pogosim.object_facts import entries_of
from pogosim.row_batches import row_batches
from pogosim.several_files import configuration_of, is_pattern, seeds_by_run
from pogosim.table_metadata import metadata_of
from pogosim.varied import plain
from pogosim.yaml_1_2 import dump_yaml

PROGRAM = "PROGRAM"  # in commands, where it is not known
MOST_NAMES = 12  # of a list in a line


@dataclass(frozen=True)
class Configurations:
    """Configurations of a file as YAML; empty where it has none."""

    given: str
    resolved: str  # with all defaults

    def repeating(self, metadata: Mapping[str, Any]) -> str:
        """Return the one that repeats the run, also with later versions; that of a batch has its options."""
        return self.given if is_batch(metadata) else self.resolved or self.given


def configurations_of(path: str, metadata: Mapping[str, Any]) -> Configurations:
    """Return the configurations of a file, as they are in it; of several files, what they have in common.

    Raises:
        OSError, ValueError: The file cannot be read.
    """
    texts: Mapping[str, Any] = {}
    if not is_pattern(path):
        texts = metadata_of(row_batches(Path(path)).schema)

    def text(name: str) -> str:
        stored = texts.get(name)
        if isinstance(stored, str):
            return stored.rstrip() + "\n" if stored.strip() else ""
        entries = metadata.get(name)
        return dump_yaml(plain(entries)) if isinstance(entries, dict) and entries else ""

    return Configurations(text("configuration"), text("resolved_configuration"))


def is_batch(metadata: Mapping[str, Any]) -> bool:
    """Tell whether a file was written by a batch."""
    return isinstance(metadata.get("combinations"), list) and "files" not in metadata


def shortened(values: Sequence[Any]) -> str:
    """Return a list in a line: "0 to 9", or "1, 5, 7, ... (20)"."""
    if len(values) > 2 and follow_each_other(values):
        return f"{values[0]} to {values[-1]}"
    told = ", ".join(map(str, values[:MOST_NAMES]))
    return told if len(values) <= MOST_NAMES else f"{told}, ... ({len(values)})"


def follow_each_other(values: Sequence[Any]) -> bool:
    """Tell whether values are whole numbers such as 3, 4, 5."""
    is_whole = all(isinstance(value, int) for value in values)
    return bool(values) and is_whole and list(values) == list(range(values[0], values[0] + len(values)))


def seeds_of(metadata: Mapping[str, Any], runs: Sequence[Trajectories]) -> list[Any]:
    """Return the seeds of all runs, each once; empty where the file does not say."""
    if is_batch(metadata):
        try:
            found = [seed for entry in metadata["combinations"] for seed in seeds_by_run(entry).values()]
        except (KeyError, TypeError, ValueError):
            return []
        return list(dict.fromkeys(found))
    if "files" in metadata:
        first = [run.rows["seed"].iloc[0] for run in runs if "seed" in run.rows]
        return list(dict.fromkeys(int(seed) for seed in first if isinstance(seed, (int, np.integer))))
    seed = configuration_of(dict(metadata)).get("seed")
    return [] if seed is None else [seed]


def facts_of(
    path: str, metadata: Mapping[str, Any], runs: Sequence[Trajectories], program: str | None
) -> list[tuple[str, str]]:
    """Return names and values of what was run; what the file does not say is left out."""
    configuration = configuration_of(dict(metadata))
    facts = [("data file", path)]
    if "files" in metadata:
        facts.append(("files", shortened([Path(name).name for name in metadata["files"]])))
    facts.append(("program", program or "not in the data file"))
    if version := metadata.get("program_version"):
        facts.append(("Pogosim", str(version)))
    if len(runs) > 1:
        facts.append(("runs", f"{len(runs)}{combinations_told(metadata)}"))
    if seeds := seeds_of(metadata, runs):
        facts.append(("seed" if len(seeds) == 1 else "seeds", shortened(seeds)))
    facts.append(("objects", objects_told(metadata, runs[0])))
    facts.append(("arena", arena_told(runs)))
    first, last = min(float(run.time_s[0]) for run in runs), max(float(run.time_s[-1]) for run in runs)
    periods = [float(np.median(np.diff(run.time_s))) for run in runs if len(run.time_s) > 1]
    often = f", recorded every {np.median(periods):.6g} s" if periods else ""
    facts.append(("time", f"{first:.9g} s to {last:.9g} s{often}"))
    physics = [
        text.format(configuration[key])
        for key, text in (("time_step", "time step {} s"), ("physics_engine", "engine {}"))
        if key in configuration
    ]
    return [*facts, ("physics", ", ".join(physics))] if physics else facts


def combinations_told(metadata: Mapping[str, Any]) -> str:
    """Return how many combinations of options there are, with the names of the options."""
    if not is_batch(metadata):
        return ""
    entries = [entry for entry in metadata["combinations"] if isinstance(entry, dict)]
    names = dict.fromkeys(name for entry in entries for name in entry.get("columns", {}))
    of = f" of {shortened(list(names))}" if names else ""
    return f" ({counted(len(entries), 'combination')}{of})" if len(entries) > 1 else ""


def objects_told(metadata: Mapping[str, Any], run: Trajectories) -> str:
    """Return the objects by category: "100 robots (pogobot), 1 sun (static_light)"."""
    facts = metadata.get("objects")
    told = []
    if isinstance(facts, Mapping):
        robots = set(run.category)
        for category, entries in sorted(facts.items(), key=lambda item: item[0] not in robots):
            for entry in entries if isinstance(entries, list) else []:
                if isinstance(entry, Mapping) and "count" in entry:
                    told.append(f"{entry['count']} {category} ({entry.get('type', '?')})")
    if not told:
        named = {own.category: own for own in entries_of(dict(metadata))}
        for category in dict.fromkeys(run.category):
            kind = named[category].settings.get("type") if category in named else None
            told.append(f"{int((run.category == category).sum())} {category}{f' ({kind})' if kind else ''}")
    return shortened(told)


def arena_told(runs: Sequence[Trajectories]) -> str:
    """Return names, sizes and borders of the arenas."""
    told = []
    for run in runs:
        text = run.arena.name
        if run.arena.polygons:
            width, height = run.arena.size_mm
            text += f", {width:.6g} x {height:.6g} mm, {'periodic' if run.arena.is_periodic else 'with walls'}"
        told.append(text)
    return "; ".join(list(dict.fromkeys(told))[:MOST_NAMES])


def command_of(path: str, metadata: Mapping[str, Any], runs: Sequence[Trajectories], program: str | None) -> str:
    """Return the command that repeats a run or a batch with the configuration of the page; empty if there is none."""
    if "files" in metadata or not (metadata.get("resolved_configuration") or metadata.get("configuration")):
        return ""
    stem = Path(path).stem
    file = shlex.quote(configuration_name(path))
    name = PROGRAM if program is None else program
    runs_it = shlex.quote(name if "/" in name else f"./{name}")
    if not is_batch(metadata):
        return f"{runs_it} -c {file} -g --set {shlex.quote(f'data_filename={stem}_again.feather')}"
    seeds = seeds_of(metadata, runs)
    again = shlex.quote(f"{stem}_again")
    if not follow_each_other(seeds):
        return ""
    if seeds[0] == 0:
        return f"pogosim batch -c {file} -S {runs_it} -r {len(seeds)} -o {again}"
    return f"pogosim batch run -c {file} -S {runs_it} --seeds {seeds[0]}:{seeds[-1]} -o {again}"


def configuration_name(path: str) -> str:
    """Return the name under which a page gives its configuration away."""
    return f"{Path(path).stem}.yaml"
