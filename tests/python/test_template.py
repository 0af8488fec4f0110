"""The project template: copied anywhere, `make sim` builds its program against an installed or a built Pogosim."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

import pytest
from project import CLEAN, compiled, copy_template, made, make, sentence, write
from running import LIBRARY, build_folder, run_command

SHORT = ["-c", "conf/test.yaml", "-g", "--set", "simulation_time=2"]
TWO_FILES = {
    "main.c": """#include "count.h"
REGISTER_USERDATA(USERDATA)
void user_init(void) {}
void user_step(void) { printf("%d\\n", count()); }
int main(void) { pogobot_start(user_init, user_step); return 0; }
""",
    "count.c": '#include "count.h"\nint count(void) { return ++mydata->n; }\n',
    "count.h": """#include "pogobase.h"
typedef struct { int n; } USERDATA;
DECLARE_USERDATA(USERDATA)
#ifdef __cplusplus
extern "C"
#endif
int count(void);
""",
}


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project that has Pogosim as a link, as built by CMake."""
    folder = copy_template(tmp_path / "swarm")
    (folder / "pogosim").symlink_to(build_folder())
    return folder


@pytest.fixture(scope="module")
def prefix(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder where Pogosim is installed."""
    folder = tmp_path_factory.mktemp("installed")
    subprocess.run(["cmake", "--install", build_folder(), "--prefix", folder], check=True, capture_output=True)
    return folder


def test_program_named_after_its_folder_runs_the_test_configuration(project: Path) -> None:
    assert "Built ./swarm\n" in made(project, "clean", "sim").output
    result = run_command(project / "swarm", project, SHORT)
    assert (result.code, result.errors) == (0, "")
    assert result.robot_lines == ["[ROBOT #0] [PRINTF] HELLO WORLD! I am robot 0, at tick 0"]
    rows = result.frame("frames/data.feather")
    assert rows.groupby(rows["time"].round(3).astype(str)).size().to_dict() == {f"{i / 5}": 150 for i in range(11)}
    assert set(rows["led_rgb"]) == {0x000019}, "blue: they turn right"
    assert not rows["turns_left"].any()
    assert (rows.query("time == 1").angle.to_numpy() != rows.query("time == 0").angle.to_numpy()).all()


def test_configuration_sets_the_parameter_of_the_template(project: Path) -> None:
    made(project, "sim")
    result = run_command(project / "swarm", project, [*SHORT, "--set", "parameters.turn_duration=1500"])
    share = result.frame("frames/data.feather").groupby("time").turns_left.mean()
    assert set(share[share.index < 1.5]) == {0}
    assert set(share[share.index > 1.7]) == {1}


@pytest.mark.parametrize("found_by", ["PKG_CONFIG_PATH", "POGOSIM_DIR"])
def test_template_of_an_installation_builds_against_it(found_by: str, prefix: Path, tmp_path: Path) -> None:
    project = copy_template(tmp_path / "installed", prefix / "share" / "pogosim" / "template_prj")
    (pkg_config,) = prefix.glob("lib*/**/pogosim.pc")
    place = {"PKG_CONFIG_PATH": pkg_config.parent, "POGOSIM_DIR": prefix}[found_by]
    made(project, "clean", "sim", environment={found_by: str(place)})
    assert run_command(project / "installed", project, SHORT).code == 0
    needed = subprocess.run(["ldd", project / "installed"], capture_output=True, text=True, check=True).stdout
    (library,) = re.findall(rf"{LIBRARY}\S* => (\S+)", needed)
    assert prefix in Path(library).resolve().parents


def test_link_is_enough_without_pkg_config(project: Path) -> None:
    made(project, "sim", "PKG_CONFIG=no-such-program")
    assert run_command(project / "swarm", project, SHORT).code == 0


def test_command_on_the_path_leads_to_its_pogosim(prefix: Path, tmp_path: Path) -> None:
    command = tmp_path / "bin" / "pogosim"
    command.parent.mkdir()
    command.write_text(f'#!/bin/sh\n[ "$*" = path ] && echo "{prefix}"\n')
    command.chmod(0o755)
    project = copy_template(tmp_path / "cloned")
    made(project, "sim", environment={"PATH": f"{command.parent}:{CLEAN['PATH']}"})
    assert run_command(project / "cloned", project, SHORT).code == 0


@pytest.mark.parametrize(
    ("found_by", "folder"),
    [(found_by, "John Doe") for found_by in ("PKG_CONFIG_PATH", "command", "POGOSIM_DIR", "link")]
    + [("link", name) for name in ("O'Neill", "a(b)", "100 $", "a;b", "a,b")],
)
def test_installation_may_have_special_characters_in_its_path(
    found_by: str, folder: str, prefix: Path, tmp_path: Path
) -> None:
    copied = tmp_path / folder / "pogosim"
    copied.parent.mkdir()
    subprocess.run(["cp", "-r", prefix, copied], check=True)
    project = copy_template(tmp_path / "mine")
    environment = {}
    if found_by == "link":
        (project / "pogosim").symlink_to(copied)
    elif found_by == "POGOSIM_DIR":
        environment = {found_by: str(copied)}
    elif found_by == "PKG_CONFIG_PATH":
        (found,) = copied.glob("lib*/**/pogosim.pc")
        environment = {found_by: str(found.parent)}
    else:
        command = tmp_path / "pogosim"
        command.write_text(f'#!/bin/sh\necho "{copied}"\n')
        command.chmod(0o755)
        environment = {"PATH": f"{tmp_path}:{CLEAN['PATH']}"}
    made(project, "sim", environment=environment)
    assert run_command(project / "mine", project, SHORT).code == 0
    needed = subprocess.run(["ldd", project / "mine"], capture_output=True, text=True, check=True).stdout
    assert f"=> {copied}" in needed


def test_installation_has_the_tool_and_the_files_for_robots(prefix: Path, tmp_path: Path) -> None:
    project = copy_template(tmp_path / "counting")
    source = (project / "main.c").read_text()
    (project / "main.c").write_text(source.replace("user_step(void) {", "user_step(void) { static int n; n++;"))
    result = made(project, "sim", f"POGOSIM_DIR={prefix}")
    assert re.search(r"^main.c:\d+:\d+: warning: 'n' in user_step\(\) \(4 bytes\)", result.errors, re.MULTILINE)
    installed = prefix / "share" / "pogosim"
    assert {path.name for path in (installed / "interface").iterdir()} == {"main_loop.c", "colormaps.c"}
    emu = {"pogobot.h", "runtime.c", "start.S", "stubs.S", "memory.ld", "robot_tools.mk"}
    assert {path.name for path in (installed / "emu").iterdir()} == emu
    files = {str(path.relative_to(installed / "template_prj")) for path in (installed / "template_prj").rglob("*.*")}
    assert files == {"main.c", "robot.mk", "README.md", ".gitignore", "conf/test.yaml"}


def test_template_is_found_by_the_tree_around_it(tmp_path: Path) -> None:
    (tmp_path / "build").mkdir()
    (tmp_path / "build" / "release").symlink_to(build_folder())
    for folder in (tmp_path / "template_prj", tmp_path / "examples" / "mine"):
        made(copy_template(folder), "sim")
        assert (folder / folder.name).exists()


def test_only_what_changed_is_built_again(project: Path) -> None:
    write(project, TWO_FILES)
    assert compiled(made(project, "sim")) == {"main.c", "count.c"}
    again = made(project, "sim")
    assert (compiled(again), "Built" in again.output) == (set(), False)

    (project / "count.c").write_text(TWO_FILES["count.c"].replace("++mydata->n", "mydata->n += 2"))
    changed = made(project, "sim")
    assert compiled(changed) == {"count.c"}
    assert run_command(project / "swarm", project, SHORT).robot_lines[-1] == "[ROBOT #149] [PRINTF] 250"

    (project / "count.h").write_text(TWO_FILES["count.h"].replace("int n;", "int m; int n;"))
    assert compiled(made(project, "sim")) == {"main.c", "count.c"}


def test_new_options_and_files_are_noticed(project: Path) -> None:
    write(project, TWO_FILES)
    made(project, "sim")
    assert compiled(made(project, "sim", "CFLAGS=-O0 -DNAME='\"x y\"'")) == {"main.c", "count.c"}
    made(project, "sim")
    (project / "more.c").write_text("int more(void);\nint more(void) { return 1; }\n")
    assert compiled(made(project, "sim")) == {"more.c"}
    assert "more" in subprocess.run(["nm", project / "swarm"], capture_output=True, text=True, check=True).stdout
    (project / "more.c").unlink()
    assert compiled(made(project, "sim")) == set()
    assert "more" not in subprocess.run(["nm", project / "swarm"], capture_output=True, text=True, check=True).stdout


def test_header_that_is_gone_is_not_asked_for(project: Path) -> None:
    write(project, TWO_FILES)
    made(project, "sim")
    (project / "count.h").rename(project / "counting.h")
    for name in ("main.c", "count.c"):
        (project / name).write_text(TWO_FILES[name].replace("count.h", "counting.h"))
    assert compiled(made(project, "sim")) == {"main.c", "count.c"}


@pytest.mark.parametrize("cpp", [("main",), ("main", "count"), ("count",)])
def test_project_may_be_of_c_and_cpp_files(cpp: tuple[str, ...], project: Path) -> None:
    renamed = {name.replace(".c", ".cpp") if name[:-2] in cpp else name: text for name, text in TWO_FILES.items()}
    renamed["count.h"] = renamed.pop("count.h", TWO_FILES["count.h"])
    write(project, renamed)
    made(project, "sim", "WARNINGS=-Wall -Wextra -Werror")
    assert run_command(project / "swarm", project, SHORT).robot_lines[0] == "[ROBOT #0] [PRINTF] 1"


def test_clean_comes_before_building_even_in_parallel(project: Path) -> None:
    for _ in range(3):
        made(project, "-j4", "clean", "sim")
        assert (project / "swarm").exists()
    made(project, "clean")
    assert not (project / "swarm").exists()
    assert not (project / "build").exists()


def test_shared_state_stops_the_build_if_asked_to(project: Path) -> None:
    source = (project / "main.c").read_text()
    (project / "main.c").write_text(source.replace("void user_step", "int16_t level;\nvoid user_step"))
    refused = make(project, "sim", "SHARED_STATE=-Werror=shared-state")
    assert (refused.code, (project / "swarm").exists()) == (2, False)
    assert re.search(r"^main.c:\d+:9: error: 'level' \(2 bytes\)", refused.errors, re.MULTILINE)
    assert made(project, "sim", "SHARED_STATE=-Wno-shared-state").errors == ""
    assert (project / "swarm").exists()


def test_template_itself_has_no_warnings(project: Path) -> None:
    result = made(project, "sim", "WARNINGS=-Wall -Wextra -Werror", "SHARED_STATE=-Werror=shared-state")
    assert result.errors == ""


@pytest.mark.parametrize("goals", [(), ("all",), ("clean", "all")], ids=" ".join)
def test_without_an_sdk_make_builds_the_simulation_and_says_so(goals: tuple[str, ...], project: Path) -> None:
    result = made(project, *goals)
    assert (project / "swarm").exists()
    assert result.errors == ""
    assert result.output.splitlines()[-2:] == [
        "Built ./swarm",
        "Only the simulation: there is no Pogobot SDK in ../../pogobot-sdk. "
        "To also build for robots: make POGO_SDK=<its folder>",
    ]
    assert made(project, *goals[-1:]).output.count("Only the simulation") == 1  # also if nothing is left to do
    assert "Only the simulation" not in made(project, "sim").output


def test_sdk_that_was_named_and_is_not_there_is_an_error(project: Path, tmp_path: Path) -> None:
    absent = f"There is no Pogobot SDK in {tmp_path}: get it, then make bin POGO_SDK=<its folder>"
    assert sentence(make(project, f"POGO_SDK={tmp_path}")) == absent
    assert sentence(make(project, environment={"POGO_SDK": str(tmp_path)})) == absent


def test_missing_pogosim_is_one_helpful_line(tmp_path: Path) -> None:
    project = copy_template(tmp_path / "lonely")
    advice = "build or install it, then make sim POGOSIM_DIR=<its folder>"
    assert sentence(make(project, "sim")) == f"Pogosim is not found: {advice}"
    assert sentence(make(project, "clean", "sim")) == f"Pogosim is not found: {advice}"
    nowhere = f"POGOSIM_DIR={tmp_path}"
    assert sentence(make(project, "sim", nowhere)) == f"Pogosim is not found in {tmp_path}: {advice}"
    assert make(project, "clean").code == 0


def test_other_mistakes_are_one_helpful_line(project: Path, tmp_path: Path) -> None:
    (project / "main.c").unlink()
    assert sentence(make(project, "sim")) == "There is no .c or .cpp file in this folder"
    assert "Rename the folder" in sentence(make(copy_template(tmp_path / "sim"), "sim"))
    assert "Rename the folder" in sentence(make(copy_template(tmp_path / "conf"), "sim"))  # has a folder conf in it


@pytest.mark.parametrize(
    "name",
    [
        "my swarm",
        "a$b",
        "README.md",
        "Makefile",
        ".PHONY",
        "a'b",
        "a(b",
        "a:b",
        "a&b",
        "a;b",
        "a%b",
        "a\\b",
        "-a",
        "a.c",
    ],
)
def test_folder_whose_name_means_something_to_make_is_refused(name: str, tmp_path: Path) -> None:
    said = sentence(make(copy_template(tmp_path / name), "sim"))
    assert "make cannot handle this name" in said or "has another meaning" in said


@pytest.mark.parametrize("name", ["a-b", "a+b", "a.b", "\u00e9t\u00e9", "John Doe/a"])
def test_other_names_and_blanks_in_the_path_will_do(name: str, tmp_path: Path) -> None:
    folder = copy_template(tmp_path / name)
    (folder / "pogosim").symlink_to(build_folder())
    made(folder, "sim")
    assert run_command(folder / folder.name, folder, SHORT).code == 0


def test_only_sources_are_for_git(project: Path) -> None:
    made(project, "sim")
    run_command(project / "swarm", project, SHORT)
    (project / "pogosim").unlink()
    git = ["git", "-c", "core.excludesFile=/dev/null"]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    subprocess.run([*git, "init", "-q", project], check=True, env=environment)
    listed = subprocess.run(
        [*git, "ls-files", "--others", "--exclude-standard"],
        cwd=project,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    expected = {".gitignore", "Makefile", "README.md", "conf/test.yaml", "main.c", "robot.mk"}
    assert set(listed.stdout.split()) == expected
