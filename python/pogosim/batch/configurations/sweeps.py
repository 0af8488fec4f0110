"""The combinations of a configuration and what they are called, as plain functions of maps and files."""

from __future__ import annotations

import contextlib
import logging
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from pogosim.batch.configurations.combinations import alternatives_of, combinations_of, resolved
from pogosim.batch.configurations.configuration import Configuration
from pogosim.batch.configurations.names import NamesError, file_name, new_columns
from pogosim.batch.configurations.option_words import (
    HIERARCHICAL_OPTIONS,
    NOT_EXPANDED,
    CombinationsError,
    OptionsError,
    check_options,
    offers_options,
)
from pogosim.batch.configurations.options import expand_batch_options
from pogosim.batch.configurations.seeds import seeds_between, seeds_up_to
from pogosim.batch.configurations.tool_maps import POGOBATCH, RESULT_KEYS, RUNDR, VERSION, without_tool_maps
from pogosim.batch.errors import BatchError, at_least, given

Entries = dict[str, Any]

log = logging.getLogger("pogobatch")


@contextlib.contextmanager
def told() -> Iterator[None]:
    """Raise BatchError for what a block finds wrong with options or names."""
    try:
        yield
    except (NamesError, CombinationsError) as error:
        raise BatchError(str(error)) from None


def build_combinations(config_path: str | Path) -> list[Entries]:
    """Return the configuration of every combination of options in a file, in order; the last option varies fastest.

    Raises:
        BatchError: The file cannot be read, or its options are wrong.
    """
    return Configuration(given.path("config_path", config_path)).combinations()


def expand_combinations(config: Mapping[str, Any]) -> list[Entries]:
    """Return the configuration of every combination of options in a map, which is not changed.

    The maps `pogobatch` and `_rundr` are not in them; what the first one says of results is at their top level.

    Raises:
        BatchError: The options are wrong.
    """
    with told():
        return combinations_of(plain_entries(config))


def count_combinations(config: Mapping[str, Any]) -> int:
    """Return the number of combinations of options in a map, without making them.

    Raises:
        BatchError: The options are wrong.
    """
    with told():
        entries = plain_entries(config)
        check_options(entries)
        return count_in(entries, ())


def count_in(node: Any, path: tuple[str, ...]) -> int:
    """Return the number of variants of a node."""
    if isinstance(node, dict) and HIERARCHICAL_OPTIONS in node:
        return sum(count_in(merged, path) for _, _, merged in alternatives_of(node, path))
    if offers_options(node):
        try:
            values = expand_batch_options(node)
        except OptionsError as error:
            raise CombinationsError(path, str(error)) from None
        return sum(1 if value is node else count_in(value, path) for value in values)
    if isinstance(node, dict):
        inner = {key: value for key, value in node.items() if path or key not in NOT_EXPANDED}
        return math.prod(count_in(value, (*path, str(key))) for key, value in inner.items())
    if isinstance(node, list):
        return math.prod(count_in(value, (*path, str(number))) for number, value in enumerate(node))
    return 1


def resolve_batch_defaults(config: Mapping[str, Any]) -> Entries:
    """Return the configuration of a single run: the `default_option` of all options, the alternative `default`.

    Raises:
        BatchError: Options have no default, or are wrong.
    """
    with told():
        return resolved(plain_entries(config))


def make_rundra_sweep_config(config: Mapping[str, Any], seeds: int | str | None = None) -> Entries:
    """Return a configuration with all its options, in the form in which schedulers of sweeps take it.

    Args:
        config: The configuration; it is not changed.
        seeds: Number of seeds (0, 1, ...), or the first and the last one, "A:B"; None: those of its own `_rundr`.

    Returns:
        The configuration; what says where results go is in its map `pogobatch`, and `_rundr` has `version` and `seeds`.

    Raises:
        BatchError: The options or the seeds are wrong, or there are no seeds.
    """
    own = config.get(RUNDR)
    if seeds is None and isinstance(own, Mapping):
        seeds = own.get("seeds")
    if seeds is None:
        raise BatchError('make_rundra_sweep_config: there are no seeds; give a number of them, or "A:B"')
    if isinstance(seeds, str):
        seeds_between(seeds, "seeds")
    else:
        seeds_up_to(at_least(1, seeds, "seeds"), "seeds")
    count_combinations(config)
    entries = plain_entries(config)
    maps = config.get(POGOBATCH)
    results = {key: entries.pop(key) for key in RESULT_KEYS if key in entries}
    inner = {**(maps if isinstance(maps, Mapping) else {}), **results}
    return {**entries, **({POGOBATCH: inner} if inner else {}), RUNDR: {"version": VERSION, "seeds": seeds}}


def compute_result_filename(config: Mapping[str, Any]) -> str:
    """Return the name of the file with the results of a combination, in the folder of the results.

    Raises:
        BatchError: `result_filename_format` is wrong.
    """
    with told():
        return file_name(plain_entries(config))


def compute_extra_columns(config: Mapping[str, Any]) -> Entries:
    """Return the constant columns of the results of a combination: names (dotted paths) and values.

    Raises:
        BatchError: `result_new_columns` is wrong.
    """
    with told():
        return new_columns(plain_entries(config))


def plain_entries(config: Mapping[str, Any]) -> Entries:
    """Return a configuration without the maps that are for batch tools alone.

    Raises:
        CombinationsError: They are wrong.
    """
    if not isinstance(config, Mapping):
        raise given.refused("config", "a map of keys and values", config)
    return without_tool_maps(dict(config), lambda path, text: log.warning("%s: %s", ".".join(path), text)).entries
