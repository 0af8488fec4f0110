"""The documentation is true: its programs compile and run, its links lead somewhere."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from running import ROOT, compile_program, run, run_command

PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").glob("*.md"))]
LINK = re.compile(r"\]\(([^)#\s]+)(#[^)]*)?\)")


def blocks(page: Path, language: str) -> list[str]:
    """Return the code blocks of a page in one language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", page.read_text(), flags=re.DOTALL | re.MULTILINE)


def programs() -> list[tuple[Path, str]]:
    """Return complete programs for Pogosim, with the page they stand on."""
    return [
        (page, code)
        for page in PAGES
        for code in blocks(page, "c")
        if '#include "pogobase.h"' in code and "int main(void)" in code
    ]


def name_of(page: Path) -> str:
    return str(page.relative_to(ROOT))


@pytest.mark.parametrize(
    ("page", "code"), programs(), ids=[f"{name_of(page)}-{number}" for number, (page, _) in enumerate(programs())]
)
def test_program_in_the_docs_compiles_and_runs(page: Path, code: str, tmp_path: Path) -> None:
    source = tmp_path / "main.c"
    source.write_text(code)
    program = compile_program(tmp_path / "program", source)
    result = run(program, tmp_path / "run", {"simulation_time": 1.0})
    assert (result.code, result.errors) == (0, ""), name_of(page)
    assert len(result.frame()) > 0


def test_first_program_of_the_readme_runs_with_its_configuration(tmp_path: Path) -> None:
    page = ROOT / "README.md"
    (tmp_path / "first").mkdir()
    (source := tmp_path / "first" / "main.c").write_text(blocks(page, "c")[0])
    (tmp_path / "first" / "first.yaml").write_text(blocks(page, "yaml")[0])
    program = compile_program(tmp_path / "first" / "first", source)
    result = run_command(program, tmp_path, ["-c", "first/first.yaml", "-g", "-q", "--strict"])
    assert (result.code, result.errors) == (0, "")
    assert result.frame("first/first.feather")["heard"].max() > 0


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_links_lead_somewhere(page: Path) -> None:
    targets = [target for target, _ in LINK.findall(page.read_text()) if "://" not in target]
    missing = [target for target in targets if not (page.parent / target).exists()]
    assert missing == []


def test_new_object_type_of_the_docs_compiles(tmp_path: Path) -> None:
    page = ROOT / "docs" / "new_object_type.md"
    (source := tmp_path / "beacon.cpp").write_text(blocks(page, "cpp")[0])
    command = ["c++", "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror"]
    command += ["-I", str(ROOT / "src"), "-I", str(ROOT / "include"), str(source)]
    assert subprocess.run(command, capture_output=True, text=True, check=False).stderr == ""
