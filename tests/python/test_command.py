"""The command `pogosim`: each subcommand as a user calls it."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pogosim
import pytest
from pogosim.machine_code import this_machine
from project import CLEAN, TEMPLATE
from running import PROGRAMS, Run, build_folder, ran, write_scene

SUBCOMMANDS = (
    "new",
    "run",
    "watch",
    "profile",
    "compare-brains",
    "export-policy",
    "batch",
    "optimize",
    "analyze",
    "picture",
    "film",
    "report",
    "compare",
    "recover",
    "join",
    "flash",
    "arena",
    "calibrate",
    "fit-comm",
    "best-psend",
    "doctor",
    "docs",
    "path",
)


def command(folder: Path, *arguments: str, environment: Mapping[str, str] | None = None) -> Run:
    """Run `pogosim` in a folder, with the simulator under test."""
    clean = CLEAN | {"POGOSIM_DIR": str(build_folder())} | dict(environment or {})
    return ran(folder, sys.executable, "-m", "pogosim", *arguments, env=clean)


def refusal(result: Run) -> str:
    """Return the one line that says what is wrong."""
    assert (result.code, result.output) == (2, "")
    (line,) = result.errors.splitlines()
    return line


@pytest.mark.parametrize("option", ["-h", "--help", "help"])
def test_help_lists_all_subcommands(option: str, tmp_path: Path) -> None:
    result = command(tmp_path, option)
    assert (result.code, result.errors) == (0, "")
    listed = [line.split()[0] for line in result.output.splitlines() if line.startswith("  ")]
    assert listed[: len(SUBCOMMANDS)] == list(SUBCOMMANDS)


def test_without_arguments_it_says_how_to_use_it(tmp_path: Path) -> None:
    result = command(tmp_path)
    assert (result.code, result.output) == (2, "")
    assert result.errors.startswith("Usage: pogosim COMMAND")


@pytest.mark.parametrize("option", ["-V", "--version"])
def test_version_is_that_of_the_package(option: str, tmp_path: Path) -> None:
    assert command(tmp_path, option).output.startswith(f"pogosim {pogosim.__version__}\ncommit: ")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("bach", "there is no command 'bach'; did you mean 'batch'?"),
        ("xyz", "there is no command 'xyz'; pogosim --help lists all commands"),
        ("-g", "there is no option -g before the command; pogosim --help lists all commands"),
    ],
)
def test_unknown_command_is_one_line_with_the_nearest_name(name: str, said: str, tmp_path: Path) -> None:
    assert refusal(command(tmp_path, name)) == f"pogosim: {said}"


def test_output_that_is_not_read_ends_it_quietly(tmp_path: Path) -> None:
    commands = f"{sys.executable} -m pogosim doctor | head -1 >/dev/null; echo ${{PIPESTATUS[0]}}"
    done = subprocess.run(["bash", "-c", commands], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("141\n", "")


def test_output_that_cannot_be_written_is_one_line(tmp_path: Path) -> None:
    with Path("/dev/full").open("w") as full:
        command_line = [sys.executable, "-m", "pogosim", "--help"]
        done = subprocess.run(command_line, cwd=tmp_path, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr) == (2, "pogosim: cannot go on: No space left on device\n")


@pytest.mark.parametrize("name", SUBCOMMANDS)
def test_each_subcommand_explains_itself_by_its_own_name(name: str, tmp_path: Path) -> None:
    result = command(tmp_path, name, "--help")
    assert (result.code, result.errors) == (0, "")
    assert result.output.startswith(f"usage: pogosim {name}")


@pytest.mark.parametrize(
    "name", ["new", "picture", "recover", "arena", "fit-comm", "best-psend", "doctor", "docs", "path"]
)
def test_each_subcommand_refuses_unknown_options_by_its_own_name(name: str, tmp_path: Path) -> None:
    result = command(tmp_path, name, "a", "b", "c", "--nonsense")
    assert result.code == 2
    assert f"pogosim {name}: " in result.errors.splitlines()[-1]


def test_console_script_is_installed() -> None:
    script = Path(sys.executable).parent / "pogosim"
    done = subprocess.run([script, "--version"], capture_output=True, text=True, check=True)
    assert done.stdout.startswith(f"pogosim {pogosim.__version__}\ncommit: ")


def test_new_project_builds_and_runs_at_once(tmp_path: Path) -> None:
    result = command(tmp_path, "new", "first")
    assert (result.code, result.errors) == (0, "")
    project = tmp_path / "first"
    advice = [line.split("#")[0].strip() for line in result.output.splitlines()[1:]]
    assert advice == ["cd first", "make sim", "./first -c conf/test.yaml"]
    subprocess.run(["make", "sim"], cwd=project, env=CLEAN, check=True, capture_output=True)
    subprocess.run(["./first", "-c", "conf/test.yaml", "-g", "-q"], cwd=project, check=True, capture_output=True)
    assert (project / "frames" / "data.feather").exists()
    assert "first" in (project / "README.md").read_text()
    assert "template_prj" not in (project / "README.md").read_text()


def test_new_project_has_all_files_of_the_template(tmp_path: Path) -> None:
    command(tmp_path, "new", "first")
    listed = subprocess.run(["git", "ls-files", "."], cwd=TEMPLATE, capture_output=True, text=True, check=True).stdout
    project = tmp_path / "first"
    made = {str(path.relative_to(project)) for path in project.rglob("*") if path.is_file() and not path.is_symlink()}
    assert made == set(listed.split())


@pytest.mark.parametrize(
    "name", ["a b", "-x", "a.c", "conf", "pogosim", "sim", "", ".", "a$b", "README.md", "GNUmakefile", ".PHONY"]
)
def test_name_that_make_cannot_handle_is_refused(name: str, tmp_path: Path) -> None:
    (tmp_path / "conf").mkdir()
    result = command(tmp_path / "conf", "new", "--", name)
    assert refusal(result).startswith("pogosim new: ")
    assert list((tmp_path / "conf").iterdir()) == []


def test_files_that_are_there_are_kept(tmp_path: Path) -> None:
    (tmp_path / "first").mkdir()
    (tmp_path / "first" / "thesis.tex").write_text("precious")
    (tmp_path / "file").write_text("precious")
    assert "with files in it" in refusal(command(tmp_path, "new", "first"))
    assert "is a file" in refusal(command(tmp_path, "new", "file"))
    assert [path.name for path in (tmp_path / "first").iterdir()] == ["thesis.tex"]
    assert (tmp_path / "file").read_text() == "precious"


def test_project_in_an_empty_or_a_deep_folder(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    assert command(tmp_path, "new", "empty").code == 0
    assert command(tmp_path, "new", "a/b/deep").code == 0
    assert (tmp_path / "a" / "b" / "deep" / "main.c").is_file()


def test_run_builds_a_project_and_takes_its_configuration(tmp_path: Path) -> None:
    command(tmp_path, "new", "first")
    for what, folder in ((["first"], tmp_path), ([], tmp_path / "first")):
        result = command(folder, "run", *what, "-g", "-q", "--set", "simulation_time=1")
        assert result.code == 0, result.text
        assert (folder / "frames" / "data.feather").exists()
    (tmp_path / "first" / "main.c").write_text("int main(void) { return 0 }")
    result = command(tmp_path, "run", "first", "-g")
    assert result.code == 2
    assert result.errors.splitlines()[-1] == "pogosim run: first cannot be built; see the messages above"


def test_run_compiles_a_source_file(tmp_path: Path) -> None:
    shutil.copy(TEMPLATE / "main.c", tmp_path / "circles.c")
    configuration = write_scene(tmp_path, {})
    result = command(tmp_path, "run", "circles.c", "-c", str(configuration), "-g", "-q")
    assert result.code == 0, result.text
    assert len(result.frame()) == 3 * 21
    assert (tmp_path / "build" / "circles").exists()
    result = command(tmp_path, "run", "build/circles", "-c", str(configuration), "-g", "-q", "--set", "seed=x")
    assert result.code == 2
    (tmp_path / "circles.c").write_text("no C")
    result = command(tmp_path, "run", "circles.c", "-c", str(configuration))
    assert (result.code, result.errors.splitlines()[-1]) == (
        2,
        "pogosim run: circles.c does not compile; see the compiler's messages above",
    )


def test_run_compiles_a_program_for_the_robots_alone(tmp_path: Path) -> None:
    shutil.copy(PROGRAMS / "endless.c", tmp_path / "endless.c")
    configuration = write_scene(tmp_path, {"parameters.gain": 9})
    result = command(tmp_path, "run", "endless.c", "-c", str(configuration), "-g")
    assert (result.code, result.errors) == (0, ""), result.text
    assert set(result.frame().gain) == {9}


def test_run_warns_of_shared_variables_and_gives_the_exit_code(tmp_path: Path) -> None:
    (tmp_path / "crash.c").write_text(
        (TEMPLATE / "main.c").read_text().replace("user_step(void) {", "user_step(void) { static int n; n++; abort();")
    )
    result = command(tmp_path, "run", "crash.c", "-c", str(write_scene(tmp_path, {})), "-g", "-q")
    assert result.code == 3
    assert "warning: 'n' in user_step()" in result.errors


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nothing"], "there is no project, source file or program nothing"),
        (["folder"], "folder is not a project: it has no Makefile (pogosim new NAME makes a project)"),
        (["text"], "text is neither a folder, a .c or .cpp file, a firmware, nor a program"),
        (["alone.so"], "alone.so is a shared object, for Python and `pogosim watch`, and no program (make sim)"),
        (["both.so"], "both.so is a shared object, for Python and `pogosim watch`; run both"),
    ],
)
def test_what_cannot_be_run_is_one_line(arguments: list[str], said: str, tmp_path: Path) -> None:
    for name in ("text", "alone.so", "both.so", "both"):
        (tmp_path / name).write_text("some text")
    (tmp_path / "folder").mkdir()
    assert refusal(command(tmp_path, "run", *arguments)) == f"pogosim run: {said}"


def test_run_refuses_programs_of_other_machines(tmp_path: Path) -> None:
    for name, machine in (("of_a_mac", "macOS on ARM64"), ("of_a_mac.so", "macOS on ARM64")):
        (tmp_path / name).write_bytes(b"\xcf\xfa\xed\xfe\x0c\x00\x00\x01" + bytes(64))
        (tmp_path / name).chmod(0o755)
        why = f"is for {machine}, and this is {this_machine()}: compile it here (make sim)"
        assert refusal(command(tmp_path, "run", f"./{name}")) == f"pogosim run: {name} {why}"


def test_run_refuses_programs_that_cannot_be_executed(tmp_path: Path) -> None:
    (tmp_path / "text").write_text("text\n")
    (tmp_path / "text").chmod(0o755)
    assert refusal(command(tmp_path, "run", "./text")) == "pogosim run: cannot run text: Exec format error"
    shutil.copy(sys.executable, tmp_path / "copied")
    (tmp_path / "copied").chmod(0o644)
    assert refusal(command(tmp_path, "run", "copied")) == "pogosim run: copied is not executable: chmod +x copied"


def test_run_without_a_program_says_how_to_name_one(tmp_path: Path) -> None:
    said = refusal(command(tmp_path, "run"))
    assert said.startswith(
        "pogosim run: no program is named, and this folder is not a project: it has no Makefile. Name"
    )
    assert said.endswith("a program or a firmware first (pogosim new NAME makes a project)")


def test_run_without_a_program_runs_what_needs_none(tmp_path: Path) -> None:
    brain = ", brain: {script: [{time_s: 0, motors: [500, 500, 0]}]}"
    scene = (
        "arena_file: arenas/disk.csv\narena_surface: 1.0e6\nsimulation_time: 1\nobjects:\n"
        f"  robots: {{type: pogobot, nb: 2, geometry: disk, radius: 26.5{brain}}}\n"
    )
    (tmp_path / "conf.yaml").write_text(scene)
    assert command(tmp_path, "run", "-c", "conf.yaml", "-g").code == 0
    (tmp_path / "conf.yaml").write_text(scene.replace(brain, ""))
    said = refusal(command(tmp_path, "run", "-c", "conf.yaml", "-g"))
    assert "category 'robots' needs a program, and none is given" in said


def test_missing_compiler_is_one_line(tmp_path: Path) -> None:
    shutil.copy(TEMPLATE / "main.c", tmp_path / "main.c")
    said = refusal(command(tmp_path, "run", "main.c", environment={"CC": "no-such-cc"}))
    assert said.startswith("pogosim run: the compiler 'no-such-cc' is not installed (")


def test_path_is_what_makefiles_need(tmp_path: Path) -> None:
    assert command(tmp_path, "path").output == f"{build_folder().resolve()}\n"
    said = refusal(command(tmp_path, "path", environment={"POGOSIM_DIR": str(tmp_path)}))
    assert said == f"pogosim path: there is no simulator in POGOSIM_DIR={tmp_path}: build it, or unset POGOSIM_DIR"


def findings(result: Run) -> dict[str, tuple[str, str]]:
    """Return what the doctor says: "ok" or "missing", and the details, by purpose."""
    lines = [line for line in result.output.splitlines()[1:] if not line.startswith(" ")]
    return {line[:17].strip(): (line[18:26].strip(), line[27:]) for line in lines}


def test_doctor_compiles_and_runs_programs(tmp_path: Path) -> None:
    result = command(tmp_path, "doctor", environment={"POGO_SDK": "/nowhere"})
    assert (result.code, result.errors) == (0, "")
    found = findings(result)
    assert [found[name][0] for name in ("C programs", "C++ programs", "Projects", "Films", "Batches")] == ["ok"] * 5
    assert found["Real robots"] == ("missing", "there is no Pogobot SDK in POGO_SDK=/nowhere")
    assert list(tmp_path.iterdir()) == []


def test_doctor_says_what_is_missing_for_what(tmp_path: Path) -> None:
    for name in ("cc", "python3"):
        (tmp_path / name).symlink_to(shutil.which(name) or name)
    bare = {"PATH": str(tmp_path), "DISPLAY": "", "WAYLAND_DISPLAY": "", "SDL_VIDEODRIVER": ""}
    result = command(tmp_path, "doctor", environment=bare)
    assert result.code == 2, "cc without as and ld cannot compile"
    found = findings(result)
    assert found["C programs"][0] == "missing"
    assert found["C++ programs"] == ("missing", "the compiler 'c++' is not installed")
    assert found["Projects"] == ("missing", "make is not installed")
    assert found["Films"] == ("missing", "ffmpeg is not installed")
    assert found["Clusters"][0] == "ok", "a job script that runs pogobatch needs nothing more"
    assert found["Window"][0] == "missing"
    assert found["Window"][1].startswith("no display: neither DISPLAY nor WAYLAND_DISPLAY is set")
    assert found["Real robots"] == ("missing", "their compiler, riscv64-unknown-elf-gcc, is not installed")


def test_doctor_without_a_simulator(tmp_path: Path) -> None:
    result = command(tmp_path, "doctor", environment={"POGOSIM_DIR": str(tmp_path)})
    assert result.code == 2
    assert "there is no simulator in POGOSIM_DIR" in result.output


@pytest.mark.parametrize(("variable", "value"), [("CC", "'"), ("CC", "true"), ("CC", "/nowhere/cc")])
def test_doctor_gets_through_whatever_is_broken(variable: str, value: str, tmp_path: Path) -> None:
    result = command(tmp_path, "doctor", environment={variable: value})
    assert (result.code, result.errors) == (2, "")
    found = findings(result)
    assert found["C programs"][0] == "missing"
    assert len(found) == 11


def test_run_says_which_variable_cannot_be_understood(tmp_path: Path) -> None:
    shutil.copy(TEMPLATE / "main.c", tmp_path / "main.c")
    said = refusal(command(tmp_path, "run", "main.c", environment={"CFLAGS": '"'}))
    assert said == "pogosim run: the environment variable CFLAGS cannot be understood: No closing quotation"


def test_run_gives_flags_to_the_compiler(tmp_path: Path) -> None:
    (tmp_path / "main.c").write_text("#ifndef OWN\n#error no flag\n#endif\n" + (TEMPLATE / "main.c").read_text())
    configuration = str(write_scene(tmp_path, {}))
    for flags, code in (("", 2), ("-DOWN", 0)):
        result = command(tmp_path, "run", "./main.c", "-c", configuration, "-g", "-q", environment={"CFLAGS": flags})
        assert result.code == code, result.text


def test_run_compiles_cpp_20(tmp_path: Path) -> None:
    step = "user_step(void) { static_assert(requires { 1; });"
    (tmp_path / "main.cpp").write_text((TEMPLATE / "main.c").read_text().replace("user_step(void) {", step))
    result = command(tmp_path, "run", "main.cpp", "-c", str(write_scene(tmp_path, {})), "-g", "-q")
    assert result.code == 0, result.text


def test_run_needs_no_configuration_to_explain_the_options(tmp_path: Path) -> None:
    command(tmp_path, "new", "first")
    result = command(tmp_path, "run", "first", "--version")
    assert result.code == 0
    assert result.output.splitlines()[0].endswith(f"pogosim v{pogosim.__version__}")


@pytest.mark.parametrize("name", ["lib64", "lib/x86_64-linux-gnu"])
def test_simulator_in_a_folder_of_the_system_is_found(name: str, tmp_path: Path) -> None:
    folder = tmp_path / name / "pkgconfig"
    folder.mkdir(parents=True)
    shutil.copy(build_folder() / "pogosim.mk", folder)
    environment = {"POGOSIM_DIR": str(tmp_path)}
    assert command(tmp_path, "path", environment=environment).output == f"{tmp_path}\n"
    (folder / "pogosim.mk").write_text("POGOSIM_VERSION := 0.10\n")
    said = refusal(command(tmp_path, "path", environment=environment))
    assert said.endswith("is of another version, or damaged: build that Pogosim again")


@pytest.mark.parametrize("name", ["pogosim", "pogobatch"])
def test_interrupt_while_modules_are_imported_ends_it_without_a_traceback(name: str, tmp_path: Path) -> None:
    (tmp_path / "tqdm.py").write_text("import os, signal\nos.kill(os.getpid(), signal.SIGINT)\n")
    arguments = ["batch"] if name == "pogosim" else []
    done = subprocess.run(
        [Path(sys.executable).parent / name, *arguments, "-c", "a.yaml", "-S", "b"],
        env=CLEAN | {"PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    prog = " ".join([name, *arguments])
    said = f"{prog}: interrupted; finished runs are kept in tmp: the same command continues\n"
    assert (done.returncode, done.stderr) == (130, said)
