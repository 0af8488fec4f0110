"""`pogosim flash`: looks into archives of robots' flash memory (`flash_state`), and makes them."""

from __future__ import annotations

import argparse
import io
import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import BinaryIO

from pogosim.command.parser import Parser, complain
from pogosim.errors import ToolError
from pogosim.flash_archive import (
    FLASH_BYTES,
    LONGEST_CATEGORY,
    PAGE_COUNT,
    ArchiveError,
    Record,
    bytes_of_head,
    read_head,
    records_of,
    write_archive,
)
from pogosim.lines import counted, say
from pogosim.outputs import OutputError, leads_to, locked_output, partial_output, real_output, told

IDS = 65536
EMPTY = bytes_of_head(0)
DAMAGED = 1  # exit code of show: a checksum is wrong


class FlashError(ToolError):
    """What was asked for cannot be done; says why."""


def parser(prog: str) -> Parser:
    """Return the command line."""
    made = Parser(prog=prog, description="Looks into archives of robots' flash memory (docs/flash.md), and makes them.")
    actions = made.add_subparsers(dest="action", required=True, metavar="ACTION", parser_class=Parser)
    show = actions.add_parser("show", help="list the robots of an archive, and check it")
    extract = actions.add_parser("extract", help="write the flash memory of one robot to a binary file")
    make = actions.add_parser("make", help="make an archive: blank, or with the flash memory of binary files")
    for action in (show, extract):
        action.add_argument("archive", metavar="FILE", help="archive")
    make.add_argument("archive", metavar="FILE", help="archive to write")
    extract.add_argument("-r", "--robot", metavar="ID", type=int, required=True, help="id of the robot")
    extract.add_argument("--category", metavar="NAME", help="its category, if several have a robot of this id")
    extract.add_argument("-o", "--output", metavar="OUT.bin", required=True, help=f"file to write, {FLASH_BYTES} bytes")
    make.add_argument(
        "-c", "--config", metavar="CONFIG", help="configuration whose robots the archive is for; their memory is blank"
    )
    make.add_argument(
        "--from",
        dest="binaries",
        metavar=("CATEGORY", "ID", "FILE.bin"),
        nargs=3,
        action="append",
        default=[],
        help="flash memory of a robot, from page 0 on; the rest is blank. May be given several times",
    )
    make.add_argument(
        "--force", action="store_true", help="replace FILE, even if it has flash memory, or is something else"
    )
    for action in (show, extract, make):
        action.add_argument("--json", action="store_true", help="print one JSON object")
    return made


def opened(name: str, expected: str) -> BinaryIO:
    """Open a file to read it; a pipe is not waited for.

    Raises:
        FlashError: It is not a file.
        OSError: It cannot be opened.
    """
    if not Path(name).is_file() and not Path(name).is_dir() and Path(name).exists():
        raise FlashError(f"{name} is not a file, but a pipe, a socket or a device; expected {expected}")
    return Path(name).open("rb")


def read_records(name: str) -> Iterator[tuple[Record, bool]]:
    """Yield the records of an archive, each of 1.5 MB, and whether the checksum of each is right."""
    with opened(name, "an archive") as file:
        try:
            yield from records_of(file)
        except ArchiveError as error:
            raise FlashError(f"{name}: {error}") from None


def show(options: argparse.Namespace) -> tuple[int, list[str]]:
    """List the records of an archive. Returns the exit code, and lines to print."""
    rows = [
        {
            "category": shown_name(record.category),
            "id": record.identifier,
            "written_pages": len(record.written_pages()),
            "directions": list(record.directions),
            "powers": list(record.powers),
            "checksum": "right" if is_right else "wrong",
        }
        for record, is_right in read_records(options.archive)
    ]
    damaged = sum(row["checksum"] == "wrong" for row in rows)
    if options.json:
        about = {"file": shown_name(options.archive), "ok": damaged == 0, "flash_bytes": FLASH_BYTES, "records": rows}
        return DAMAGED if damaged else 0, [json.dumps(about)]
    lines = [f"{options.archive}: {counted(len(rows), 'record')}, each of {PAGE_COUNT} pages of 256 bytes"]
    if rows:
        titles = ("category", "id", "written pages", "directions", "powers (right, left, back)", "checksum")
        cells = [[text_of(value) for value in row.values()] for row in rows]
        widths = [max(map(len, column)) for column in zip(titles, *cells, strict=True)]
        for row in (titles, *cells):
            lines.append("  ".join(f"{cell:{width}}" for cell, width in zip(row, widths, strict=True)).rstrip())
    if damaged:
        lines.append(f"{counted(damaged, 'record')} damaged: the simulator refuses this archive")
    return DAMAGED if damaged else 0, lines


def extract(options: argparse.Namespace) -> tuple[int, list[str]]:
    """Write the flash memory of one robot. Returns the exit code, and lines to print."""
    output = real_output(options.output)
    if leads_to(options.output, options.archive):
        raise OutputError(f"{options.output} is the archive, which would be lost; choose another --output")
    found = [
        (record, is_right)
        for record, is_right in read_records(options.archive)
        if record.identifier == options.robot and options.category in (None, record.category)
    ]
    name = f"robot #{options.robot}" + (f" of category '{options.category}'" if options.category else "")
    if not found:
        raise FlashError(f"{options.archive} has no record of {name}; pogosim flash show lists those it has")
    if len(found) > 1:
        categories = ", ".join(shown_name(record.category) for record, _ in found)
        raise FlashError(
            f"{options.archive} has robots #{options.robot} of several categories; add --category, one of {categories}"
        )
    record, is_right = found[0]
    if not is_right:
        raise FlashError(f"{options.archive}: the record of {name} is damaged: its checksum is wrong")
    with partial_output(output) as partial:
        partial.write_bytes(record.flash)
    pages = len(record.written_pages())
    if options.json:
        about = {
            "file": shown_name(options.output),
            "category": shown_name(record.category),
            "id": record.identifier,
            "written_pages": pages,
        }
        return 0, [json.dumps(about)]
    return 0, [f"{options.output}: {FLASH_BYTES} bytes, {counted(pages, 'page')} not blank"]


def make(options: argparse.Namespace) -> tuple[int, list[str]]:
    """Write an archive. Returns the exit code, and lines to print."""
    output = real_output(options.archive)
    for file in ([] if options.config is None else [options.config]) + [file for *_, file in options.binaries]:
        if leads_to(options.archive, file):
            raise OutputError(f"{options.archive} is an input, which would be lost; choose another archive")
    with locked_output(output, options.archive):
        return make_there(output, options)


def make_there(output: Path, options: argparse.Namespace) -> tuple[int, list[str]]:
    """Write an archive that no run is writing, to its real place. Returns the exit code, and lines to print."""
    if not options.force:
        check_nothing_is_lost(options.archive)
    if options.config is None and not options.binaries:
        raise FlashError("expected the robots of the archive: -c CONFIG, or --from CATEGORY ID FILE.bin")
    owners = robots_of(options.config) if options.config is not None else []
    memories: dict[tuple[str, int], bytes | None] = dict.fromkeys(owners)
    given = set()
    for category, identifier, file in options.binaries:
        owner = (category, id_of(identifier))
        if owner in given:
            raise FlashError(f"--from {category} {identifier} is given twice")
        if owners and owner not in memories:
            raise FlashError(f"{options.config} has no robot #{identifier} of category '{category}'")
        given.add(owner)
        memories[owner] = flash_of(file)
    for category, _ in memories:
        try:
            length = len(category.encode())
        except UnicodeEncodeError:
            name = shown_name(category)
            raise FlashError(f"the category '{name}' is no text in UTF-8, as names in an archive are") from None
        if length > LONGEST_CATEGORY:
            raise FlashError(
                f"the category '{category[:20]}...' has a longer name than an archive can have: expected at most "
                f"{LONGEST_CATEGORY} bytes"
            )
    records = [
        Record(category, identifier) if flash is None else Record(category, identifier, flash=flash)
        for (category, identifier), flash in sorted(memories.items(), key=lambda item: item[0])  # as their bytes are
    ]
    with partial_output(output) as partial, partial.open("wb") as file:
        write_archive(file, records)
    if options.json:
        listed = [{"category": record.category, "id": record.identifier} for record in records]
        return 0, [json.dumps({"file": shown_name(options.archive), "records": listed})]
    return 0, [f"{options.archive}: {counted(len(records), 'record')}"]


def check_nothing_is_lost(name: str) -> None:
    """Check that a file is missing, empty, or an archive without records.

    Raises:
        OutputError: It is something else.
    """
    try:
        with Path(name).open("rb") as file:
            data = file.read(len(EMPTY) + 1)
    except FileNotFoundError:
        return
    if data in (b"", EMPTY):
        return
    try:
        what = f"has the flash memory of {counted(read_head(io.BytesIO(data)), 'robot')}"
    except ArchiveError:
        what = "is not an archive of flash memory"
    raise OutputError(f"{name} {what}, and would be lost; choose another archive, or add --force")


def robots_of(configuration: str) -> list[tuple[str, int]]:
    """Return category and id of all robots and other objects with a program, as the simulator numbers them."""
    from pogosim.batch.configurations.configuration import Configuration
    from pogosim.object_categories import UnknownCategoriesError, ids_of
    from pogosim.object_facts import TYPES, entries_in, entry_of, type_of
    from pogosim.scene import bodies_of, read_periodic

    tree = Configuration(configuration).of_one_run()
    entries = entries_in(tree)
    bodies = [
        entry_of(own.category, {**own.settings, "nb": own.settings.get("nb", len(own.settings.get("poses") or [0]))})
        for own in bodies_of(entries)
    ]
    instead = "run the program with --set simulation_time=0 --set flash_state.output_file=FILE instead"
    if strange := [type_of(own.settings) for own in entries if type_of(own.settings) not in TYPES]:
        raise FlashError(f"{configuration}: only the simulator knows what a {strange[0]} has; {instead}")
    try:
        ids = ids_of(bodies, read_periodic(tree))
    except UnknownCategoriesError:
        raise FlashError(
            f"{configuration} does not say how many objects of each category there are; {instead}"
        ) from None
    with_program = ["robot" in own.has for own in bodies]
    robots = [
        (name, identifier)
        for (name, first, last), runs in zip(ids, with_program, strict=True)
        if runs
        for identifier in range(first, last + 1)
    ]
    if any(identifier >= IDS for _, identifier in robots):
        raise FlashError(f"{configuration} has more than {IDS} objects; ids in an archive have 16 bits")
    return robots


def id_of(text: str) -> int:
    """Return the id of a robot."""
    if not text.isascii() or not text.isdigit() or int(text) >= IDS:
        raise FlashError(f"--from: expected an id from 0 to {IDS - 1}, found '{text}'")
    return int(text)


def flash_of(name: str) -> bytes:
    """Return flash memory that begins with the bytes of a file."""
    with opened(name, "flash memory") as file:
        data = file.read(FLASH_BYTES + 1)
    if len(data) > FLASH_BYTES:
        raise FlashError(f"{name} is longer than flash memory, which has {FLASH_BYTES} bytes")
    return data.ljust(FLASH_BYTES, b"\xff")


def shown_name(name: str) -> str:
    """Return a name with its bytes that are not UTF-8 as escape sequences, for JSON and messages."""
    return "".join(f"\\x{ord(own) - 0xDC00:02x}" if "\udc80" <= own <= "\udcff" else own for own in name)


def text_of(value: object) -> str:
    """Return a cell of the table."""
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)


ACTIONS = {"show": show, "extract": extract, "make": make}


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim flash") -> int:
    """Run the command. Returns its exit code: 0 done, 1 a record is damaged, 2 nothing could be done."""
    options = parser(prog).parse_args(arguments)
    try:
        code, lines = ACTIONS[options.action](options)
    except ToolError as error:
        return complain(prog, error)
    except OSError as error:
        return complain(prog, told(error, options.archive))
    say(*lines)
    return code
