"""The wheel holds all that programs need, but for Arrow and SDL, which come with other packages."""

from __future__ import annotations

import importlib.util
import os
import platform
import re
import subprocess
import sys
import zipfile
from email.parser import Parser
from pathlib import Path

import pyarrow
import pytest
from project import CLEAN, TEMPLATE
from pyarrow import feather
from running import ROOT, Run, compile_program, ran, run_command, write_scene

# Every Linux has these, or gets them with a C compiler.
OF_THE_SYSTEM = {"linux-vdso.so.1", "libc.so.6", "libm.so.6", "libstdc++.so.6", "libgcc_s.so.1", "libz.so.1"}
OF_OLDER_SYSTEMS = {"libpthread.so.0", "libdl.so.2", "librt.so.1"}
OTHER_PACKAGES = ("pyarrow", "sdl2dll", "matplotlib")

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="auditwheel makes wheels for Linux")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the wheel, built with the packages of the project's environment."""
    folder = tmp_path_factory.mktemp("wheel")
    command: list[str | Path] = [sys.executable, ROOT / "scripts" / "make_wheel.py", "--here", folder, "--environment"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    (made,) = folder.iterdir()
    assert done.stdout.splitlines()[-1] == str(made)
    return made


@pytest.fixture(scope="module")
def packages(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder where it is installed, with the packages that it requires beside it."""
    folder = tmp_path_factory.mktemp("site-packages")
    command: list[str | Path] = [
        sys.executable,
        "-m",
        "pip",
        "install",
        "--quiet",
        "--no-deps",
        "--no-compile",
        "--target",
        folder,
        wheel,
    ]
    subprocess.run(command, check=True, capture_output=True)
    for name in OTHER_PACKAGES:
        found = importlib.util.find_spec(name)
        assert found and found.origin
        (folder / name).symlink_to(Path(found.origin).parent)
    return folder


def pogosim(packages: Path, folder: Path, *arguments: str) -> Run:
    """Run the command `pogosim` of the installed wheel."""
    return ran(folder, sys.executable, "-S", "-m", "pogosim", *arguments, env=CLEAN | {"PYTHONPATH": str(packages)})


@pytest.fixture(scope="module")
def project(packages: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a project made and built with the wheel, without pkg-config."""
    folder = tmp_path_factory.mktemp("project")
    assert pogosim(packages, folder, "new", "first").code == 0
    command: list[str | Path] = ["make", "-C", folder / "first", "sim", "PKG_CONFIG=no-such-program"]
    subprocess.run(command, env=CLEAN, check=True, capture_output=True)
    return folder / "first"


def needed(file: Path) -> dict[str, Path]:
    """Return the libraries that a file loads, by name."""
    printed = subprocess.run(["ldd", file], capture_output=True, text=True, check=True).stdout
    assert "not found" not in printed, printed
    return {name: Path(path) for name, path in re.findall(r"(\S+) => (/\S+)", printed)}


def test_it_loads_nothing_else_of_the_system(packages: Path, project: Path) -> None:
    binaries = [*packages.glob("pogosim/simulator/lib/*.so"), *packages.glob("pogosim/simulator/bin/*")]
    assert len(binaries) == 6
    for file in [*binaries, *packages.glob("pogobot_simulator.libs/*"), project / "first"]:
        for name, path in needed(file).items():
            is_of_a_package = packages in path.resolve().parents or "site-packages" in str(path)
            assert is_of_a_package or name in OF_THE_SYSTEM | OF_OLDER_SYSTEMS, f"{file.name} loads {path}"


def test_arrow_and_sdl_are_those_of_their_packages(packages: Path) -> None:
    library, parquet, tables, module = sorted(packages.glob("pogosim/simulator/lib/*.so"))
    assert ["_parquet" in parquet.name, "_tables" in tables.name, "_view" in module.name] == [True] * 3
    assert not any(name.startswith("libarrow") for name in needed(library))
    (arrow,) = (path for name, path in needed(tables).items() if name.startswith("libarrow.so"))
    (sdl,) = (path for name, path in needed(module).items() if name.startswith("libSDL2"))
    assert arrow.samefile(next((packages / "pyarrow").glob("libarrow.so.*")))
    assert sdl.samefile(packages / "sdl2dll" / "dll" / "libSDL2-2.0.so")


def test_metadata_require_the_arrow_it_was_built_with(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as content:
        (name,) = (name for name in content.namelist() if name.endswith(".dist-info/METADATA"))
        metadata = Parser().parsestr(content.read(name).decode())
    required = metadata.get_all("Requires-Dist", [])
    assert f"pyarrow=={'.'.join(pyarrow.__version__.split('.')[:2])}.*" in required
    assert any(requirement.startswith("pysdl2-dll") for requirement in required)
    assert re.fullmatch(rf"pogobot_simulator-[\d.]+-py3-none-manylinux_[\w.]+_{platform.machine()}\.whl", wheel.name)


def test_no_folder_of_the_machine_that_built_it_is_left_in_it(packages: Path) -> None:
    for file in packages.glob("pogo*/**/*"):
        if file.is_file() and file.suffix != ".pyc":
            assert os.fsencode(ROOT) not in file.read_bytes(), file


def test_program_gives_the_same_rows_as_with_the_build_in_the_tree(project: Path, tmp_path: Path) -> None:
    in_the_tree = compile_program(tmp_path / "first", TEMPLATE / "main.c")
    contents = set()
    for number, program in enumerate((project / "first", in_the_tree)):
        folder = tmp_path / str(number)
        folder.mkdir()
        result = run_command(program, folder, ["-c", str(write_scene(folder, {"simulation_time": 5.0}).name), "-q"])
        assert (result.code, result.errors) == (0, "")
        table = feather.read_table(folder / "data.feather")
        table = table.replace_schema_metadata({**table.schema.metadata, b"program_commit": b"that of each build"})
        feather.write_feather(table, folder / "same.feather", compression="uncompressed")
        contents.add((folder / "same.feather").read_bytes())
    assert len(contents) == 1


def test_arenas_frames_and_window_work(project: Path, tmp_path: Path) -> None:
    for arena in ("disk", "square", "arena8"):
        settings = {"arena_file": f"arenas/{arena}.csv", "save_video_period": 1.0, "frames_name": "f{:03.0f}.png"}
        folder = tmp_path / arena
        folder.mkdir()
        write_scene(folder, settings | {"GUI": True})
        ended = subprocess.run(
            [project / "first", "-c", "scene.yaml", "-q", "-nr", "--close-at-end"],
            cwd=folder,
            env=os.environ | {"SDL_VIDEODRIVER": "dummy"},
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
        )
        assert (ended.returncode, ended.stdout, ended.stderr) == (0, "", "")
        assert len(list(folder.glob("f*.png"))) == 2


def test_tool_for_shared_variables_is_in_it(packages: Path, tmp_path: Path) -> None:
    (tmp_path / "main.c").write_text(
        (TEMPLATE / "main.c").read_text().replace("user_step(void) {", "user_step(void) { static int n; n++;")
    )
    result = pogosim(packages, tmp_path, "run", "main.c", "-c", str(write_scene(tmp_path, {})), "-g", "-q")
    assert result.code == 0
    assert "warning: 'n' in user_step()" in result.errors


def test_doctor_finds_what_is_installed(packages: Path, tmp_path: Path) -> None:
    result = pogosim(packages, tmp_path, "doctor")
    assert result.code == 0
    assert f" in {packages}/pogosim/simulator" in result.output.splitlines()[0]
