"""What a run writes never costs what it reads, and a broken console never costs the run."""

from __future__ import annotations

import os
import subprocess
import time
from pathlib import Path

import pytest
from running import Run, example, run, run_command, start, write_scene

SQUARE = "0,0\n1000,0\n1000,1000\n0,1000\n"
POSES = "x,y\n300,300\n500,500\n700,700\n"
SETTINGS = {
    "arena_file": "arena.csv",
    "initial_formation": "imported",
    "formation_filename": "poses.csv",
    "enable_console_logging": True,
    "console_filename": "console.txt",
}
INPUTS = {"arena_file": "arena.csv", "formation_filename": "poses.csv", "": "scene.yaml"}


def scene(folder: Path, changes: dict[str, object]) -> Run:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "arena.csv").write_text(SQUARE)
    (folder / "poses.csv").write_text(POSES)
    return run(example("helloworld"), folder, {**SETTINGS, **changes})


def test_files_of_different_names_are_no_problem(tmp_path: Path) -> None:
    result = scene(tmp_path, {})
    assert (result.code, result.errors) == (0, "")


@pytest.mark.parametrize("output", ["data_filename", "console_filename"])
@pytest.mark.parametrize("key", sorted(INPUTS))
@pytest.mark.parametrize("name", ["{}", "./{}", "folder/../{}", "symbolic", "hard", "{folder}/{}"])
def test_output_that_is_an_input_is_refused_and_nothing_is_written(
    tmp_path: Path, output: str, key: str, name: str
) -> None:
    (tmp_path / "folder").mkdir()
    target = INPUTS[key]
    if name == "symbolic":
        (tmp_path / name).symlink_to(target)
    if name == "hard":
        (tmp_path / target).touch()
        (tmp_path / name).hardlink_to(tmp_path / target)
    result = scene(tmp_path, {output: name.format(target, folder=tmp_path)})
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert f": {output}: " in line
    assert (f"the same file as {key} '{target}' (scene.yaml:" if key else "the configuration file 'scene.yaml'") in line
    assert (tmp_path / "arena.csv").read_text() == SQUARE
    assert (tmp_path / "poses.csv").read_text() == POSES
    assert (tmp_path / "scene.yaml").stat().st_size > 0
    assert not {"data.feather", "console.txt"} & {file.name for file in tmp_path.iterdir()}


@pytest.mark.parametrize("name", ["both", "./both", "dangling", "folder/both"])
def test_two_outputs_in_one_file_are_refused(tmp_path: Path, name: str) -> None:
    (tmp_path / "dangling").symlink_to("both")
    (tmp_path / "folder").symlink_to(".")
    result = scene(tmp_path, {"data_filename": "both", "console_filename": name})
    assert result.code == 2
    assert f"console_filename: '{name}' is the same file as data_filename 'both' (scene.yaml:" in result.errors
    assert not (tmp_path / "both").exists()


@pytest.mark.parametrize("key", ["arena_file", "formation_filename", "console_filename", ""])
@pytest.mark.parametrize("data", ["{}.feather", "link.feather"])
def test_place_where_the_data_file_is_put_together_counts_as_an_output(tmp_path: Path, key: str, data: str) -> None:
    (tmp_path / "link.feather").symlink_to("d.feather")
    beside = "d.feather.pogosim-new"
    contents = {"arena_file": SQUARE, "formation_filename": POSES}.get(key, "")
    (tmp_path / beside).write_text(contents)
    changes: dict[str, object] = {"data_filename": data.format("d"), **({key: beside} if key else {})}
    if key:
        result = scene(tmp_path, changes)
    else:
        scene(tmp_path, {"simulation_time": 0.1})
        write_scene(tmp_path, {**SETTINGS, **changes}).rename(tmp_path / beside)
        contents = (tmp_path / beside).read_text()
        result = run_command(example("helloworld"), tmp_path, ["-c", beside, "-g"])
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert f": data_filename: '{tmp_path / beside}' (used to assemble the data file) is the same" in line
    assert (f"file as {key} '{beside}' (scene.yaml:" if key else f"the configuration file '{beside}'") in line
    assert (tmp_path / beside).read_text() == contents


@pytest.mark.parametrize(
    "changes",
    [
        {"enable_data_logging": False, "data_filename": "arena.csv"},
        {"enable_console_logging": False, "console_filename": "arena.csv"},
        {"initial_formation": "random", "data_filename": "poses.csv"},
    ],
)
def test_files_that_a_run_does_not_use_may_have_any_name(tmp_path: Path, changes: dict[str, object]) -> None:
    result = scene(tmp_path, changes)
    assert (result.code, result.errors) == (0, "")
    assert (tmp_path / "arena.csv").read_text() == SQUARE


def test_one_terminal_may_be_read_and_written(tmp_path: Path) -> None:
    ours, theirs = os.openpty()
    terminal = os.ttyname(theirs)
    os.write(ours, b"\x04")  # the end of what is typed: no arena
    result = scene(tmp_path, {"arena_file": terminal, "console_filename": terminal})
    os.close(ours)
    os.close(theirs)
    assert result.code == 2
    assert "the same file" not in result.errors
    assert f"{terminal}:" in result.errors


def test_second_run_that_writes_the_same_console_file_is_refused(tmp_path: Path) -> None:
    settings = {"enable_console_logging": True, "simulation_time": 1.0e6, "save_data_period": 100.0}
    process = start(example("helloworld"), tmp_path, settings)
    assert process.stdout is not None
    process.stdout.readline()
    for _ in range(400):  # what is printed comes to the file after 2 s
        if (tmp_path / "console.txt").stat().st_size > 0:
            break
        time.sleep(0.05)
    second = run(example("helloworld"), tmp_path, {**settings, "data_filename": "b.feather"})
    process.kill()
    process.communicate()
    assert second.code == 2
    assert "'console.txt' (console_filename): in use by another run" in second.errors
    assert (tmp_path / "console.txt").stat().st_size > 0
    assert not (tmp_path / "b.feather").exists()


# ---- A broken console ----


@pytest.mark.parametrize(
    "redirection",
    [
        "2>/dev/full",
        ">/dev/full",
        ">/dev/full 2>&1",
        "2>&-",
        ">&-",
        "<&- >&- 2>&-",
        "2>&1 | head -c 1 >/dev/null",
        "2> >(head -c 1 >/dev/null)",
        "2> >(exit)",
        "2>&1 | true",
    ],
)
@pytest.mark.parametrize("options", ["-P", "-P -q", "-v"])
def test_broken_console_does_not_end_the_run(tmp_path: Path, redirection: str, options: str) -> None:
    # An unknown key for a warning, and a robot that prints.
    write_scene(tmp_path, {"simulation_time": 20.0, "no_such_key": 1})
    command = f"{example('helloworld')} -c scene.yaml -g {options} {redirection}; exit ${{PIPESTATUS[0]}}"
    ended = subprocess.run(["bash", "-c", command], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr
    frame = Run(0, "", "", tmp_path).frame()
    assert frame["time"].max() == pytest.approx(20.0)


def test_console_file_on_a_full_disk_is_an_error_all_the_same(tmp_path: Path) -> None:
    result = run(
        example("helloworld"), tmp_path, {"enable_console_logging": True, "console_filename": "/dev/full"}, ["-P"]
    )
    assert result.code == 2
    assert "cannot write the console file (console_filename)" in result.errors
    assert len(result.frame()) > 0
