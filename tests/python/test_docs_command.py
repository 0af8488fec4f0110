"""`pogosim docs` shows the pages that messages name, wherever Pogosim is installed."""

from __future__ import annotations

import contextlib
import os
import pty
import re
import subprocess
import sys
from pathlib import Path

import pytest
from pogosim.command.docs import pages_in, section_of
from project import CLEAN
from running import ROOT, Run, build_folder, ran

DOCS = ROOT / "docs"
NAMED_IN = ("src", "include", "python/pogosim", "tools", "template_prj", "examples")
ENVIRONMENT = CLEAN | {"POGOSIM_DIR": str(build_folder())}
COMMAND = (sys.executable, "-m", "pogosim", "docs")


def docs(folder: Path, *arguments: str) -> Run:
    """Run `pogosim docs`."""
    return ran(folder, *COMMAND, *arguments, env=ENVIRONMENT)


def test_all_pages_are_listed_with_their_titles(tmp_path: Path) -> None:
    result = docs(tmp_path)
    assert (result.code, result.errors) == (0, "")
    listed = dict(line.split(maxsplit=1) for line in result.output.splitlines())
    assert set(listed) == {"changelog", *(str(page.relative_to(DOCS).with_suffix("")) for page in DOCS.rglob("*.md"))}
    assert listed["determinism"] == (DOCS / "determinism.md").read_text().splitlines()[0].removeprefix("# ")


@pytest.mark.parametrize(
    "typed", ["porting", "porting.md", "docs/porting.md", "./docs/porting.md", "Porting", "porting#"]
)
def test_a_page_is_shown_however_a_message_names_it(typed: str, tmp_path: Path) -> None:
    result = docs(tmp_path, typed)
    assert (result.code, result.errors) == (0, "")
    assert result.output == (DOCS / "porting.md").read_text(encoding="utf-8")


def test_a_section_is_shown_with_those_in_it_and_no_others(tmp_path: Path) -> None:
    shown = docs(tmp_path, "docs/displays.md#symptoms").output
    assert shown.startswith("## Symptoms\n")
    assert "### In a container" in shown
    assert docs(tmp_path, "displays#in-a-container").output.count("\n#") == 0
    assert docs(tmp_path, "displays#xdg_runtime_dir").output.startswith("### `XDG_RUNTIME_DIR`\n")
    assert docs(tmp_path, "porting#with-the-main-loop").output.startswith("## With the main loop\n")


def test_all_sections_that_pages_link_to_can_be_shown() -> None:
    pages = pages_in(DOCS)
    for page in pages.values():
        for name, anchor in re.findall(r"\]\(([a-z_]+)\.md#([^)]+)\)", page.read_text(encoding="utf-8")):
            assert section_of(pages[name].read_text(encoding="utf-8"), anchor)


def test_unknown_sections_are_refused_in_one_line(tmp_path: Path) -> None:
    result = docs(tmp_path, "displays#in-a-contaner")
    assert (result.code, result.output) == (2, "")
    assert result.errors == "pogosim docs: there is no section 'in-a-contaner'; did you mean 'in-a-container'?\n"
    assert "; there are " in docs(tmp_path, "decisions/walls#nonsense").errors


def test_changes_are_a_page(tmp_path: Path) -> None:
    assert docs(tmp_path, "changelog").output == (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert docs(tmp_path, "CHANGELOG.md").output == (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


def test_pages_of_folders_are_found(tmp_path: Path) -> None:
    assert docs(tmp_path, "decisions/walls").output.startswith("# ")


def test_the_place_is_printed_on_request(tmp_path: Path) -> None:
    assert docs(tmp_path, "--path").output == f"{DOCS}\n"
    assert docs(tmp_path, "--path", "window").output == f"{DOCS / 'window.md'}\n"


def test_a_reader_that_leaves_early_is_no_error() -> None:
    piped = f"set -o pipefail; {' '.join(COMMAND)} | head -n 1"
    done = subprocess.run(
        ["bash", "-c", piped], capture_output=True, text=True, env=ENVIRONMENT, check=False, timeout=60
    )
    assert (done.returncode in (0, 141), done.stderr) == (True, "")


@pytest.mark.parametrize(
    ("typed", "advice"),
    [
        ("portign", "did you mean 'porting'?"),
        ("nonsense", "pogosim docs lists all pages"),
        ("../README", "pogosim docs lists all pages"),
        ("/etc/passwd", "pogosim docs lists all pages"),
        ("", "pogosim docs lists all pages"),
        ("\udcff", "pogosim docs lists all pages"),
    ],
)
def test_unknown_pages_are_refused_in_one_line(typed: str, advice: str, tmp_path: Path) -> None:
    result = docs(tmp_path, typed)
    assert (result.code, result.output) == (2, "")
    (line,) = result.errors.splitlines()
    assert line.startswith("pogosim docs: there is no page ")
    assert line.endswith(advice)


def test_a_pager_shows_pages_on_a_terminal(tmp_path: Path) -> None:
    ours, terminal = pty.openpty()
    environment = ENVIRONMENT | {"TERM": "xterm", "PAGER": f"tee {tmp_path / 'shown'} >/dev/null"}
    done = subprocess.run(
        [*COMMAND, "window"], stdin=terminal, stdout=terminal, env=environment, check=False, timeout=60
    )
    os.close(terminal)
    os.close(ours)
    assert done.returncode == 0
    assert (tmp_path / "shown").read_text().startswith("# ")


def test_a_page_is_printed_where_the_pager_is_not_there() -> None:
    ours, terminal = pty.openpty()
    environment = ENVIRONMENT | {"PAGER": "no-such-pager"}
    command = [*COMMAND, "decisions/walls"]
    with subprocess.Popen(command, stdin=terminal, stdout=terminal, stderr=subprocess.PIPE, env=environment) as process:
        os.close(terminal)
        shown = b""
        with contextlib.suppress(OSError):  # when the terminal's other end is closed
            while part := os.read(ours, 1 << 16):
                shown += part
        assert process.wait(60) == 0
    os.close(ours)
    assert shown.startswith((DOCS / "decisions/walls.md").read_bytes().splitlines()[0])


def test_nothing_is_printed_where_there_is_no_output() -> None:
    done = subprocess.run(
        ["bash", "-c", f"{' '.join(COMMAND)} window >&-"], capture_output=True, env=ENVIRONMENT, check=False, timeout=60
    )
    assert (done.returncode, done.stderr) == (0, b"")


def test_an_installation_has_all_pages_that_its_files_name(tmp_path: Path) -> None:
    command: list[str | Path] = ["cmake", "--install", build_folder(), "--prefix", tmp_path]
    subprocess.run(command, check=True, capture_output=True, timeout=120)
    installed = tmp_path / "share/pogosim"
    named = set()
    for folder in NAMED_IN:
        for file in (ROOT / folder).rglob("*"):
            if file.suffix in {".c", ".cpp", ".h", ".hpp", ".py", ".md", ".mk"}:
                named |= set(re.findall(r"\bdocs/[a-z_/]+\.md", file.read_text(encoding="utf-8")))
    assert len(named) > 20
    assert sorted(page for page in named if not (installed / page).is_file()) == []
    assert not [file for file in (installed / "docs").rglob("*") if file.is_file() and file.suffix != ".md"]
    for folder in ("containers", "modules"):
        assert [file.name for file in sorted((installed / folder).iterdir())] == sorted(
            file.name for file in (ROOT / folder).iterdir()
        )
