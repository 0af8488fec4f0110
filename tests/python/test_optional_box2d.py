"""The simulator is built with Box2D 2.4, or without: cmake/box2d.cmake."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from running import ROOT

PROJECT = f"""cmake_minimum_required(VERSION 3.25)
project(box2d_or_not LANGUAGES CXX)
include({ROOT}/cmake/box2d.cmake)
message(STATUS "has it: ${{POGOSIM_HAS_BOX2D}}")
"""
# What a package of Box2D 3 has: the same names of the package and of its target, and a header for C.
VERSION_3 = """add_library(box2d::box2d INTERFACE IMPORTED)
set_target_properties(box2d::box2d PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${CMAKE_CURRENT_LIST_DIR}")
set(box2d_VERSION 3.1.0)
"""
WANTED = "Pogosim needs Box2D 2.4, not 3 (Debian and Ubuntu: libbox2d-dev)"


def configured(folder: Path, *options: str) -> tuple[int, str]:
    """Configure a project that has this file alone; returns the exit code, and what was said as one line."""
    (folder / "CMakeLists.txt").write_text(PROJECT)
    command = ["cmake", "-S", str(folder), "-B", str(folder / "build"), *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    return done.returncode, " ".join((done.stdout + done.stderr).split())


def package_of_version_3(folder: Path) -> str:
    (folder / "package" / "box2d").mkdir(parents=True)
    (folder / "package" / "box2dConfig.cmake").write_text(VERSION_3)
    (folder / "package" / "box2d" / "box2d.h").write_text("typedef struct b2WorldId b2WorldId;\n")
    return f"-Dbox2d_DIR={folder / 'package'}"


def test_version_2_4_is_found(tmp_path: Path) -> None:
    code, said = configured(tmp_path)
    assert code == 0
    assert "has it: 1" in said
    assert "Built without" not in said


def test_other_version_is_named_and_done_without(tmp_path: Path) -> None:
    code, said = configured(tmp_path, package_of_version_3(tmp_path))
    assert code == 0
    assert "Built without physics_engine: box2d: the Box2D in " in said
    assert f"(3.1.0) does not fit. {WANTED}" in said
    assert "has it: 1" not in said


def test_other_version_is_an_error_if_it_is_asked_for(tmp_path: Path) -> None:
    code, said = configured(tmp_path, package_of_version_3(tmp_path), "-DPOGOSIM_BOX2D=ON")
    assert code == 1
    assert "POGOSIM_BOX2D is ON, but the Box2D in " in said
    assert WANTED in said
    assert "With -DPOGOSIM_BOX2D=OFF, all objects are moved by our own engine." in said


@pytest.mark.parametrize("option", ["-DCMAKE_DISABLE_FIND_PACKAGE_box2d=ON", "-DPOGOSIM_BOX2D=OFF"])
def test_build_does_without(option: str, tmp_path: Path) -> None:
    code, said = configured(tmp_path, option)
    assert code == 0
    assert "has it: OFF" in said
    assert ("Box2D is not installed" in said) == ("DISABLE" in option)


def test_value_that_is_not_in_the_list_is_one_clear_error(tmp_path: Path) -> None:
    code, said = configured(tmp_path, "-DPOGOSIM_BOX2D=maybe")
    assert code == 1
    assert 'POGOSIM_BOX2D is "maybe"; expected one of AUTO, ON, OFF: cmake -DPOGOSIM_BOX2D=AUTO' in said
