"""Whether runs that are merged are those of one configuration, are all there, and are told apart by columns."""

from __future__ import annotations

import functools
import itertools
import logging
import operator
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import PurePath
from typing import Any

from pogosim.batch.configurations.configuration import Configuration
from pogosim.batch.configurations.names import file_name
from pogosim.batch.configurations.option_words import CHOICES, chosen_in, shown
from pogosim.batch.errors import BatchError
from pogosim.batch.result_files.manifests import for_json
from pogosim.batch.result_files.result_metadata import Earlier, configuration_in
from pogosim.batch.result_files.run_counts import RunCounts, gaps
from pogosim.batch.runs.identity import config_hash
from pogosim.batch.runs.run_files import ALL_OUTPUTS, is_file_beside
from pogosim.batch.single_task import TaskArtifact
from pogosim.lines import counted
from pogosim.varied import NO_PARAMETERS, differ, leaves, varied_parameters

OF_VIEW = ("GUI", "progress_bar", "mm_to_pixels")  # which a run adds to its configuration
LISTED = 1000  # runs that are missing, in JSON
NAMED = 3  # of them, in the warning
NOT_COMPARED = (*NO_PARAMETERS, *ALL_OUTPUTS, *OF_VIEW)

log = logging.getLogger("pogobatch")


@dataclass(frozen=True)
class MissingRun:
    """A run that is not there, although others of its number, of its combination or of its batch are."""

    output: str
    logical_run: int
    batch_choices: Mapping[str, Any]  # what tells its combination from others
    combination_ordinal: int | None = None  # number of its combination, from 0 on; None: its manifests do not say it


@dataclass(frozen=True)
class MissingRuns:
    """Runs that are not there.

    Attributes:
        first: The first ones of them, at most LISTED.
        count: How many are missing.
        wanted: How many there should be.
    """

    first: list[MissingRun]
    count: int
    wanted: int


class Expected:
    """What a configuration with options says of runs.

    Raises:
        BatchError: Its options are wrong.
    """

    def __init__(self, configuration: Configuration) -> None:
        self.configuration = configuration
        self.combinations = configuration.combinations()
        self.numbers: dict[str, list[int]] = {}  # several that differ in the names of outputs alone have one hash
        for number, entries in enumerate(self.combinations):
            self.numbers.setdefault(config_hash(entries), []).append(number)

    @cached_property
    def single(self) -> dict[str, Any] | None:
        """The configuration of a run that takes all defaults, as `pogobatch task` does; None: there is none."""
        try:
            return self.configuration.resolved()
        except BatchError:
            return None

    @cached_property
    def known(self) -> list[dict[str, Any]]:
        """Values of all configurations that runs may have, by dotted path."""
        return [compared(entries) for entries in (*self.combinations, self.single) if entries is not None]

    def number_of(self, artifact: TaskArtifact) -> int | None:
        """Return which combination a run is of; None: of none."""
        numbers = self.numbers.get(str(artifact.manifest.get("config_hash", "")), [])
        if len(numbers) > 1:
            output = artifact.manifest["result_filename"]
            numbers = [number for number in numbers if file_name(self.combinations[number]) == output] or numbers
        if numbers or not (entries := artifact.configuration):
            return numbers[0] if numbers else None
        found = self.known.index(own) if (own := compared(entries)) in self.known else len(self.combinations)
        return found if found < len(self.combinations) else None

    def other_keys(self, artifact: TaskArtifact) -> list[str]:
        """Return in which keys a run differs from all that the configuration says; empty: it is one of its runs."""
        digest = str(artifact.manifest.get("config_hash", ""))
        if digest in self.numbers or (self.single is not None and digest == config_hash(self.single)):
            return []
        own = compared(artifact.configuration)
        if not own or own in self.known:
            return []
        keys = dict.fromkeys(key for values in (own, *self.known) for key in values)
        nowhere = [key for key in keys if all(differ(own.get(key), values.get(key)) for values in self.known)]
        return nowhere or list(varied_parameters(self.combinations))

    def choices_of(self, number: int) -> dict[str, Any]:
        """Return what tells a combination from others: keys and values."""
        return chosen_in(self.varied, number)

    @cached_property
    def varied(self) -> dict[str, list[Any]]:
        """What differs between the combinations: keys, with a value for each."""
        return varied_parameters(self.combinations)


def compared(entries: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of a configuration by dotted path, without those that differ between its runs.

    Files are there by their names: runs have them with other paths, if they are beside the configuration.
    """
    kept = {key: value for key, value in entries.items() if key != CHOICES}
    values = {path: for_json(value) for path, value in leaves(kept) if path not in NOT_COMPARED and value != {}}
    return {
        path: PurePath(value).name if isinstance(value, str) and is_file_beside(path) else value
        for path, value in values.items()
    }


def warn_of_others(artifacts: Sequence[TaskArtifact], expected: Expected) -> None:
    """Warn of runs that are not of the configuration which the metadata of their results will have."""
    keys_of: dict[tuple[str, ...], list[str]] = {}
    others = []
    for artifact in artifacts:
        if artifact.combination not in keys_of:
            keys_of[artifact.combination] = expected.other_keys(artifact)
        if keys_of[artifact.combination]:
            others.append(artifact)
    if others:
        first = others[0]
        log.warning(
            "%s: %d of %s %s of other configurations, the first in %s, which differs in %s; the metadata of the "
            "results will not say so: merge these apart, with their own configuration",
            expected.configuration.path,
            len(others),
            counted(len(artifacts), "run"),
            "is" if len(others) == 1 else "are",
            first.folder,
            ", ".join(keys_of[first.combination]),
        )


def warn_of_programs(artifacts: Sequence[TaskArtifact]) -> None:
    """Warn of runs that different programs have done, or different versions of one or of the simulator."""
    firsts: dict[str, TaskArtifact] = {}
    for artifact in artifacts:
        if program := artifact.manifest.get("program_hash"):
            firsts.setdefault(program, artifact)
    if len(firsts) > 1:
        log.warning(
            "the runs were done by %d programs, or versions of them or of the simulator; the first of each: %s",
            len(firsts),
            ", ".join(str(artifact.folder) for artifact in firsts.values()),
        )


def warn_of_indistinguishable(output: str, runs: Sequence[TaskArtifact], earlier: Earlier | None) -> None:
    """Warn of runs in a file of results that differ in keys which no column has."""
    firsts = [own[0] for own in by_combination(runs)]
    keys: dict[str, None] = {}
    for columns in dict.fromkeys(run.columns_text for run in firsts):
        alike = [configuration_in(run.file.metadata) for run in firsts if run.columns_text == columns]
        found = list(varied_parameters(alike))
        if earlier is not None and earlier.has_columns(columns):
            # Metadata say only what all earlier runs have in common.
            there = dict(leaves(configuration_in(earlier.metadata)))
            own = dict(leaves(alike[0]))
            found += [key for key in own if key in there and differ(own[key], there[key])]
        keys.update(dict.fromkeys(key for key in found if key not in NOT_COMPARED))
    if keys:
        log.warning("%s: no column tells apart its runs, which differ in %s", output, ", ".join(keys))


def by_combination(artifacts: Sequence[TaskArtifact]) -> list[list[TaskArtifact]]:
    """Return the runs of each combination."""
    found: dict[tuple[str, ...], list[TaskArtifact]] = {}
    for artifact in artifacts:
        found.setdefault(artifact.combination, []).append(artifact)
    return list(found.values())


def missing_runs(by_output: Mapping[str, Sequence[TaskArtifact]], expected: Expected | None) -> MissingRuns:
    """Return the runs that are missing, and how many there should be.

    Each combination should have the same runs as all others together, one number several times if batches with other
    seeds are merged, and all seeds of the batches that its runs are of. With a configuration, each of its combinations
    should have the runs 0, 1, ... up to the greatest number that there is, or as many as `_rundr` in it says. Without
    one, there should be as many combinations as the greatest of the batches has.

    Args:
        by_output: The runs that are there, by file of results.
        expected: What the configuration says; None: there is none.
    """
    found: dict[Any, list[TaskArtifact]] = {}
    named: dict[Any, MissingRun] = {}  # run 0 of each combination
    for output, artifacts in by_output.items():
        for own in by_combination(artifacts):
            which: Any = own[0].combination if expected is None else expected.number_of(own[0])
            if which is None:
                continue
            ordinal = own[0].manifest.get("combination_ordinal") if expected is None else which
            choices = own[0].batch_choices if expected is None else for_json(expected.choices_of(which))
            named[which] = MissingRun(output, 0, choices, ordinal)
            found.setdefault(which, []).extend(own)
    if not found:
        return MissingRuns([], 0, 0)
    runs_of = {which: RunCounts.of(map(as_range, own)) for which, own in found.items()}
    with_left = (runs.joined(seeds_left(found[which]), operator.add) for which, runs in runs_of.items())
    wanted = functools.reduce(lambda some, more: some.joined(more, max), with_left)
    others = 0
    names_of_others: Iterator[int] = iter(())
    if expected is not None:
        end = max(wanted.end, len(expected.configuration.seeds or ()))
        wanted = wanted.joined(RunCounts.of([(0, end)]), max)
        for which in range(len(expected.combinations)):
            named.setdefault(which, MissingRun("", 0, for_json(expected.choices_of(which)), which))
        named = dict(sorted(named.items()))
    else:
        others, names_of_others = combinations_left([run for runs in found.values() for run in runs], len(found))
    left = [(name, wanted.joined(runs_of.get(which, RunCounts()), less)) for which, name in named.items()]
    without_runs = ((MissingRun("", 0, {}, ordinal), wanted) for ordinal in names_of_others)
    runs = (
        replace(name, logical_run=run)
        for name, counts in itertools.chain(left, without_runs)
        for run in counts.numbers()
    )
    count = sum(counts.total for _, counts in left) + others * wanted.total
    return MissingRuns(list(itertools.islice(runs, LISTED)), count, (len(named) + others) * wanted.total)


def as_range(artifact: TaskArtifact) -> tuple[int, int]:
    """Return the number of a run, as a range of one number."""
    run = int(artifact.manifest["logical_run"])
    return run, run + 1


def less(count: int, other: int) -> int:
    """Return what is left of a count without another one."""
    return max(0, count - other)


def seeds_left(artifacts: Sequence[TaskArtifact]) -> RunCounts:
    """Return the numbers of those runs of a combination whose seeds its batches have, but no run that is there has.

    A seed of several batches counts once, for the last one.
    """
    taken = [(seed, seed + 1) for seed in {artifact.first_seed for artifact in artifacts}]
    runs: list[tuple[int, int]] = []
    for seeds in reversed(dict.fromkeys(artifact.batch_seeds for artifact in artifacts)):
        runs += [(first - seeds.start, end - seeds.start) for first, end in gaps(seeds, sorted(taken))]
        taken.append((seeds.start, seeds.stop))
    return RunCounts.of(runs)


def combinations_left(artifacts: Sequence[TaskArtifact], found: int) -> tuple[int, Iterator[int]]:
    """Return how many combinations none of these runs has, although their batch has more than are found, and which.

    The greatest batch counts: a smaller one may have shared its runs with it.
    """
    count = max(artifact.manifest.get("batch_combinations") or 0 for artifact in artifacts)
    of_greatest = (run.manifest for run in artifacts if run.manifest.get("batch_combinations") == count)
    ordinals = (manifest.get("combination_ordinal") for manifest in of_greatest)
    there = {ordinal for ordinal in ordinals if ordinal is not None and ordinal < count}
    left = min(count - len(there), max(0, count - found))
    return left, itertools.islice((ordinal for ordinal in itertools.count() if ordinal not in there), left)


def warn_of_missing(missing: MissingRuns) -> None:
    """Warn of runs that are not there."""
    if missing.first:
        first = missing.first[0]
        of = f" of {first.output}" if first.output else ""
        choices = "".join(f", {key}: {shown(value)}" for key, value in first.batch_choices.items())
        if not of and not choices:
            of = f" of combination {first.combination_ordinal}"
        alike = (run for run in missing.first[:NAMED] if replace(run, logical_run=first.logical_run) == first)
        together = [run.logical_run for run in alike]
        log.warning(
            "%d of %s %s missing, the first: %s %s%s%s",
            missing.count,
            counted(missing.wanted, "run"),
            "is" if missing.count == 1 else "are",
            "run" if len(together) == 1 else "runs",
            ", ".join(map(str, together)),
            of,
            choices,
        )
