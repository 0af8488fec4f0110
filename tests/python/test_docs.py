"""The documentation is true: its programs compile, its commands run, its links lead somewhere."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import functions
import pytest
from debugger import debug, needs_gdb
from first_program import NAMES, pictures_in
from pictures import difference
from pogosim.command.docs import anchor_of
from pogosim.utils import load_dataframe
from project import CLEAN
from robot_sdk import make_sdk
from running import (
    LIBRARY,
    ROOT,
    Run,
    build_folder,
    compile_program,
    example,
    pkg_config,
    ran,
    run,
    run_command,
)

README = ROOT / "README.md"
PAGES = [
    README,
    ROOT / "CHANGELOG.md",
    ROOT / "CONTRIBUTING.md",
    ROOT / "bench" / "README.md",
    ROOT / "template_prj" / "README.md",
    ROOT / "docs" / "decisions" / "index.md",
    *sorted((ROOT / "docs").glob("*.md")),
]
DECISIONS = sorted({*(ROOT / "docs" / "decisions").glob("*.md")} - {ROOT / "docs" / "decisions" / "index.md"})
# Pages whose commands are run word for word, in a tree with the program of the README.
PAGES_WITH_COMMANDS = [
    README,
    *(
        ROOT / "docs" / f"{name}.md"
        for name in (
            "batches",
            "calibration",
            "command_line",
            "data_file",
            "examples",
            "flash",
            "installing",
            "learners",
            "learning",
            "message_log",
            "optimization",
            "pictures",
            "policy_export",
            "reports",
            "supervisor",
            "window",
        )
    ),
]
SCRIPTS = ("build.sh", "demo.sh", "test.sh")  # run by test.sh itself
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
    said = [line for line in result.errors.splitlines() if "all robots share the variable" not in line]
    assert (result.code, said) == (0, []), name_of(page)
    shares = name_of(page) == "docs/first_program.md" and "mydata" not in code  # what the page mends afterwards
    assert ("all robots share the variable 'change_at_ms'" in result.errors) == shares
    assert len(result.frame()) > 0


def test_host_in_c_of_the_page_drives_its_robot(tmp_path: Path) -> None:
    page = ROOT / "docs" / "python.md"
    (code,) = [code for code in blocks(page, "c") if "<pogosim/host.h>" in code]
    (tmp_path / "drive.c").write_text(code)
    (tmp_path / "conf.yaml").write_text(
        f"arena_file: {ROOT}/arenas/square.csv\narena_surface: 1.0e+6\n"
        "objects: {robots: {type: pogobot, poses: [[300, 500, 0]], brain: host}}\n"
    )
    flags = pkg_config("--cflags", "--libs", package="pogosim-host")
    command = ["cc", "-std=c11", "-Wall", "-Wextra", "-Werror", "drive.c", *flags, "-o", "drive"]
    subprocess.run(command, cwd=tmp_path, check=True)
    done = subprocess.run(["./drive"], cwd=tmp_path, capture_output=True, text=True, check=False, timeout=60)
    assert (done.returncode, done.stdout) == (0, "200 steps, x = 500 mm, y = 500 mm\n"), done.stderr


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A project's folder as a reader has it, in which all commands of the README have been run."""
    folder = tmp_path_factory.mktemp("tree")
    (folder / "build").mkdir()
    (folder / "build" / "release").symlink_to(build_folder())
    for name in (".venv", "arenas", "bench", "conf", "docs", "examples", "tools"):
        (folder / name).symlink_to(ROOT / name)
    for name in SCRIPTS:
        (folder / name).write_text("#!/bin/sh\n")
        (folder / name).chmod(0o755)
    (folder / "home").mkdir()
    (folder / "first").mkdir()
    (folder / "first" / "main.c").write_text(blocks(README, "c")[0])
    (folder / "first" / "first.yaml").write_text(blocks(README, "yaml")[0])
    return shell("\n".join(blocks(README, "sh")), folder)


def shell(commands: str, folder: Path) -> Run:
    """Run commands in a project's folder; the first that fails ends them."""
    environment = CLEAN | {"HOME": str(folder / "home")}
    return ran(folder, "bash", "-euo", "pipefail", "-c", commands, env=environment, timeout=300)


def test_first_program_of_the_readme_runs_as_it_says(tree: Run) -> None:
    assert (tree.code, tree.errors) == (0, "")
    assert "warning" not in tree.output
    assert tree.frame("first/first.feather")["heard"].max() > 0
    assert (tree.folder / "first" / "first.png").stat().st_size > 10_000
    result = shell("first/first -c first/first.yaml -g -q --strict", tree.folder)
    assert (result.code, result.text) == (0, "")


def test_first_program_of_the_readme_keeps_moving(tree: Run) -> None:
    """Also in the end, most robots drive on: none is stuck at a wall."""
    rows = tree.frame("first/first.feather")
    last = rows[rows["time"] > rows["time"].max() - 2.01].sort_values("time")
    way = last.groupby("robot_id")[["x", "y"]].agg(lambda place: (place.diff().abs() > 5.0).mean()).max(axis=1)
    assert (way > 0.2).mean() > 0.9


@pytest.mark.parametrize("page", [page for page in PAGES_WITH_COMMANDS if page != README], ids=name_of)
def test_commands_and_python_of_the_page_work(page: Path, tree: Run) -> None:
    commands = "\n".join(blocks(page, "sh"))
    result = shell(commands, tree.folder)
    assert result.code == 0, f"{commands}\n{result.text}"
    for code in blocks(page, "python"):
        done = subprocess.run(
            [sys.executable, "-c", code], cwd=tree.folder, capture_output=True, text=True, check=False
        )
        assert (done.returncode, done.stderr) == (0, ""), code
        assert done.stdout, code


DEBUGGING = ROOT / "docs" / "debugging.md"


def commands_of(page: Path) -> list[str]:
    """Return the shell commands of a page, each with the lines that continue it."""
    return re.findall(r"(?:.*\\\n)*.+", "\n".join(blocks(page, "sh")))


def with_step(program: str, code: str) -> str:
    """Put lines at the start of user_step()."""
    start = re.search(r"void user_step\(.*\n", program)
    assert start is not None
    return program[: start.end()] + code + program[start.end() :]


@pytest.fixture(scope="module")
def debugged(tree: Run) -> Run:
    """The README's program with the additions of the page on debugging, after its commands but those of debuggers."""
    prints, function, calls = blocks(DEBUGGING, "c")
    program = blocks(README, "c")[0]
    program = program.replace("void user_init(", f"{function}\nvoid user_init(")
    (tree.folder / "first" / "main.c").write_text(with_step(program, prints + calls))
    commands = [command for command in commands_of(DEBUGGING) if not re.search(r"^gdb|valgrind", command)]
    return shell("\n".join(commands), tree.folder)


def test_page_on_debugging_shows_one_robot_and_finds_nothing_wrong(debugged: Run) -> None:
    assert (debugged.code, debugged.errors) == (0, "")
    said = [line for line in debugged.output.splitlines() if "PRINTF" in line]
    assert len(said) > 100
    assert all(re.search(r"\[ROBOT #7\] .*heard \d+ messages$", line) for line in said)


@pytest.mark.parametrize("fault", ["int odd[4]; odd[pogobot_ticks] = 1;", "free(malloc(1) + (pogobot_ticks > 5));"])
def test_sanitizers_of_the_page_on_debugging_name_the_line(fault: str, debugged: Run) -> None:
    source = debugged.folder / "first" / "main.c"
    sound = source.read_text()
    source.write_text(with_step(sound, f"{fault}\n"))
    line = 1 + source.read_text().splitlines().index(fault)
    commands = [command for command in commands_of(DEBUGGING) if "first/sanitized" in command]
    assert len(commands) == 2
    result = shell("\n".join(commands).replace("-Wall ", ""), debugged.folder)
    source.write_text(sound)
    assert result.code == 1
    assert f"main.c:{line}" in result.text


def gdb_says(debugged: Run, commands: str) -> str:
    """Run gdb as the page says, with some of its commands."""
    (start,) = [command for command in commands_of(DEBUGGING) if command.startswith("gdb")]
    arguments = shlex.split(start)
    return debug(arguments[arguments.index("--args") + 1 :], commands.splitlines(), debugged.folder)


@needs_gdb
def test_gdb_answers_as_the_page_on_debugging_shows(debugged: Run) -> None:
    commands = blocks(DEBUGGING, "gdb")[0]
    (answer,) = [block for block in blocks(DEBUGGING, "text") if "Breakpoint 1" in block]
    output = gdb_says(debugged, commands)
    place = 0
    for line in answer.splitlines():  # in this order; numbers and addresses may differ
        pattern = re.sub(
            r"(?<![$#\w])(0x[\da-f]+|\d+(\\\.\d+)?)", lambda _: r"(0x[\da-f]+|\d+(\.\d+)?)", re.escape(line)
        )
        found = re.compile("^" + pattern, re.MULTILINE).search(output, place)
        assert found, f"{line}\n{output}"
        place = found.end()


@needs_gdb
def test_gdb_stops_at_conditions_and_functions_of_the_page_on_debugging(debugged: Run) -> None:
    _, condition, function, _ = blocks(DEBUGGING, "gdb")
    heard = re.search(r"\$1 = (\d+)", gdb_says(debugged, condition))
    assert heard is not None
    assert int(heard[1]) > 25
    output = gdb_says(debugged, function)
    assert "hit Breakpoint 1, stop_here ()" in output
    assert re.search(r"\$1 = \{heard = \d+, turn_until_ms = \d+\}\n\$2 = 100\nturns = ", output)


def compilation() -> str:
    """Return the page's command that compiles for debuggers; tests put faults in, so each compiles what it runs."""
    (command,) = [command for command in commands_of(DEBUGGING) if "-O0" in command]
    return command


@needs_gdb
@pytest.mark.parametrize(
    ("fault", "signal"),
    [
        ("*(int volatile*)0 = (int)pogobot_ticks;", "SIGSEGV"),
        ("abort();", "SIGABRT"),
        # Ctrl-C
        ("for (int volatile on = 1; on != 0;) {}", "SIGINT"),
    ],
)
def test_gdb_stops_at_the_line_that_crashes_or_does_not_return(fault: str, signal: str, debugged: Run) -> None:
    source = debugged.folder / "first" / "main.c"
    sound = source.read_text()
    source.write_text(with_step(sound, f"{fault}\n"))
    line = 1 + source.read_text().splitlines().index(fault)
    made = shell(compilation().replace("-Wall ", ""), debugged.folder)
    commands = blocks(DEBUGGING, "gdb")[3]
    if signal == "SIGINT":
        press = "threading.Timer(1.0, lambda: os.kill(gdb.selected_inferior().pid, signal.SIGINT)).start()"
        commands = f"python import os, signal, threading\nbreak user_step\nrun\npython {press}\ncontinue\nbacktrace\n"
    output = gdb_says(debugged, commands)
    source.write_text(sound)
    assert made.code == 0, made.text
    assert f"received signal {signal}" in output
    assert re.search(rf"in user_step \(\) at first/main.c:{line}|user_step \(\) at first/main.c:{line}", output), output
    if signal != "SIGINT":
        assert "the user program failed in user_step of robot #0" in output


@pytest.mark.parametrize("name", [name for name in ("valgrind",) if shutil.which(name)])
def test_valgrind_finds_nothing_wrong_with_the_first_program(name: str, debugged: Run) -> None:
    (start,) = [command for command in commands_of(DEBUGGING) if f"{name} --" in command]
    result = shell(f"{compilation()}\n{start}", debugged.folder)
    assert result.code == 0, result.errors
    assert "ERROR SUMMARY: 0 errors" in result.errors


def test_readme_is_short_and_leads_to_every_page() -> None:
    text = README.read_text()
    assert len(text.splitlines()) < 200
    linked = {(ROOT / target).resolve() for target, _ in LINK.findall(text) if "://" not in target}
    assert [name_of(page) for page in PAGES if page != README and page not in linked] == []


def test_readme_has_a_row_for_each_page() -> None:
    section = README.read_text().partition("## Pages")[2]
    rows = re.findall(r"^\| (?!page)(.*?) \| .+ \|$", section, re.MULTILINE)
    assert len(rows) > 30
    assert [row for row in rows if len(LINK.findall(row)) != 1] == []
    assert re.findall(r"^\*\*(.*)\*\*$", section, re.MULTILINE) == ["To learn", "To look up", "To change"]


def test_decisions_are_listed_and_each_has_its_reasons() -> None:
    index = ROOT / "docs" / "decisions" / "index.md"
    listed = re.findall(r"^- \[(.*)\]\((\w+\.md)\): .+$", index.read_text(), re.MULTILINE)
    assert sorted(name for _, name in listed) == [page.name for page in DECISIONS]
    for title, name in listed:
        text = (index.parent / name).read_text()
        assert text.startswith(f"# {title}\n")
        parts = re.findall(r"^\*\*(.*?)\.\*\* \S", text, re.MULTILINE)
        assert parts == ["Context", "Decision", "Reasons", "What it costs", "What would change our mind"], name


def declared_functions() -> set[str]:
    """Return the names of functions and macros with arguments in the headers for programs, read without doxygen."""
    found: set[str] = set()
    for header in (ROOT / "include" / "pogosim").rglob("*.h"):
        if header.name in ("host.h", "painter.h", "program.h"):  # for other processes, and for the simulator itself
            continue
        text = re.sub(r"\\\n", " ", header.read_text())
        found |= set(
            re.findall(r"^(?:static inline |extern )?[\w ]+[ *]+(\w+)\([^;{]*\)(?:;| \{)$", text, re.MULTILINE)
        )
        found |= set(re.findall(r"/// .*\n#define (\w+)\(", text))
    others = {"user_init", "user_step", "robot_main", "clear_IR_buffers", "static_assert"}  # programs', robots' and C's
    return {name for name in found if not re.match(r"_|pogosim_(?!world_)", name)} - others


def test_page_of_functions_has_each_function_of_the_headers() -> None:
    page = (ROOT / "docs" / "api.md").read_text()
    listed = set()
    for start, words, end in re.findall(r"`(\w*)(?:\{([\w, ]+)\})?(\w*)\(", page):
        listed |= {start + word + end for word in words.split(", ")}
    declared = declared_functions()
    assert len(declared) > 130
    assert sorted(declared - listed) == []


def test_numbers_of_functions_have_units_and_ranges(tmp_path: Path) -> None:
    """Each number that a function takes or returns has its unit and range in the table: `/// @range` in the header."""
    indices = ("object", "lamp", "link")
    missing = []
    for name, header in functions.headers(tmp_path).items():
        if name not in (*functions.TABLES["robot"], *functions.TABLES["simulator"]):
            continue
        for member in filter(functions.is_called, header.members):
            ranges = functions.split(member)[1]
            numbers = [
                word for kind, word in functions.arguments(member) if re.search(r"(int\d*_t|\bint|float|double)$", kind)
            ]
            told = [word for word in numbers if word in ranges or word in indices or "the three" in ranges]
            if "the range of the type" not in ranges and numbers != told:
                missing.append(f"{member.name}: {', '.join(sorted(set(numbers) - set(told)))}")
            returned = re.match(r"(u?int\d*_t|int|float|double) \w+\(", member.declaration)
            if returned and "return" not in ranges and not ranges:
                missing.append(f"{member.name}: what it returns")
    assert missing == [], (
        "give them a line '/// @range' in the header, then .venv/bin/python docs/figures/all.py functions"
    )


def test_page_of_examples_has_every_example_and_a_configuration_for_it() -> None:
    page = ROOT / "docs" / "examples.md"
    rows = re.findall(r"^\| \[(\w+)\]\(\.\./(examples/\S+)\) \|.*\| `(conf/\S+)` \|$", page.read_text(), re.MULTILINE)
    assert {name for name, _, _ in rows} == {source.parent.name for source in ROOT.glob("examples/*/main.c*")}
    assert [conf for _, _, conf in rows if not (ROOT / conf).exists()] == []


def test_page_of_the_command_line_has_every_option(tmp_path: Path) -> None:
    listed = set(re.findall(r"`(-{1,2}[A-Za-z][\w-]*)", "\n".join(table(ROOT / "docs" / "command_line.md"))))
    text = run_command(example("helloworld"), tmp_path, ["-h"]).output
    offered = set(re.findall(r"(?<![\w-])(-{1,2}[A-Za-z][\w-]*)", text[text.index("Options:") :]))
    assert listed == offered


def table(page: Path) -> list[str]:
    """Return the first cells of all tables of a page."""
    return re.findall(r"^\|(.*?)\|", page.read_text(), re.MULTILINE)


def test_page_of_the_window_lists_the_keys_that_the_window_helps_with() -> None:
    page = (ROOT / "docs" / "window.md").read_text()
    section = page[page.index("## Keys and mouse") : page.index("## Speed")]
    listed = re.findall(r"^\| (.*?) \|", section, re.MULTILINE)[1:]
    of_run, of_view = (ROOT / "src" / "view" / "actions.cpp").read_text().split("kHelpOfTheView{")
    switches = re.findall(r'\.key_name = "(.*?)"', (ROOT / "src" / "view" / "switches.cpp").read_text())
    before, behind = (re.findall(r'Help\{"(.*?)", ', part) for part in (of_run, of_view))
    assert min(map(len, (before, switches, behind))) > 5
    assert listed == [*before, *switches, *behind]


def test_callback_of_the_page_of_the_window_works_in_the_program_of_the_readme(tmp_path: Path) -> None:
    function, call = blocks(ROOT / "docs" / "window.md", "c")
    program = blocks(README, "c")[0].replace("#endif\n", f"{function}#endif\n")
    program = program.replace("    return 0;\n}\n", f"{call}    return 0;\n}}\n")
    assert function in program
    assert call in program
    (source := tmp_path / "main.c").write_text(program)
    result = run(compile_program(tmp_path / "program", source), tmp_path / "run", {"simulation_time": 1.0})
    assert (result.code, result.errors) == (0, "")


def anchors(page: Path) -> set[str]:
    """Return the names by which links address the headings of a page."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(), re.MULTILINE)
    return {anchor_of(heading) for heading in headings}


@pytest.mark.parametrize("page", [*PAGES, *DECISIONS], ids=name_of)
def test_links_lead_somewhere(page: Path) -> None:
    targets = [target for target, _ in LINK.findall(page.read_text()) if "://" not in target]
    missing = [target for target in targets if not (page.parent / target).exists()]
    assert missing == []
    sections = [
        (page.parent / target if target else page, section[1:])
        for target, section in re.findall(r"\]\(([^)#\s]*)(#[^)\s]+)\)", page.read_text())
        if "://" not in target
    ]
    assert [section for target, section in sections if section not in anchors(target)] == []


def compiler_says(source: Path, *folders: Path) -> str:
    """What the compiler finds wrong in a source that becomes a part of the simulator."""
    command = ["c++", "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror"]
    for folder in (*folders, ROOT / "src", ROOT / "include"):
        command += ["-I", str(folder)]
    return subprocess.run([*command, str(source)], capture_output=True, text=True, check=False).stderr


def test_new_object_type_of_the_docs_compiles(tmp_path: Path) -> None:
    function, line, *_ = blocks(ROOT / "docs" / "new_object_type.md", "cpp")
    before, table, after = (
        (ROOT / "src" / "config" / "solid_types.cpp").read_text().partition("constexpr std::array kSolidTypes{\n")
    )
    (source := tmp_path / "solid_types.cpp").write_text(f"{before}{function}\n{table}{line}{after}")
    assert compiler_says(source) == ""


def test_kind_of_lamp_of_the_docs_is_a_file_and_a_line(tmp_path: Path) -> None:
    *_, header, line = blocks(ROOT / "docs" / "new_object_type.md", "cpp")
    (tmp_path / "strobe_lamp.hpp").write_text(header)
    before, table, after = (
        (ROOT / "src" / "lamps" / "lamp_types.cpp").read_text().partition("constexpr std::array kLampTypes{\n")
    )
    (source := tmp_path / "lamp_types.cpp").write_text(f'#include "strobe_lamp.hpp"\n{before}{table}{line}{after}')
    assert compiler_says(source, tmp_path) == ""


def test_api_reference_has_all_functions_and_variables_of_the_library(tmp_path: Path) -> None:
    settings = f"@INCLUDE = docs/Doxyfile\nOUTPUT_DIRECTORY = {tmp_path}\nGENERATE_HTML = NO\n"
    made = subprocess.run(["doxygen", "-"], cwd=ROOT, input=settings, capture_output=True, text=True, check=False)
    assert (made.returncode, made.stderr) == (0, "")
    members = [member for page in tmp_path.glob("xml/*.xml") for member in ElementTree.parse(page).iter("memberdef")]
    documented = {member.findtext("name") for member in members}

    command = ["nm", "-D", "--defined-only", str(build_folder() / "src" / LIBRARY)]
    listing = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    exported = {line.split()[-1] for line in listing.splitlines()}
    of_others = {"fork", "pthread_create", "pthread_exit", *(name for name in exported if name.startswith("_Z"))}
    of_hosts_and_macros = {name for name in exported if re.match("pogosim_(?!world_)", name)}
    behind_macros = of_hosts_and_macros | {"_pogobot_start"}
    of_the_loop = {"_global_timer", "timer_main_loop", "_current_time_milliseconds", "_error_code_initial_time"}
    assert exported - documented == of_others | behind_macros | of_the_loop
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
    made = pictures_in(project)
    assert set(made) == set(NAMES)
    assert [text for name, picture in made.items() if (text := difference(ROOT / "docs" / name, picture))] == []
    for seed in range(1, 6):
        rows = load_dataframe(project / "results" / f"{seed}.feather")[0]
        mean = rows.groupby("time").neighbours.mean()
        assert mean.loc[2.0:10.0].mean() < 2.5 < 3.5 < mean.loc[110.0:].mean()
