"""Several data files as one table: which run each row is of, and what differs between the runs."""

from __future__ import annotations

import glob
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.continued import with_joined_parts
from pogosim.deferred import pandas as pd
from pogosim.outputs import PathLike
from pogosim.run_columns import RUN, is_one_run, run_numbers, tells_runs_apart
from pogosim.times import with_exact_times
from pogosim.varied import MISSING, OBJECTS, facts_in_common, in_common, varied_parameters

Loaded = tuple[Path, "pd.DataFrame", "dict[str, Any]"]


def is_pattern(path: PathLike) -> bool:
    """Tell whether a path stands for the files that fit it; a file of that very name comes first."""
    return glob.has_magic(str(path)) and not Path(path).exists()


def files_that_fit(pattern: PathLike) -> list[Path]:
    """Return the files that fit a pattern, sorted: numbers in names by value, so 2.feather comes before 10.feather.

    Raises:
        FileNotFoundError: There is none.
    """
    files = [path for path in map(Path, glob.glob(str(pattern), recursive=True)) if path.is_file()]  # noqa: PTH207
    if not files:
        raise FileNotFoundError(f"no file fits the pattern '{pattern}'")
    return sorted(files, key=lambda path: (natural_order(str(path)), str(path)))


def natural_order(text: str) -> list[tuple[int, int, str]]:
    """Return a sort key in which numbers in the text count as numbers."""
    parts: list[tuple[int, int, str]] = []
    digits = ""
    for character in [*text, ""]:
        if character.isdecimal():
            digits += character
            continue
        if digits:
            parts.append((0, int(digits), ""))
            digits = ""
        parts.append((1, 0, character))
    return parts


def configuration_of(metadata: dict[str, Any]) -> dict[str, Any]:
    """Return the configuration with all defaults if the file has it, otherwise the one that was given."""
    configuration: dict[str, Any] = metadata.get("resolved_configuration") or metadata.get("configuration") or {}
    return configuration


def scalar(value: Any) -> Any:
    """Return a value that fits into one cell: lists and maps as text."""
    return str(value) if isinstance(value, (list, dict)) else value


def combinations_of_file(
    rows: pd.DataFrame, metadata: Mapping[str, Any], added: Mapping[str, Any]
) -> list[dict[str, Any]]:
    """Return the combinations of a file that is joined with others, with the columns that it gets; one for a run."""
    entries: Any = metadata.get("combinations")
    if not isinstance(entries, list):
        entries = [{"columns": {}, "runs": 1, "rows": len(rows), "failed_runs": []}]
    arena = {name: metadata[name] for name in ("arena_polygons",) if isinstance(metadata.get(name), list)}
    columns = {name: value for name, value in added.items() if name != "seed" and value is not None}
    return [{**arena, **entry, "columns": {**columns, **entry.get("columns", {})}} for entry in entries]


def seeds_of_runs(rows: pd.DataFrame, metadata: Mapping[str, Any]) -> npt.NDArray[np.object_] | None:
    """Return the seed of the run of each row of a batch; None for other files, or if the metadata do not say them."""
    combinations = metadata.get("combinations")
    if not isinstance(combinations, list) or RUN not in rows or "files" in metadata:
        return None
    try:
        seeds = [seeds_by_run(entry) for entry in combinations]
        counts = [int(entry["rows"]) for entry in combinations]
    except (KeyError, TypeError, ValueError):
        return None
    runs = rows[RUN].to_numpy()
    if all(own == seeds[0] for own in seeds):
        return np.array([seeds[0].get(run) for run in runs], dtype=object)
    if sum(counts) != len(rows):
        return None
    combination = np.repeat(np.arange(len(counts)), counts)
    return np.array([seeds[place].get(run) for place, run in zip(combination, runs, strict=True)], dtype=object)


def has_own_seeds(metadata: Mapping[str, Any]) -> bool:
    """Tell whether the seeds of a batch are others than the numbers of its runs."""
    combinations = metadata.get("combinations")
    return isinstance(combinations, list) and any("seeds" in entry for entry in combinations)


def seeds_by_run(combination: Mapping[str, Any]) -> dict[int, int]:
    """Return the seeds of the runs of a combination of a batch; those are their numbers, unless it says others."""
    runs = run_numbers(combination)
    return dict(zip(runs, combination.get("seeds", runs), strict=True))


def warn_of_same_runs(files: Sequence[Loaded], parts: Sequence[pd.DataFrame], names: Sequence[str]) -> None:
    """Warn if nothing tells apart runs of two batches: neither their number nor their seed, nor a parameter."""
    seen: dict[tuple[Any, ...], Path] = {}
    for (path, rows, metadata), part in zip(files, parts, strict=True):
        if RUN not in rows or is_one_run(rows, metadata):
            continue
        known = [name for name in part.columns if name in names or tells_runs_apart(str(name))]
        runs = [tuple(map(str, run)) for run in part[known].drop_duplicates().itertuples(index=False)]
        keys = [tuple(zip(known, run, strict=True)) for run in runs]
        if other := next((seen[key] for key in keys if key in seen), None):
            warnings.warn(
                f"{other} and {path} have runs of the same number, seed and parameters, which nothing tells apart; "
                "leave one out, or read them one by one and give their runs other numbers in the column run",
                RuntimeWarning,
                stacklevel=4,
            )
        seen |= dict.fromkeys(keys, path)


def check_own_columns(path: Path, rows: pd.DataFrame, metadata: Mapping[str, Any]) -> None:
    """Raise ValueError if the program of a single run wrote a column that would say which run its rows are of."""
    own = [name for name in map(str, rows.columns) if tells_runs_apart(name)]
    if own and is_one_run(rows, metadata):
        raise ValueError(
            f"{path}: its program writes a column '{own[0]}', and columns of that name tell apart the runs of files "
            "that are read together; choose another name in the program (data_add_column_*), or read the files one by "
            "one and rename the column"
        )


def is_kept_beside(path: Path, other: Path) -> bool:
    """Tell whether the window has kept a file under this name, when a run wrote the other one again (run.1.feather)."""
    number = Path(path.stem).suffix[1:]
    return path.parent == other.parent and number.isdecimal() and path.name == f"{other.stem}.{number}{other.suffix}"


def warn_of_copies(files: Sequence[Loaded], added: Mapping[str, Sequence[Any]]) -> None:
    """Warn of two files of the same seed and parameters that hold the same rows, or of which one was kept."""
    alike: dict[str, list[Loaded]] = {}
    for number, file in enumerate(files):
        values = {name: scalar(found[number]) for name, found in added.items() if name != "run"}
        if values.get("seed") is not None:
            alike.setdefault(str(values), []).append(file)
    for group in alike.values():
        for index, (path, rows, _) in enumerate(group):
            for other_path, other_rows, _ in group[:index]:
                kept = is_kept_beside(path, other_path) or is_kept_beside(other_path, path)
                if kept or (len(rows) == len(other_rows) and rows.equals(other_rows)):
                    warnings.warn(
                        f"{other_path} and {path} are of the same seed and parameters"
                        f"{', and one was kept when the run was repeated' if kept else ' and hold the same rows'}: "
                        "they count as two runs; leave one out",
                        RuntimeWarning,
                        stacklevel=3,
                    )
                    break


def join_files(files: Sequence[Loaded]) -> tuple[pd.DataFrame, dict[str, Any]]:
    """Join the rows of several data files.

    Args:
        files: Path, rows and metadata of each, as `load_dataframe` reads one of them. Parts of a run that went on from
            a saved state count as one file, whose rows after the state are those of the later part.

    Returns:
        All rows, in the order of the files, with these columns in addition, unless the file has them:
        `run`, the number of the file (0, 1, ...); `seed`, if a configuration has one or a batch other seeds than the
        numbers of its runs; and for each key whose value differs between the files, its dotted path
        (`objects.robots.nb`). Null where a file has no such key; lists as text.
        And the metadata that all files have in common, `files` with the names of the files, and `configuration` with
        the common entries. If arenas differ, `combinations` has those of all files, with
        their arenas; a file of one run is a combination of its own.

    Raises:
        ContinuedError: A part of a run that went on from a saved state is missing.
        ValueError: There are no files; or the program of one has a column by which files are told apart.
    """
    if not files:
        raise ValueError("there are no files to read: the list is empty")
    names = [str(path) for path, _, _ in files]
    files = with_joined_parts(files, [configuration_of(metadata) for _, _, metadata in files])
    configurations = [configuration_of(metadata) for _, _, metadata in files]
    of_batches = [seeds_of_runs(rows, metadata) for _, rows, metadata in files]
    added: dict[str, list[Any]] = {
        "run": list(range(len(files))),
        "seed": [
            own.get("seed") if of_batch is None else None
            for own, of_batch in zip(configurations, of_batches, strict=True)
        ],
    }
    if all(seed is None for seed in added["seed"]) and not any(has_own_seeds(metadata) for _, _, metadata in files):
        del added["seed"]
    added |= varied_parameters(configurations)
    warn_of_copies(files, added)
    parts, combinations = [], []
    for number, (path, rows, own) in enumerate(files):
        check_own_columns(path, rows, own)
        missing = {name: scalar(found[number]) for name, found in added.items() if name not in rows.columns}
        if (seeds := of_batches[number]) is not None and "seed" in missing:
            missing["seed"] = seeds if any(seed is None for seed in seeds) else seeds.astype(np.int64)
        parts.append(rows.assign(**missing))
        combinations += combinations_of_file(rows, own, missing)
    warn_of_same_runs(files, parts, list(added))
    if len({str(rows["time"].dtype) for rows in parts if list(rows.columns).count("time") == 1}) > 1:
        parts = [with_exact_times(rows) for rows in parts]
    metadata: dict[str, Any] = in_common([metadata for _, _, metadata in files])
    metadata = {} if metadata is MISSING else metadata
    if facts := facts_in_common([own.get(OBJECTS) for _, _, own in files]):
        metadata[OBJECTS] = facts
    metadata.setdefault("configuration", {})
    if not metadata.get("arena_polygons") and any(entry.get("arena_polygons") for entry in combinations):
        metadata["combinations"] = combinations
    metadata["files"] = names
    return pd.concat(parts, ignore_index=True), metadata
