"""The package of docs/extending.md, installed, and packages with mistakes: each as a user calls it."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pandas as pd
import pytest
from pogosim import extensions
from pogosim.batch.runs.run_files import with_files_beside
from pogosim.utils import load_dataframe
from project import CLEAN
from running import ROOT, Run, build_folder, example, ran, run, write_scene

PAGE = ROOT / "docs" / "extending.md"
FILES = re.compile(r"^`([\w./]+)`:\n\n```\w+\n(.*?)^```$", re.DOTALL | re.MULTILINE)
GROUPS = ("optimizers", "analyses", "commands", "robot_models")
SHOWN = "; PYTHONDEVMODE=1 shows the traceback"


@pytest.fixture(scope="module")
def packages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder into which pip has installed the package of the page."""
    folder = tmp_path_factory.mktemp("my-lab")
    files = dict(FILES.findall(PAGE.read_text())) | {"my_lab/__init__.py": "", "my_lab/models/__init__.py": ""}
    assert len(files) == 7
    for name, text in files.items():
        (folder / "source" / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / "source" / name).write_text(text)
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-build-isolation", "--no-deps", "--no-index"]
    target = folder / "packages"
    subprocess.run([*pip, "--target", str(target), "./source"], cwd=folder, check=True, capture_output=True)
    return target


def called(folder: Path, packages: Path, *command: str, module: str = "pogosim") -> Run:
    """Run `pogosim`, or another module, with a folder of packages."""
    environment = CLEAN | {"POGOSIM_DIR": str(build_folder()), "PYTHONPATH": str(packages)}
    return ran(folder, sys.executable, "-m", module, *command, env=environment, timeout=300)


def test_command_of_a_package_is_listed_and_runs(packages: Path, tmp_path: Path) -> None:
    listed = called(tmp_path, packages, "--help")
    assert (listed.code, listed.errors) == (0, "")
    assert re.search(r"^  count +say how many objects are in a data file$", listed.output, re.MULTILINE)
    result = run(example("helloworld"), tmp_path, {"simulation_time": 1.0})
    assert result.code == 0
    counted = called(tmp_path, packages, "count", "data.feather")
    assert (counted.code, counted.output, counted.errors) == (0, "3 objects\n", "")
    assert "did you mean 'count'?" in called(tmp_path, packages, "cout").errors


def test_analysis_of_a_package_is_listed_and_writes_its_table(packages: Path, tmp_path: Path) -> None:
    listed = called(tmp_path, packages, "analyze", "--help")
    assert re.search(r"^  turning +how much robots turn$", listed.output, re.MULTILINE), listed.text
    assert run(example("run_and_tumble"), tmp_path, {"simulation_time": 5.0}).code == 0
    done = called(tmp_path, packages, "analyze", "turning", "-i", "data.feather", "-o", "out", "--from-s", "1")
    assert (done.code, done.output, done.errors) == (0, "written to out\n", "")
    table = pd.read_csv(tmp_path / "out" / "turning.csv")
    assert len(table) == 3
    assert (table["turned_rad"] > 0.1).any()
    wrong = called(tmp_path, packages, "analyze", "turning", "-i", "none.feather")
    assert (wrong.code, wrong.output) == (2, "")
    assert len(wrong.errors.splitlines()) == 1


def test_optimiser_of_a_package_searches_and_resumes(packages: Path, tmp_path: Path) -> None:
    write_scene(
        tmp_path,
        {
            "simulation_time": 2.0,
            "parameters.run_duration_min": {"optimization_domain": {"type": "int", "min": 100, "max": 2000}},
            "optimization": {"algorithm": "hill", "hill": {"step": 0.2}, "budget": 5, "final_runs": 0, "popsize": 2},
        },
    )
    search = ["optimize", "-c", "scene.yaml", "-S", str(example("run_and_tumble"))]
    done = called(tmp_path, packages, *search)
    assert done.code == 0, done.text
    assert "Starting the search: HILL" in done.errors
    assert "unknown key" not in done.errors
    again = called(tmp_path, packages, *search, "--resume", "--max-evals", "5")
    assert again.code == 0, again.text
    assert "tpe, hill (cmaes)" in " ".join(called(tmp_path, packages, "optimize", "--help").output.split())
    unknown = called(tmp_path, packages, *search, "--optimizer", "hil")
    assert unknown.code == 2
    assert "expected one of cmaes, random, mapelites, cma_me, cma_mae, tpe, hill; found 'hil'" in unknown.errors


def test_models_of_a_package_are_found_by_whatever_simulates(packages: Path, tmp_path: Path) -> None:
    models = str(packages / "my_lab" / "models")
    shown = called(tmp_path, packages, "path", "--models")
    assert (shown.code, shown.output, shown.errors) == (0, f"{models}\n", "")
    script = tmp_path / "program"
    script.write_text('#!/bin/sh\n# pogosim\necho "$POGOSIM_PATH" > path.txt\n')
    script.chmod(0o755)
    write_scene(tmp_path, {})
    for command in (["run", "./program"], ["batch", "run", "-c", "scene.yaml", "-S", "./program", "-R", "0"]):
        called(tmp_path, packages, *command)
        searched = f"{tmp_path}:{models}" if command[0] == "batch" else str(models)  # its configuration is elsewhere
        assert (tmp_path / "path.txt").read_text() == f"{searched}\n"
        (tmp_path / "path.txt").unlink()
    program = example("helloworld").with_suffix(".so")
    (tmp_path / "inside.py").write_text(
        "import os, sys, pogosim\n"
        "pogosim.Simulation(sys.argv[1], 'scene.yaml').close()\n"
        "print(os.environ['POGOSIM_PATH'])\n"
    )
    inside = called(tmp_path, packages, str(program), module="inside")
    assert (inside.code, inside.output) == (0, f"{models}\n"), inside.text


def test_run_of_the_page_has_the_model_of_the_package(packages: Path, tmp_path: Path) -> None:
    (line,) = re.findall(r"^pogosim (run .*)$", PAGE.read_text(), re.MULTILINE)
    words = [word if not word.startswith(("./", "conf/")) else str(ROOT / word) for word in line.split()]
    words[1] = str(example("hanabi"))
    done = called(
        tmp_path, packages, *words, "-g", "-q", "--set", "simulation_time=1", "--set", "data_filename=a.feather"
    )
    assert (done.code, done.output, done.errors) == (0, "", "")
    robots = load_dataframe(tmp_path / "a.feather")[1]["resolved_configuration"]["objects"]["robots"]
    assert [face["angle_deg"] for face in robots["faces"]] == [0, 180]
    assert robots["communication_radius"] == 80


def test_folders_of_the_user_come_before_those_of_packages(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    install(tmp_path, "lab", {"robot_models": "lab = lab_models"})
    (tmp_path / "lab_models").mkdir()
    (tmp_path / "lab_models" / "a.yaml").write_text("radius: 30\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setenv("POGOSIM_PATH", "/mine::/others")
    extensions.entry_points_of.cache_clear()
    said: list[str] = []
    assert extensions.models_path(said.append) == f"/mine:/others:{tmp_path / 'lab_models'}"
    assert said == []
    extensions.entry_points_of.cache_clear()


def test_batch_finds_models_beside_its_configuration(tmp_path: Path) -> None:
    model = tmp_path / "models" / "own.yaml"
    model.parent.mkdir()
    model.write_text("radius: 30\n")
    own, other = {"robot_model": "models/own.yaml", "nb": 3}, {"robot_model": "of_a_package.yaml"}
    found = with_files_beside({"objects": {"robots": own, "walls": [own, other]}}, tmp_path)
    there = {"robot_model": str(model), "nb": 3}
    assert found == {"objects": {"robots": there, "walls": [there, other]}}


# ---- Packages with mistakes ----


def install(folder: Path, name: str, points: Mapping[str, str], code: str = "") -> None:
    """Install a package by hand: its metadata, and a module of its name."""
    info = folder / f"{name}-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("".join(f"[pogosim.{group}]\n{line}\n" for group, line in points.items()))
    (folder / f"{name}.py").write_text(code)


def asked(group: str, name: str) -> list[str]:
    """Return a command that asks for a name of a group."""
    search = ["optimize", "-c", "search.yaml", "-S", "none", "--optimizer"]
    return {"commands": [name], "analyses": ["analyze", name], "optimizers": [*search, name]}[group]


LISTING = {"commands": ["--help"], "analyses": ["analyze", "--help"], "optimizers": ["optimize", "--help"]}
LISTING["robot_models"] = ["path", "--models"]
KINDS = {"commands": "command", "analyses": "analysis", "optimizers": "optimiser", "robot_models": "robot models"}
EXPECTED = {
    "commands": "a function main(arguments, prog) that returns the exit code",
    "analyses": "a pogosim.reports.command_lines.Analysis with functions parser(prog) and analyze(options, prog)",
    "optimizers": "a class, made of a space and settings, with ask(), begin() and tell()",
    "robot_models": "a package, or the path of a folder, with YAML files in it",
}


def check_refused(folder: Path, group: str, name: str, problem: str) -> None:
    """A name is refused in a line when it is asked for, and warned of in the same line when all are listed."""
    (folder / "search.yaml").write_text("simulation_time: {optimization_domain: {type: float, min: 1, max: 2}}\n")
    listed = called(folder, folder, *LISTING[group])
    assert listed.code == 0
    (line,) = listed.errors.splitlines()
    assert "warning: " in line
    assert problem in line
    assert f"  {name} " not in listed.output
    if group == "robot_models":
        return
    wrong = called(folder, folder, *asked(group, name))
    assert (wrong.code, wrong.output) == (2, "")
    (line,) = wrong.errors.splitlines()
    assert problem in line


@pytest.mark.parametrize("group", GROUPS)
@pytest.mark.parametrize(
    ("place", "code", "reason"),
    [
        ("lab:thing", "import nowhere\n", "No module named 'nowhere'"),
        ("lab:thing", "raise RuntimeError\n", "RuntimeError"),
        ("lab:thing", "exit(3)\n", "3"),
        ("lab:thing", "x = (\n", "'(' was never closed (lab.py, line 1)"),
        ("lab:other", "", "module 'lab' has no attribute 'other'"),
        ("gone:main", "", "No module named 'gone'"),
    ],
)
def test_package_that_cannot_be_imported(group: str, place: str, code: str, reason: str, tmp_path: Path) -> None:
    install(tmp_path, "lab", {group: f"thing = {place}"}, code)
    entry = f"{KINDS[group]} 'thing' of the package lab 1.0 (pogosim.{group}: {place})"
    problem = f"{entry} cannot be imported: {reason}; update or uninstall the package"
    check_refused(tmp_path, group, "thing", problem)


def searched(folder: Path, **methods: str) -> Run:
    """Run a search with an optimiser of a package, some methods of which do something else."""
    bodies = {"__init__": "pass", "begin": "pass", "ask": "return np.full((2, 1), 0.5)", "tell": "pass"} | methods
    arguments = {"__init__": "self, space, settings", "ask": "self"}
    lines = [f"    def {name}({arguments.get(name, 'self, it')}): {body}\n" for name, body in bodies.items()]
    install(folder, "lab", {"optimizers": "thing = lab:Thing"}, f"import numpy as np\nclass Thing:\n{''.join(lines)}")
    write_scene(
        folder,
        {
            "simulation_time": 0.1,
            "parameters.run_duration_min": {"optimization_domain": {"type": "int", "min": 1, "max": 9}},
        },
    )
    search = ["optimize", "-c", "scene.yaml", "-S", str(example("run_and_tumble")), "--optimizer", "thing"]
    return called(folder, folder, *search, "--max-evals", "5")


@pytest.mark.parametrize(
    ("points", "found"),
    [
        ("np.zeros((0, 1))", "an array of shape (0, 1)"),
        ("np.zeros(3)", "an array of shape (3,)"),
        ("np.zeros((2, 2))", "an array of shape (2, 2)"),
        ("np.full((2, 1), np.nan)", "nan among them"),
        ("[[0.5], [7.0]]", "7 among them"),
        ("[[0.5], [-1e-9]]", "-1e-09 among them"),
        ("None", "nan among them"),
        ("[[1], [1, 2]]", "[[1], [1, 2]]"),
        ("'ab'", "'ab'"),
    ],
)
def test_optimiser_that_asks_for_no_points_of_the_unit_cube(points: str, found: str, tmp_path: Path) -> None:
    done = searched(tmp_path, ask=f"return {points}")
    assert done.code == 2, done.text
    problem = "optimiser 'thing': ask() must return points, numbers of shape (points, 1), each from 0 to 1; found "
    assert f"{problem}{found};" in done.errors
    assert "Traceback" not in done.text


@pytest.mark.parametrize(("method", "line"), [("__init__", 3), ("begin", 4), ("ask", 5), ("tell", 6)])
def test_optimiser_that_raises_is_told_in_a_line(method: str, line: int, tmp_path: Path) -> None:
    done = searched(tmp_path, **{method: "{}['age']"})
    entry = "optimiser 'thing' of the package lab 1.0 (pogosim.optimizers: lab:Thing)"
    assert done.code == 3, done.text
    assert done.errors.endswith(f"{entry} raised KeyError: 'age' ({tmp_path}/lab.py:{line}){SHOWN}\n")
    assert "Traceback" not in done.text


PARSER = "lambda prog: analysis_parser(prog, 'x')"
BARE = "lambda prog: __import__('argparse').ArgumentParser()"
NO_FUNCTIONS = f": expected {EXPECTED['analyses']}, found a value of type Analysis; update or uninstall the package"
NO_PARSER = " raised TypeError: parser() returned 3, expected what analysis_parser() returns"
NO_OPTION = " raised TypeError: its parser has no option for output_dir, which that of analysis_parser() has"


@pytest.mark.parametrize(
    ("parser", "analyze", "exit_code", "problem"),
    [
        ("None", "raising", 2, NO_FUNCTIONS),
        (PARSER, "None", 2, NO_FUNCTIONS),
        ("lambda prog: {}['age']", "raising", 3, " raised KeyError: 'age' ({folder}/lab.py:3)"),
        ("lambda prog: 3", "raising", 3, NO_PARSER),
        ("without_output", "raising", 3, NO_OPTION),
        (PARSER, "raising", 3, " raised ValueError: too old ({folder}/lab.py:2)"),
        (PARSER, "lambda options, prog: exit(4)", 3, " raised SystemExit: 4 ({folder}/lab.py:3)"),
        (PARSER, "print", 0, None),
    ],
)
def test_analysis_that_raises_is_told_in_a_line(
    parser: str, analyze: str, exit_code: int, problem: str | None, tmp_path: Path
) -> None:
    code = (
        "from pogosim.reports.command_lines import Analysis, Parser, analysis_parser\n"
        "def raising(options, prog): raise ValueError('too old')\n"
        f"def others(): return Analysis('x', {parser}, {analyze})\n"
        "def without_output(prog):\n"
        "    parser = Parser(prog=prog)\n"
        "    parser.add_argument('-i', '--input')\n"
        "    return parser\n"
        "thing = others()\n"
    )
    install(tmp_path, "lab", {"analyses": "thing = lab:thing"}, code)
    (tmp_path / "a.feather").touch()
    done = called(tmp_path, tmp_path, "analyze", "thing", "-i", "a.feather")
    assert done.code == exit_code, done.text
    entry = "analysis 'thing' of the package lab 1.0 (pogosim.analyses: lab:thing)"
    if problem is None:
        assert done.errors == ""
        return
    shown = problem.format(folder=tmp_path) + (SHOWN if exit_code == 3 else "")
    assert done.errors == f"pogosim analyze thing: {entry}{shown}\n"
    helped = called(tmp_path, tmp_path, "analyze", "thing", "--help")
    assert (helped.errors == done.errors) is (parser not in (PARSER, "without_output") or analyze == "None")


def test_damaged_file_is_no_fault_of_the_package_that_analyses_it(packages: Path, tmp_path: Path) -> None:
    (tmp_path / "a.feather").write_bytes(b"ARROW1 of no use")
    done = called(tmp_path, packages, "analyze", "turning", "-i", "a.feather", "-o", "out")
    assert (done.code, done.output, len(done.errors.splitlines())) == (2, "", 1)
    assert "a.feather" in done.errors
    assert "my-lab" not in done.errors


def test_analysis_whose_work_is_not_there(tmp_path: Path) -> None:
    code = (
        "from pogosim.reports.command_lines import Analysis, analysis_parser\n"
        "thing = Analysis('x', lambda prog: analysis_parser(prog, 'x'), 'lab:nosuch')\n"
    )
    install(tmp_path, "lab", {"analyses": "thing = lab:thing"}, code)
    (tmp_path / "a.feather").touch()
    done = called(tmp_path, tmp_path, "analyze", "thing", "-i", "a.feather")
    (line,) = done.errors.splitlines()
    assert (done.code, done.output) == (2, "")
    assert line.endswith("lab:nosuch cannot be imported: module 'lab' has no attribute 'nosuch'")


NUMBERS = "expected a number from 0 to 255 or nothing"
IN_AST = "(<unknown>, line 1) ({folder}/lab.py:3)"


@pytest.mark.parametrize(
    ("code", "exit_code", "problem"),
    [
        ("    {}['age']", 3, "{entry} raised KeyError: 'age' ({folder}/lab.py:2)" + SHOWN),
        ("    import ast\n    ast.parse('(')", 3, "{entry} raised SyntaxError: '(' was never closed " + IN_AST + SHOWN),
        ("    open('none.csv')", 2, "none.csv: no such file or directory"),
        ("    import pogosim.errors\n    raise pogosim.errors.ToolError('expected a file')", 2, "expected a file"),
        ("    import pogosim.errors\n    raise pogosim.errors.ToolError('a\\nb\\t')", 2, "a\nb"),
        ("    raise SystemExit(7)", 7, None),
        ("    raise SystemExit", 0, None),
        ("    raise SystemExit('no such file')", 1, "no such file"),
        ("    raise SystemExit(300)", 3, "{entry} raised TypeError: exit code 300, " + NUMBERS + SHOWN),
        ("    return 256", 3, "{entry} raised TypeError: exit code 256, " + NUMBERS + SHOWN),
        ("    return -1", 3, "{entry} raised TypeError: exit code -1, " + NUMBERS + SHOWN),
        ("    return 'x'", 3, "{entry} raised TypeError: exit code 'x', " + NUMBERS + SHOWN),
        ("    return 255", 255, None),
    ],
)
def test_command_that_raises_is_told_in_a_line(code: str, exit_code: int, problem: str | None, tmp_path: Path) -> None:
    install(tmp_path, "lab", {"commands": "thing = lab:main"}, f"def main(arguments, prog):\n{code}\n")
    done = called(tmp_path, tmp_path, "thing")
    entry = "command 'thing' of the package lab 1.0 (pogosim.commands: lab:main)"
    line = "" if problem is None else f"pogosim thing: {problem.format(entry=entry, folder=tmp_path)}\n"
    assert (done.code, done.output, done.errors) == (exit_code, "", line)


def test_traceback_of_a_command_is_shown_in_the_development_mode_of_python(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    install(tmp_path, "lab", {"commands": "thing = lab:main"}, "def main(arguments, prog):\n    {}['age']\n")
    monkeypatch.setitem(CLEAN, "PYTHONDEVMODE", "1")
    done = called(tmp_path, tmp_path, "thing")
    assert done.code == 3
    assert "Traceback (most recent call last):" in done.errors
    assert done.errors.splitlines()[-1].startswith("pogosim thing: command 'thing' of the package lab 1.0 ")


@pytest.mark.parametrize("group", GROUPS)
@pytest.mark.parametrize(
    ("code", "found"),
    [
        ("thing = 5\n", "a value of type int"),
        ("def thing(only):\n    pass\n", "thing, a value of type function"),
        ("class thing:\n    pass\n", "thing, a value of type type"),
    ],
)
def test_entry_of_another_type(group: str, code: str, found: str, tmp_path: Path) -> None:
    install(tmp_path, "lab", {group: "thing = lab:thing"}, code)
    problem = f"(pogosim.{group}: lab:thing): expected {EXPECTED[group]}, found {found}; update or uninstall"
    check_refused(tmp_path, group, "thing", problem)


GOOD = """
from pogosim.reports.command_lines import Analysis, analysis_parser
def main(arguments, prog):
    "does something"
class Search:
    def __init__(self, space, settings): pass
    ask = begin = tell = lambda self: None
ANALYSIS = Analysis("something", analysis_parser, print)
"""
PLACES = {"commands": "main", "analyses": "ANALYSIS", "optimizers": "Search"}


@pytest.mark.parametrize("group", PLACES)
def test_name_of_two_packages(group: str, tmp_path: Path) -> None:
    for package in ("lab", "school"):
        install(tmp_path, package, {group: f"thing = {package}:{PLACES[group]}"}, GOOD)
    problem = f"{KINDS[group]} 'thing': lab 1.0 and school 1.0 all have one of this name (pogosim.{group}: "
    check_refused(tmp_path, group, "thing", problem)


@pytest.mark.parametrize(("group", "name"), [("analyses", "locomotion"), ("optimizers", "cmaes")])
def test_name_that_pogosim_has(group: str, name: str, tmp_path: Path) -> None:
    install(tmp_path, "lab", {group: f"{name} = lab:{PLACES[group]}"}, GOOD)
    (tmp_path / "search.yaml").write_text("simulation_time: {optimization_domain: {type: float, min: 1, max: 2}}\n")
    wrong = called(tmp_path, tmp_path, *asked(group, name))
    problem = f"{KINDS[group]} '{name}': Pogosim and lab 1.0 all have one of this name"
    assert (wrong.code, problem in wrong.errors, len(wrong.errors.splitlines())) == (2, True, 1)
    assert problem in called(tmp_path, tmp_path, *LISTING[group]).errors


def test_no_command_of_pogosim_is_replaced(tmp_path: Path) -> None:
    install(tmp_path, "lab", {"commands": "path = lab:main"}, GOOD)
    assert called(tmp_path, tmp_path, "path").output == f"{build_folder().resolve()}\n"
    listed = called(tmp_path, tmp_path, "--help")
    assert "warning: command 'path': Pogosim and lab 1.0 all have one of this name" in listed.errors
    assert "print the folder of the simulator" in listed.output


def test_models_that_hide_others_are_told(tmp_path: Path) -> None:
    for package in ("lab", "school"):
        install(tmp_path, package, {"robot_models": f"{package} = {package}_models"})
        (tmp_path / f"{package}_models").mkdir()
        (tmp_path / f"{package}_models" / "a.yaml").write_text("radius: 30\n")
    shown = called(tmp_path, tmp_path, "path", "--models")
    assert shown.output == f"{tmp_path / 'lab_models'}:{tmp_path / 'school_models'}\n"
    hidden = tmp_path / "school_models" / "a.yaml"
    assert shown.errors == (
        f"pogosim path: warning: robot models 'school': {hidden} is hidden by the file of this name in 'lab'\n"
    )


def test_damaged_metadata_are_told(tmp_path: Path) -> None:
    install(tmp_path, "lab", {"commands": "thing = lab:main"}, GOOD)
    (tmp_path / "lab-1.0.dist-info" / "entry_points.txt").write_bytes(b"[pogosim.commands]\nthing = \xff\n")
    check_refused(tmp_path, "commands", "thing", "the entry points pogosim.commands of installed packages cannot be")


def test_commands_of_pogosim_do_not_look_for_packages(tmp_path: Path) -> None:
    code = (
        "import sys\nfrom pogosim.command.main import main\nmain(['path'])\nprint('importlib.metadata' in sys.modules)"
    )
    (tmp_path / "inside.py").write_text(code)
    inside = called(tmp_path, tmp_path, module="inside")
    assert inside.output.splitlines()[1:] == ["False"]
