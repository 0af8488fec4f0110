"""The documentation is true: its programs compile and run, its links lead somewhere."""

from __future__ import annotations

import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from pogosim.utils import load_dataframe
from project import CLEAN
from robot_sdk import make_sdk
from running import LIBRARY, ROOT, build_folder, compile_program, run, run_command

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


def test_api_reference_has_all_functions_and_variables_of_the_library(tmp_path: Path) -> None:
    settings = f"@INCLUDE = docs/Doxyfile\nOUTPUT_DIRECTORY = {tmp_path}\nGENERATE_HTML = NO\n"
    made = subprocess.run(["doxygen", "-"], cwd=ROOT, input=settings, capture_output=True, text=True, check=False)
    assert (made.returncode, made.stderr) == (0, "")
    members = [member for page in tmp_path.glob("xml/*.xml") for member in ElementTree.parse(page).iter("memberdef")]
    documented = {member.findtext("name") for member in members}

    command = ["nm", "-D", "--defined-only", str(build_folder() / "src" / LIBRARY)]
    listing = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    exported = {line.split()[-1] for line in listing.splitlines()}
    of_libc = {"main", "rand", "srand", "exit"}
    behind_macros = {name for name in exported if name.startswith("pogosim_")} | {
        "_pogobot_start",
        "UserdataConstruct",
        "UserdataSize",
        "mydata",
    }
    of_the_loop = {"_global_timer", "timer_main_loop", "_current_time_milliseconds", "_error_code_initial_time"}
    assert exported - documented == of_libc | behind_macros | of_the_loop
    macros = {
        "pogobot_start",
        "SET_CALLBACK",
        "init_from_configuration",
        "DECLARE_USERDATA",
        "REGISTER_USERDATA",
        "printf",
    }
    assert macros <= documented


def test_tutorial_does_what_it_says(tmp_path: Path) -> None:
    """From its first command to firmware, with the program, configuration and plot that stand in it."""
    page = ROOT / "docs" / "first_program.md"
    *parts, program = blocks(page, "c")
    snippets = [part for part in parts if "int main(void)" not in part]
    assert len(snippets) == 6
    assert [part for part in snippets if " ".join(part.split()) not in " ".join(program.split())] == []

    script = ROOT / "docs" / "figures" / "first_program.py"
    environment = CLEAN | {"POGO_SDK": str(make_sdk(tmp_path / "pogobot-sdk"))}
    done = subprocess.run(
        [sys.executable, script, tmp_path], env=environment, capture_output=True, text=True, timeout=300, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    project = tmp_path / "crowds"
    assert (project / "build" / "bin" / "firmware.bin").stat().st_size > 0
    assert (project / "results" / "neighbours.png").stat().st_size > 10_000
    for seed in range(1, 6):
        rows = load_dataframe(project / "results" / f"{seed}.feather")[0]
        mean = rows.groupby("time").neighbours.mean()
        assert mean.loc[2.0:10.0].mean() < 2.5 < 3.5 < mean.loc[110.0:].mean()
