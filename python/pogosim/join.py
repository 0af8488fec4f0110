"""Make one data file of the parts of a run that went on from saved states."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import pyarrow as pa
import pyarrow.compute as pc

from pogosim.continued import (
    ROUNDING_S,
    ContinuedError,
    Part,
    before,
    begin_of,
    check_columns,
    counted_parts,
    counts_rows,
    goes_on,
    identity,
    in_order,
    rows_of,
    whole_schema,
)
from pogosim.outputs import PathLike, leads_to, lock, real_output
from pogosim.recover import (
    DAMAGED,
    INCOMPLETE,
    RECOVERED,
    NoRowsError,
    RecoverError,
    check_is_file,
    check_metadata_beside,
    check_replaceable,
    is_complete,
    is_ours_in_other_format,
    last_time_s,
    locked,
    open_rows,
    reraise_system_error,
    rows_up_to,
    write_complete,
)
from pogosim.table_formats import EXPECTED, format_of
from pogosim.table_metadata import metadata_of, parse_configuration
from pogosim.tables import read_other

ROWS_AT_ONCE = 65536


@dataclass(frozen=True)
class Source:
    """A part as it is in its file."""

    part: Part
    schema: pa.Schema
    rows: int  # that can be read
    table: pa.Table | None  # all of a Parquet or CSV file; rows of others are read when they are needed

    def batches(self, end: float | None) -> Iterator[pa.RecordBatch]:
        """Yield the rows that count; end: None, or up to where."""
        if not self.part.by_rows:
            for batch in rows_of(self.part.path, self.rows) if self.table is None else self.table.to_batches():
                yield batch if end is None else batch.filter(pc.less(batch.column("time"), end - ROUNDING_S))
            return
        count = self.rows if end is None else int(end - self.part.begin)
        if self.table is None:
            yield from rows_of(self.part.path, count)
        else:
            yield from self.table.slice(0, count).to_batches()


@dataclass(frozen=True)
class Joined:
    """What was written: how many rows of how many parts, the last time, and parts without a row of the run."""

    rows: int
    parts: int
    last_s: float | None
    left_out: tuple[Path, ...]

    @property
    def told(self) -> str:
        """What is said of it."""
        return f"{rows_up_to(self.rows, self.last_s)}, of {self.parts} part{'' if self.parts == 1 else 's'}"


def join(paths: Sequence[PathLike], output: PathLike) -> Joined:
    """Make one data file, or message log, of the parts of a run, as of one that was never interrupted.

    Args:
        paths: Files of the parts, in any order. Those that are not needed are left out.
        output: Where to write, in the format that its name says. Nothing there is touched before all is written.

    Raises:
        ToolError: The files are not parts of one run, a part is missing, or the output cannot be one.
        OSError: A file cannot be read or written.
    """
    target = checked_target(paths, output)
    found, left_out = sources(list(dict.fromkeys(map(Path, paths))))
    counted = chosen(found)
    last = counted[-1][0]
    left_out += [one.part.path for one in found if all(one is not source for source, _ in counted)]
    schema = joined_schema(last.schema)
    for source, _ in counted:
        check_columns(source.part.path, source.schema, last.part.path, schema)
    rows, last_s = 0, -math.inf

    def tables() -> Iterator[pa.Table]:
        nonlocal rows, last_s
        for table in in_larger_pieces((batch for source, end in counted for batch in source.batches(end)), schema):
            rows += table.num_rows
            last_s = max(last_s, -math.inf if (time_s := last_time_s(table)) is None else time_s)
            yield table

    with locked(target) if target.exists() else contextlib.nullcontext():
        try:
            write_complete(tables(), schema, target, (target if target.exists() else last.part.path).stat())
        except pa.ArrowException as error:
            raise ContinuedError(f"the rows of the parts cannot be joined: {error}") from error
    return Joined(rows, len(counted), last_s if math.isfinite(last_s) else None, tuple(left_out))


def checked_target(paths: Sequence[PathLike], output: PathLike) -> Path:
    """Return where the output leads.

    Raises:
        ToolError: It cannot be written there.
    """
    target = real_output(output)
    if any(leads_to(output, path) for path in paths):
        raise ContinuedError(f"{output} is one of the parts, which stay as they are; choose another file with -o")
    if format_of(target) is None:
        raise ContinuedError(f"{output}: its format is unknown; expected {EXPECTED}")
    check_metadata_beside(target)
    if target.exists():
        check_replaceable(target)
    return target


def sources(paths: Sequence[Path]) -> tuple[list[Source], list[Path]]:
    """Open the parts. Returns them, and those that were killed before their first row.

    Raises:
        ToolError: One is no file of a run, is being written, or they are not of one run.
        OSError: One cannot be read.
    """
    found, without_rows = [], []
    for path in paths:
        check_is_file(path)
        with path.open("rb") as file:
            if not lock(file):
                raise ContinuedError(f"{path} is in use by a run; wait for its end")
        try:
            found.append(source(path))
        except NoRowsError:
            without_rows.append(path)
    if not found:
        raise ContinuedError(f"{paths[0]} has no row: its run was killed while it began")
    metadata = [one.schema.metadata or {} for one in found]
    by_rows = all(counts_rows(own) or not goes_on(own) for own in metadata)
    check_one_run(found)
    parts = [replace(one.part, by_rows=by_rows, end=one.part.end if by_rows else math.inf) for one in found]
    return [replace(one, part=part) for one, part in zip(found, parts, strict=True)], without_rows


def source(path: Path) -> Source:
    """Open a part, and count its rows.

    Raises:
        RecoverError: It is no file of the simulator.
    """
    try:
        table = read_other(path) if is_ours_in_other_format(path) else None
    except DAMAGED as error:
        reraise_system_error(error)
        raise RecoverError(f"{path} is damaged: {error}") from error
    if table is not None:
        schema, rows = table.schema, table.num_rows
    else:
        with path.open("rb") as file:
            schema = open_rows(path, file).schema
        if is_complete(path) and not is_complete(path, to_the_last_row=True):
            raise RecoverError(
                f"{path} is damaged; to save its first rows: pogosim recover {path} -o another_file.feather"
            )
        rows = row_count(path)
    metadata = schema.metadata or {}
    begin = begin_of(metadata)
    return Source(Part(path, begin, begin + rows, goes_on(metadata)), schema, rows, table)


def row_count(path: Path) -> int:
    """Return how many rows can be read of a file, complete or not."""
    rows = 0
    with path.open("rb") as file, contextlib.suppress(*DAMAGED):
        for batch in open_rows(path, file):
            rows += batch.num_rows
    return rows


def check_one_run(found: Sequence[Source]) -> None:
    """Raise ContinuedError for files of several runs."""
    first, *others = [(one.part.path, configuration(one.schema)) for one in found]
    for path, own in others:
        for key in [*first[1], *own]:
            if first[1].get(key) != own.get(key):
                values = f"{key} is {first[1].get(key)} in the one, and {own.get(key)} in the other"
                raise ContinuedError(f"{first[0]} and {path} are not of one run: {values}")
    if not any(one.part.goes_on for one in found):
        raise ContinuedError(f"no run goes on from a saved state in {', '.join(str(one.part.path) for one in found)}")


def configuration(schema: pa.Schema) -> Mapping[str, str]:
    """Return what parts of one run have in common of their configurations."""
    metadata = metadata_of(schema)
    entries = parse_configuration(metadata.get("resolved_configuration") or metadata.get("configuration", ""))
    return identity(entries)


def chosen(found: Sequence[Source]) -> list[tuple[Source, float | None]]:
    """Return the parts that count, in order, and up to where."""
    parts = [one.part for one in found]
    order = in_order(parts)
    last = next(place for place in reversed(order) if parts[place].goes_on)
    counted = counted_parts(before(parts, order, last))
    return [(next(one for one in found if one.part is part), end) for part, end in counted]


def joined_schema(last: pa.Schema) -> pa.Schema:
    """Return the schema of the whole run; its metadata say if the last part was killed."""
    schema = whole_schema(last)
    if INCOMPLETE not in (last.metadata or {}):
        return schema
    told = b"The run did not end by itself; these are the rows that were saved."
    return schema.with_metadata({**(schema.metadata or {}), RECOVERED: told})


def in_larger_pieces(batches: Iterator[pa.RecordBatch], schema: pa.Schema) -> Iterator[pa.Table]:
    """Yield rows in tables of some size, whatever that of the pieces is in which they were written."""
    kept: list[pa.RecordBatch] = []
    rows = 0
    for batch in batches:
        kept.append(pa.RecordBatch.from_arrays(batch.columns, schema=schema))
        rows += batch.num_rows
        if rows >= ROWS_AT_ONCE:
            yield pa.Table.from_batches(kept, schema).combine_chunks()
            kept, rows = [], 0
    if rows:
        yield pa.Table.from_batches(kept, schema).combine_chunks()
