"""This package beside another one named pogosim in an environment of pip, in either order, and what is left of it."""

from __future__ import annotations

import base64
import hashlib
import os
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Mapping
from pathlib import Path

import pytest
from running import ROOT, Run, ran

# What the pogosim 0.10.10 of PyPI installs.
MODULES = [
    *("__init__", "am", "arenas", "compute_optimal_psend", "convert_and_scale_svg", "coverage", "locomotion"),
    *("neighbors", "network", "pogobatch", "pogoptim", "scale_csv_arena", "utils"),
]
OTHER = "'pogosim 0.10.10', another program,"
MEND = "-m pip uninstall pogosim pogobot-simulator, then install the one that you want"


def wheel(folder: Path, version: str, files: Mapping[str, bytes], scripts: Mapping[str, str]) -> Path:
    """Write the wheel of a distribution named pogosim."""
    info = f"pogosim-{version}.dist-info"
    content = {
        **files,
        f"{info}/METADATA": f"Metadata-Version: 2.1\nName: pogosim\nVersion: {version}\n".encode(),
        f"{info}/WHEEL": b"Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
        f"{info}/entry_points.txt": "\n".join(
            ["[console_scripts]", *(f"{name} = {function}" for name, function in scripts.items()), ""]
        ).encode(),
    }
    record = []
    with zipfile.ZipFile(folder / f"pogosim-{version}-py3-none-any.whl", "w") as file:
        for name, data in content.items():
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append(f"{name},sha256={digest},{len(data)}")
            file.writestr(name, data)
        file.writestr(f"{info}/RECORD", "\n".join([*record, f"{info}/RECORD,,", ""]))
    return Path(str(file.filename))


@pytest.fixture(scope="module")
def other(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the wheel of another program, with the names of the files of that on PyPI."""
    files = {f"pogosim/{name}.py": f'"""{name} of another program."""\n'.encode() for name in MODULES}
    files["pogosim/pogobatch.py"] = b'def main():\n    print("the other pogobatch")\n'
    return wheel(tmp_path_factory.mktemp("other"), "0.10.10", files, {"pogobatch": "pogosim.pogobatch:main"})


@pytest.fixture(scope="module")
def ours(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the wheel of this package, without the simulator in it."""
    folder = tmp_path_factory.mktemp("ours")
    options = ["--quiet", "--no-deps", "--no-build-isolation", "--config-settings", "wheel.cmake=false"]
    command = [sys.executable, "-m", "pip", "wheel", *options, "--wheel-dir", str(folder), str(ROOT)]
    subprocess.run(command, check=True, capture_output=True)
    (made,) = folder.iterdir()
    assert made.name.startswith("pogobot_simulator-")
    return made


@pytest.fixture(scope="module")
def older(ours: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the wheel of this package as it was, named pogosim and without anything that looks for others."""
    with zipfile.ZipFile(ours) as file:
        files = {name: file.read(name) for name in file.namelist() if name.startswith("pogosim/")}
    files["pogosim/__init__.py"] = b'__version__ = "0.11.0"\n'
    scripts = {"pogosim": "pogosim.command.main:pogosim_command", "pogobatch": "pogosim.command.main:pogobatch"}
    return wheel(tmp_path_factory.mktemp("older"), "0.11.0", files, scripts)


@pytest.fixture(scope="module")
def empty(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return an environment with pip alone."""
    folder = tmp_path_factory.mktemp("empty") / "environment"
    subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    return folder


class Environment:
    """An environment of its own."""

    def __init__(self, folder: Path, empty: Path) -> None:
        self.folder = folder / "environment"
        shutil.copytree(empty, self.folder, symlinks=True)
        self.work = folder / "work"
        self.work.mkdir()
        (self.packages,) = (self.folder / "lib").glob("python*/site-packages")
        self.variables = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "POGO"))}

    def pip(self, *arguments: str | Path) -> None:
        """Run pip, which must work and has no network."""
        options = ["--quiet", "--disable-pip-version-check"]
        done = self.python("-m", "pip", *options, *map(str, arguments))
        assert done.code == 0, done.text

    def install(self, *wheels: Path) -> None:
        """Install wheels one after the other."""
        for file in wheels:
            self.pip("install", "--no-deps", "--no-index", "--no-compile", file)

    def python(self, *arguments: str, **variables: str) -> Run:
        """Run Python."""
        return ran(self.work, self.folder / "bin" / "python", *arguments, env=self.variables | variables)

    def command(self, name: str, *arguments: str, **variables: str) -> Run:
        """Run a command of the environment."""
        return ran(self.work, self.folder / "bin" / name, *arguments, env=self.variables | variables)

    def refusal(self, name: str = "pogosim", **variables: str) -> str:
        """Return the one line with which a command does nothing."""
        result = self.command(name, "--help", **variables)
        assert (result.code, result.output) == (2, ""), result.text
        (line,) = result.errors.splitlines()
        return line


@pytest.fixture
def environment(tmp_path: Path, empty: Path) -> Environment:
    """Return an environment with pip alone."""
    return Environment(tmp_path, empty)


def works(environment: Environment, errors: int = 0) -> str:
    """Check that the command is this one and works, and return what it warns of, in so many lines."""
    result = environment.command("pogosim", "--help")
    assert result.code == 0, result.text
    assert result.output.startswith("Usage: pogosim COMMAND")
    assert len(result.errors.splitlines()) == errors, result.errors
    return result.errors


def test_it_is_silent_when_it_is_alone(environment: Environment, ours: Path) -> None:
    environment.install(ours)
    assert works(environment) == ""
    assert environment.python("-W", "error", "-c", "import pogosim").text == ""


def test_beside_another_one_that_came_first_it_works_and_warns(
    environment: Environment, other: Path, ours: Path
) -> None:
    environment.install(other, ours)
    said = works(environment, errors=1)
    assert "pogobot_simulator" in (environment.folder / "bin" / "pogobatch").read_text()  # the other's is replaced
    assert said.startswith(
        f"{environment.packages / 'pogosim'}:1: UserWarning: {OTHER} is installed in the same folder"
    )
    assert MEND in said
    refused = environment.python("-W", "error", "-c", "import pogosim")
    assert refused.code == 1
    assert environment.python("-W", "ignore", "-c", "import pogosim").text == ""


def test_command_says_that_uninstalling_the_other_one_has_removed_its_files(
    environment: Environment, other: Path, ours: Path
) -> None:
    environment.install(other, ours)
    environment.pip("uninstall", "--yes", "pogosim")
    assert not (environment.folder / "bin" / "pogobatch").exists()  # both have it
    for name in ("pogosim", "pogoptim", "pogosim-recover"):
        said = environment.refusal(name)
        assert said.startswith(f"{name}: files are missing in {environment.packages / 'pogosim'}: ")
        assert said.endswith(MEND)


@pytest.mark.parametrize("order", [("other", "ours"), ("ours", "other")])
def test_what_the_line_says_mends_it(order: tuple[str, str], environment: Environment, other: Path, ours: Path) -> None:
    environment.install(*({"other": other, "ours": ours}[name] for name in order))
    environment.pip("uninstall", "--yes", "pogosim", "pogobot-simulator")
    assert list(environment.packages.glob("pogo*")) == []
    environment.install(ours)
    assert works(environment) == ""


def test_commands_refuse_files_that_another_one_has_replaced(environment: Environment, other: Path, ours: Path) -> None:
    environment.install(ours, other)
    for name in ("pogosim", "pogoptim", "pogosim-recover"):
        said = environment.refusal(name)
        assert said.startswith(f"{name}: {OTHER} has replaced {len(MODULES)} files of this one in ")
        assert ", such as pogosim/__init__.py: " in said
        assert said.endswith(MEND)
    module = environment.python("-m", "pogosim", "--help")
    assert (module.code, module.output, len(module.errors.splitlines())) == (2, "", 1)
    assert environment.command("pogobatch").output == "the other pogobatch\n"  # its command, and all of its files


def test_import_is_refused_where_some_modules_are_those_of_another_one(
    environment: Environment, other: Path, ours: Path
) -> None:
    environment.install(ours, other)
    with zipfile.ZipFile(ours) as file:
        file.extract("pogosim/__init__.py", environment.packages)
    result = environment.python("-c", "import pogosim")
    assert result.code == 1
    assert result.errors.splitlines()[-1].startswith(
        f"ImportError: {OTHER} has replaced {len(MODULES) - 1} files of this one in "
    )


def test_this_program_by_its_former_name_is_known(environment: Environment, older: Path, ours: Path) -> None:
    environment.install(older)
    works(environment)
    environment.install(ours)
    said = works(environment, errors=1)
    assert "'pogosim 0.11.0', this program by its former name, is installed in the same folder" in said
    environment.pip("uninstall", "--yes", "pogosim", "pogobot-simulator")
    environment.install(ours)
    assert works(environment) == ""


def test_former_version_that_comes_later_is_no_mixture(environment: Environment, older: Path, ours: Path) -> None:
    """It has replaced the command, too, and works as it did; this one says so where it is asked."""
    environment.install(ours, older)
    works(environment)
    said = environment.python("-c", "import pogobot_simulator as ours; print(ours.obstacle())").output
    assert said.startswith("'pogosim 0.11.0', this program by its former name, has replaced 1 files of this one")


def test_files_that_a_user_has_changed_are_still_those_of_this_one(
    environment: Environment, other: Path, ours: Path
) -> None:
    environment.install(other, ours)
    for name in ("utils", "errors"):
        with (environment.packages / "pogosim" / f"{name}.py").open("a") as file:
            file.write("# changed\n")
    works(environment, errors=1)


def test_package_elsewhere_that_is_found_first_is_refused(environment: Environment, ours: Path, tmp_path: Path) -> None:
    environment.install(ours)
    (elsewhere := tmp_path / "elsewhere" / "pogosim").mkdir(parents=True)
    (elsewhere / "__init__.py").touch()
    said = environment.refusal(PYTHONPATH=str(elsewhere.parent))
    assert said.startswith(f"pogosim: Python finds another package named pogosim first, {elsewhere / '__init__.py'}: ")
    environment.variables["PYTHONPATH"] = str(environment.packages)  # the same one in another way
    assert works(environment) == ""


def test_metadata_of_other_formats_and_similar_names(environment: Environment, ours: Path) -> None:
    environment.install(ours)
    for name in ("pogosim_lab-1.0.dist-info", "pogosims-1.0.dist-info", "pogosim.libs"):
        (environment.packages / name).mkdir()
    assert works(environment) == ""
    (environment.packages / "pogosim-0.10.10-py3.11.egg-info").touch()  # as distutils leaves them
    assert "'pogosim 0.10.10-py3.11', another program," in works(environment, errors=1)


def test_doctor_names_the_other_distribution(environment: Environment, other: Path, ours: Path) -> None:
    environment.install(other, ours)
    code = "from pogosim.command.doctor import others_of_that_name\nprint(others_of_that_name())"
    said = environment.python("-W", "ignore", "-c", code).output
    assert str(environment.packages / "pogosim-0.10.10.dist-info") in said
