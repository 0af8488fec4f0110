"""Compiling and running programs as a user does: a compiler, pkg-config, a configuration file and a command line."""

from __future__ import annotations

import copy
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import pyarrow as pa
import yaml
from pogosim import recover
from pogosim.utils import load_dataframe
from pyarrow import ipc

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = ROOT / "tests" / "programs"
SHARED = ("-shared", "-fPIC", "-g", "-Wall", "-Wextra")  # flags of a program that Python loads
LIBRARY = "libpogosim.dylib" if sys.platform == "darwin" else "libpogosim.so"

SCENE: dict[str, Any] = {
    "arena_file": "arenas/disk.csv",
    "arena_surface": 1.0e6,
    "simulation_time": 2.0,
    "time_step": 0.01,
    "save_data_period": 0.1,
    "data_filename": "data.feather",
    "seed": 1,
    "GUI": False,
    "objects": {"robots": {"type": "pogobot", "nb": 3, "geometry": "disk", "radius": 26.5}},
}

Floats = npt.NDArray[np.float64]
Settings = Mapping[str, object]

SUMMARY = re.compile(r"^\S+ s of \d+ robots? simulated in \S+ s, \S+ x real time; .*\n", re.MULTILINE)


def scene(settings: Settings) -> dict[str, Any]:
    """Return the scene with some keys (dotted paths) changed; None takes a key out."""
    result = copy.deepcopy(SCENE)
    for path, value in settings.items():
        *parents, key = path.split(".")
        node = result
        for parent in parents:
            node = node.setdefault(parent, {})
        if value is None:
            node.pop(key, None)
        else:
            node[key] = copy.deepcopy(value)  # later paths change entries of it
    return result


@dataclass(frozen=True)
class Run:
    """A program that has ended."""

    code: int
    output: str
    errors: str  # without the summary
    folder: Path
    summary: str = ""  # the line that a run says at its end

    def __post_init__(self) -> None:
        """Take the summary out of the errors."""
        if found := SUMMARY.search(self.errors):
            object.__setattr__(self, "summary", found[0].rstrip("\n"))
            object.__setattr__(self, "errors", SUMMARY.sub("", self.errors))

    @property
    def text(self) -> str:
        """All that was printed."""
        return self.output + self.errors

    @property
    def robot_lines(self) -> list[str]:
        """What robots printed, without date and level: "[ROBOT #0] [PRINTF] hello"."""
        return [line[line.index("[ROBOT #") :] for line in self.output.splitlines() if "[ROBOT #" in line]

    def frame(self, name: str = "data.feather") -> pd.DataFrame:
        """Rows of the data file."""
        return load_dataframe(self.folder / name)[0]

    def table(self, name: str = "data.feather") -> pa.Table:
        """The data file with its types and metadata."""
        with ipc.open_file(self.folder / name) as reader:
            return reader.read_all()


def write_scene(folder: Path, settings: Settings) -> Path:
    """Write scene.yaml in a folder, which is made."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "scene.yaml"
    path.write_text(yaml.safe_dump(scene(settings), sort_keys=False))
    return path


def compile_text(folder: Path, text: str, name: str = "main.c", **options: Any) -> Path:
    """Compile the text of a program to `prog` in a folder; `options` are those of compile_program()."""
    source = folder / name
    source.write_text(text)
    return compile_program(folder / "prog", source, **options)


def start(
    program: Path, folder: Path, settings: Settings | None = None, arguments: Sequence[str] = ()
) -> subprocess.Popen[str]:
    """Start a program headless in a folder, to be disturbed while it runs."""
    write_scene(folder, settings or {})
    command = [str(program), "-c", "scene.yaml", "-g", *arguments]
    return subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def run(program: Path, folder: Path, settings: Settings | None = None, arguments: Sequence[str] = ()) -> Run:
    """Run a program headless in a folder, with scene.yaml made there."""
    write_scene(folder, settings or {})
    return run_command(program, folder, ["-c", "scene.yaml", "-g", *arguments])


def run_shipped(name: str, folder: Path, settings: Settings | None = None, configuration: str | None = None) -> Run:
    """Run an example with conf/<name>.yaml or another one, some keys (dotted paths) changed, in a folder to make."""
    folder.mkdir(parents=True, exist_ok=True)
    path = ROOT / "conf" / f"{configuration or name}.yaml"
    changes = {"data_filename": str(folder / "data.feather"), "console_filename": str(folder / "console.txt")}
    arguments = ["-c", str(path), "-g"]
    for key, value in {**changes, **(settings or {})}.items():
        arguments += ["--set", f"{key}={yaml.safe_dump(value, default_flow_style=True).splitlines()[0]}"]
    result = run_command(example(name), folder, arguments)
    assert (result.code, result.errors) == (0, ""), result.text
    return result


def run_command(program: Path, folder: Path, arguments: Sequence[str]) -> Run:
    """Run a program with these arguments in a folder."""
    return ran(folder, program, *arguments)


def ran(folder: Path, *command: str | Path, **how: Any) -> Run:
    """Run a command in a folder to its end; `how` goes to subprocess.run()."""
    options = {"capture_output": True, "text": True, "timeout": 120, "check": False} | how
    ended = subprocess.run([*map(str, command)], cwd=folder, **options)
    return Run(ended.returncode, ended.stdout, ended.stderr, folder)


def end(process: subprocess.Popen[str], folder: Path) -> Run:
    """Wait for the end of a program whose output is a pipe."""
    output, errors = process.communicate(timeout=60)
    return Run(process.returncode, output, errors, folder)


def wait_for_rows(path: Path) -> None:
    """Wait until a run has written rows into a file."""
    for _ in range(600):
        time.sleep(0.05)
        try:
            if recover.read_unfinished(path).table.num_rows > 0:
                return
        except (FileNotFoundError, recover.RecoverError):
            pass  # its head is not there yet, or only a part of it
    raise AssertionError("no rows come")


def warnings(result: Run) -> list[str]:
    """Return the warnings without date and level; the run has ended well."""
    assert result.code == 0, result.text
    return [line.partition("[warning] ")[2] for line in result.errors.splitlines()]


def by_robot(frame: pd.DataFrame, column: str) -> Floats:
    """One row per time, one column per robot."""
    return frame.pivot(index="time", columns="robot_id", values=column).to_numpy(dtype=np.float64)


def order(frame: pd.DataFrame) -> Floats:
    """Polar order of the headings over time, 0 to 1."""
    return np.asarray(np.abs(np.exp(1j * by_robot(frame, "angle")).mean(axis=1)))


def without_places(messages: str) -> str:
    """Leave out where in the program's source a failure was, which depends on how it is compiled."""
    return re.sub(r"(t = [\d.]+ s), (?:at [^\n:]+:\d+ )?in [^\n]*?\): ", r"\1: ", messages)


def example(name: str) -> Path:
    """Return a built example program."""
    path = ROOT / "examples" / name / name
    assert path.exists(), f"{path} is not built: run ./build.sh"
    return path


@cache
def build_folder() -> Path:
    """Return the folder of the built library: POGOSIM_BUILD_DIR, or else the newest without sanitizers, of no wheel."""
    if chosen := os.environ.get("POGOSIM_BUILD_DIR"):
        return Path(chosen).resolve()
    libraries = sorted((ROOT / "build").glob(f"*/src/{LIBRARY}"), key=lambda path: path.stat().st_mtime)
    folders = [library.parents[1] for library in libraries]
    others = re.compile(r"^(POGOSIM_SANITIZE:\w+=(?!OFF).+|SKBUILD:.*)$", re.MULTILINE)
    usable = [folder for folder in folders if not others.search((folder / "CMakeCache.txt").read_text())]
    assert usable, f"no {LIBRARY} in {ROOT / 'build'}/*/src: run ./build.sh"
    return usable[-1]


def pkg_config(*arguments: str, package: str = "pogosim") -> list[str]:
    """Ask pkg-config about the built library."""
    environment = {**os.environ, "PKG_CONFIG_PATH": str(build_folder())}
    command = ["pkg-config", *arguments, package]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.split()


def compile_program(
    output: Path,
    *sources: Path,
    compiler: str | None = None,
    flags: Sequence[str] = ("-Wall", "-Wextra", "-Wfloat-conversion", "-Werror"),
    package: str = "pogosim",
) -> Path:
    """Compile sources of one language to a program; `package`: "pogosim-sdk" for one that includes pogobot.h."""
    is_cpp = sources[0].suffix == ".cpp"
    standard = [] if any(flag.startswith("-std=") for flag in flags) else ["-std=c++20" if is_cpp else "-std=c11"]
    command = [compiler or ("c++" if is_cpp else "cc"), *standard, "-O1", *flags]
    command += [str(source) for source in sources]
    command += [*pkg_config("--cflags", "--libs", package=package), "-o", str(output)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{' '.join(command)}\n{done.stderr}"
    return output


def compiler(*names: str) -> str | None:
    """Return the first of these compilers that is installed."""
    return next((name for name in names if shutil.which(name)), None)
