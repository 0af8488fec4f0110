"""Nothing tells users to install the program that has the name pogosim on PyPI, and doctor notices it."""

from __future__ import annotations

import re
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from pogosim.command import doctor
from pogosim.extras import EXTRAS, installing
from running import ROOT

INSTALLS = re.compile(r"pip3? install(?:\s+-\S+)*\s+['\"]?pogosim(?!\w)")


def texts() -> list[Path]:
    """Return all files of the project that a user may read, or see messages of."""
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    suffixes = {".md", ".py", ".sh", ".c", ".h", ".cpp", ".hpp", ".mk", ".toml", ".yaml", ".yml", ".txt", ""}
    found = [ROOT / name for name in listed.splitlines() if Path(name).suffix in suffixes]
    return [path for path in found if path.is_file() and path.name != Path(__file__).name]


def test_no_page_or_message_installs_the_program_of_that_name_on_pypi() -> None:
    found = [
        f"{path.relative_to(ROOT)}: {match[0]}"
        for path in texts()
        for match in INSTALLS.finditer(path.read_text(encoding="utf-8", errors="replace"))
        if path.name != "CHANGELOG.md"  # what was
    ]
    assert found == []


@pytest.mark.parametrize(
    "text", ["pip install pogosim", "pip install 'pogosim[dask]'", 'pip install "pogosim"', "pip install -U pogosim"]
)
def test_plain_names_are_found(text: str) -> None:
    assert INSTALLS.search(text)


@pytest.mark.parametrize(
    "text", ["pip install ./pogobot_simulator-VERSION-py3-none-PLATFORM.whl", "pip install .", "pip install ~/pogosim"]
)
def test_wheels_and_checkouts_are_not_plain_names(text: str) -> None:
    assert not INSTALLS.search(text)


def split(package: str) -> tuple[str, SpecifierSet]:
    """Return the name of a package, and the versions that will do."""
    requirement = Requirement(package)
    return requirement.name, requirement.specifier


def test_optional_packages_are_those_of_the_project() -> None:
    project: dict[str, set[tuple[str, SpecifierSet]]] = {}
    for text in metadata.requires("pogobot-simulator") or []:
        package, _, extra = text.partition("; extra == ")
        project.setdefault(extra.strip("'\""), set()).add(split(package))
    assert {name: project[name] for name in EXTRAS} == {name: set(map(split, EXTRAS[name])) for name in EXTRAS}
    assert set(project) - set(EXTRAS) == {"", "docs", "test"}


def test_advice_names_this_python_and_packages_but_not_pogosim() -> None:
    for extra in EXTRAS:
        command = installing(extra)
        assert command.startswith(f"{sys.executable} -m pip install ")
        assert not re.search(r"pogosim(\[|$)", command.partition(" install ")[2])


def findings(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> str:
    monkeypatch.setattr(doctor, "CHECKS", {"Name": doctor.check_name})
    doctor.main([])
    return capsys.readouterr().out


def test_doctor_notices_another_package_of_that_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (other := tmp_path / "pogosim").mkdir()
    (other / "__init__.py").write_text('__version__ = "1.0"\n')
    monkeypatch.syspath_prepend(str(tmp_path))
    said = findings(monkeypatch, capsys)
    assert f"another program named pogosim is installed: {other}" in said
    assert "docs/other_pogosim.md" in said


def test_doctor_notices_another_command_of_that_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (command := tmp_path / "pogosim").write_text("#!/bin/sh\necho other\n")
    command.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    assert f"another program named pogosim is installed: {command}" in findings(monkeypatch, capsys)


def test_doctor_finds_this_one_alone(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("PATH", str(Path(sys.executable).parent), prepend=":")
    assert "Name              ok       this Pogosim is the only one" in findings(monkeypatch, capsys)


def test_folder_of_a_project_is_no_other_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A project may have a link `pogosim` to the tree, and be the working folder."""
    (tmp_path / "pogosim").symlink_to(ROOT)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", ["", *sys.path])
    assert "another program" not in findings(monkeypatch, capsys)
