"""Runs that were done one by one, each in a folder of its own, joined into files of results."""

from __future__ import annotations

import itertools
import logging
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from pyarrow import ipc

from pogosim.batch.completeness import (
    Expected,
    MissingRuns,
    missing_runs,
    warn_of_indistinguishable,
    warn_of_missing,
    warn_of_others,
    warn_of_programs,
)
from pogosim.batch.configurations.configuration import Configuration
from pogosim.batch.configurations.names import is_linked_out, leads_out
from pogosim.batch.errors import BatchError, given
from pogosim.batch.result_files.manifests import TASK, read_manifest
from pogosim.batch.result_files.parts import OF_CAMPAIGNS, Part
from pogosim.batch.result_files.result_metadata import COMBINATIONS, Earlier, columns_as_text, manifest
from pogosim.batch.result_files.results import check_columns, check_output, write_results
from pogosim.batch.runs.run_data import RunFile, opened
from pogosim.batch.single_task import TaskArtifact
from pogosim.lines import counted
from pogosim.outputs import PathLike
from pogosim.run_columns import RUN, SEED, run_numbers
from pogosim.table_formats import FEATHER, format_of
from pogosim.yaml_1_2 import WRONG_VALUES, parse_yaml

log = logging.getLogger("pogobatch")


def discover_task_artifacts(inputs: Iterable[PathLike]) -> list[TaskArtifact]:
    """Return the runs in some folders, at any depth, in the order in which they are merged.

    Args:
        inputs: Folders, or files `pogobatch_task.json`.

    Raises:
        BatchError: One is not there, or damaged; or there are no runs in it.
    """
    found: dict[Path, TaskArtifact] = {}
    for name in [inputs] if isinstance(inputs, (str, Path)) else inputs:
        place = given.path("inputs", name)
        if not place.exists():
            raise BatchError(f"{place} does not exist; expected a folder with runs, or a {TASK}")
        paths = sorted(place.rglob(TASK)) if place.is_dir() else [place]
        if not paths:
            raise BatchError(f"there is no {TASK} in {place}; expected a folder with runs of pogobatch")
        for path in paths:
            if path.resolve() not in found:
                found[path.resolve()] = TaskArtifact(path.parent, read_manifest(path))
    return sorted(found.values(), key=lambda artifact: place_of(artifact.manifest))


def place_of(manifest: Mapping[str, Any]) -> tuple[Any, ...]:
    """Return the order of a run among others."""
    return (
        manifest.get("combination_ordinal") or 0,
        str(manifest.get("config_hash", "")),
        manifest["logical_run"],
        manifest["seed"],
    )


def merge_task_artifacts(
    artifacts: Sequence[TaskArtifact],
    output_dir: PathLike,
    *,
    config_path: PathLike | None = None,
    append: bool = False,
) -> list[str]:
    """Join runs into the files of results that their manifests name, as `pogobatch run` does.

    Args:
        artifacts: The runs, see `discover_task_artifacts`.
        output_dir: Folder of the results, which is made.
        config_path: Configuration with options that the runs are of, for the metadata; None: that of the first run.
        append: Keep the rows of results that are there, and add others; otherwise, they are replaced.

    Returns:
        Paths of the files of results.

    Raises:
        BatchError: Nothing is to be merged, a run is there twice, or a file cannot be read or written.
    """
    return merge_runs(artifacts, output_dir, config_path, append).outputs


class Merged(NamedTuple):
    """What a merge has done."""

    outputs: list[str]  # paths of the files of results
    missing: MissingRuns  # runs that are not there although others are; none are looked for with `append`


def merge_runs(
    artifacts: Sequence[TaskArtifact], output_dir: PathLike, config_path: PathLike | None, append: bool
) -> Merged:
    """Do what `merge_task_artifacts` does, and return what is missing as well."""
    if not artifacts:
        raise BatchError("there are no runs to merge")
    refuse_same_runs(artifacts)
    folder = given.path("output_dir", output_dir)
    by_output: dict[str, list[TaskArtifact]] = {}
    for artifact in artifacts:
        by_output.setdefault(output_of(artifact, folder), []).append(artifact)
    expected = None if config_path is None else Expected(Configuration(given.path("config_path", config_path)))
    for artifact in artifacts:
        check_columns(artifact.file.schema, list(artifact.columns), str(artifact.folder), OF_CAMPAIGNS)
    parts = {output: parts_of(own) for output, own in by_output.items()}
    earlier = {output: earlier_results(output, parts[output]) if append else None for output in by_output}
    parts = {output: numbered(own, earlier[output]) for output, own in parts.items()}
    warn_of_lost_columns(artifacts)
    warn_of_programs(artifacts)
    if expected is not None:
        warn_of_others(artifacts, expected)
    for output, own in by_output.items():
        warn_of_indistinguishable(output, own, earlier[output])
    for output, own in by_output.items():
        own_text = own[0].configuration_text if expected is None else expected.configuration.text
        write_results(output, parts[output], own_text, OF_CAMPAIGNS, earlier[output])
    # The results are there whatever is found now.
    missing = MissingRuns([], 0, 0) if append else missing_runs(by_output, expected)
    warn_of_missing(missing)
    return Merged(list(by_output), missing)


def refuse_same_runs(artifacts: Sequence[TaskArtifact]) -> None:
    """Raise BatchError if a run is there twice: its seed is that of another run of its combination."""
    known: dict[tuple[Any, ...], TaskArtifact] = {}
    for artifact in artifacts:
        seed = artifact.manifest["seed"]
        before = known.setdefault((*artifact.combination, seed), artifact)
        if before.folder != artifact.folder:
            programs = {own.manifest.get("program_hash") for own in (before, artifact)}
            why = " (by different programs, or versions of one)" if len(programs) > 1 else ""
            raise BatchError(
                f"{before.folder} and {artifact.folder} have the same seed, {seed}, of one configuration{why}, which "
                "would count twice; leave one out"
            )


def warn_of_lost_columns(artifacts: Sequence[TaskArtifact]) -> None:
    """Warn of constant columns that results cannot have, since columns of these names say which run a row is of."""
    having = [artifact for artifact in artifacts if artifact.lost_columns]
    if having:
        log.warning(
            "%s: extra_columns: left out: %s%s; columns of results with these names say which run a row is of",
            having[0].folder / TASK,
            ", ".join(having[0].lost_columns),
            f", and those of {counted(len(having) - 1, 'more manifest')}" if len(having) > 1 else "",
        )


def output_of(artifact: TaskArtifact, folder: Path) -> str:
    """Return the path of the results that a run belongs to."""
    name = str(artifact.manifest["result_filename"])
    output = str(folder / name)
    if not name or "\0" in name or leads_out(name) or is_linked_out(output, str(folder)):
        raise BatchError(f"{artifact.folder / TASK}: result_filename: '{name}' is not in the folder of the results")
    if format_of(name) is None:
        raise BatchError(f"{artifact.folder / TASK}: result_filename: the format of '{name}' is unknown")
    return output


def parts_of(artifacts: Sequence[TaskArtifact]) -> list[Part]:
    """Return runs by their combinations of options, in the order of the first run of each."""
    parts: dict[tuple[str, ...], list[TaskArtifact]] = {}
    for artifact in artifacts:
        parts.setdefault(artifact.combination, []).append(artifact)
    return [Part(runs[0].columns, [run.file for run in runs], (), which[0]) for which, runs in parts.items()]


def numbered(parts: Sequence[Part], earlier: Earlier | None) -> list[Part]:
    """Return runs each with a number that no other run of its combination has.

    A run keeps its own, unless one before it has it; then it takes the smallest that is free.
    """
    taken: dict[str, set[int]] = {}
    for entry in earlier.combinations if earlier else ():
        taken.setdefault(columns_as_text(entry["columns"]), set()).update(run_numbers(entry))
    return [
        replace(part, runs=with_own_numbers(part.runs, taken.get(columns_as_text(part.columns), set())))
        for part in parts
    ]


def with_own_numbers(runs: Sequence[RunFile], taken: Iterable[int]) -> list[RunFile]:
    """Return runs whose numbers differ from each other and from those that are taken."""
    used = set(taken)
    again = set()
    for index, run in enumerate(runs):
        if run.run in used:
            again.add(index)
        used.add(run.run)
    free = (number for number in itertools.count() if number not in used)
    return [replace(run, run=next(free)) if index in again else run for index, run in enumerate(runs)]


def earlier_results(output: str, parts: Sequence[Part]) -> Earlier | None:
    """Return the results that are there, to which others are appended; None: there are none.

    Raises:
        BatchError: They are in another format than Feather, or have one of the runs already.
    """
    real = check_output(output)
    if not real.exists() or real.stat().st_size == 0:
        return None
    if format_of(real) != FEATHER:
        raise BatchError(f"{output}: --append needs results in Feather; join all runs anew, without it")
    with opened(real) as file:
        schema = ipc.open_file(file).schema
        names = set(schema.names)
    if not {RUN, SEED} <= names:
        raise BatchError(f"{output} has no columns run and seed: pogobatch run, or merge, did not write it")
    try:
        combinations = parse_yaml((schema.metadata or {})[COMBINATIONS.encode()].decode())
        known = {(columns_as_text(entry["columns"]), seed) for entry in combinations for seed in seeds_of(entry)}
        earlier = Earlier(real, schema, combinations)
        manifest([], earlier)  # which is read, too
    except WRONG_VALUES:
        raise BatchError(f"{output} does not say which runs it has: pogobatch did not write it") from None
    for part in parts:
        for run in part.runs:
            if (columns_as_text(part.columns), run.seed) in known:
                raise BatchError(f"{output} has the run of {run.path} already, with seed {run.seed}; leave it out")
    return earlier


def seeds_of(entry: Mapping[str, Any]) -> list[int]:
    """Return the seeds of a combination, as the metadata of results say."""
    return list(entry.get("seeds", run_numbers(entry)))
