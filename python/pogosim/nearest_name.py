"""Names that can be typed: their list, and the one that is nearest to what was typed, as the simulator finds it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping


def edit_distance(a: str, b: str) -> int:
    """Return how many letters have to be inserted, deleted or replaced to make one string of the other."""
    previous = list(range(len(b) + 1))
    for i, letter in enumerate(a.lower()):
        current = [i + 1]
        for j, other in enumerate(b.lower()):
            current.append(min(previous[j] + (letter != other), previous[j + 1] + 1, current[j] + 1))
        previous = current
    return previous[-1]


def nearest_name(typed: str, known: Iterable[str]) -> str | None:
    """Return the nearest of the known names.

    None if more than three letters, or more than a third of the shorter name, would have to change.
    """
    near = [(edit_distance(typed, name), name) for name in known]
    near = [(distance, name) for distance, name in near if distance <= min(3, len(typed) // 3, len(name) // 3)]
    return min(near, key=lambda pair: pair[0])[1] if near else None


def listed(summaries: Mapping[str, str]) -> list[str]:
    """Return names with what each is for, as the lines of a help."""
    width = max(map(len, summaries), default=0)
    return [f"  {name:{width}}  {summary}" for name, summary in summaries.items()]


def unknown(kind: str, typed: str, known: Iterable[str], otherwise: str) -> str:
    """Return what is said of a name that is not known: which one is near, or else where all are."""
    near = nearest_name(typed, known)
    question = f"did you mean '{near}'?" if near else otherwise
    return f"there is no {kind} '{typed}'; {question}"


def advice(typed: str, known: Iterable[str]) -> str:
    """Return the end of a message on a wrong name: "; did you mean 'a'?", or which are known."""
    names = list(known)
    nearest = nearest_name(typed, names)
    return f"; did you mean '{nearest}'?" if nearest else f"; known are {', '.join(names)}"
