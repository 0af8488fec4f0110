"""Dependencies between rooms go one way: in src/ as src/CMakeLists.txt says, in batches as this file does."""

from __future__ import annotations

import ast
import re
import subprocess
from collections import defaultdict
from functools import cache
from pathlib import Path

import pytest
from running import build_folder

SOURCE = Path(__file__).resolve().parents[2] / "src"
OF_FIRMWARE = "emu"  # compiled into programs for the emulated processor, by `make emu`; no part of the simulator

# Libraries, and the rooms that alone may include them.
PRIVATE_LIBRARIES = {
    "yaml-cpp/": {"config"},
    "box2d/": {"physics"},
    "arrow/": {"tables"},
    "CLI/": {"app"},
    "imgui": {"render", "view"},
    "png.h": {"render"},
    "SDL": {"view"},
}

BATCH = SOURCE.parent / "python" / "pogosim" / "batch"
# Rooms of pogosim.batch, each with those it may look into; the modules of the package itself may look into all.
BATCH_ROOMS = {
    "configurations": {"errors"},
    "runs": {"configurations", "errors"},
    "workers": {"runs", "errors"},
    "result_files": {"configurations", "runs", "errors"},
}


def declared_rooms() -> dict[str, set[str]]:
    """Rooms by name, each with the rooms it may look into."""
    text = (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")
    rooms = {}
    for name, body in re.findall(r"^pogosim_room\((\w+)\n(.*?)\)", text, re.MULTILINE | re.DOTALL):
        listed = re.search(r"ROOMS ([\w\s]*?)(?=LIBRARIES|APART|$)", body, re.DOTALL)
        rooms[name] = set(listed.group(1).split()) if listed else set()
    return rooms


def rooms_below(room: str) -> set[str]:
    """All rooms that a room may look into, and those that they may look into."""
    below: set[str] = set()
    left = [room]
    while left:
        new = declared_rooms()[left.pop()] - below
        below |= new
        left += new
    return below


@cache
def symbols(room: str) -> dict[str, set[str]]:
    """Functions and variables of C++ with a name in the linker, by its letters for what they are: U is needed."""
    folder = build_folder() / "src" / "CMakeFiles" / f"pogosim_{room}.dir"
    # Builds leave the object files of sources that are gone.
    files = [
        file for file in sorted(folder.rglob("*.o")) if (SOURCE / file.relative_to(folder).with_suffix("")).exists()
    ]
    if not files:
        pytest.skip("the object files of the rooms are not there")
    found = defaultdict(set)
    for line in subprocess.run(["nm", "-P", *files], capture_output=True, text=True, check=True).stdout.splitlines():
        name, *kind = line.split()[:2]
        if kind and name.lstrip("_").startswith("Z"):
            found[kind[0]].add(name)
    return found


def includes(room: str, pattern: str) -> set[tuple[str, str]]:
    """Pairs of file and what it includes, of all sources of a room."""
    files = [file for file in (SOURCE / room).rglob("*") if file.suffix in {".c", ".cpp", ".hpp"}]
    return {
        (file.name, found)
        for file in files
        for found in re.findall(pattern, file.read_text(encoding="utf-8"), re.MULTILINE)
    }


def imported(file: Path) -> set[str]:
    """What a Python file imports, modules with the names that are taken from them."""
    names = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{file}: relative import"
            names |= {f"{node.module}.{name.name}" for name in node.names}
        elif isinstance(node, ast.Import):
            names |= {name.name for name in node.names}
    return names


def test_every_folder_is_a_declared_room() -> None:
    folders = {folder.name for folder in SOURCE.iterdir() if folder.is_dir() and not folder.is_symlink()}
    assert folders - {OF_FIRMWARE} == set(declared_rooms())


@pytest.mark.parametrize("room", sorted(declared_rooms()))
def test_room_includes_only_what_it_declares(room: str) -> None:
    allowed = declared_rooms()[room] | {room, "pogosim"}
    for file, other in includes(room, r'^#include "(\w+)/'):
        assert other in allowed, f"{room}/{file} looks into {other}"


@pytest.mark.parametrize("room", sorted(declared_rooms()))
def test_room_declares_only_what_it_includes(room: str) -> None:
    used = {other for _, other in includes(room, r'^#include "(\w+)/')}
    assert declared_rooms()[room] - used == set()


@pytest.mark.parametrize("library", sorted(PRIVATE_LIBRARIES))
def test_library_is_included_by_its_rooms_alone(library: str) -> None:
    for room in declared_rooms():
        for file, _ in includes(room, rf"^#include <({re.escape(library)})"):
            assert room in PRIVATE_LIBRARIES[library], f"{room}/{file} includes {library}"


def test_declared_arrows_make_no_circle() -> None:
    rooms = declared_rooms()
    while rooms:
        free = {name for name, needs in rooms.items() if not needs & set(rooms)}
        assert free, f"rooms in a circle: {sorted(rooms)}"
        rooms = {name: needs for name, needs in rooms.items() if name not in free}


def test_every_source_is_a_part_of_its_room() -> None:
    """A file that is only needed in Debug builds would be missed there, and nowhere else."""
    text = (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")
    sources = [
        file for file in SOURCE.rglob("*") if file.suffix in {".c", ".cpp"} and file.parent != SOURCE / OF_FIRMWARE
    ]
    assert len(sources) > 100
    missing = [str(file) for file in sources if not re.search(rf"\b{re.escape(file.name)}\b", text)]
    assert missing == []


def test_no_room_needs_what_a_room_above_it_defines() -> None:
    """A declaration of another room's function would hide an arrow. Functions of C are those of include/, for all."""
    needed = {room: symbols(room)["U"] for room in declared_rooms()}
    home = {name: room for room in declared_rooms() for kind in "TDBRS" for name in symbols(room)[kind]}
    assert len(home) > 1000
    wrong = [
        f"{room} needs {name} of {home[name]}"
        for room, names in needed.items()
        for name in names
        if name in home and home[name] not in rooms_below(room) | {room}
    ]
    assert wrong == []


def test_every_folder_of_batches_is_a_room() -> None:
    assert {file.parent.name for file in BATCH.glob("*/__init__.py")} == set(BATCH_ROOMS)


@pytest.mark.parametrize("room", BATCH_ROOMS)
def test_room_of_batches_imports_exactly_what_it_declares(room: str) -> None:
    """Imports within functions count, too."""
    used = defaultdict(set)
    for file in (BATCH / room).glob("*.py"):
        for name in imported(file):
            if name.startswith("pogosim.batch."):
                used[name.split(".")[2]].add(file.name)
    del used[room]
    assert {other: used[other] for other in used.keys() - BATCH_ROOMS[room]} == {}
    assert BATCH_ROOMS[room] - used.keys() == set()


def test_arrows_between_rooms_of_batches_make_no_circle() -> None:
    above: set[str] = {"errors"}
    for room, others in BATCH_ROOMS.items():  # in an order in which each looks into earlier ones alone
        assert others <= above
        above.add(room)
