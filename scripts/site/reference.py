"""The pages of reference: the C interface, the Python package, and the C++ rooms."""

from __future__ import annotations

import ast
from pathlib import Path

from doxygen_pages import Header, declarations, introduction, read_headers, structure
from links import ROOT

# Headers that only include others, and one of the SDK's whose functions are on the page of pogolib/magnetometer.h.
NOT_SHOWN = {"pogobase.h", "pogosim/pogolib.h", "sdk/magnetometer.h"}
# Modules of the package that are commands, or other names of commands.
NOT_FOR_SCRIPTS = {"__init__", "__main__", "command"}
OF_FIRMWARE = "emu"  # compiled into programs for the emulated processor; no room
ROOMS_SETTINGS = [
    "INPUT = src",
    "RECURSIVE = YES",
    "FILE_PATTERNS = *.hpp",
    "STRIP_FROM_PATH = src",
    "EXTRACT_ALL = YES",
    "JAVADOC_AUTOBRIEF = YES",
    "DISTRIBUTE_GROUP_DOC = YES",
    "SORT_MEMBER_DOCS = NO",
    "MACRO_EXPANSION = YES",
    "GENERATE_LATEX = NO",
    "HAVE_DOT = NO",
    "WARNINGS = NO",
]


def c_pages(folder: Path) -> dict[str, str]:
    """Return a page for each header that docs/Doxyfile does not exclude, by its place on the site."""
    headers = read_headers(["@INCLUDE = docs/Doxyfile"], ROOT, folder)
    pages = {}
    for name in sorted(headers.keys() - NOT_SHOWN):
        path = Path(name)
        text = f"# {path.name}\n\n{headers[name].text}\n\n{contents(headers[name], 2, 'c')}"
        pages[f"reference/c/{path.stem}.md"] = text
    return pages


def room_pages(folder: Path) -> dict[str, str]:
    """Return a page for each folder of src/."""
    headers = read_headers(ROOMS_SETTINGS, ROOT, folder)
    pages = {}
    folders = (path for path in (ROOT / "src").iterdir() if path.is_dir() and not path.is_symlink())
    for room in sorted(path for path in folders if path.name != OF_FIRMWARE):
        text = f"# {room.name}\n\nHeaders of `src/{room.name}/`. Private members are left out.\n\n"
        for path in sorted(room.rglob("*.hpp")):
            name = path.relative_to(ROOT / "src").as_posix()
            text += f"## {path.relative_to(room).as_posix()}\n\n{introduction(path)}\n\n"
            if name in headers:
                text += contents(headers[name], 3, "cpp") + "\n\n"
        pages[f"reference/rooms/{room.name}.md"] = text
    return pages


def contents(header: Header, level: int, language: str) -> str:
    """Return everything that a header declares."""
    types = [structure(itself, members, level, language) for itself, members in header.types]
    return "\n".join([*types, declarations(header.members, level, language)])


def python_pages() -> dict[str, str]:
    """Return a page for each part of the Python package that has functions for scripts."""
    package = ROOT / "python" / "pogosim"
    pages = {"reference/python/pogosim.md": python_page("pogosim", sorted(package.glob("*.py")))}
    for folder in sorted(path for path in package.iterdir() if (path / "__init__.py").exists()):
        if folder.name not in NOT_FOR_SCRIPTS:
            modules = sorted(folder.rglob("*.py"))
            pages[f"reference/python/{folder.name}.md"] = python_page(f"pogosim.{folder.name}", modules)
    return pages


def python_page(name: str, modules: list[Path]) -> str:
    """Return a page of modules: mkdocstrings replaces the lines with colons."""
    text = f"# {name}\n\n"
    for module in modules:
        dotted = ".".join(module.relative_to(ROOT / "python").with_suffix("").parts)
        if module.stem not in NOT_FOR_SCRIPTS and has_functions(module):
            text += f"::: {dotted}\n\n"
    return text


def has_functions(module: Path) -> bool:
    """Tell whether a module has public functions or classes of its own, besides `main`."""
    nodes = ast.parse(module.read_text(encoding="utf-8")).body
    named = (node.name for node in nodes if isinstance(node, ast.FunctionDef | ast.ClassDef))
    return any(not name.startswith("_") and name != "main" for name in named)
