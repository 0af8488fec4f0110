"""Which combinations a batch does, and whether the columns that are asked for can tell them apart."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pogosim.batch.configurations.names import COLUMNS, NamesError, has_key, new_columns
from pogosim.batch.configurations.option_words import CHOICES
from pogosim.batch.errors import NothingSelectedError
from pogosim.varied import varied_parameters


def with_output(named: Sequence[tuple[dict[str, Any], str]], wanted: str) -> list[tuple[dict[str, Any], str]]:
    """Return those combinations whose file of results has a name, or path; all if it is empty.

    Args:
        named: Configurations, each with the path of its file of results.
        wanted: The name or path.

    Raises:
        NothingSelectedError: There are none.
    """
    if not wanted:
        return list(named)
    kept = [
        (entries, output)
        for entries, output in named
        if wanted in (output, Path(output).name) or Path(output).absolute() == Path(wanted).absolute()
    ]
    if not kept:
        raise NothingSelectedError(
            f"--only-output: no combination has the output '{wanted}'; --list-outputs shows those that there are"
        )
    return kept


def check_columns_exist(combinations: Sequence[dict[str, Any]]) -> None:
    """Check that each of the new columns is a key in some combination.

    Raises:
        NamesError: One is in none of them.
    """
    for name in new_columns(combinations[0]):
        if not any(has_key(entries, name) for entries in combinations):
            raise NamesError(
                COLUMNS,
                f"there is no key '{name}' in the configuration; expected the dotted paths of keys, such as "
                "objects.robots.nb",
            )


def indistinguishable(selected: Sequence[tuple[dict[str, Any], str, dict[str, Any]]]) -> dict[str, list[str]]:
    """Return files of results with combinations that no column tells apart, and the keys in which those differ.

    Args:
        selected: Configurations, each with its file of results and its new columns.
    """
    alike: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for entries, output, columns in selected:
        alike.setdefault((output, repr(columns)), []).append(entries)
    keys: dict[str, list[str]] = {}
    for (output, _), combinations in alike.items():
        varied = [key.removeprefix(f"{CHOICES}.") for key in varied_parameters(combinations)]
        keys[output] = list(dict.fromkeys([*keys.get(output, []), *varied]))
    return {output: varied for output, varied in keys.items() if varied}
