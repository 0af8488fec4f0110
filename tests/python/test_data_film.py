"""pogosim film: what its frames show, and what it says of bad input."""

from __future__ import annotations

import itertools
import json
import os
import re
import subprocess
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from PIL import Image
from pogosim import Simulation
from pogosim.errors import MissingColumnWarning, PictureError
from pogosim.film.ahead import made_ahead
from pogosim.film.cards import card
from pogosim.film.command import main
from pogosim.film.frames import ABOVE_PX, FILLED, Frames
from pogosim.film.grid import Grid, labels_of
from pogosim.film.making import frame_times
from pogosim.film.moments import Moments
from pogosim.film.painter import Painter, Stage
from pogosim.film.timeline import Timeline, timeline_of
from pogosim.picture.colouring import Scale
from pogosim.picture.swarm import OBJECT, RGB, Recording, read_recording
from pogosim.utils import load_dataframe
from recordings import SIDE_MM, walkers, write
from running import example, run


@pytest.fixture
def data(tmp_path: Path) -> Path:
    return write(tmp_path / "data.feather", walkers())


def film(data: Path, name: str, *options: str) -> int:
    return main([str(data), "-o", str(data.parent / name), "--size", "160", *options])


def probe(path: Path) -> dict[str, object]:
    entries = "stream=codec_name,width,height,nb_read_frames"
    command = ["ffprobe", "-v", "error", "-count_frames", "-show_entries", entries, "-of", "json", str(path)]
    (stream,) = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)["streams"]
    return dict(stream)


@pytest.mark.parametrize(("name", "codec"), [("a.mp4", "h264"), ("a.webm", "vp9"), ("a.GIF", "gif")])
def test_film_has_a_frame_for_each_time(data: Path, name: str, codec: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert film(data, name, "--fps", "10", "--speed", "2", "--links", "--tail", "1") == 0
    expected = {"codec_name": codec, "width": 160, "height": 160, "nb_read_frames": "11"}  # 0, 0.2, ..., 2 s
    assert probe(data.parent / name) == expected
    assert capsys.readouterr().out == f"{data.parent / name}: 11 frames of 160 x 160 pixels, 1.10 s\n"
    assert list(data.parent.glob("*pogosim-new*")) == []


@pytest.mark.parametrize(
    ("span", "speed", "fps", "times"),
    [((0.0, 1.0), 1.0, 4.0, [0, 0.25, 0.5, 0.75, 1]), ((3.0, 4.0), 8.0, 10.0, [3, 3.8]), ((2.0, 2.0), 1.0, 30.0, [2])],
)
def test_times_of_frames_follow_speed_and_rate(
    span: tuple[float, float], speed: float, fps: float, times: list[float]
) -> None:
    assert frame_times(*span, speed, fps) == pytest.approx(times)


@pytest.mark.parametrize(("fps", "said"), [("24", False), ("50", False), ("60", True), ("1000", True)])
def test_gif_lasts_as_long_as_it_should_in_all_players(
    data: Path, fps: str, said: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    """Players take delays below 20 ms for 100 ms."""
    assert film(data, "film.gif", "--fps", fps, "--size", "200") == 0
    warning = f"warning: a GIF has 50 frames per second, not {fps}: players show more of them slowly"
    assert (warning in capsys.readouterr().err) == said
    command = ["ffprobe", "-v", "error", "-show_entries", "packet=duration_time", "-of", "csv=p=0"]
    text = subprocess.run([*command, str(data.parent / "film.gif")], capture_output=True, text=True, check=True).stdout
    delays = np.array([float(line.rstrip(",")) for line in text.split()])
    assert delays.min() >= 0.02
    recorded_s = float(load_dataframe(data)[0]["time"].max())
    assert delays.sum() == pytest.approx(recorded_s, abs=0.06)


def test_last_frame_is_not_lost_to_rounding() -> None:
    assert (0.7 - 0.4) * 10.0 < 3.0
    assert len(frame_times(0.4, 0.7, 1.0, 10.0)) == 4
    assert len(frame_times(0.4, 0.699, 1.0, 10.0)) == 3


def line_of(rows: pd.DataFrame, folder: Path, **settings: str) -> Timeline:
    recording = read_recording(write(folder / "line.feather", rows, None, **settings))
    return timeline_of(recording, recording.last.rows, [OBJECT])


def steps(x: list[float], angle: list[float]) -> pd.DataFrame:
    rows = walkers(1, len(x))
    return rows.assign(x=np.array(x, np.float32), angle=np.array(angle, np.float32))


def test_between_two_records_robots_are_on_the_straight_way(tmp_path: Path) -> None:
    now = line_of(steps([100, 200, 400], [0.0, 1.0, -1.0]), tmp_path).at(0.6)
    assert now["x"].item() == pytest.approx(240)
    assert now["y"].item() == pytest.approx(160)
    assert now["angle"].item() == pytest.approx(0.6)
    assert now["heard"].item() == 1


def test_angles_turn_the_short_way(tmp_path: Path) -> None:
    angle = line_of(steps([100, 100], [3.0, -3.0]), tmp_path).at(0.25)["angle"].item()
    assert np.cos(angle) == pytest.approx(-1.0, abs=1e-5)


@pytest.mark.parametrize(("boundary", "expected"), [("periodic", 0.0), ("solid", 980.0)])
def test_way_across_the_border_is_short_where_there_is_none(tmp_path: Path, boundary: str, expected: float) -> None:
    x = line_of(steps([980, 20], [0, 0]), tmp_path, boundary_condition=boundary).at(0.25)["x"].item()
    assert x % 1000.0 == pytest.approx(expected)


def test_robot_without_a_row_stays_where_it_was_and_is_not_there_before_its_first(tmp_path: Path) -> None:
    rows = walkers()
    gap = ((rows["robot_id"] == 1) & rows["time"].between(0.4, 1.1)) | ((rows["robot_id"] == 2) & (rows["time"] < 1))
    line = line_of(rows[~gap], tmp_path)
    assert line.at(0.0)["robot_id"].tolist() == [0, 1]
    assert line.at(1.0).set_index("robot_id")["y"].to_dict() == {0: 200.0, 1: 100.0, 2: 200.0}
    assert line.at(2.0)["y"].tolist() == [300.0] * 3


def frames_of(recording: Recording, side: int = 400, tail_s: float | None = None, **view: Any) -> Frames:
    """Frames of a run, with a picture of so many pixels in both directions."""
    shown = {"trails": tail_s is not None, "time": False, "scale_bar": False, **view}
    return Frames(recording, (side, side + ABOVE_PX), shown, tail_s)


def pixels(frames: Frames, time_s: float) -> npt.NDArray[np.int64]:
    frame = np.empty((frames.size[1], frames.size[0], 3), np.uint8)
    frames.draw(time_s, frame)
    return frame.astype(int)


def scale_of(frames: Frames) -> float:
    """Pixels per mm."""
    return FILLED * min(frames.picture_size) / SIDE_MM


def place_of(frames: Frames, x_mm: float, y_mm: float) -> tuple[int, int]:
    """Row and column of a place in the arena."""
    width, height = frames.picture_size
    x = width / 2 + scale_of(frames) * (x_mm - SIDE_MM / 2)
    return int(ABOVE_PX + height / 2 + scale_of(frames) * (y_mm - SIDE_MM / 2)), int(x)


def middle_of_red(image: npt.NDArray[np.int64]) -> tuple[float, float]:
    """Row and column of what is as red as robot 0."""
    mask = (image[..., 0] > 180) & (image[..., 1:] < 50).all(axis=-1)
    assert mask.sum() > 20
    rows, columns = np.nonzero(mask)
    return float(rows.mean()) + 0.5, float(columns.mean()) + 0.5


def test_robot_is_where_its_pose_says_in_its_colour(data: Path) -> None:
    frames = frames_of(read_recording(data), 700)
    for time_s in (0.0, 0.25, 2.0):
        row, column = middle_of_red(pixels(frames, time_s))
        scale = scale_of(frames)
        assert column == pytest.approx(350 + scale * (1000 / 6 - 500), abs=0.5)
        # The dark mark of the heading, 0.7 of a radius long, moves the mean upwards a little.
        assert row == pytest.approx(ABOVE_PX + 350 + scale * (100 + 100 * time_s - 500), abs=1.5)
    image = pixels(frames, 0.0)
    assert image[place_of(frames, 1000 / 6, 90)].tolist() == [210, 0, 0]
    assert image[place_of(frames, 500, 90)].tolist() == [0, 210, 0]
    assert image[place_of(frames, 2500 / 3, 90)].tolist() == [0, 0, 210]


def test_frames_forget_where_robots_were(data: Path) -> None:
    frames = frames_of(read_recording(data))
    start = pixels(frames, 0.0)
    pixels(frames, 2.0)
    np.testing.assert_array_equal(pixels(frames, 0.0), start)


def test_light_of_a_lamp_that_goes_on_appears_where_the_configuration_shows_light(tmp_path: Path) -> None:
    lamp = {"type": "static_light", "geometry": "disk", "x": 500, "y": 800, "radius": 100, "value": 0}
    flash = {"photo_start_at": 1.0, "photo_start_duration": 0.5, "photo_start_value": 500}
    recording = read_recording(write(tmp_path / "a.feather", walkers(), {"lamp": {**lamp, **flash}}))
    frames, dark = (frames_of(recording, light_levels=shown) for shown in (True, False))
    place = place_of(frames, 460, 800)
    brightness = [int(pixels(frames, time_s)[place].mean()) for time_s in (0.9, 1.1, 1.6)]
    assert brightness[1] > 60
    assert brightness[0] == brightness[2] < 40
    assert int(pixels(dark, 1.1)[place].mean()) < 40
    sun = pixels(dark, 0.0)[place_of(frames, 500, 800)]
    assert sun[0] > 200


# ---- bad input -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "rows",
    [
        walkers().iloc[:1],
        walkers(1),
        walkers().drop(columns=["angle", "led_rgb"]),
        walkers().drop(columns=["robot_category", "robot_id"]),
        walkers().assign(x=lambda frame: frame["x"].where(frame["time"] != 1.0)),
        walkers().assign(robot_category=pd.Categorical(["robots"] * 15), state=pd.Categorical(["a"] * 15)),
    ],
    ids=["one row", "one robot", "places only", "nobody", "gaps", "categories"],
)
@pytest.mark.parametrize("name", ["a.gif", "a.html"])
def test_film_shows_what_is_there(tmp_path: Path, rows: pd.DataFrame, name: str) -> None:
    assert film(write(tmp_path / "data.feather", rows), name, "--fps", "2") == 0
    assert (tmp_path / name).stat().st_size > 300


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (walkers().iloc[:0], "it holds no object with a position"),
        (walkers().drop(columns="x"), "it has no column x"),
        (walkers().assign(y=np.nan), "it holds no object with a position"),
    ],
)
@pytest.mark.parametrize("name", ["a.mp4", "a.html"])
def test_file_without_poses_is_one_line(
    tmp_path: Path, rows: pd.DataFrame, said: str, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert film(write(tmp_path / "data.feather", rows), name) == 2
    assert said in refusal(capsys)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["data.feather"]


def refusal(capsys: pytest.CaptureFixture[str]) -> str:
    said = capsys.readouterr()
    assert said.out == ""
    (line,) = said.err.splitlines()
    assert line.startswith("pogosim film: ")
    return line


@pytest.mark.parametrize(
    ("name", "options", "said"),
    [
        ("a.avi", [], "let it end in .mp4, .webm, .gif or .html"),
        ("data.feather", [], "would take the place of the data file"),
        ("none/a.mp4", [], "there is no folder"),
        ("a.mp4", ["--from", "3"], "it has rows from 0 s to 2 s"),
        ("a.html", ["--from", "1.5", "--to", "1"], "--from and --to leave nothing"),
        ("a.mp4", ["--speed", "1e-9"], "frames are too many"),
        ("a.mp4", ["--size", "10"], "160 to 8192 are possible"),
        ("a.mp4", ["--view", "links=sideways"], "view.links: expected one of hidden, below, above, found 'sideways'"),
        ("a.mp4", ["--view", "trials=true"], "unknown key 'view.trials'; did you mean 'trails'?"),
        ("a.html", ["--color-by", "none"], "it has no column none"),
    ],
)
def test_what_cannot_be_filmed_is_one_line(
    data: Path, name: str, options: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    before = data.read_bytes()
    assert film(data, name, *options) == 2
    assert said in refusal(capsys)
    assert data.read_bytes() == before
    assert [path.name for path in data.parent.iterdir()] == ["data.feather"]


@pytest.mark.parametrize("content", [b"", b"no table", b"ARROW1\0\0 and no more"])
def test_foreign_files_are_one_line(tmp_path: Path, content: bytes, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "data.feather").write_bytes(content)
    assert film(tmp_path / "data.feather", "a.html") == 2
    assert "data.feather" in refusal(capsys)
    assert film(tmp_path / "none.feather", "a.html") == 2
    assert "no such file" in refusal(capsys)


def test_pipe_is_not_waited_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    os.mkfifo(tmp_path / "data.feather")
    assert film(tmp_path / "data.feather", "a.html") == 2
    assert "is not a file, but a pipe" in refusal(capsys)


def test_without_ffmpeg_it_says_how_to_install_it(
    data: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", str(data.parent))
    assert film(data, "a.mp4") == 2
    assert "need ffmpeg, which is not installed" in refusal(capsys)
    assert film(data, "a.html") == 0


def test_film_that_fails_leaves_the_older_one(
    data: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    fake = data.parent / "ffmpeg"
    fake.write_text('#!/bin/sh\ncase "$*" in *-encoders) echo libx264;; *) echo "disk full" >&2; exit 1;; esac\n')
    fake.chmod(0o755)
    monkeypatch.setenv("PATH", f"{data.parent}{os.pathsep}{os.environ['PATH']}")
    (data.parent / "a.mp4").write_bytes(b"older")
    assert film(data, "a.mp4") == 2
    assert "ffmpeg: disk full" in refusal(capsys)
    assert (data.parent / "a.mp4").read_bytes() == b"older"
    assert list(data.parent.glob("*pogosim-new*")) == []


# ---- the same picture as the window's --------------------------------------------------------------------------------

OBJECTS: dict[str, object] = {
    "robots": {"type": "pogobot", "nb": 12, "geometry": "disk", "radius": 26.5, "communication_radius": 80},
    "boxes": {"type": "passive_object", "nb": 3, "geometry": "rectangle", "body_width": 90, "body_height": 40},
    "stars": {
        "type": "passive_object",
        "nb": 2,
        "geometry": "compound",
        "parts": [
            {"geometry": "rectangle", "body_width": 80, "body_height": 20},
            {"geometry": "rectangle", "body_width": 20, "body_height": 80},
        ],
    },
    "lamp": {"type": "static_light", "geometry": "disk", "x": 300, "y": 300, "radius": 200, "value": 500},
}


SOFT: dict[str, object] = {
    "robots": OBJECTS["robots"],
    "skin": {"type": "membrane", "geometry": "disk", "radius": 150, "num_dots": 40, "serialize_dot_pose": True},
    "wall": {"type": "pogowall", "geometry": "arena"},
}


@pytest.mark.parametrize(
    "view",
    [{}, {"view": {"light_levels": True}}, {"show_time": False, "show_scale_bar": False, "show_light_levels": True}],
    ids=["bodies", "light", "older keys"],
)
@pytest.mark.parametrize("boundary", ["solid", "periodic"])
@pytest.mark.parametrize("objects", [OBJECTS, SOFT], ids=["rigid", "soft"])
def test_frame_is_the_picture_of_the_run_at_that_time(
    tmp_path: Path, boundary: str, objects: dict[str, object], view: dict[str, object]
) -> None:
    settings = {
        "objects": objects,
        "boundary_condition": boundary,
        "save_data_period": 0.5,
        "data_logger_led": True,
    }
    settings = {**settings, "simulation_time": 2.0, "show_lateral_LEDs": False, **view}
    result = run(example("helloworld"), tmp_path, settings)
    assert result.code == 0, result.text
    recording = read_recording(tmp_path / "data.feather")
    frames = Frames(recording, (300, 300 + ABOVE_PX), {})
    with Simulation(example("helloworld").with_suffix(".so"), tmp_path / "scene.yaml") as simulation:
        for time_s in (0.5, 1.5):
            simulation.run(time_s)
            picture = simulation.render(300, 300)
            frame = pixels(frames, time_s)[ABOVE_PX:]
            assert np.ptp(picture) > 100
            np.testing.assert_array_equal(frame, picture)


def test_trails_of_a_file_with_every_step_are_those_of_the_run(tmp_path: Path) -> None:
    size = {"window_width": 300, "window_height": 300, "save_video_period": 8.0, "frames_name": "f{}.png"}
    settings = {"view": {"trails": True}, "save_data_period": 0.01, "data_logger_led": True, "simulation_time": 8.0}
    result = run(example("helloworld"), tmp_path, {**settings, **size, "show_lateral_LEDs": False})
    assert result.code == 0, result.text
    recording = read_recording(tmp_path / "data.feather")
    frame, plain = (pixels(Frames(recording, (300, 300 + ABOVE_PX), {"trails": shown}), 8.0) for shown in (True, False))
    assert (frame != plain).any(axis=-1).sum() > 100
    (picture,) = tmp_path.glob("f*.png")
    np.testing.assert_array_equal(frame[ABOVE_PX:], np.asarray(Image.open(picture).convert("RGB")))


def test_trail_fades_over_its_seconds_and_ends_there(tmp_path: Path) -> None:
    recording = read_recording(write(tmp_path / "a.feather", walkers(1, 41)))  # 20 s, 2 m down
    frames, without = frames_of(recording, 800, tail_s=4.0), frames_of(recording, 800)
    trail, plain = pixels(frames, 8.0), pixels(without, 8.0)  # at y = 900 mm
    shown = [int(trail[place_of(frames, 500, y)][0] - plain[place_of(frames, 500, y)][0]) for y in (840, 700, 600)]
    assert shown[0] > shown[1] > shown[2] > 0
    assert trail[place_of(frames, 500, 480)].tolist() == plain[place_of(frames, 500, 480)].tolist()


def test_jump_leaves_no_trail(tmp_path: Path) -> None:
    rows = walkers(1, 2).assign(x=np.array([900.0, 100.0]), y=500.0)
    frames = frames_of(read_recording(write(tmp_path / "jump.feather", rows)), tail_s=1.0)
    assert pixels(frames, 0.5)[place_of(frames, 500, 500)].max() < 40  # the floor


def test_trail_across_a_periodic_border_is_there_on_both_sides(tmp_path: Path) -> None:
    rows = walkers(1, 2).assign(x=np.array([900.0, 100.0]), y=500.0)
    path = write(tmp_path / "a.feather", rows, boundary_condition="periodic")
    recording = read_recording(path)
    frames, without = frames_of(recording, 800, tail_s=5.0), frames_of(recording, 800)
    changed = (pixels(frames, 0.5) != pixels(without, 0.5)).any(axis=-1)
    for x_mm in (920, 990, 10, 60):
        row, column = place_of(frames, x_mm, 500)
        assert changed[row - 1 : row + 2, column].any()
    row, column = place_of(frames, 500, 500)
    assert not changed[row - 3 : row + 4, column].any()


def test_links_join_robots_near_enough_and_say_which_is_deaf(tmp_path: Path) -> None:
    rows = walkers(3, 2).assign(x=lambda frame: 400.0 + 120.0 * frame["robot_id"], y=500.0)
    rows["robot_category"] = np.where(rows["robot_id"] == 2, "silent", "robots")
    mute = {"silent": {"type": "pogobot", "geometry": "disk", "radius": 26.5, "communication_radius": 0}}
    recording = read_recording(write(tmp_path / "a.feather", rows, mute))
    frames = frames_of(recording, 800, links="below")
    pairs = frames.moments.at(0.0).heard
    assert pairs is not None
    assert pairs.tolist() == [(0, 1, 1), (1, 2, 0)]
    image, plain = pixels(frames, 0.0), pixels(frames_of(recording, 800), 0.0)
    for x_mm in (455, 460, 465, 580):
        place = place_of(frames, x_mm, 500)
        assert image[place].min() > plain[place].min() + 40


def test_glow_ends_at_the_wall(tmp_path: Path) -> None:
    rows = walkers(1, 2).assign(x=20.0, y=500.0)
    frames = frames_of(read_recording(write(tmp_path / "wall.feather", rows)), 800)
    image = pixels(frames, 0.0)
    assert image[place_of(frames, -13.0, 500)].tolist() == [255, 255, 255]
    assert image[place_of(frames, 52.0, 500)][0] > 30


def test_colours_of_a_column_do_not_glow(tmp_path: Path) -> None:
    recording = read_recording(write(tmp_path / "a.feather", walkers()), color_by="state")
    frames = Frames(recording, (900, 800 + ABOVE_PX), {})
    image = pixels(frames, 0.0)
    expected = np.round(255 * recording.last.rows[RGB].to_numpy()[:3])
    scale = FILLED * min(frames.picture_size) / SIDE_MM
    width, height = frames.picture_size
    for x_mm, colour in zip((1000 / 6, 500, 2500 / 3), expected, strict=True):
        column = int(width / 2 + scale * (x_mm - 500))
        row = int(ABOVE_PX + height / 2 + scale * (90 - 500))
        assert image[row, column].tolist() == colour.tolist()
        assert image[int(row - scale * 22), column].max() < 40  # the floor behind the robot


def test_robot_at_a_periodic_border_comes_back_on_the_other_side(tmp_path: Path) -> None:
    rows = walkers(1, 2).assign(x=995.0, y=500.0)
    frames = frames_of(read_recording(write(tmp_path / "border.feather", rows, boundary_condition="periodic")), 800)
    image = pixels(frames, 0.0)
    for x_mm in (980.0, 12.0):
        assert np.ptp(image[place_of(frames, x_mm, 490)]) > 100  # red
    assert image[place_of(frames, 1014.0, 500)].tolist() == [255, 255, 255]


def test_robot_is_not_there_before_its_first_row(tmp_path: Path) -> None:
    rows = walkers(2, 3)
    rows = rows[(rows["robot_id"] == 0) | (rows["time"] > 0.6)]
    frames = frames_of(read_recording(write(tmp_path / "a.feather", rows, boundary_condition="periodic")), 800)
    assert pixels(frames, 0.5)[place_of(frames, 750, 140)].max() < 40
    assert pixels(frames, 1.0)[place_of(frames, 750, 190)].tolist() == [0, 210, 0]


def test_headings_stand_out_from_bright_and_dark_colours(data: Path) -> None:
    frames = frames_of(read_recording(data), 720)
    image = pixels(frames, 0.0)
    assert image[place_of(frames, 500, 116)].max() < 60  # green
    assert image[place_of(frames, 2500 / 3, 116)].min() > 200  # blue


@pytest.mark.parametrize("tail_s", [None, 3.0])
def test_frames_are_the_same_each_time_and_whatever_came_before(tmp_path: Path, tail_s: float | None) -> None:
    recording = read_recording(write(tmp_path / "a.feather", walkers(8, 21)))
    first, other = (frames_of(recording, 320, tail_s, links="above") for _ in range(2))
    for time_s in (0.0, 7.3, 2.0):
        pixels(other, time_s)
    np.testing.assert_array_equal(pixels(other, 4.13), pixels(first, 4.13))


def test_slow_robot_moves_by_parts_of_a_pixel(data: Path) -> None:
    frames = frames_of(read_recording(data))
    heights = []
    for time_s in np.arange(0.0, 0.1, 0.01):
        image = pixels(frames, time_s)
        red = np.clip(image[..., 0] - image[..., 1:].max(axis=-1), 0, None).astype(float)
        heights.append(float(red.sum(axis=1) @ np.arange(len(red)) / red.sum()))
    assert np.array(heights) - heights[0] == pytest.approx(np.arange(10) * scale_of(frames), abs=0.13)


def test_arrays_of_another_size_are_refused(data: Path) -> None:
    moments = frames_of(read_recording(data)).moments
    moment = moments.at(0.0)
    picture = np.empty((100, 100, 3), np.uint8)
    wrong = {
        "poses: expected an array of float32 of shape (3, 3)": replace(moment, poses=moment.poses[:2]),
        "rgb: expected an array of uint32 of shape (3,)": replace(moment, rgb=moment.rgb.astype(np.int32)),
        "lamps: expected an array of float32 of shape (0, 2)": replace(moment, lamps=np.zeros((1, 2), np.float32)),
    }
    for said, other in wrong.items():
        with pytest.raises(ValueError, match=re.escape(said)):
            moments.painter.draw(other, picture)
    with pytest.raises(ValueError, match="picture: expected bytes of shape"):
        moments.painter.draw(moment, picture[:, ::2])
    with pytest.raises(PictureError, match=r"has 1 to 16384 pixels in a row, .*; found 0 x 100"):
        moments.painter.draw(moment, picture[:, :0])


def test_stage_that_says_nonsense_is_refused() -> None:
    square = [np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]])]
    kinds = [{"is": "robot", "geometry": "disk"}]
    description: dict[str, Any] = {"light_map": {"columns": 1, "rows": 1}, "kinds": kinds, "lamps": []}
    one, none = np.zeros(1, np.uint32), np.zeros(1, np.uint32)
    wrong: list[tuple[str, Stage]] = [
        ("object 0 is of kind 7, and there are 1 kinds", Stage(description, square, one + 7, none, none)),
        ("object 0 has 4 parts, but is no membrane", Stage(description, square, one, none, none + 4)),
        ("a polygon has at least 3 corners, found 2", Stage(description, [square[0][:2]], one, none, none)),
        (
            "view.links: expected",
            Stage({**description, "view": {"view": {"links": "sideways"}}}, square, one, none, none),
        ),
        (
            "unknown key 'perodic'; did you mean 'periodic'?",
            Stage({**description, "perodic": True}, square, one, none, none),
        ),
    ]
    for said, stage in wrong:
        with pytest.raises(PictureError, match=re.escape(said)):
            Painter(stage)


def test_film_shows_what_the_configuration_says_and_the_command_line_prevails(tmp_path: Path) -> None:
    def parts(options: dict[str, Any], **settings: Any) -> list[bool]:
        recording = read_recording(write(tmp_path / "a.feather", walkers(), None, **settings))
        painter = Moments(recording, options).painter
        return [painter.shows(part) for part in ("trails", "links", "light_levels")]

    assert parts({}) == [False, False, False]
    assert parts({}, view={"trails": True, "links": "above"}) == [True, True, False]
    assert parts({}, show_trajectory_traces=True, show_light_levels=True) == [True, False, True]
    assert parts({}, show_communication_channels=True, view={"links": "hidden"}) == [False, False, False]
    assert parts({"links": "hidden", "light_levels": True}, view={"trails": True, "links": "above"}) == [
        True, False, True,
    ]  # fmt: skip
    assert parts({}, show_light_levels={"default_option": True, "batch_options": [True, False]})[2] is False


def test_older_files_with_a_value_that_is_wrong_say_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert film(write(tmp_path / "a.feather", walkers(), None, view={"links": "up"}), "a.mp4") == 2
    assert refusal(capsys).endswith("a.feather: view.links: expected one of hidden, below, above, found 'up'")


# ---- several runs, and cards -----------------------------------------------------------------------------------------


def test_runs_stand_side_by_side_at_one_time_and_the_shorter_one_is_over(tmp_path: Path) -> None:
    short = read_recording(write(tmp_path / "short.feather", walkers(1, 3)))  # 1 s
    long = read_recording(write(tmp_path / "long.feather", walkers(1, 9)))  # 4 s
    grid = Grid([short, long], (800, 400 + ABOVE_PX), {"scale_bar": False}, labels=["a", "b"])
    assert (grid.columns, grid.rows, grid.cell) == (2, 1, (400, 400 + ABOVE_PX))
    for time_s in (0.5, 3.0):
        frame = grid.frame(time_s)
        for i, own in enumerate(grid.runs):
            alone = np.empty((400 + ABOVE_PX, 400, 3), np.uint8)
            own.draw(time_s, alone)
            np.testing.assert_array_equal(frame[:, 400 * i : 400 * (i + 1)], alone)
    at_end, later, last = (grid.frame(time_s).astype(int) for time_s in (1.0, 3.0, 4.0))
    np.testing.assert_array_equal(at_end[ABOVE_PX:, :400], later[ABOVE_PX:, :400])  # it stands still
    assert (at_end[:ABOVE_PX, 200:400] > 200).all()
    assert (later[:ABOVE_PX, 200:400] < 128).any()  # over
    assert (later[:ABOVE_PX, 600:] > 200).all()
    clock = np.s_[ABOVE_PX : ABOVE_PX + 30, 700:]
    assert (later[clock] < 128).any()
    assert (later[clock] != last[clock]).any()
    assert not (later[ABOVE_PX : ABOVE_PX + 8, 300:400] < 128).any()  # there is one clock


@pytest.mark.parametrize(("count", "columns", "rows"), [(1, 1, 1), (2, 2, 1), (3, 3, 1), (4, 2, 2), (5, 3, 2)])
def test_runs_are_arranged_in_rows(data: Path, count: int, columns: int, rows: int) -> None:
    grid = Grid([read_recording(data)] * count, None, {}, is_even=True)
    assert (grid.columns, grid.rows) == (columns, rows)
    assert all(side % 2 == 0 for side in grid.size)
    frame = grid.frame(0.0)
    assert frame.shape == (grid.size[1], grid.size[0], 3)
    is_red = (frame[..., 0] > 180) & (frame[..., 1:] < 50).all(axis=-1)
    found = [
        is_red[grid.cell[1] * (i // columns) :, grid.cell[0] * (i % columns) :][: grid.cell[1], : grid.cell[0]].any()
        for i in range(columns * rows)
    ]
    assert found == [i < count for i in range(columns * rows)]


def test_runs_are_labelled_by_what_differs(tmp_path: Path) -> None:
    def labels(*settings: dict[str, Any], names: tuple[str, str] = ("a.feather", "b.feather")) -> list[str]:
        paths = []
        for own, name in zip(settings, names, strict=True):
            (tmp_path / name).parent.mkdir(exist_ok=True)
            paths.append(write(tmp_path / name, walkers(), None, **own))
        return labels_of(list(names), [read_recording(path) for path in paths])

    named = {"data_filename": "x"}
    assert labels({"parameters": {"p": 0.1}, **named}, {"parameters": {"p": 0.5}}) == ["p = 0.1", "p = 0.5"]
    assert labels({"seed": 1, "time_step": 0.1}, {"seed": 2, "time_step": 0.2}) == [
        "seed = 1, time_step = 0.1",
        "seed = 2, time_step = 0.2",
    ]
    assert labels({}, named) == ["a.feather", "b.feather"]
    assert labels({}, named, names=("u/run.feather", "v/run.feather")) == ["u/run.feather", "v/run.feather"]


def test_film_of_several_runs_with_cards(data: Path, capsys: pytest.CaptureFixture[str]) -> None:
    other = write(data.parent / "other.feather", walkers(2, 7))  # 3 s
    output = data.parent / "both.mp4"
    cards = ["--title", "Schwärme $x_1$", "--subtitle", "中 ∑", "--credits", "one\nand two"]
    runs = ["--labels", "p = 0.1", "p = 0.5", "--fps", "10", "--size", "400x240"]
    assert main([str(data), str(other), "-o", str(output), *runs, *cards]) == 0
    assert capsys.readouterr().out == f"{output}: 71 frames of 400 x 240 pixels, 7.10 s\n"  # 2 s, 3.1 s and 2 s
    assert probe(output) == {"codec_name": "h264", "width": 400, "height": 240, "nb_read_frames": "71"}


def test_card_has_its_words_within_it() -> None:
    words = "many words " * 20
    blank = card((400, 240))
    assert np.ptp(blank.reshape(-1, 3), axis=0).max() == 0
    for shown in (card((400, 240), "A title"), card((400, 240), "A title", "and more"), card((400, 240), "", words)):
        assert (shown < 128).any()
        for edge in (shown[:2], shown[-2:], shown[:, :2], shown[:, -2:]):
            assert (edge == blank[0, 0]).all()


@pytest.mark.parametrize(
    ("name", "options", "said"),
    [
        ("a.mp4", ["--labels", "x", "y", "z"], "3 labels for 2 data files; give one for each (--labels)"),
        ("a.mp4", ["--labels", "x"], "1 label for 2 data files; give one for each (--labels)"),
        ("a.html", [], "a page shows one run, not 2"),
        ("a.mp4", ["--from", "9"], "it has rows from 0 s to 2 s; --from and --to leave nothing of that"),
        ("a.mp4", ["--size", "9000"], "frames of 9000 x 9000 pixels; 160 to 8192 are possible (--size)"),
    ],
)
def test_several_runs_that_cannot_be_filmed_are_one_line(
    data: Path, name: str, options: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([str(data), str(data), "-o", str(data.parent / name), *options]) == 2
    assert said in refusal(capsys)
    assert [path.name for path in data.parent.iterdir()] == ["data.feather"]


def test_second_file_that_does_not_exist_is_named(data: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(data), "none.feather", "-o", str(data.parent / "a.mp4")]) == 2
    assert refusal(capsys) == "pogosim film: cannot read 'none.feather': no such file"


def test_pages_have_no_cards(data: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert film(data, "a.html", "--title", "a") == 2
    assert "--title is for films (.mp4, .webm, .gif)" in refusal(capsys)


# ---- drawing ahead ---------------------------------------------------------------------------------------------------


def test_error_while_drawing_ends_the_film_in_its_turn() -> None:
    def three() -> Iterator[int]:
        yield from (1, 2, 3)
        raise PictureError("no more")

    taken = []
    with pytest.raises(PictureError, match="no more"):
        for item in made_ahead(three(), 1):
            taken.append(item)
    assert taken == [1, 2, 3]


def test_nothing_more_is_made_once_nothing_is_wanted() -> None:
    made = []

    def endless() -> Iterator[int]:
        for i in itertools.count():
            made.append(i)
            yield i

    ahead = made_ahead(endless(), 2)
    assert [next(ahead) for _ in range(3)] == [0, 1, 2]
    ahead.close()
    count = len(made)
    assert count <= 3 + 2 + 2
    time.sleep(0.3)
    assert len(made) == count


def test_names_that_look_like_marks_of_the_page_are_names(tmp_path: Path) -> None:
    rows = walkers(records=3).assign(**{"@@HEAD@@": 1.5}, robot_category="@@SCRIPT@@")
    data = write(tmp_path / "@@DATA@@.feather", rows)
    assert film(data, "page.html") == 0
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert "<title>@@DATA@@" in page
    assert '"@@HEAD@@"' in page


def test_colours_of_the_view_are_those_of_the_option(tmp_path: Path) -> None:
    rows = walkers()
    path = tmp_path / "a.feather"
    by_option = read_recording(write(path, rows), color_by="heard").last
    by_view = read_recording(write(path, rows, None, view={"color_by": "heard"})).last
    pd.testing.assert_frame_equal(by_view.rows, by_option.rows)
    assert read_recording(path, color_by="").last.colouring is None
    assert read_recording(path, color_by="led_rgb").last.colouring is None
    assert read_recording(write(path, rows, None, view={"color_by": "speed"})).last.colouring is not None
    write(path, rows, None, view={"color_by": "light"})
    with pytest.warns(MissingColumnWarning, match="view.color_by: the data file has no column light"):
        assert read_recording(path).last.colouring is None


def test_arrows_reach_to_where_robots_would_be_a_second_later(tmp_path: Path) -> None:
    moments = frames_of(read_recording(write(tmp_path / "a.feather", walkers(2))), velocities=True).moments
    for time_s in (0.0, 0.7, 2.0, 9.0):
        velocities = moments.at(time_s).velocities
        assert velocities is not None
        np.testing.assert_allclose(velocities, [[0.0, 100.0]] * 2, atol=1e-3)
    plain = frames_of(read_recording(tmp_path / "a.feather"), 800)
    assert plain.moments.at(0.0).velocities is None
    arrows = frames_of(read_recording(tmp_path / "a.feather"), 800, velocities=True)
    drawn = np.argwhere((pixels(arrows, 0.0) != pixels(plain, 0.0)).any(axis=2))
    lowest_mm = (drawn[:, 0].max() - ABOVE_PX - 400) / scale_of(arrows) + SIDE_MM / 2
    assert lowest_mm == pytest.approx(200.0, abs=3.0)  # 100 mm below the robot at 100 mm


def test_heat_map_of_a_value_has_the_colours_of_its_lowest_and_highest(tmp_path: Path) -> None:
    rows = walkers(2).assign(level=lambda own: np.where(own["robot_id"] == 0, 5.0, 9.0))
    path = write(tmp_path / "a.feather", rows, None, view={"heat_map": "level"})
    frames = frames_of(read_recording(path), 800)
    moment = frames.moments.at(0.0)
    np.testing.assert_array_equal(moment.heat, np.array([5.0, 9.0], np.float32))
    assert moment.heat_span == (5.0, 9.0)
    left, right = (pixels(frames, 0.0)[ABOVE_PX + 30 : ABOVE_PX + 60, x : x + 20].mean(axis=(0, 1)) for x in (190, 590))
    assert right[0] > left[0] + 100  # yellow against violet
    assert right[1] > left[1] + 100
    assert frames_of(read_recording(path), 800, heat_map="").moments.at(0.0).heat is None


def test_heat_map_of_what_the_file_does_not_have_is_told(tmp_path: Path) -> None:
    path = write(tmp_path / "a.feather", walkers(), None, view={"heat_map": "light"})
    with pytest.warns(MissingColumnWarning, match="view.heat_map: the data file has no numbers light"):
        assert frames_of(read_recording(path)).moments.at(0.0).heat is None
    with pytest.raises(PictureError, match="no column hoard; did you mean 'heard'"):
        frames_of(read_recording(path), heat_map="hoard")
    with pytest.raises(PictureError, match=r"column state holds no numbers \(heat_map\)"):
        frames_of(read_recording(path), heat_map="state")


@pytest.mark.parametrize("ending", ["gif", "html"])
def test_films_and_pages_say_the_same_of_what_is_not_there(
    tmp_path: Path, ending: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path / "a.feather", walkers(), None, view={"heat_map": "light", "color_by": "herd"})
    output = str(tmp_path / f"film.{ending}")
    assert main([str(path), "-o", output]) == 0
    said = capsys.readouterr().err
    assert said.count("view.heat_map: the data file has no numbers light") == 1
    assert said.count("view.color_by: the data file has no column herd") == 1
    for option, message in (
        ("heat_map=hoard", "no column hoard; did you mean 'heard'"),
        ("heat_map=state", "its column state holds no numbers"),
        ("follow=99", "it has no robot 99 to follow"),
        ("theme=lite", "theme: expected dark or light"),
    ):
        assert main([str(path), "-o", output, "--view", option]) == 2
        assert message in capsys.readouterr().err


def test_robot_to_follow_has_to_be_there(tmp_path: Path) -> None:
    path = write(tmp_path / "a.feather", walkers(3))
    assert frames_of(read_recording(path), follow=2).moments.painter.objects == 3
    with pytest.raises(PictureError, match="it has no robot 3 to follow"):
        frames_of(read_recording(path), follow=3)


@pytest.mark.parametrize("values", [[1.7e308, -1.7e308, 1.0], [np.nan, np.inf, -1e308], [np.nan] * 3, [4e38, 1.0, 2.0]])
def test_values_that_sums_of_would_overflow_do_not_count(tmp_path: Path, values: list[float]) -> None:
    rows = walkers(3, 5).assign(level=np.tile(values, 5))
    path = write(tmp_path / "a.feather", rows)
    frames = frames_of(read_recording(path, color_by="level"), heat_map="level")
    assert pixels(frames, 1.0).any()
    scale = frames.recording.last.colouring
    assert isinstance(scale, Scale)
    known = [value for value in values if abs(value) < 3e38]
    assert (scale.low, scale.high) == ((min(known), max(known)) if known else (0.0, 0.0))
    for ending in ("html", "gif"):
        assert main([str(path), "-o", str(tmp_path / f"film.{ending}"), "--color-by", "level", "--tail", "1e300"]) == 0
