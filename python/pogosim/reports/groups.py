"""Runs by combination of options and by arena, and what these are called."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

from pogosim.analysis.trajectories import Run

T = TypeVar("T")

# With more combinations than this, figures have panels.
MOST_CURVES = 6
MOST_PANELS = 12


def group_names(runs: Sequence[Run]) -> list[str]:
    """Return the labels whose values differ between runs, apart from the number of the run: those of combinations."""
    names = dict.fromkeys(name for run in runs for name in run.labels)
    return [name for name in names if name != "run" and len({str(run.labels.get(name)) for run in runs}) > 1]


def group_of(run: Run, names: Sequence[str]) -> str:
    """Return what a curve of this run's combination is called: its values of these labels; the arena if none differ."""
    if not names:
        return run.arena.name
    return ", ".join(f"{short} {run.labels.get(name)}" for name, short in zip(names, endings(names), strict=True))


def endings(names: Sequence[str]) -> list[str]:
    """Return the shortest ends of dotted names that tell them apart: "speed", but "a.speed" beside "b.speed"."""
    return [next(end for end in ends_of(name) if is_alone(end, names) or end == name) for name in names]


def ends_of(name: str) -> list[str]:
    """Return "c", "b.c" and "a.b.c" of "a.b.c"."""
    parts = name.split(".")
    return [".".join(parts[-count:]) for count in range(1, len(parts) + 1)]


def is_alone(end: str, names: Sequence[str]) -> bool:
    """Tell whether only one of the names ends like that."""
    return sum(end in ends_of(name) for name in names) == 1


def by_combination(runs: Sequence[Run], values: Sequence[T], names: Sequence[str] | None = None) -> dict[str, list[T]]:
    """Sort what belongs to each run by combination, so that each has what belongs to repetitions of the same.

    Args:
        runs: The runs.
        values: What belongs to each of them.
        names: Labels that tell combinations apart; None: those that differ between the runs.
    """
    names = group_names(runs) if names is None else names
    groups: dict[str, list[T]] = {}
    for run, value in zip(runs, values, strict=True):
        groups.setdefault(group_of(run, names), []).append(value)
    return groups


def by_arena(runs: Sequence[Run], values: Sequence[T]) -> dict[str, tuple[list[Run], list[T]]]:
    """Sort runs, and what belongs to each, by the name of the arena."""
    arenas: dict[str, tuple[list[Run], list[T]]] = {}
    for run, value in zip(runs, values, strict=True):
        own_runs, own_values = arenas.setdefault(run.arena.name, ([], []))
        own_runs.append(run)
        own_values.append(value)
    return arenas


def panel_label(runs: Sequence[Run]) -> str | None:
    """Return the label whose values have a panel each, where one would have too many curves; None: one panel is enough.

    It is the one with the fewest values; the others tell the curves of a panel apart.
    """
    names = group_names(runs)
    if len(names) < 2 or len(by_combination(runs, runs)) <= MOST_CURVES:
        return None
    count = {name: len({str(run.labels.get(name)) for run in runs}) for name in names}
    name = min(names, key=lambda name: count[name])
    return name if count[name] <= MOST_PANELS else None


def by_panel(runs: Sequence[Run], values: Sequence[T]) -> tuple[dict[str, dict[str, list[T]]], list[str]]:
    """Sort what belongs to each run by panel, and by combination within a panel.

    Returns:
        By the title of the panel, empty if there is but one, and by the name of the curve; and the names of all curves.
    """
    label = panel_label(runs)
    names = [name for name in group_names(runs) if name != label]
    if label is None:
        groups = by_combination(runs, values, names)
        return {"": groups}, list(groups)
    panels: dict[str, tuple[list[Run], list[T]]] = {}
    for run, value in zip(runs, values, strict=True):
        title = f"{endings([label, *names])[0]} {run.labels.get(label)}"
        own_runs, own_values = panels.setdefault(title, ([], []))
        own_runs.append(run)
        own_values.append(value)
    return {title: by_combination(*own, names) for title, own in panels.items()}, list(
        by_combination(runs, values, names)
    )
