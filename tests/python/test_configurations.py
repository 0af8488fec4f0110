"""The configurations that come with the project are right."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest
import yaml
from pogosim.utils import load_dataframe
from running import ROOT, example, run_command

CONFIGURATIONS = sorted((ROOT / "conf").glob("*.yaml"))
PROGRAMS = sorted(path.parent.name for path in ROOT.glob("examples/*/main.c*"))


def run_shortly(program: str, configuration: Path, folder: Path, *flags: str) -> str:
    """Run for a tenth of a second, in another folder than the project's; return what was printed."""
    files = {
        "data_filename": folder / "data.feather",
        "console_filename": folder / "console.txt",
        "frames_name": folder / "f{:010.4f}.png",
    }
    arguments = ["-c", str(configuration), "-g", "-q", "--set", "simulation_time=0.1", *flags]
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
    assert run_shortly(program, ROOT / NAMED[program], tmp_path, "--strict") == ""


@pytest.mark.parametrize("program", PROGRAMS)
def test_example_warns_of_nothing_until_its_run_is_over(program: str, tmp_path: Path) -> None:
    outputs = {"data_filename": "data.feather", "console_filename": "console.txt", "frames_name": "f{:010.4f}.png"}
    arguments = ["-c", str(ROOT / NAMED[program]), "-g", "--set", "simulation_time=15"]
    for key, name in outputs.items():
        arguments += ["--set", f"{key}={tmp_path / name}"]
    result = run_command(example(program), tmp_path, arguments)
    assert (result.code, result.errors) == (0, "")


@pytest.mark.parametrize("program", PROGRAMS)
def test_resolved_configuration_gives_the_same_run(program: str, tmp_path: Path) -> None:
    first, again = tmp_path / "first", tmp_path / "again"
    first.mkdir()
    again.mkdir()
    run_shortly(program, ROOT / NAMED[program], first)
    rows, metadata = load_dataframe(first / "data.feather")
    resolved = tmp_path / "resolved.yaml"
    resolved.write_text(yaml.safe_dump(metadata["resolved_configuration"], sort_keys=False))
    assert run_shortly(program, resolved, again, "--strict") == ""
    same_rows, same_metadata = load_dataframe(again / "data.feather")
    pd.testing.assert_frame_equal(rows, same_rows)
    for key in ("data_filename", "console_filename", "frames_name"):
        same_metadata["resolved_configuration"][key] = metadata["resolved_configuration"][key]
    assert same_metadata["resolved_configuration"] == metadata["resolved_configuration"]


def test_resolved_configuration_says_that_the_arena_file_is_periodic(tmp_path: Path) -> None:
    arena = ("--set", "arena_file=arenas/torus.csv", "--strict")
    entries = yaml.safe_load((ROOT / NAMED["vicsek"]).read_text())
    del entries["boundary_condition"]
    (tmp_path / "torus.yaml").write_text(yaml.safe_dump(entries, sort_keys=False))
    run_shortly("vicsek", tmp_path / "torus.yaml", tmp_path, *arena)
    rows, metadata = load_dataframe(tmp_path / "data.feather")
    resolved = metadata["resolved_configuration"]
    assert resolved["boundary_condition"] == "periodic"
    (tmp_path / "resolved.yaml").write_text(yaml.safe_dump(resolved, sort_keys=False))
    assert run_shortly("vicsek", tmp_path / "resolved.yaml", tmp_path, "--strict") == ""
    pd.testing.assert_frame_equal(rows, load_dataframe(tmp_path / "data.feather")[0])


def test_every_configuration_is_named_by_an_example() -> None:
    of_batches_and_pages = ("test", "original", "magnetometer", "shapes")
    others = {f"conf/{name}.yaml" for name in of_batches_and_pages}
    assert {f"conf/{path.name}" for path in CONFIGURATIONS} == set(NAMED.values()) | others


@pytest.mark.parametrize("program", PROGRAMS)
def test_example_runs_with_the_simplest_configuration(program: str, tmp_path: Path) -> None:
    # Its parameters are those of run_and_tumble.
    text = run_shortly(program, ROOT / "conf/simple.yaml", tmp_path)
    assert [line for line in text.splitlines() if "parameters never read by the program: " not in line] == []


@pytest.mark.parametrize("configuration", CONFIGURATIONS, ids=lambda path: path.name)
def test_configuration_is_yaml_that_the_python_tools_read(configuration: Path) -> None:
    content = yaml.safe_load(configuration.read_text())
    assert "robots" in content["objects"]
    assert isinstance(content["seed"], int)
