"""Two batches: where the distributions of the numbers of their runs differ."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from pogosim.analysis.quantities import Quantity, quantities_of
from pogosim.analysis.trajectories import Trajectories, trajectories_of
from pogosim.comparison.statistics import Floats, difference_interval, holm, least_p, two_sample_p
from pogosim.reports.each_run import for_each_run
from pogosim.run_columns import RETRY, RUN, SEED
from pogosim.utils import load_dataframe

WHEN = ("mean", "final")  # over time, and at the end
OF_ONE_RUN = (RUN, SEED, RETRY)

Key = tuple[tuple[str, str], ...]  # names and values of options


@dataclass
class Numbers:
    """The numbers of the runs of a file, by combination of options; curves only if they are to be drawn."""

    samples: dict[Key, dict[str, list[float]]] = field(default_factory=dict)  # by "speed, mean"
    curves: dict[Key, dict[str, list[tuple[Floats, Floats]]]] = field(default_factory=dict)  # by label: times, values
    runs: dict[Key, int] = field(default_factory=dict)
    ends_s: list[float] = field(default_factory=list)  # last time of each run


@dataclass(frozen=True)
class NumberDifference:
    """How a number differs between two samples of runs."""

    combination: str  # empty: there is one only
    name: str  # "speed, mean"
    runs: tuple[int, int]  # that have it
    means: tuple[float, float]
    difference: float  # of the means, b - a
    interval: tuple[float, float]
    p: float  # NaN: too few runs
    corrected: float  # p, corrected for all tests


@dataclass(frozen=True)
class Distributions:
    """All numbers that both files have."""

    numbers: list[NumberDifference]
    only_in: tuple[list[str], list[str]]  # combinations that only one file has
    tests: int
    least: float  # corrected p that the smallest samples can have

    def significant(self, level: float) -> list[NumberDifference]:
        """Return the numbers whose distributions differ at a level."""
        return [own for own in self.numbers if own.corrected <= level]


def numbers_of(data: str, category: str | None, with_curves: bool) -> Numbers:
    """Compute the numbers of all runs of a file.

    Raises:
        AnalysisError: It has no robots with positions.
        OSError, ValueError: It cannot be read.
    """
    rows, metadata = load_dataframe(data)
    runs = trajectories_of(rows, metadata, category)
    found = Numbers()
    for run, quantities in zip(runs, for_each_run(listed, runs, argparse.Namespace(), "compare"), strict=True):
        key = key_of(run)
        found.ends_s.append(float(run.time_s[-1]))
        found.runs[key] = found.runs.get(key, 0) + 1
        samples = found.samples.setdefault(key, {})
        for own in quantities:
            for when, value in zip(WHEN, (own.mean, own.final), strict=True):
                samples.setdefault(f"{own.name}, {when}", []).append(value)
            if with_curves:
                curves = found.curves.setdefault(key, {}).setdefault(own.label, [])
                curves.append((run.time_s, own.over_time))
    return found


def listed(run: Trajectories) -> list[Quantity]:
    """Return all quantities of a run that has any value of them."""
    return [quantity for quantity in quantities_of(run) if np.isfinite(quantity.over_time).any()]


def key_of(run: Trajectories) -> Key:
    """Return what tells the combination of a run from others."""
    return tuple((name, str(value)) for name, value in sorted(run.labels.items()) if name not in OF_ONE_RUN)


def told(key: Key) -> str:
    """Return a combination in words."""
    return ", ".join(f"{name} {value}" for name, value in key)


def pairs_of(a: Numbers, b: Numbers) -> tuple[dict[str, tuple[Key, Key]], tuple[list[str], list[str]]]:
    """Return the combinations that belong together, by what they are called, and those that only one file has.

    If each file has one combination only, these belong together, whatever their options.
    """
    if len(a.runs) == len(b.runs) == 1:
        return {"": (next(iter(a.runs)), next(iter(b.runs)))}, ([], [])
    common = [key for key in a.runs if key in b.runs]
    return {told(key): (key, key) for key in common}, (
        [told(key) for key in a.runs if key not in b.runs],
        [told(key) for key in b.runs if key not in a.runs],
    )


def compare_numbers(a: Numbers, b: Numbers, test: str) -> Distributions:
    """Compare the numbers that both files have; those that are equal in all runs of both are not tested."""
    pairs, only_in = pairs_of(a, b)
    found: list[tuple[str, str, Floats, Floats]] = []
    for name, (key_a, key_b) in pairs.items():
        of_a, of_b = a.samples.get(key_a, {}), b.samples.get(key_b, {})
        found += [(name, number, finite(of_a[number]), finite(of_b[number])) for number in of_a if number in of_b]
    probabilities = [tested(one, other, test) for _, _, one, other in found]
    corrected = holm(probabilities)
    tests = int(np.isfinite(probabilities).sum())
    least = [least_p(len(one), len(other), test) for _, _, one, other in found if min(len(one), len(other)) > 1]
    return Distributions(
        [
            difference_of(*own, p, after)
            for own, p, after in zip(found, probabilities, corrected, strict=True)
            if len(own[2]) and len(own[3])
        ],
        only_in,
        tests,
        min(tests * min(least, default=1.0), 1.0),
    )


def finite(values: Sequence[float]) -> Floats:
    """Return the values that are finite."""
    array = np.array(values, dtype=float)
    return np.asarray(array[np.isfinite(array)])


def tested(a: Floats, b: Floats, test: str) -> float:
    """Return the probability that a test gives; NaN without a test."""
    together = np.concatenate([a, b])
    if len(together) == 0 or np.ptp(together) == 0.0:
        return float("nan")
    return two_sample_p(a, b, test)


def difference_of(combination: str, name: str, a: Floats, b: Floats, p: float, corrected: float) -> NumberDifference:
    """Return what is said of two samples."""
    means = float(a.mean()), float(b.mean())
    interval = difference_interval(a, b)
    return NumberDifference(combination, name, (len(a), len(b)), means, means[1] - means[0], interval, p, corrected)


def as_map(own: NumberDifference) -> Mapping[str, Any]:
    """Return a difference with the names that it has in JSON."""
    return {
        "combination": own.combination,
        "number": own.name,
        "runs": list(own.runs),
        "means": list(own.means),
        "difference": own.difference,
        "interval": list(own.interval),
        "p": own.p,
        "p_corrected": own.corrected,
    }
