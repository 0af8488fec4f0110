"""Worlds develop to the same bits whatever compiler, level of optimisation and processor the simulator is built for.

The project's own builds run the program same_bytes as a test, with gcc at -O3 and with clang at -O1 and sanitizers.
Here are others.
"""

from __future__ import annotations

import shutil
import subprocess
import sys

import pytest
from running import ROOT

SOURCES = ROOT / "tests" / "same_bytes"

# Compiler, its flags, and what runs the program.
BUILDS = {
    "clang for this processor": (["clang++"], "-O2 -march=native", []),
    "ARM64": (["aarch64-linux-gnu-g++"], "-O2 -static", ["qemu-aarch64"]),
}


@pytest.mark.skipif(sys.platform != "linux", reason="needs a cross compiler of Linux")
@pytest.mark.parametrize("name", BUILDS)
def test_worlds_develop_to_the_same_bits(name: str) -> None:
    compiler, flags, runner = BUILDS[name]
    for tool in (*compiler, *runner):
        assert shutil.which(tool), f"{tool} is missing: scripts/bootstrap.sh installs it"
    generator = ["-G", "Ninja"] if shutil.which("ninja") else []
    # Within the tree, where ccache finds what was compiled before, here or in another clone: cmake/ccache.cmake.
    folder = ROOT / "build" / "same_bytes" / name.replace(" ", "_")
    configure = ["cmake", "--fresh", "-S", str(SOURCES), "-B", str(folder), *generator]
    configure += [f"-DCMAKE_CXX_COMPILER={compiler[0]}", f"-DCMAKE_CXX_FLAGS={flags}"]
    for command in (configure, ["cmake", "--build", str(folder), "--parallel", "2"]):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
    result = subprocess.run(
        [*runner, str(folder / "same_bytes")], capture_output=True, text=True, check=False, timeout=600
    )
    assert (result.returncode, result.stderr) == (0, "")
    assert result.stdout == (SOURCES / "expected.txt").read_text()
