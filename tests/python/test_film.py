"""Films of a run: their length, size and codec, and what happens when there can be none."""

from __future__ import annotations

import json
import os
import signal
import stat
import subprocess
import time
from collections.abc import Mapping
from pathlib import Path

import pytest
from conftest import Compile
from running import Run, compile_program, example, run, write_scene

SIZE: dict[str, object] = {"window_width": 120, "window_height": 90}
LONG = {"simulation_time": 1.0e6}


def film_of(
    folder: Path, name: str, settings: Mapping[str, object] | None = None, arguments: tuple[str, ...] = ()
) -> Run:
    return run(example("helloworld"), folder, {**SIZE, **(settings or {})}, ["--video", name, *arguments])


def filmed(folder: Path, name: str, settings: Mapping[str, object] | None = None) -> dict[str, object]:
    """Make a film; returns what ffprobe says about its pictures."""
    result = film_of(folder, name, settings)
    assert (result.code, result.errors) == (0, ""), result.text
    assert list(folder.glob("*.pogosim-new")) == []
    return probe(folder / name)


def probe(path: Path) -> dict[str, object]:
    entries = "stream=codec_name,width,height,pix_fmt,nb_read_frames:format=duration"
    command = ["ffprobe", "-v", "error", "-count_frames", "-show_entries", entries, "-of", "json", str(path)]
    found = subprocess.run(command, capture_output=True, text=True, check=True)
    assert found.stderr == ""
    told = json.loads(found.stdout)
    (stream,) = told["streams"]
    return {**stream, "pictures": int(stream["nb_read_frames"]), "duration_s": float(told["format"]["duration"])}


def refused(folder: Path, name: str, settings: Mapping[str, object] | None = None) -> str:
    result = film_of(folder, name, settings)
    assert result.code == 2, result.text
    assert not (folder / "data.feather").exists()
    (line,) = result.errors.splitlines()
    return line


@pytest.mark.parametrize(
    ("name", "codec", "pixels"),
    [("a.mp4", "h264", "yuv420p"), ("a.webm", "vp9", "yuv420p"), ("new/a.GIF", "gif", None)],
)
def test_film_shows_the_run_in_real_time(tmp_path: Path, name: str, codec: str, pixels: str | None) -> None:
    film = filmed(tmp_path, name, {"simulation_time": 1.0})
    assert (film["codec_name"], film["width"], film["height"]) == (codec, 120, 90)
    assert pixels in (None, film["pix_fmt"])
    assert film["pictures"] == 31  # of 0 s, 1/30 s, ..., 1 s
    assert film["duration_s"] == pytest.approx(31 / 30, abs=0.05)


@pytest.mark.parametrize(
    ("settings", "pictures"),
    [
        ({"GUI_speed_up": 4.0}, 15 + 1),
        ({"GUI_speed_up": 0.5}, 120 + 1),
        ({"GUI_speed_up": 0}, 60 + 1),
        ({"GUI_speed_up": 0.1, "simulation_time": 0.5}, 150 + 1),  # several for each step
        ({"save_video_period": 0.5}, 60 + 1),
        ({"save_data_period": -1, "enable_data_logging": False}, 60 + 1),
    ],
)
def test_length_follows_the_speed_and_not_the_steps(tmp_path: Path, settings: dict[str, object], pictures: int) -> None:
    assert filmed(tmp_path, "a.mp4", settings)["pictures"] == pictures


def test_odd_sizes_get_one_more_row_and_column(tmp_path: Path) -> None:
    film = filmed(tmp_path, "a.mp4", {"simulation_time": 0.2, "window_width": 33, "window_height": 21})
    assert (film["width"], film["height"]) == (34, 22)


def test_film_changes_no_byte_of_the_data_file(tmp_path: Path) -> None:
    files = []
    for folder, arguments in ((tmp_path / "with", ["--video", "a.mp4"]), (tmp_path / "without", [])):
        result = run(example("helloworld"), folder, SIZE, arguments)
        assert (result.code, result.errors) == (0, "")
        files.append((folder / "data.feather").read_bytes())
    assert files[0] == files[1]


# What stands in the way of a film.


@pytest.mark.parametrize("name", ["a.avi", "a", "mp4", "a.mp4.txt"])
def test_other_endings_are_refused(tmp_path: Path, name: str) -> None:
    expected = f"Error: --video: expected a name that ends in .mp4, .webm or .gif, found '{name}'"
    assert refused(tmp_path, name) == expected


def test_film_without_a_name_is_refused(tmp_path: Path) -> None:
    assert "expected the name of a file" in film_of(tmp_path, "").errors


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("folder.mp4", "this is not a regular file"),
        ("file/a.mp4", "Not a directory"),
        ("/proc/a.mp4", "No such file or directory"),
        (300 * "a" + ".mp4", "File name too long"),
    ],
)
def test_film_that_cannot_be_written_is_refused(tmp_path: Path, name: str, reason: str) -> None:
    (tmp_path / "folder.mp4").mkdir()
    (tmp_path / "file").write_text("a file")
    expected = f"Error: --video: the film '{name}' cannot be written: {reason}; choose another file"
    assert refused(tmp_path, name) == expected


@pytest.mark.parametrize(
    ("settings", "reason"),
    [
        ({"window_width": 16384, "window_height": 16384}, "too large for ffmpeg"),
        ({"GUI_speed_up": 1e-6}, "expected at least 0.0003, or 0 for real time"),
        ({"GUI_speed_up": 1e-300}, "expected at least 0.0003, or 0 for real time"),
    ],
)
def test_film_that_no_encoder_takes_or_that_has_no_pictures_is_refused(
    tmp_path: Path, settings: dict[str, object], reason: str
) -> None:
    assert reason in refused(tmp_path, "a.mp4", settings)
    assert run(example("helloworld"), tmp_path, {"GUI_speed_up": 1e-300}).code == 0


def test_film_is_no_other_file_of_the_run(tmp_path: Path) -> None:
    same = refused(tmp_path, "a.mp4", {"data_filename": "./a.mp4"})
    assert same.startswith("Error: --video: 'a.mp4' is the same file as data_filename './a.mp4' (scene.yaml:")
    frames = refused(tmp_path, "f1.gif", {"save_video_period": 1, "frames_name": "f{}.gif"})
    assert "a frame may be the same file as the film 'f1.gif' (--video), which the run also writes" in frames
    (tmp_path / "a.gif").symlink_to("scene.yaml")
    assert "is the same file as the configuration file 'scene.yaml', which the run would overwrite" in refused(
        tmp_path, "a.gif"
    )


def with_ffmpeg(monkeypatch: pytest.MonkeyPatch, folder: Path, script: str | None) -> None:
    """Replace ffmpeg by a shell script, or take it away."""
    folder.mkdir()
    if script is not None:
        (folder / "ffmpeg").write_text(f"#!/bin/sh\n{script}\n")
        (folder / "ffmpeg").chmod(stat.S_IRWXU)
    monkeypatch.setenv("PATH", str(folder) + ("" if script is None else os.pathsep + os.environ["PATH"]))


def test_missing_ffmpeg_is_said_before_the_run_and_how_to_install_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with_ffmpeg(monkeypatch, tmp_path / "bin", None)
    assert refused(tmp_path, "a.mp4") == (
        "Error: --video needs ffmpeg, which cannot be started (No such file or directory); install it: "
        "'sudo apt install ffmpeg' on Debian and Ubuntu, 'brew install ffmpeg' on macOS"
    )


def test_missing_encoder_is_said_before_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with_ffmpeg(monkeypatch, tmp_path / "bin", 'echo " V....D libvpx-vp9   libvpx VP9 (codec vp9)"')
    assert "this ffmpeg has no encoder 'libx264', which .mp4 films need" in refused(tmp_path, "a.mp4")


@pytest.mark.parametrize(
    ("script", "reason"),
    [
        ("echo no more room >&2; exit 1", "no more room"),  # before it has read anything
        ("cat > /dev/null; echo no more room >&2; echo at all >&2; exit 1", "no more room; at all"),
        ("cat > /dev/null; exit 1", "it ended without a message"),
        ("cat > /dev/null; exit 0", "it ended without writing anything"),
    ],
)
def test_film_that_fails_costs_neither_data_nor_the_older_film(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, script: str, reason: str
) -> None:
    (tmp_path / "a.mp4").write_text("an older film")
    listed = 'case "$*" in *-encoders) echo " V....D libx264 x"; exit 0;; esac'
    with_ffmpeg(monkeypatch, tmp_path / "bin", f"{listed}\n{script}")
    result = film_of(tmp_path, "a.mp4", {"save_video_period": 0.5})
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert line.endswith(f"[error] the film 'a.mp4' could not be written: ffmpeg: {reason}")
    assert round(float(result.frame()["time"].max()), 4) == 2.0
    assert (tmp_path / "a.mp4").read_text() == "an older film"
    assert list(tmp_path.glob("*.pogosim-new")) == []
    assert len(list((tmp_path / "frames").glob("*.png"))) == 4


# Ends of the run.


def test_film_of_a_run_that_crashes_shows_it_until_then(program: Compile, tmp_path: Path) -> None:
    misdeed = {**SIZE, "parameters": {"kind": "write_to_null", "place": "user_step"}}
    result = run(program("misbehave.c"), tmp_path, misdeed, ["--video", "a.mp4"])
    assert result.code == 3
    assert probe(tmp_path / "a.mp4")["pictures"] == 5  # until 0.16 s


def test_run_that_fails_before_its_start_leaves_the_older_film(program: Compile, tmp_path: Path) -> None:
    (tmp_path / "a.mp4").write_text("an older film")
    misdeed = {**SIZE, "parameters": {"kind": "write_to_null", "place": "user_init"}}
    result = run(program("misbehave.c"), tmp_path, misdeed, ["--video", "a.mp4"])
    assert result.code == 3
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.mp4", "data.feather", "scene.yaml"]
    assert (tmp_path / "a.mp4").read_text() == "an older film"


def wait_for(path: Path) -> None:
    for _ in range(600):
        time.sleep(0.05)
        if path.exists() and path.stat().st_size > 0:
            return
    raise AssertionError(f"{path} does not come")


@pytest.mark.parametrize("name", ["a.mp4", "a.gif"])
def test_film_of_an_interrupted_run_plays(tmp_path: Path, name: str) -> None:
    write_scene(tmp_path, {**SIZE, **LONG, "GUI_speed_up": 1.0})
    command = [str(example("helloworld")), "-c", "scene.yaml", "-g", "--video", name]
    process = subprocess.Popen(
        command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    wait_for(tmp_path / f"{name}.pogosim-new")
    os.killpg(process.pid, signal.SIGINT)  # as Ctrl-C in a terminal: to the whole group
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    end_s = float(errors.split("interrupted at t = ")[1].split(" s.")[0])
    assert probe(tmp_path / name)["pictures"] == int(30 * end_s + 1e-6) + 1


FORKING = """
#include "pogobase.h"
#include <unistd.h>
typedef struct { int unused; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
void user_init(void) {}
void user_step(void) {
    if (pogobot_helper_getid() == 0 && pogobot_ticks == 60 && fork() == 0) {
        for (int i = 0; i < 3; i++) { close(i); }
        sleep(30);
        _exit(0);
    }
}
int main(void) { pogobot_init(); pogobot_start(user_init, user_step); return 0; }
"""


def test_film_ends_although_a_child_of_the_program_lives_on(tmp_path: Path) -> None:
    (tmp_path / "main.c").write_text(FORKING)
    program = compile_program(tmp_path / "main", tmp_path / "main.c")
    began_s = time.monotonic()
    result = run(program, tmp_path, SIZE, ["--video", "a.mp4"])
    assert (result.code, result.errors) == (0, "")
    assert time.monotonic() - began_s < 20
    assert probe(tmp_path / "a.mp4")["pictures"] == 61


def test_encoder_that_stalls_does_not_hold_up_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with_ffmpeg(
        monkeypatch, tmp_path / "bin", 'case "$*" in *-encoders) echo " V....D libx264 x";; *) sleep 1000;; esac'
    )
    result = film_of(tmp_path, "a.mp4", {"simulation_time": 3.0, "window_width": 400, "window_height": 400})
    assert result.code == 2
    assert "the film 'a.mp4' could not be written: ffmpeg: it took no picture for 20 s" in result.text
    assert result.frame()["time"].max() == pytest.approx(3.0)


def test_folder_for_temporary_files_does_not_matter(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMPDIR", "/nonexistent")
    assert filmed(tmp_path, "a.mp4")["codec_name"] == "h264"
