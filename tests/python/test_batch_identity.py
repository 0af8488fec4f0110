"""Finished runs count only while the program, its library and the files that a configuration names are the same."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from pogosim.batch.runs.identity import config_hash, program_digest
from pogosim.batch.runs.run import RunSettings, Task
from pogosim.batch.runs.run_files import found_beside
from pogosim.batch.runs.run_policy import RunPolicy
from pogosim.batch.runs.tasks import tasks_of
from pogosim.batch.runs.temporary import TemporaryFolder
from running import LIBRARY

Tasks = Callable[..., list[Task]]


@pytest.fixture
def beside(tmp_path: Path) -> Path:
    """The folder of the configuration."""
    folder = tmp_path / "beside"
    folder.mkdir()
    return folder


@pytest.fixture
def tasks(tmp_path: Path, beside: Path, monkeypatch: pytest.MonkeyPatch) -> Tasks:
    """Return a function from the configuration and the program's digest to the runs with the seeds 5 and 6."""
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    temporary = TemporaryFolder(tmp_path / "tmp", "batch", is_kept=False)

    def make(entries: dict[str, Any], program: str = "") -> list[Task]:
        settings = RunSettings(Path("/program"), program, beside, temporary, RunPolicy(retries=0))
        return tasks_of(entries, [5, 6], settings, {})

    return make


def compile_c(folder: Path, text: str, *flags: str) -> None:
    """Compile a text in C."""
    (folder / "a.c").write_text(text)
    subprocess.run(["cc", "a.c", *flags], cwd=folder, check=True)


def test_program_is_another_one_when_its_library_is_built_anew(tmp_path: Path) -> None:
    library = tmp_path / LIBRARY
    compile_c(tmp_path, "int one(void) { return 1; }", "-shared", "-fPIC", "-o", str(library))
    compile_c(tmp_path, "int one(void); int main(void) { return one(); }", str(library), "-o", "program")
    before = program_digest(tmp_path / "program")
    assert program_digest(tmp_path / "program") == before
    compile_c(tmp_path, "int one(void) { return 2; }", "-shared", "-fPIC", "-o", str(library))
    after = program_digest(tmp_path / "program")
    assert after != before
    with (tmp_path / "program").open("ab") as file:
        file.write(b"more")
    assert program_digest(tmp_path / "program") not in (before, after)


def test_runs_differ_with_the_program_and_the_seed(tasks: Tasks) -> None:
    first, second = (tasks({"a": 1}, program) for program in ("one", "two"))
    assert len({task.key for task in [*first, *second]}) == 4
    assert [(task.run, task.seed) for task in first] == [(0, 5), (1, 6)]


@pytest.mark.parametrize("folder", ["beside", "here"])
@pytest.mark.parametrize(
    "entries",
    [
        {"arena_file": "mine.csv"},
        {"formation_filename": "mine.csv"},
        {"objects": {"a": [{"image": "mine.csv"}]}},
        {"objects": {"a": {"robot_model": "mine.csv"}}},
        {"objects": {"a": [{"brain": {"script": "mine.csv"}}]}},
        {"links": {"a": {"file": "mine.csv"}}},
    ],
)
def test_runs_differ_when_a_file_does_that_their_configuration_names(
    entries: dict[str, Any], folder: str, tasks: Tasks, tmp_path: Path
) -> None:
    file = tmp_path / folder / "mine.csv"
    keys = []
    for content in ("0,0\n", "1,1\n", "0,0\n"):
        file.write_text(content)
        keys.append(tasks(entries)[0].key)
    assert keys[0] == keys[2] != keys[1]


def test_files_beside_the_configuration_are_found_and_those_of_the_working_folder_first(
    tasks: Tasks, beside: Path
) -> None:
    def named() -> dict[str, Any]:
        entries = {"arena_file": "mine.csv", "formation_filename": "mine.csv", "other": "mine.csv"}
        return dict(yaml.safe_load(tasks(entries)[0].text))

    assert set(named().values()) == {"mine.csv"}
    (beside / "mine.csv").touch()
    found = str(beside / "mine.csv")
    assert named() == {"arena_file": found, "formation_filename": found, "other": "mine.csv"}
    Path("mine.csv").touch()
    assert set(named().values()) == {"mine.csv"}
    for value in ("", None, 3):
        assert found_beside(value, beside) == value


def test_files_of_categories_are_found_beside_the_configuration(tasks: Tasks, beside: Path) -> None:
    (beside / "mine.csv").touch()
    found = str(beside / "mine.csv")

    def objects(name: str) -> dict[str, Any]:
        script = {"nb": 2, "brain": {"script": name}}
        return {"a": script, "b": [{"robot_model": name}, {"brain": "host", "script": "mine.csv"}]}

    (task, _) = tasks({"objects": objects("mine.csv")})
    assert yaml.safe_load(task.text)["objects"] == objects(found)


def test_names_of_outputs_make_no_other_run(tasks: Tasks) -> None:
    names = {"data_filename": "a/b.feather", "console_filename": "", "frames_name": "x{:010.4f}.png"}
    (plain, _), (named, _) = tasks({"a": 1}), tasks({"a": 1, **names})
    assert (plain.key, plain.text) == (named.key, named.text)
    outputs = {"data_filename": "b.feather", "console_filename": "console.txt", "frames_name": "x{:010.4f}.png"}
    assert dict(named.outputs) == outputs
    (logged, _) = tasks({"a": 1, **names, "message_log": "a/m.feather"})
    assert (logged.key, logged.text) == (plain.key, plain.text)
    assert dict(logged.outputs) == outputs | {"message_log": "m.feather"}


def test_no_name_of_an_output_is_part_of_a_configuration(tasks: Tasks) -> None:
    outputs = {"data_filename": "d", "console_filename": "c", "frames_name": "f", "message_log": "m"}
    base: dict[str, Any] = {"flash_state": {"input_file": "a.flash"}}
    named = {**outputs, "flash_state": {"input_file": "a.flash", "output_file": "b/c.flash"}}
    assert config_hash(base) == config_hash(named) != config_hash({})
    (plain, _), (wanted, _) = tasks(base), tasks(named)
    assert plain.key == wanted.key
    assert dict(wanted.outputs)["flash_state.output_file"] == "c.flash"
    assert "flash_state.output_file" not in dict(plain.outputs)
