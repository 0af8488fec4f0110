"""The configurations that come with the project are right."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from running import ROOT, example, run_command

CONFIGURATIONS = sorted((ROOT / "conf").glob("*.yaml"))
PROGRAMS = sorted(path.parent.name for path in ROOT.glob("examples/*/main.c*"))


def run_shortly(program: str, configuration: Path, folder: Path) -> str:
    """Run for a tenth of a second, in another folder than the project's; return what was printed."""
    files = {
        "data_filename": folder / "data.feather",
        "console_filename": folder / "console.txt",
        "frames_name": folder / "f{:010.4f}.png",
    }
    arguments = ["-c", str(configuration), "-g", "-q", "--strict", "--set", "simulation_time=0.1"]
    for key, value in files.items():
        arguments += ["--set", f"{key}={value}"]
    result = run_command(example(program), folder, arguments)
    assert result.code == 0, result.text
    return result.text


def named_configuration(program: str) -> str:
    """Return the configuration that the first lines of a program name."""
    (source,) = (ROOT / "examples" / program).glob("main.c*")
    command = next(line for line in source.read_text().splitlines() if f"./examples/{program}/{program} -c" in line)
    return command.split(" -c ")[1].split()[0]


NAMED = {program: named_configuration(program) for program in PROGRAMS}


@pytest.mark.parametrize("program", PROGRAMS)
def test_example_runs_with_the_configuration_that_its_first_lines_name(program: str, tmp_path: Path) -> None:
    assert run_shortly(program, ROOT / NAMED[program], tmp_path) == ""


@pytest.mark.parametrize(
    "configuration",
    [path for path in CONFIGURATIONS if f"conf/{path.name}" not in NAMED.values()],
    ids=lambda p: p.name,
)
def test_other_configurations_run_without_a_warning(configuration: Path, tmp_path: Path) -> None:
    assert run_shortly("helloworld", configuration, tmp_path) == ""


@pytest.mark.parametrize("program", PROGRAMS)
def test_example_runs_with_the_simplest_configuration(program: str, tmp_path: Path) -> None:
    assert "error" not in run_shortly(program, ROOT / "conf/simple.yaml", tmp_path)


@pytest.mark.parametrize("configuration", CONFIGURATIONS, ids=lambda path: path.name)
def test_configuration_is_yaml_that_the_python_tools_read(configuration: Path) -> None:
    content = yaml.safe_load(configuration.read_text())
    assert "robots" in content["objects"]
    assert isinstance(content["seed"], int)
