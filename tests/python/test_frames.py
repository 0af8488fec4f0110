"""Frames of a run: how many, when, what they show, and what happens when they cannot be written."""

from __future__ import annotations

import re
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from conftest import Compile
from PIL import Image
from pogosim.swarm_picture import led_colours
from pogosim.utils import load_dataframe
from running import Run, compile_program, example, run, start, write_scene

FRAMES: dict[str, object] = {"save_video_period": 0.5, "window_width": 200, "window_height": 160}
LONG = {"simulation_time": 1.0e6}
PROGRAM = """
#include "pogobase.h"
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>
typedef struct { int unused; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
void user_init(void) {}
void user_step(void) { if (pogobot_helper_getid() == 0 && pogobot_ticks == 60) { %s } }
int main(void) { pogobot_init(); pogobot_start(user_init, user_step); return 0; }
"""


def names(folder: Path, pattern: str = "*.png") -> list[str]:
    return sorted(path.name for path in folder.glob(pattern))


def ended_well(folder: Path, settings: Mapping[str, object]) -> Run:
    result = run(example("helloworld"), folder, {**FRAMES, **settings})
    assert (result.code, result.errors) == (0, ""), result.text
    return result


def refused(folder: Path, settings: Mapping[str, object]) -> str:
    """Return the message of a run that must not begin."""
    result = run(example("helloworld"), folder, {**FRAMES, **settings})
    assert result.code == 2, result.text
    assert not (folder / "data.feather").exists()
    assert result.robot_lines == []
    (line,) = result.errors.splitlines()
    return line


def pixels_of(path: Path) -> npt.NDArray[np.uint8]:
    """Colours of a complete picture. Shape (rows, columns, 3)."""
    with Image.open(path) as picture:
        return np.asarray(picture)


def bytes_of(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.glob("*.png")}


def program_with(folder: Path, code: str) -> Path:
    source = folder / "main.c"
    source.write_text(PROGRAM % code)
    return compile_program(folder / "main", source)


def complete_frames(folder: Path) -> int:
    """Count the frames, each of which must be complete."""
    for path in folder.glob("*.png"):
        assert pixels_of(path).size > 0
    assert names(folder, "*.pogosim-new") == []
    return len(names(folder))


# How many, when, how large.


def test_frames_come_at_each_multiple_of_the_period_but_not_at_the_start(tmp_path: Path) -> None:
    ended_well(tmp_path, {"simulation_time": 2.2})
    assert names(tmp_path / "frames") == [f"f{t:010.4f}.png" for t in (0.5, 1.0, 1.5, 2.0)]
    assert pixels_of(tmp_path / "frames" / "f00000.5000.png").shape == (160, 200, 3)


def test_frames_come_at_the_first_step_after_a_multiple_without_drift(tmp_path: Path) -> None:
    ended_well(tmp_path, {"simulation_time": 0.2, "save_video_period": 0.025, "frames_name": "f{:.3f}.png"})
    expected = ["0.030", "0.050", "0.080", "0.100", "0.130", "0.150", "0.180", "0.200"]
    assert names(tmp_path) == [f"f{t}.png" for t in expected]


def test_period_shorter_than_a_step_gives_a_frame_at_every_step(tmp_path: Path) -> None:
    ended_well(tmp_path, {"simulation_time": 0.05, "save_video_period": 0.001, "frames_name": "f{}.png"})
    assert names(tmp_path) == [f"f0.0{i}.png" for i in (1, 2, 3, 4, 5)]


@pytest.mark.parametrize("period", [0, -1])
def test_no_period_makes_no_frames(tmp_path: Path, period: float) -> None:
    ended_well(tmp_path, {"save_video_period": period})
    assert sorted(path.name for path in tmp_path.iterdir()) == ["data.feather", "scene.yaml"]


def test_folders_are_made_and_may_depend_on_the_time(tmp_path: Path) -> None:
    ended_well(tmp_path, {"simulation_time": 2.0, "save_video_period": 1.0, "frames_name": "a/b{:.0f}/c.png"})
    assert [str(p.relative_to(tmp_path)) for p in sorted(tmp_path.rglob("*.png"))] == ["a/b1/c.png", "a/b2/c.png"]


# What they show.


def test_robots_are_where_the_data_file_says(tmp_path: Path) -> None:
    ended_well(tmp_path, {"data_logger_led": True, "save_data_period": 0.5, "window_width": 400, "show_time": False})
    rows, metadata = load_dataframe(tmp_path / "data.feather")
    for t in (0.5, 1.0, 1.5, 2.0):
        pixels = pixels_of(tmp_path / "frames" / f"f{t:010.4f}.png")
        corners = np.asarray(metadata["arena_polygons"][0])
        low, high = corners.min(axis=0), corners.max(axis=0)
        size = np.array([400, 160])
        scale = 0.95 * (size / (high - low)).min()
        at_t = rows[np.isclose(rows["time"], t)]
        assert len(at_t) == 3
        for _, robot in at_t.iterrows():
            heading = np.array([np.cos(robot["angle"]), np.sin(robot["angle"])])
            place = np.array([robot["x"], robot["y"]]) - 8.0 * heading  # beside the mark of the heading
            column, row = (size / 2 + scale * (place - (low + high) / 2)).astype(int)
            expected = 255.0 * led_colours(np.array([robot["led_rgb"]], dtype=np.int64))[0]
            np.testing.assert_allclose(pixels[row, column], expected[:3], atol=12)


@pytest.mark.parametrize(
    "key", ["show_time", "show_scale_bar", "show_light_levels", "show_trajectory_traces", "show_communication_channels"]
)
def test_key_of_the_window_changes_the_frames(tmp_path: Path, key: str) -> None:
    lamp = {"type": "static_light", "geometry": "disk", "radius": 200, "x": 300, "y": 300, "value": 500}
    scene = {"simulation_time": 1.0, "objects.lamp": lamp, "objects.robots.nb": 20}
    for value in (True, False):
        ended_well(tmp_path / str(value), {**scene, key: value})
    shown, hidden = (pixels_of(tmp_path / v / "frames/f00001.0000.png") for v in ("True", "False"))
    assert np.any(shown != hidden)


# What does not change.


def test_same_seed_gives_the_same_frames_and_another_seed_others(tmp_path: Path) -> None:
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        ended_well(tmp_path / name, {"seed": seed})
    frames = {name: bytes_of(tmp_path / name / "frames") for name in "abc"}
    assert len(frames["a"]) == 4
    assert frames["a"] == frames["b"]
    assert frames["a"] != frames["c"]


def test_frames_do_not_change_the_data_file(tmp_path: Path) -> None:
    path = {"show_trajectory_traces": True, "show_communication_channels": True, "show_light_levels": True}
    files = []
    for name, frames_name in (("none", "/nowhere/x{}.png"), ("some", "frames/f{}.png")):
        period = 0.1 if name == "some" else -1
        ended_well(tmp_path / name, {**path, "save_video_period": period, "frames_name": frames_name})
        rows, _ = load_dataframe(tmp_path / name / "data.feather")
        files.append(rows)
    assert files[0].equals(files[1])


# Old frames.


def test_old_frames_are_deleted_only_on_demand_and_nothing_else_is(tmp_path: Path) -> None:
    folder = tmp_path / "frames"
    (folder / "deeper").mkdir(parents=True)
    for name in ("old.png", "notes.txt", "deeper/old.png", "OLD.PNG"):
        (folder / name).write_text("old")
    (folder / "folder.png").mkdir()
    (folder / "link.png").symlink_to("notes.txt")
    ended_well(tmp_path, {"simulation_time": 0.5})
    assert (folder / "old.png").exists()
    ended_well(tmp_path, {"simulation_time": 1.0, "save_video_period": 1.0, "delete_old_files": True})
    assert names(folder, "*") == [
        "OLD.PNG",
        "deeper",
        "f00001.0000.png",
        "folder.png",
        "link.png",
        "notes.txt",
    ]
    assert (folder / "deeper" / "old.png").exists()


def test_files_of_the_run_are_not_deleted(tmp_path: Path) -> None:
    outputs = {"enable_console_logging": True, "console_filename": "console.png"}
    ended_well(tmp_path, {**outputs, "frames_name": "f{}.png", "delete_old_files": True})
    assert "console.png" in names(tmp_path)


def test_nothing_is_deleted_by_a_run_without_frames_or_one_that_is_refused(tmp_path: Path) -> None:
    (tmp_path / "old.png").write_text("old")
    scene = {"frames_name": "f{}.png", "delete_old_files": True}
    ended_well(tmp_path, {**scene, "save_video_period": -1})
    (tmp_path / "data.feather").unlink()
    refused(tmp_path, {**scene, "objects.robots.nb": 5000})
    assert (tmp_path / "old.png").exists()


# Two runs at the same time.


@pytest.fixture
def drawing(tmp_path: Path) -> Iterator[subprocess.Popen[str]]:
    """A run that draws frames in tmp_path, until the test is over."""
    process = start(example("helloworld"), tmp_path, {**FRAMES, **LONG, "data_filename": "first.feather"})
    for _ in range(600):
        if names(tmp_path / "frames", "f00001.0000.png"):
            break
        time.sleep(0.05)
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


@pytest.mark.parametrize("name", ["frames/f{:010.4f}.png", "./other/../frames/f{:010.4f}.png", "link/f{:010.4f}.png"])
@pytest.mark.parametrize("period", [0.5, 0.3])
def test_second_run_that_draws_frames_of_the_same_names_is_refused(
    tmp_path: Path, drawing: subprocess.Popen[str], name: str, period: float
) -> None:
    (tmp_path / "other").mkdir()
    (tmp_path / "link").symlink_to("frames")
    line = refused(tmp_path, {"frames_name": name, "save_video_period": period})
    assert line.startswith("Error: scene.yaml:")
    assert "frames_name: another run is drawing frames of these names, such as '" in line
    assert "wait for it to finish, or give each run its own names" in line
    assert drawing.poll() is None


def test_run_does_not_delete_frames_that_another_one_draws(tmp_path: Path, drawing: subprocess.Popen[str]) -> None:
    line = refused(tmp_path, {"frames_name": "frames/other{}.png", "delete_old_files": True})
    assert "delete_old_files: another run is drawing frames in the folder 'frames', which would be deleted" in line
    assert names(tmp_path / "frames", "f00001.0000.png")
    assert drawing.poll() is None


def test_runs_with_frames_of_other_names_share_a_folder(tmp_path: Path, drawing: subprocess.Popen[str]) -> None:
    ended_well(tmp_path, {"frames_name": "frames/other{}.png", "simulation_time": 1.0})
    assert len(names(tmp_path / "frames", "other*")) == 2
    assert drawing.poll() is None


def test_names_are_free_after_a_run_and_after_a_killed_one(tmp_path: Path, drawing: subprocess.Popen[str]) -> None:
    drawing.kill()
    drawing.communicate()
    assert names(tmp_path / "frames", "f00000.0000*") == ["f00000.0000.png.pogosim-new"]
    for _ in range(2):
        ended_well(tmp_path, {"simulation_time": 1.0, "delete_old_files": True})
        assert names(tmp_path / "frames") == ["f00000.5000.png", "f00001.0000.png"]
        assert names(tmp_path / "frames", "f00000.0000*") == []


def test_folder_of_a_time_without_a_frame_is_not_left(tmp_path: Path) -> None:
    ended_well(tmp_path, {"frames_name": "frames/{:.1f}/a.png", "simulation_time": 1.0})
    assert names(tmp_path / "frames", "*") == ["0.5", "1.0"]


# Errors before the run.


@pytest.mark.parametrize(
    ("frames_name", "message"),
    [
        ("file/f{}.png", "the frame 'file/f0.5.png' cannot be written: Not a directory; choose another name or folder"),
        ("/proc/f{}.png", "the frame '/proc/f0.5.png' cannot be written: No such file or directory;"),
        ("folder{:.0f}.png", "the frame 'folder2.png' cannot be written: it is a folder;"),
        ("{}" + 260 * "a" + ".png", "cannot be written: File name too long; choose another name or folder"),
        ("a{:.0f}.png", "the frames of t = 1.5 s and 2 s would both be 'a2.png'; use more decimals"),
        ("f{:.0f}.feather", "a frame may be the same file as data_filename 'f1.feather'"),
    ],
)
def test_frames_that_cannot_be_written_are_refused(tmp_path: Path, frames_name: str, message: str) -> None:
    (tmp_path / "file").write_text("a file")
    (tmp_path / "folder2.png").mkdir()
    period = 0.5 if "{}" in frames_name or frames_name.startswith("a") else 1.0
    scene = {"data_filename": "f1.feather", "frames_name": frames_name, "save_video_period": period}
    line = refused(tmp_path, scene)
    assert line.startswith("Error: scene.yaml:")
    assert ": frames_name: " in line
    expected = message if period == 0.5 or "proc" in frames_name else message.replace("0.5", "1")
    assert expected in line


def test_frames_cannot_take_the_place_of_the_configuration_or_the_console_file(tmp_path: Path) -> None:
    console = {"enable_console_logging": True, "console_filename": "c1.txt", "frames_name": "./c{}.txt"}
    assert "a frame may be the same file as console_filename 'c1.txt'" in refused(tmp_path, console)
    (tmp_path / "s1.png").symlink_to("scene.yaml")
    ended_well(tmp_path, {"frames_name": "s{:.0f}.png", "save_video_period": 1.0})  # takes the place of the link
    assert "arena_file" in (tmp_path / "scene.yaml").read_text()


# Errors during the run.


def test_folder_that_is_moved_away_during_the_run_costs_no_data(tmp_path: Path) -> None:
    program = program_with(tmp_path, 'if (rename("frames", "gone") != 0) { abort(); }')
    result = run(program, tmp_path, {**FRAMES, "save_video_period": 0.02})
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert "[error] the frame 'frames/f0000" in line
    assert "could not be written: No such file or directory; " in line
    assert line.endswith(" of 100 frames were written")
    assert round(float(result.frame()["time"].max()), 4) == 2.0


def test_disk_that_is_full_costs_no_data(tmp_path: Path) -> None:
    write_scene(tmp_path, {**FRAMES, "window_width": 1000, "window_height": 1000, "objects.robots.nb": 60})
    ended = subprocess.run(
        [str(example("helloworld")), "-c", "scene.yaml", "-q"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (60000, 60000)),
    )
    assert ended.returncode == 2
    (line,) = ended.stderr.splitlines()
    assert line.endswith(
        "the frame 'frames/f00000.5000.png' could not be written: File too large; 0 of 4 frames were written"
    )
    assert names(tmp_path / "frames", "*") == []
    assert len(load_dataframe(tmp_path / "data.feather")[0]) == 21 * 60


def test_picture_that_does_not_fit_into_memory_is_refused(tmp_path: Path) -> None:
    write_scene(tmp_path, {**FRAMES, "window_width": 16384, "window_height": 16384})
    limit = 800 * 1024 * 1024
    ended = subprocess.run(
        [str(example("helloworld")), "-c", "scene.yaml", "-q"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)),
    )
    assert ended.returncode == 2
    (line,) = ended.stderr.splitlines()
    what = "1 picture of 16384 x 16384 pixels (window_width, window_height), 1.0 GiB"
    assert line.startswith(f"Error: not enough memory for {what}; reduce it")


# Ends of the run.


@pytest.mark.parametrize(
    ("kind", "code"),
    [
        ("write_to_null", 3),
        ("free_what_is_not_allocated", 3),
        ("overflow_the_stack", 3),
        ("loop_for_ever", 3),
        ("allocate_for_ever", 3),
        ("exit_with_7", 7),
        ("stop_simulation", 0),
    ],
)
def test_run_that_ends_in_user_code_completes_the_frames_until_then(
    program: Compile, tmp_path: Path, kind: str, code: int
) -> None:
    misdeed = {"parameters": {"kind": kind, "place": "user_step"}, "user_code_timeout": 0.25}
    result = run(program("misbehave.c"), tmp_path, {**FRAMES, **misdeed, "save_video_period": 0.01})
    assert result.code == code
    assert complete_frames(tmp_path / "frames") == 17 if kind == "stop_simulation" else 16
    assert round(float(result.frame()["time"].max()), 4) == 0.1


def wait_for_frames(folder: Path, count: int = 3) -> None:
    for _ in range(600):
        time.sleep(0.05)
        if len(names(folder)) >= count:
            return
    raise AssertionError("no frames come")


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_interrupted_run_completes_its_frames(tmp_path: Path, name: str) -> None:
    process = start(example("helloworld"), tmp_path, {**FRAMES, **LONG, "save_video_period": 0.1})
    wait_for_frames(tmp_path / "frames")
    process.send_signal(signal.Signals[name])
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    end_s = float(errors.split("interrupted at t = ")[1].split(" s.")[0])
    assert complete_frames(tmp_path / "frames") == int(10 * end_s + 1e-6)


def test_killed_run_leaves_no_half_frames(tmp_path: Path) -> None:
    for i in range(5):
        folder = tmp_path / str(i)
        process = start(example("helloworld"), folder, {**FRAMES, **LONG, "save_video_period": 0.01})
        wait_for_frames(folder / "frames")
        process.kill()
        process.communicate()
        for path in (folder / "frames").glob("*.png"):
            assert pixels_of(path).size > 0


# Threads and children of the program.


def test_child_processes_of_the_program_make_no_frames_of_their_own(tmp_path: Path) -> None:
    code = "for (int i = 0; i < 20; i++) { if (fork() == 0) { sleep(i % 2); _exit(0); } } while (wait(NULL) > 0) {}"
    program = program_with(tmp_path, code)
    result = run(program, tmp_path, {**FRAMES, "save_video_period": 0.02})
    assert (result.code, result.errors) == (0, "")
    assert complete_frames(tmp_path / "frames") == 100


@pytest.mark.skipif(sys.platform != "linux", reason="finds its threads in /proc")
@pytest.mark.parametrize("size", [50, 500])  # the thread waits for the run, or the run for the thread
def test_crash_of_a_thread_that_draws_ends_the_run_soon_with_its_data(
    program: Compile, tmp_path: Path, size: int
) -> None:
    scene = {"save_video_period": 0.01, "window_width": size, "window_height": size}
    began_s = time.monotonic()
    result = run(program("crash_of_other_threads.c"), tmp_path, scene)
    assert time.monotonic() - began_s < 20.0
    assert result.code == 3
    (line,) = result.errors.splitlines()
    assert "[error] the user program failed in user_step of robot #" in line
    # All crash; the run hears of one first.
    activity = "(drawing pictures|watching over blocked calls)"
    assert re.search(rf"the simulator crashed while it was {activity} \(segmentation fault", line)
    assert line.endswith("The data file 'data.feather' contains all rows up to that point")
    assert 0.4 <= float(result.frame()["time"].max()) < 1.5


def test_time_limit_of_user_code_does_not_count_the_drawing(program: Compile, tmp_path: Path) -> None:
    large = {"window_width": 1500, "window_height": 1500, "save_video_period": 0.05}
    result = run(program("misbehave.c"), tmp_path, {**large, "user_code_timeout": 0.05})
    assert (result.code, result.errors) == (0, "")
    assert complete_frames(tmp_path / "frames") == 40


def colour_count(picture: npt.NDArray[np.uint8]) -> int:
    return len(np.unique(picture.reshape(-1, 3), axis=0))


@pytest.mark.parametrize(("width", "height"), [(1, 1), (1, 300), (2000, 10)])
def test_strange_sizes_are_drawn(tmp_path: Path, width: int, height: int) -> None:
    ended_well(tmp_path, {"simulation_time": 0.5, "window_width": width, "window_height": height})
    picture = pixels_of(tmp_path / "frames" / "f00000.5000.png")
    assert picture.shape == (height, width, 3)
    assert colour_count(picture) >= 1
