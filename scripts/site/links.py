"""Links of the project's pages, which are between files of the repository, as links between pages of the site."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# Pages outside of docs/, and their places on the site. Every page of docs/ keeps its name.
OUTSIDE = {
    "README.md": "index.md",
    "CONTRIBUTING.md": "contributing.md",
    "CHANGELOG.md": "changelog.md",
    "bench/README.md": "benchmarks.md",
    "template_prj/README.md": "template.md",
}
SOURCES = "source/"  # where source files that pages link to are shown
LANGUAGES = {".cpp": "cpp", ".hpp": "cpp", ".h": "c", ".c": "c", ".py": "python", ".js": "js", ".yaml": "yaml"} | {
    ".yml": "yaml",
    ".json": "json",
    ".toml": "toml",
    ".cmake": "cmake",
    ".txt": "cmake",
    ".sh": "sh",
}

_FENCED = re.compile(r"^(```+)[^\n]*\n.*?^\1[ ]*$", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"(?<=\]\()([^)#\s]*)(#[^)\s]*)?(?=\))")


def page_of(path: str) -> str:
    """Return where the site shows a file or folder of the repository: window.md for docs/window.md."""
    if path in OUTSIDE:
        return OUTSIDE[path]
    if path.startswith("docs/") and Path(path).suffix in {".md", ".png"}:
        return path.removeprefix("docs/")
    visible = "/".join(
        part.lstrip(".") for part in path.split("/")
    )  # MkDocs and pages of forges leave out hidden files
    return f"{SOURCES}{visible}.md"


def for_site(markdown: str, path: str, note: Callable[[str], None]) -> str:
    """Rewrite the links of the page at `path` in the repository. `note` gets each file or folder that it links to."""
    folder = posixpath.dirname(path)
    here = posixpath.dirname(page_of(path))

    def rewrite(link: re.Match[str]) -> str:
        target, anchor = link[1], link[2] or ""
        if not target or ":" in target:
            return link[0]
        aim = posixpath.normpath(posixpath.join(folder, target))
        if not (ROOT / aim).exists():
            return link[0]  # MkDocs says so
        note(aim)
        return posixpath.relpath(page_of(aim), here or ".") + anchor

    kept = []  # code stays as it is
    place = 0
    for block in _FENCED.finditer(markdown):
        kept += [_LINK.sub(rewrite, markdown[place : block.start()]), block[0]]
        place = block.end()
    return "".join([*kept, _LINK.sub(rewrite, markdown[place:])])


def source_page(path: str, note: Callable[[str], None]) -> str:
    """Return a page with the text of a source file, or with links to the files of a folder."""
    place = ROOT / path
    if place.is_file():
        language = LANGUAGES.get(place.suffix, "text")
        code = f"````{language}\n{place.read_text(encoding='utf-8').rstrip()}\n````\n"
        return f"---\nsearch:\n    exclude: true\n---\n# {path}\n\n{code}"
    lines = [f"# {path}/", ""]
    for file in sorted(place.iterdir()):
        if file.is_file() and (file.suffix in LANGUAGES or file.name == "Makefile"):
            aim = f"{path}/{file.name}"
            note(aim)
            lines.append(f"- [{file.name}]({posixpath.relpath(page_of(aim), posixpath.dirname(page_of(path)))})")
    return "\n".join([*lines, ""])
