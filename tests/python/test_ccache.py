"""Builds of the same sources in several folders share what ccache keeps: cmake/ccache.cmake."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

import pytest
from running import ROOT

PROJECT = """cmake_minimum_required(VERSION 3.22)
project(one_file LANGUAGES CXX)
include(cmake/ccache.cmake)
add_executable(one_file src/one_file.cpp)
target_include_directories(one_file PRIVATE ${PROJECT_SOURCE_DIR}/include)
"""


def built(clone: Path, kept: Path, build_type: str) -> Path:
    """Build a project of one file in a folder with CMake's own commands; returns the object file."""
    for name, text in {
        "CMakeLists.txt": PROJECT,
        "cmake/ccache.cmake": (ROOT / "cmake" / "ccache.cmake").read_text(),
        "include/one.hpp": "int one();\n",
        "src/one_file.cpp": '#include "one.hpp"\nint main() { return 0; }\n',
    }.items():
        (clone / name).parent.mkdir(parents=True, exist_ok=True)
        (clone / name).write_text(text)
    build = clone / "build"
    environment = {name: value for name, value in os.environ.items() if not name.startswith("CCACHE")}
    environment["CCACHE_DIR"] = str(kept)
    commands: list[list[str | Path]] = [
        ["cmake", "-S", clone, "-B", build, f"-DCMAKE_BUILD_TYPE={build_type}"],
        ["cmake", "--build", build],
    ]
    for command in commands:
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
    return build / "CMakeFiles" / "one_file.dir" / "src" / "one_file.cpp.o"


def hits(kept: Path) -> int:
    """Return how often ccache found what it had kept."""
    done = subprocess.run(
        ["ccache", "--print-stats"],
        env=os.environ | {"CCACHE_DIR": str(kept)},
        capture_output=True,
        text=True,
        check=True,
    )
    return sum(int(count) for count in re.findall(r"^(?:direct|preprocessed)_cache_hit\s+(\d+)", done.stdout, re.M))


@pytest.mark.parametrize(("build_type", "shared"), [("Release", 1), ("Debug", 0)])
def test_clones_share_what_was_compiled_unless_it_names_their_folder(
    build_type: str, shared: int, tmp_path: Path
) -> None:
    for number, clone in enumerate(("one clone", "another clone")):
        built(tmp_path / clone, tmp_path / "kept", build_type)
        assert hits(tmp_path / "kept") == number * shared


def test_debug_information_names_the_folder_of_its_build(tmp_path: Path) -> None:
    for clone in ("first", "second"):
        assert f"/{clone}/build".encode() in built(tmp_path / clone, tmp_path / "kept", "Debug").read_bytes()
