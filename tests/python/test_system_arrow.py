"""Where the system has an Arrow, the simulator is built with it, and without a Python: FindPogosimArrow.cmake."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pyarrow
from running import ROOT

PROJECT = f"""cmake_minimum_required(VERSION 3.22)
project(with_arrow LANGUAGES CXX)
list(APPEND CMAKE_MODULE_PATH {ROOT}/cmake)
find_package(PogosimArrow REQUIRED)
add_executable(with_arrow main.cpp)
set_property(TARGET with_arrow PROPERTY CXX_STANDARD 20)
target_link_libraries(with_arrow PRIVATE pogosim::arrow)
if(NOT TARGET pogosim::parquet)
    message(FATAL_ERROR "no Parquet")
endif()
"""
MAIN = """#include <arrow/config.h>
#include <cstdio>
int main() { std::puts(arrow::GetBuildInfo().version_string.c_str()); }
"""
LIBRARY = """if(NOT TARGET {name}::{lower}_shared)
    add_library({name}::{lower}_shared SHARED IMPORTED)
    set_target_properties({name}::{lower}_shared PROPERTIES
        IMPORTED_LOCATION {file} INTERFACE_INCLUDE_DIRECTORIES {include})
endif()
"""


def install_arrow(prefix: Path, version: str) -> None:
    """Make what a distribution's package has for CMake, of the libraries in pyarrow."""
    for name in ("Arrow", "Parquet"):
        lower = name.lower()
        (file,) = (path for path in Path(pyarrow.__file__).parent.glob(f"lib{lower}.so.*") if path.suffix[1:].isdigit())
        package = prefix / "lib" / "cmake" / name
        package.mkdir(parents=True)
        text = LIBRARY.format(name=name, lower=lower, file=file, include=pyarrow.get_include())
        (package / f"{name}Config.cmake").write_text(text)
        versions = f'set(PACKAGE_VERSION "{version}")\nset(PACKAGE_VERSION_COMPATIBLE TRUE)\n'
        (package / f"{name}ConfigVersion.cmake").write_text(versions)


def configured(folder: Path) -> tuple[int, str]:
    """Configure the project without a Python; returns the exit code, and what was said as one line."""
    (folder / "CMakeLists.txt").write_text(PROJECT)
    (folder / "main.cpp").write_text(MAIN)
    command: list[str | Path] = ["cmake", "-S", folder, "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={folder}/prefix"]
    command += ["-DPOGOSIM_PYTHON=/nowhere/python"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    return done.returncode, " ".join((done.stdout + done.stderr).split())


def test_arrow_of_the_system_needs_no_python(tmp_path: Path) -> None:
    install_arrow(tmp_path / "prefix", "23.0.1")
    code, said = configured(tmp_path)
    assert code == 0, said
    assert f'Found PogosimArrow: {tmp_path}/prefix/lib/cmake/Arrow (found version "23.0.1")' in said
    subprocess.run(["cmake", "--build", tmp_path / "build"], check=True, capture_output=True, timeout=300)
    printed = subprocess.run(
        [tmp_path / "build" / "with_arrow"], check=True, capture_output=True, text=True, timeout=60
    )
    assert printed.stdout.strip() == pyarrow.cpp_build_info.version


def test_older_arrow_is_named(tmp_path: Path) -> None:
    install_arrow(tmp_path / "prefix", "9.0.0")
    code, said = configured(tmp_path)
    assert code == 1
    assert f"the Arrow in {tmp_path}/prefix/lib/cmake/Arrow is 9.0.0, expected 10 or later" in said
    assert "there is no /nowhere/python" in said
    assert "install Arrow (Ubuntu 26.04 and later: libarrow-dev" in said
