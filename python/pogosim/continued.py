"""Runs that went on from a saved state: which files have the parts of one run, and its rows, joined from them."""

from __future__ import annotations

import contextlib
import math
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyarrow as pa

from pogosim.errors import ToolError
from pogosim.recover import DAMAGED, INCOMPLETE, RecoverError, open_rows, reraise_system_error
from pogosim.table_formats import FEATHER
from pogosim.tables import table_writer
from pogosim.varied import leaves

if TYPE_CHECKING:
    import pandas as pd

# In the metadata of a part that goes on: the number of rows before, and the time from which it does. Message logs have
# no number.
AFTER_ROWS = "continued_after_rows"
FROM_S = "continued_from_s"
CONTINUED = (FROM_S.encode(), AFTER_ROWS.encode())
NOT_OF_THE_WHOLE = (*CONTINUED, INCOMPLETE)

# What a run may do otherwise from a state on (src/sim/state_file.cpp), but for its seed; and keys that begin so.
FREE_KEYS = frozenset(
    (
        *("simulation_time", "user_code_timeout", "threads", "enable_data_logging", "data_filename"),
        *("save_data_period", "save_data_times", "data_logger_fields", "data_logger_category"),
        *("data_logger_flush_row_count", "data_logger_led", "message_log", "enable_console_logging"),
        *("console_filename", "log_format", "GUI", "GUI_speed_up", "window_width", "window_height", "mm_to_pixels"),
        *("save_video_period", "frames_name", "delete_old_files", "progress_bar", "batch_options", "optimization"),
        *("flash_state", "view"),
    )
)
FREE_BEGINNING = "show_"

ROUNDING_S = 1e-7  # of times: far less than any time step


class ContinuedError(ToolError, ValueError):
    """The parts of a run cannot be joined; says why."""


@dataclass(frozen=True)
class Part:
    """A file with rows of a run that went on from a state, or of which one was saved.

    Its begin and its end are numbers of rows of the whole run; of message logs, times in s.
    """

    path: Path
    begin: float
    end: float = math.inf  # or what is not known
    goes_on: bool = True  # from a state; perhaps from one before the first row
    by_rows: bool = True


# ---- which parts count ----


def begin_of(metadata: Mapping[Any, Any]) -> float:
    """Return what came before a part, by its metadata (texts, or bytes): rows; or a time in s, of message logs."""
    for key in (AFTER_ROWS, FROM_S):
        value = metadata.get(key, metadata.get(key.encode()))
        with contextlib.suppress(TypeError, ValueError):
            return float(value)
    return 0.0


def goes_on(metadata: Mapping[Any, Any]) -> bool:
    """Tell by the metadata of a file whether its run went on from a saved state."""
    return any(key in metadata or key.encode() in metadata for key in (AFTER_ROWS, FROM_S))


def counts_rows(metadata: Mapping[Any, Any]) -> bool:
    """Tell whether the metadata of a part that goes on say how many rows came before."""
    return AFTER_ROWS in metadata or AFTER_ROWS.encode() in metadata


def counted_parts(parts: Sequence[Part]) -> list[tuple[Part, float | None]]:
    """Return which parts have rows of the run, in order, and up to where they count; None: to their ends.

    Rows after the state from which the run went on are in the next part again; a part that was killed before it saved
    a state has none that count.

    Args:
        parts: In the order in which they were written.

    Raises:
        ContinuedError: A part is missing.
    """
    counted: list[tuple[Part, float | None]] = [(parts[-1], None)]
    missing = parts[-1].begin
    for part in reversed(parts[:-1]):
        if part.begin < missing <= part.end:
            counted.append((part, missing))
            missing = part.begin
    if missing > 0.0:
        raise ContinuedError(missing_text(counted[-1][0]))
    return counted[::-1]


def missing_text(part: Part) -> str:
    """Return what is said where nothing comes before a part."""
    known = [path.name for path in parts_of(plain_name(part.path)) if path != part.path and number_in(path) < math.inf]
    earlier = [name for name in known if number_in(Path(name)) < number_in(part.path)]
    hint = f", such as {' '.join(earlier)} beside it" if earlier else ""
    before = (
        f"the first {part.begin:.0f} rows of the run are" if part.by_rows else f"what came before {part.begin:g} s is"
    )
    return f"{part.path} goes on from a saved state, and {before} missing: give its earlier parts, too{hint}"


def number_in(path: Path) -> float:
    """Return the number of an earlier part in its name, data.1.feather; infinite for the last one, data.feather."""
    number = Path(path.stem).suffix[1:]
    return int(number) if number.isdecimal() else math.inf


def plain_name(path: Path) -> Path:
    """Return the name of the last part of a run of which a file is a part, by its name."""
    return path if number_in(path) == math.inf else path.with_name(f"{Path(path.stem).stem}{path.suffix}")


def in_order(parts: Sequence[Part]) -> list[int]:
    """Return the places of the parts of a run in the order in which they were written.

    Numbers in names say it; files of other names have the order of the states from which they go on.
    """
    latest: dict[Path, float] = {}
    for part in parts:
        name = plain_name(part.path)
        latest[name] = max(latest.get(name, 0.0), part.begin)
    keys = [(latest[plain_name(part.path)], number_in(part.path)) for part in parts]
    return sorted(range(len(parts)), key=keys.__getitem__)


def identity(configuration: Mapping[str, Any]) -> dict[str, str]:
    """Return what parts of one run have in common of their configurations: values by dotted path."""
    entries = dict(leaves(configuration))
    return {path: str(value) for path, value in entries.items() if not is_free(path)}


def is_free(path: str) -> bool:
    """Tell whether a run may go on with another value of a key."""
    return path.split(".")[0] in FREE_KEYS or path.startswith(FREE_BEGINNING)


# ---- dataframes ----

Loaded = tuple[Path, "pd.DataFrame", "dict[str, Any]"]


def with_joined_parts(files: Sequence[Loaded], configurations: Sequence[Mapping[str, Any]]) -> list[Loaded]:
    """Return files that are read together, with one in place of all parts of a run that went on from a state.

    Args:
        files: Path, rows and metadata of each.
        configurations: Theirs.

    Raises:
        ContinuedError: A part is missing, or has other columns.
    """
    if not any(goes_on(metadata) for _, _, metadata in files):
        return list(files)
    groups: dict[str, list[int]] = {}
    for number, ((_, rows, _), configuration) in enumerate(zip(files, configurations, strict=True)):
        groups.setdefault(str((sorted(identity(configuration).items()), "outcome" in rows)), []).append(number)
    joined: dict[int, Loaded] = {}
    for group in groups.values():
        joined |= joined_in_group({number: files[number] for number in group})
    return [joined[number] for number in sorted(joined)]


def joined_in_group(files: Mapping[int, Loaded]) -> dict[int, Loaded]:
    """Join the parts among the files of one configuration; those of each run get the number of its first file.

    Where there are parts, a file that is given twice counts once.
    """
    if not any(goes_on(metadata) for _, _, metadata in files.values()):
        return dict(files)
    first: dict[Path, int] = {}
    for number, (path, _, _) in files.items():
        first.setdefault(path.resolve(), number)
    files = {number: files[number] for number in sorted(first.values())}
    numbers = list(files)
    by_rows = any(counts_rows(metadata) for _, _, metadata in files.values())
    parts = []
    for path, rows, metadata in files.values():
        begin = begin_of(metadata)
        end = begin + len(rows) if by_rows else math.inf
        parts.append(Part(path, begin, end, goes_on(metadata), by_rows))
    left = in_order(parts)
    joined: dict[int, Loaded] = {}
    while (last := next((place for place in reversed(left) if parts[place].goes_on), None)) is not None:
        try:
            counted = counted_parts(before(parts, left, last))
        except ContinuedError:
            # That run has been gone on with from the same state again: its rows are in the other parts.
            counted_parts(before(parts, in_order(parts), last))
            left.remove(last)
            continue
        own = [next(place for place in left if parts[place] is part) for part, _ in counted]
        ends = [end for _, end in counted]
        joined[min(numbers[place] for place in own)] = whole([files[numbers[place]] for place in own], ends, by_rows)
        left = [place for place in left if place not in own]
        if counted[0][0].goes_on:  # from a state before the first row: none of what was before counts
            left = [place for place in left if parts[place] not in without_rows(before(parts, left, last)[:-1])]
    return joined | {numbers[place]: files[numbers[place]] for place in left}


def without_rows(earlier: Sequence[Part]) -> list[Part]:
    """Return the parts before one that has all rows of its run."""
    found: list[Part] = []
    for part in reversed(earlier):
        if part.begin == 0.0:
            found.append(part)
            if not part.goes_on:
                break
    return found


def before(parts: Sequence[Part], order: Sequence[int], last: int) -> list[Part]:
    """Return a part behind those that may come before it: of other names, and of its own, which are more likely."""
    name = plain_name(parts[last].path)
    others = [place for place in order if place != last]
    return [parts[place] for place in sorted(others, key=lambda place: plain_name(parts[place].path) == name)] + [
        parts[last]
    ]


def whole(files: Sequence[Loaded], ends: Sequence[float | None], by_rows: bool) -> Loaded:
    """Return the rows of all parts of a run, with the metadata of the last one, as those of one in one go."""
    import pandas as pd  # takes a while

    path, last, metadata = files[-1]
    pieces = []
    for (own, rows, of_part), end in zip(files, ends, strict=True):
        if list(rows.columns) != list(last.columns):
            raise ContinuedError(other_columns(own, path))
        if end is not None:
            rows = rows.iloc[: int(end - begin_of(of_part))] if by_rows else rows[rows["time"] < end - ROUNDING_S]
        pieces.append(rows)
    table = pd.concat([rows for rows in pieces if len(rows)] or [last], ignore_index=True)
    return path, table, {key: value for key, value in metadata.items() if key not in (AFTER_ROWS, FROM_S)}


def check_columns(part: Path, own: pa.Schema, last: Path, schema: pa.Schema) -> None:
    """Raise ContinuedError if a part has other columns than the last one."""
    if not own.equals(schema, check_metadata=False):
        raise ContinuedError(other_columns(part, last))


def other_columns(part: Path, last: Path) -> str:
    """Return what is said of parts that cannot be one table."""
    return f"{part} and {last} are parts of one run, but with other columns"


# ---- data files ----


def parts_of(data: Path) -> list[Path]:
    """Return the data files of a run and of its earlier parts that are there, in order."""
    name = re.compile(rf"{re.escape(data.stem)}\.(\d+){re.escape(data.suffix)}")
    try:
        numbered = [(int(found[1]), path) for path in data.parent.iterdir() if (found := name.fullmatch(path.name))]
    except FileNotFoundError:
        return []
    return [path for _, path in sorted(numbered)] + ([data] if data.exists() else [])


@contextlib.contextmanager
def opened_part(path: Path) -> Iterator[pa.ipc.RecordBatchStreamReader]:
    """Open the rows of a part, which may be unfinished.

    Raises:
        ContinuedError: It ends before its first row could.
        OSError: It cannot be read.
    """
    with path.open("rb") as file:
        try:
            reader = open_rows(path, file)
        except RecoverError as error:
            raise ContinuedError(str(error)) from None
        yield reader


def readable_parts(paths: Sequence[Path]) -> list[Part]:
    """Return parts, without those that were killed while they began; the last one has to be readable."""
    parts = []
    for path in paths:
        try:
            with opened_part(path) as reader:
                parts.append(Part(path, begin_of(reader.schema.metadata or {})))
        except ContinuedError:
            if path == paths[-1]:
                raise
    return parts


def whole_schema(schema: pa.Schema) -> pa.Schema:
    """Return the schema of a run that was never interrupted, of that of its last part."""
    metadata = schema.metadata or {}
    return schema.with_metadata({key: metadata[key] for key in metadata if key not in NOT_OF_THE_WHOLE})


def join_parts(data: Path) -> None:
    """Put the rows of all parts of a run into its data file; memory does not grow with their number.

    Raises:
        ContinuedError: Rows are missing.
        OSError: It cannot be written.
    """
    counted = counted_parts(readable_parts(parts_of(data)))
    with opened_part(data) as last:
        if not any(key in (last.schema.metadata or {}) for key in CONTINUED):
            return  # it has all rows
        schema = whole_schema(last.schema)
    scratch = data.with_name(f"{data.name}.joined")
    try:
        with scratch.open("wb") as file:
            with contextlib.closing(table_writer(file, FEATHER, schema)) as writer:
                for batch in rows_of_parts(counted, schema):
                    writer.write_table(pa.table(batch.columns, schema=schema))
            file.flush()
            os.fsync(file.fileno())
        scratch.replace(data)
    finally:
        scratch.unlink(missing_ok=True)


def rows_of_parts(counted: Sequence[tuple[Part, float | None]], schema: pa.Schema) -> Iterator[pa.RecordBatch]:
    """Yield the rows of the parts of a run.

    Raises:
        ContinuedError: One has less rows, or other columns.
    """
    for part, end in counted:
        for batch in rows_of(part.path, None if end is None else int(end - part.begin)):
            check_columns(part.path, batch.schema, counted[-1][0].path, schema)
            yield batch


def rows_of(path: Path, count: int | None) -> Iterator[pa.RecordBatch]:
    """Yield the first rows of a part, or all.

    Raises:
        ContinuedError: It has less.
    """
    left = count
    with opened_part(path) as reader:
        while left is None or left > 0:
            try:
                batch = reader.read_next_batch()
                batch.validate(full=True)
            except StopIteration:
                break
            except DAMAGED as error:
                reraise_system_error(error)
                if left is None:
                    raise
                break
            batch = batch if left is None else batch.slice(0, left)
            left = None if left is None else left - batch.num_rows
            if batch.num_rows:
                yield batch
    if left:
        raise ContinuedError(f"{path} lacks {left} rows before the state")
