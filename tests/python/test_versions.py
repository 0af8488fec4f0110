"""The version stands in one place, and the library says what it was built of and with."""

from __future__ import annotations

import ctypes
import json
import os
import platform
import re
import shutil
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pogosim
import pytest
from pogosim.command.version import build_info, commit_of, library_file
from pogosim.installation import installation_in
from project import CLEAN
from running import ROOT, Run, build_folder, pkg_config, ran, write_scene

HEADER = ROOT / "include" / "pogosim" / "version.h"
COPY = ROOT / "python" / "pogosim" / "__init__.py"
CONTRIBUTING = ROOT / "CONTRIBUTING.md"
COMMIT = ROOT / "cmake" / "commit.cmake"
AUTHOR = [f"GIT_{role}_{what}" for role in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")]
NAMES = ["commit", "compiler", "engines", "Arrow"]


def header_of_minor_version(minor: int) -> str:
    """Return the text of the header with another minor version."""
    text, count = re.subn(r"(?m)^(#define POGOSIM_VERSION_MINOR) \d+$", rf"\1 {minor}", HEADER.read_text())
    assert count == 1
    return text


def version_of(header: Path) -> str:
    """Return the version that a header defines."""
    return ".".join(
        re.findall(r"^#define POGOSIM_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)$", header.read_text(), re.MULTILINE)
    )


def git(folder: Path, *arguments: str) -> str:
    """Run git in a folder; returns what it prints."""
    command = ["git", "-C", str(folder), *arguments]
    environment = os.environ | dict.fromkeys(AUTHOR, "tester@example.org")
    return subprocess.run(
        command,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.strip()


def committed(folder: Path, message: str = "first") -> str:
    """Commit all files of a folder, a repository of its own; returns the commit as git describes it."""
    if not (folder / ".git").exists():
        git(folder, "init", "--quiet")
    git(folder, "add", "--all")
    git(folder, "commit", "--quiet", "--allow-empty", "--message", message)
    return git(folder, "describe", "--always", "--tags", "--dirty")


# ---- One place


def test_package_build_and_metadata_have_the_version_of_the_header() -> None:
    version = version_of(HEADER)
    assert re.fullmatch(r"\d+\.\d+\.\d+", version)
    assert pogosim.__version__ == version
    assert metadata.version("pogobot-simulator") == version
    found = installation_in(build_folder())
    assert found
    assert found.version == version


def test_copies_are_in_the_files_that_the_page_on_releases_names_and_in_no_others() -> None:
    release = CONTRIBUTING.read_text().split("## A release\n")[1]
    (copies,) = re.findall(r"its copies, .*?:\n(.*?)\.\n", release, re.DOTALL)
    named = re.findall(r"`(\S+)`", copies)
    version = version_of(HEADER)
    # Pages and tests name versions for other reasons: when a time was measured, what a change is of.
    places = ["*.cff", "*.toml", "CMakeLists.txt", ".ci", ".github", ".gitlab-ci.yml", "cmake", "containers", "include"]
    listed = git(ROOT, "ls-files", *places, "modules", "python", "scripts", "src", "template_prj", "tools")
    found = [
        name
        for name in listed.splitlines()
        if (file := ROOT / name).is_file()  # no link to a folder
        and version in re.sub(r'such as ".*"|before .*', "", file.read_text(errors="replace"))
    ]
    assert sorted(name.replace(version, "VERSION") for name in found) == sorted(named)


def test_text_of_the_header_is_made_of_its_numbers(tmp_path: Path) -> None:
    (tmp_path / "main.c").write_text(
        '#include <stdio.h>\n#include "version.h"\nint main(void) { return puts(POGOSIM_VERSION) < 0; }\n'
    )
    (tmp_path / "version.h").write_text(header_of_minor_version(34))
    subprocess.run(["cc", "-Wall", "-Werror", "main.c", "-o", "main"], cwd=tmp_path, check=True)
    assert ran(tmp_path, "./main").output == f"v{version_of(tmp_path / 'version.h')}\n"
    assert ".34." in version_of(tmp_path / "version.h")


def configured(tree: Path) -> Run:
    """Configure a tree that has nothing but the version."""
    (tree / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.22)\ninclude(cmake/version.cmake)\n"
        'project(one VERSION "${POGOSIM_VERSION}" LANGUAGES NONE)\nmessage("it is ${PROJECT_VERSION}")\n'
    )
    return ran(tree, "cmake", "-S", ".", "-B", "build")


def test_build_with_another_version_in_the_package_is_refused(tmp_path: Path) -> None:
    for file in (HEADER, COPY, ROOT / "cmake" / "version.cmake"):
        copy = tmp_path / file.relative_to(ROOT)
        copy.parent.mkdir(parents=True)
        shutil.copy(file, copy)
    version = version_of(HEADER)
    assert f"it is {version}\n" in configured(tmp_path).errors
    copy = tmp_path / COPY.relative_to(ROOT)
    copy.write_text(COPY.read_text().replace(version, "9.8.7"))
    refused = configured(tmp_path)
    assert refused.code == 1
    assert f'Write the version of the header there: __version__ = "{version}"' in refused.errors


# ---- What the library says


def test_library_says_what_it_was_built_of_and_with() -> None:
    found = installation_in(build_folder())
    assert found
    said = build_info(library_file(found))
    assert list(said) == NAMES
    assert re.fullmatch(r"(gcc|clang) \d+\..*", said["compiler"])
    assert re.fullmatch(r"disk(, box2d 2\.4\.\d+)?", said["engines"])
    assert re.fullmatch(r"\d+\.\d+\.\d+", said["Arrow"])
    assert said["commit"] == (found.library / "libpogosim.commit").read_text().strip()


def test_its_engines_are_those_that_move_objects() -> None:
    found = installation_in(build_folder())
    assert found
    cache = (build_folder() / "CMakeCache.txt").read_text()
    has_box2d = "POGOSIM_BOX2D_FITS:INTERNAL=1" in cache and "POGOSIM_BOX2D:STRING=OFF" not in cache
    assert ("box2d" in build_info(library_file(found))["engines"]) == has_box2d


def test_commit_is_unknown_where_the_file_beside_the_library_is_missing(tmp_path: Path) -> None:
    found = installation_in(build_folder())
    assert found
    copy = tmp_path / "libpogosim.so"
    shutil.copy(library_file(found).resolve(), copy)
    code = f"from pogosim.command.version import build_info\nprint(build_info({str(copy)!r})['commit'])"
    # In processes of their own, since one that has loaded several libraries has no room for the data of its threads.
    assert ran(tmp_path, sys.executable, "-c", code).output == "unknown\n"
    (tmp_path / "libpogosim.commit").write_text("abc-dirty\n")
    assert ran(tmp_path, sys.executable, "-c", code).output == "abc-dirty\n"


def test_function_has_c_linkage_and_is_the_same_text_each_time() -> None:
    found = installation_in(build_folder())
    assert found
    function = ctypes.CDLL(str(library_file(found))).pogosim_build_info
    function.restype = ctypes.c_void_p
    assert function() == function() != 0


# ---- What the command says


def command(folder: Path, *arguments: str, place: Path | None = None) -> Run:
    """Run `pogosim` with the simulator under test, or that of another folder."""
    return ran(
        folder, sys.executable, "-m", "pogosim", *arguments, env=CLEAN | {"POGOSIM_DIR": str(place or build_folder())}
    )


def test_version_has_a_line_for_each_thing(tmp_path: Path) -> None:
    result = command(tmp_path, "--version")
    assert (result.code, result.errors) == (0, "")
    first, *lines = result.output.splitlines()
    assert first == f"pogosim {pogosim.__version__}"
    said = dict(line.split(": ", 1) for line in lines)
    assert list(said) == [*NAMES, "library", "Python"]
    assert Path(said["library"]).is_file()
    assert said["Python"] == platform.python_version()


def test_version_as_json_says_the_same(tmp_path: Path) -> None:
    first, *lines = command(tmp_path, "--version").output.splitlines()
    result = command(tmp_path, "-V", "--json")
    said = json.loads(result.output)
    assert said.pop("version") == first.split()[1]
    assert isinstance(said["engines"], list)
    said["engines"] = ", ".join(said["engines"])
    assert said == {name.lower(): value for name, value in (line.split(": ", 1) for line in lines)}


def test_version_takes_no_other_option(tmp_path: Path) -> None:
    result = command(tmp_path, "--version", "--yaml")
    assert (result.code, result.output) == (2, "")
    assert result.errors == "pogosim: --version is followed by nothing or --json, found '--yaml'\n"


def test_version_of_a_package_without_a_library_is_told(tmp_path: Path) -> None:
    result = command(tmp_path, "--version", place=tmp_path)
    assert result.code == 0
    assert result.output.splitlines()[:2] == [f"pogosim {pogosim.__version__}", "commit: unknown"]
    assert result.errors.startswith("pogosim: warning: no library: there is no simulator in POGOSIM_DIR=")


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """Return a checkout with a simulator in it: that under test, built at its first commit."""
    (folder := tmp_path / "checkout").mkdir()
    (folder / ".gitignore").write_text("build\n")
    commit = committed(folder)
    (library := folder / "build" / "release").mkdir(parents=True)
    found = installation_in(build_folder())
    assert found
    shutil.copy(library_file(found).resolve(), library / library_file(found).name)
    (library / "libpogosim.commit").write_text(f"{commit}\n")
    settings = (build_folder() / "pogosim.mk").read_text().replace(f"{found.library}\n", f"{library}\n")
    (library / "pogosim.mk").write_text(settings)
    return folder


def test_checkout_of_the_commit_of_the_library_is_named(checkout: Path, tmp_path: Path) -> None:
    result = command(tmp_path, "--version", place=checkout)
    assert (result.code, result.errors) == (0, "")
    assert f"checkout: {git(checkout, 'describe', '--always')}\n" in result.output


def test_checkout_of_another_commit_than_the_library_is_told(checkout: Path, tmp_path: Path) -> None:
    old = git(checkout, "describe", "--always")
    new = committed(checkout, "second")
    result = command(tmp_path, "--version", place=checkout)
    assert result.code == 0
    assert f"commit: {old}\n" in result.output
    assert f"checkout: {new}\n" in result.output
    assert result.errors == (
        f"pogosim: warning: the library was built at {old}, and {checkout} is at {new}: build it again\n"
    )


def test_library_of_another_version_than_the_package_is_told(checkout: Path, tmp_path: Path) -> None:
    settings = checkout / "build" / "release" / "pogosim.mk"
    settings.write_text(settings.read_text().replace(f":= {pogosim.__version__}\n", ":= 9.8.7\n"))
    result = command(tmp_path, "--version", place=checkout)
    assert (
        result.errors
        == f"pogosim: warning: the library is of version 9.8.7, and this package of {pogosim.__version__}\n"
    )


# ---- The commit that a build records


def recorded(folder: Path, file: Path) -> str:
    """Return what a build of the sources in a folder writes into a file, without a warning."""
    built = ran(folder, "cmake", f"-DFOLDER={folder}", f"-DFILE={file}", "-P", COMMIT)
    assert (built.code, built.text) == (0, "")
    return file.read_text().removesuffix("\n")


@pytest.fixture
def sources(tmp_path: Path) -> Path:
    """Return a folder with sources that is no checkout yet."""
    (folder := tmp_path / "sources").mkdir()
    (folder / "cmake").mkdir()
    return folder


def test_commit_is_that_of_the_checkout(sources: Path, tmp_path: Path) -> None:
    file = tmp_path / "commit"
    assert recorded(sources, file) == "unknown"
    (sources / "main.c").touch()
    first = committed(sources)
    assert recorded(sources, file) == commit_of(sources) == first
    (sources / "main.c").write_text("int a;\n")
    assert recorded(sources, file) == commit_of(sources) == f"{first}-dirty"
    second = committed(sources, "second")
    assert recorded(sources, file) == commit_of(sources) == second != first
    git(sources, "tag", "v7.8.9")
    assert recorded(sources, file) == commit_of(sources) == "v7.8.9"


def test_build_says_in_one_line_that_git_fails(sources: Path, tmp_path: Path) -> None:
    (sources / ".git").write_text("gitdir: nowhere\n")
    file = tmp_path / "commit"
    built = ran(sources, "cmake", f"-DFOLDER={sources}", f"-DFILE={file}", "-P", COMMIT)
    assert (built.code, built.output, built.errors.count("\n")) == (0, "", 1)
    assert f'checkout {sources}, so its commit is recorded as "unknown": fatal: ' in built.errors
    assert file.read_text() == "unknown\n"
    assert commit_of(sources) is None


def test_file_is_written_only_for_another_commit(sources: Path, tmp_path: Path) -> None:
    file = tmp_path / "commit"
    committed(sources)
    recorded(sources, file)
    os.utime(file, ns=(1, 1))
    recorded(sources, file)
    assert file.stat().st_mtime_ns == 1
    committed(sources, "second")
    recorded(sources, file)
    assert file.stat().st_mtime_ns > 1


def test_repository_around_a_copy_of_the_sources_is_not_asked(sources: Path, tmp_path: Path) -> None:
    committed(sources.parent)
    assert recorded(sources, tmp_path / "commit") == "unknown"


def test_archive_of_git_has_its_commit(sources: Path, tmp_path: Path) -> None:
    for name in (".gitattributes", "cmake/archive_commit.txt"):
        shutil.copy(ROOT / name, sources / name)
    commit = committed(sources)
    git(sources, "archive", "--output", str(tmp_path / "sources.tar"), "HEAD")
    (unpacked := tmp_path / "unpacked").mkdir()
    subprocess.run(["tar", "-xf", tmp_path / "sources.tar", "-C", unpacked], check=True)
    assert recorded(unpacked, tmp_path / "commit") == commit


@pytest.mark.parametrize("works", [True, False], ids=["git works", "git fails"])
def test_source_distribution_has_its_commit(works: bool, sources: Path, tmp_path: Path) -> None:
    needed = ("pyproject.toml", "README.md", "LICENSE", ".gitignore", "include/pogosim/version.h")
    providers = ("arrow_requirement.py", "recorded_commit.py", "commit.cmake", "archive_commit.txt")
    for name in (*needed, *(f"cmake/{provider}" for provider in providers)):
        (sources / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, sources / name)
    (sources / "cmake" / "sdist_commit.txt").write_text("earlier\n")
    if works:
        commit = committed(sources)
    else:
        (sources / ".git").write_text("gitdir: nowhere\n")
        commit = "unknown"
    code = f"from scikit_build_core.build import build_sdist\nbuild_sdist({str(tmp_path)!r})"
    built = ran(sources, sys.executable, "-c", code)
    assert built.code == 0, built.text
    name = f"pogobot_simulator-{version_of(HEADER)}"
    subprocess.run(["tar", "-xzf", tmp_path / f"{name}.tar.gz", "-C", tmp_path], check=True)
    assert recorded(tmp_path / name, tmp_path / "commit") == commit


# ---- What a minor version may break


def program_of_minor_version(folder: Path, minor: int, *flags: str) -> Path:
    """Compile a program, and what is linked into each, for another minor version; returns it."""
    (include := folder / "include" / "pogosim").mkdir(parents=True)
    (include / "version.h").write_text(header_of_minor_version(minor))
    sources = [ROOT / "src" / "program" / name for name in ("program.c", "main.c")]
    words = ["-I", str(include.parent), "-I", str(ROOT / "include"), *flags, str(ROOT / "examples/helloworld/main.c")]
    program = folder / "program"
    compiler = ["cc", "-std=gnu11", *words, *map(str, sources), "-o", str(program), *pkg_config("--libs")]
    subprocess.run(compiler, check=True)
    return program


def test_program_of_another_minor_version_is_refused_and_still_says_what_it_runs_with(tmp_path: Path) -> None:
    minor = int(version_of(HEADER).split(".")[1])
    program = program_of_minor_version(tmp_path, minor + 1)
    configuration = write_scene(tmp_path, {})
    for options in ([], ["--check-config"]):
        result = ran(tmp_path, program, "-c", configuration.name, "-g", "-q", *options)
        assert (result.code, result.output) == (2, "")
        (line,) = result.errors.splitlines()
        versions = rf"was built with Pogosim \d+\.{minor + 1}\.\d+, and this is {pogosim.__version__}"
        assert re.fullmatch(rf".*'{program}' {versions}: build it again", line)
    assert ran(tmp_path, program, "--version").output.startswith(f"pogosim v{pogosim.__version__}\n")
    batch = command(tmp_path, "batch", "-c", configuration.name, "-S", str(program), "-r", "2", "-o", "results")
    assert batch.code != 0
    assert "build it again" in batch.errors


def test_program_of_this_minor_version_runs(tmp_path: Path) -> None:
    program = program_of_minor_version(tmp_path, int(version_of(HEADER).split(".")[1]))
    assert ran(tmp_path, program, "-c", write_scene(tmp_path, {}).name, "-g", "-q").code == 0


def test_shared_object_of_another_minor_version_is_refused(tmp_path: Path) -> None:
    program = program_of_minor_version(tmp_path, int(version_of(HEADER).split(".")[1]) - 1, "-shared", "-fPIC")
    with pytest.raises(pogosim.ConfigurationError, match=r"was built with Pogosim .*: build it again"):
        pogosim.Simulation(program, write_scene(tmp_path, {}))


@pytest.mark.skipif(sys.platform != "linux", reason="other systems name libraries in another way")
def test_name_of_the_library_is_that_of_the_minor_version() -> None:
    found = installation_in(build_folder())
    assert found
    read = subprocess.run(["readelf", "-d", library_file(found)], capture_output=True, text=True, check=True).stdout
    assert f"soname: [libpogosim.so.{version_of(HEADER).rpartition('.')[0]}]" in read


def test_page_names_each_line_of_the_command(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "versions.md").read_text()
    rows = re.findall(
        r"^\| `([\w ]+)` \|", page.partition("## Which one is it?")[2].partition("\n## ")[0], re.MULTILINE
    )
    lines = command(tmp_path, "--version").output.splitlines()[1:]
    assert rows == ["pogosim", *(line.split(": ")[0] for line in lines), "checkout"]
