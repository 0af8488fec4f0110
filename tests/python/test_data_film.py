"""pogosim film: what its frames show, and what it says of bad input."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from pogosim.film.brush import DISK
from pogosim.film.command import main
from pogosim.film.making import frame_times
from pogosim.film.stills import Look, Stills, size_for
from pogosim.film.timeline import Timeline, timeline_of
from pogosim.picture import layers
from pogosim.picture.links import links_at_end
from pogosim.picture.swarm import OBJECT, Recording, read_recording
from pogosim.utils import load_dataframe
from recordings import walkers, write


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


def pixels(stills: Stills, time_s: float) -> npt.NDArray[np.uint8]:
    frame = np.frombuffer(stills.frame(time_s), np.uint8).reshape(stills.size[1], stills.size[0], 4)
    return frame[..., :3].astype(int)


def height_of_red(image: npt.NDArray[np.uint8]) -> float:
    mask = (image[..., 0] > 180) & (image[..., 1:] < 50).all(axis=-1)
    assert mask.sum() > 20
    return float(np.nonzero(mask)[0].mean())


def test_frames_show_robots_on_their_way_and_forget_where_they_were(data: Path) -> None:
    recording = read_recording(data)
    stills = Stills(recording, size_for(recording, None, is_even=True), Look())
    start, quarter, end = (pixels(stills, time_s) for time_s in (0.0, 0.25, 2.0))
    scale = (height_of_red(end) - height_of_red(start)) / 200.0
    assert scale == pytest.approx(0.72 / 1.04, rel=0.02)  # pixels per mm
    assert height_of_red(quarter) - height_of_red(start) == pytest.approx(25.0 * scale, abs=0.7)
    np.testing.assert_array_equal(pixels(stills, 0.0), start)


def test_light_of_a_lamp_that_goes_on_appears(tmp_path: Path) -> None:
    lamp = {"type": "static_light", "geometry": "disk", "x": 500, "y": 800, "radius": 100, "value": 0}
    flash = {"photo_start_at": 1.0, "photo_start_duration": 0.5, "photo_start_value": 500}
    recording = read_recording(write(tmp_path / "a.feather", walkers(), {"lamp": {**lamp, **flash}}))
    stills = Stills(recording, (400, 400), Look())
    brightness = [pixels(stills, time_s).mean() for time_s in (0.9, 1.1, 1.6)]
    assert brightness[1] > brightness[0] + 0.3
    assert brightness[1] > brightness[2] + 0.3


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


# ---- the same picture, drawn faster ----------------------------------------------------------------------------------


def mixed(folder: Path, **settings: str) -> Recording:
    """Robots, boxes, wedges and a mute ball, some at walls, some beyond them, on curved ways."""
    random = np.random.default_rng(3)
    rows = walkers(24, 21)
    time, number = rows["time"].to_numpy(), rows["robot_id"].to_numpy()
    middle = random.uniform(0, 1000, (24, 2))[number]
    turn = time + number
    shapes = np.array(["robots", "robots", "robots", "boxes", "wedges", "balls"])
    rows = rows.assign(
        x=middle[:, 0] + 60 * np.cos(turn),
        y=middle[:, 1] + 60 * np.sin(turn),
        angle=np.where(number == 6, np.nan, np.angle(np.exp(1j * turn))),
        robot_category=shapes[number % 6],
    )
    objects = {
        "boxes": {"type": "active_object", "geometry": "rectangle", "body_width": 90, "body_height": 40},
        "wedges": {"type": "pogobject", "geometry": "triangle", "side_length": 80},
        "balls": {"type": "passive_object", "geometry": "disk", "radius": 40},
    }
    if settings.get("boundary_condition") == "periodic":
        rows[["x", "y"]] %= 1000.0
    return read_recording(write(folder / "mixed.feather", rows, objects, **settings))


@pytest.mark.parametrize("boundary", ["solid", "periodic"])
@pytest.mark.parametrize("look", [Look(), Look(links=True), Look(tail_s=3.0)], ids=["bodies", "links", "trails"])
def test_frame_shows_what_a_picture_shows(tmp_path: Path, look: Look, boundary: str) -> None:
    recording = mixed(tmp_path, boundary_condition=boundary)
    stills = Stills(recording, (720, 800), look)
    frame = pixels(stills, 6.0)[40:-45]

    swarm = recording.until(6.0)
    stills.canvas.restore_region(stills.still)
    for artist in [*stills.axes.collections, *stills.axes.patches]:
        artist.remove()
    if look.tail_s:
        layers.draw_trails(stills.axes, swarm, stills.floor, look.tail_s, 60)
    if look.links:
        layers.draw_links(stills.axes, links_at_end(swarm), stills.floor)
    layers.draw_bodies(stills.axes, swarm, stills.floor)
    layers.draw_border(stills.axes, swarm)
    for artist in sorted([*stills.axes.collections, *stills.axes.patches], key=lambda one: one.get_zorder()):
        artist.draw(stills.canvas.get_renderer())
    picture = np.array(stills.canvas.buffer_rgba())[40:-45, :, :3].astype(int)

    difference = np.abs(frame - picture).max(axis=-1)
    assert difference.mean() < 0.5
    assert (difference > 40).mean() < 0.002


def place_of(stills: Stills, x_mm: float, y_mm: float) -> tuple[int, int]:
    """Row and column of a place in the arena."""
    x, y = stills.axes.transData.transform((x_mm, y_mm))
    return int(stills.size[1] - y), int(x)


def test_jump_leaves_no_trail(tmp_path: Path) -> None:
    rows = walkers(1, 2).assign(x=np.array([900.0, 100.0]), y=500.0)
    stills = Stills(read_recording(write(tmp_path / "jump.feather", rows)), (400, 400), Look(tail_s=1.0))
    assert pixels(stills, 0.5)[place_of(stills, 500, 500)].max() < 40  # the floor


def test_glow_ends_at_the_wall(tmp_path: Path) -> None:
    rows = walkers(1, 2).assign(x=20.0, y=500.0)
    stills = Stills(read_recording(write(tmp_path / "wall.feather", rows)), (720, 800), Look())
    image = pixels(stills, 0.0)
    assert image[place_of(stills, -13.0, 500)].tolist() == [255, 255, 255]
    assert image[place_of(stills, 52.0, 500)][0] > 30


def test_robot_at_a_periodic_border_comes_back_on_the_other_side(tmp_path: Path) -> None:
    rows = walkers(1, 2).assign(x=995.0, y=500.0)
    recording = read_recording(write(tmp_path / "border.feather", rows, boundary_condition="periodic"))
    stills = Stills(recording, (720, 800), Look())
    image = pixels(stills, 0.0)
    for x_mm in (980.0, 12.0):
        assert np.ptp(image[place_of(stills, x_mm, 500)]) > 100  # red
    assert image[place_of(stills, 1014.0, 500)].tolist() == [255, 255, 255]


def test_headings_stand_out_from_bright_and_dark_colours(data: Path) -> None:
    stills = Stills(read_recording(data), (720, 800), Look())
    image = pixels(stills, 0.0)
    assert image[place_of(stills, 500, 116)].max() < 60  # green
    assert image[place_of(stills, 2500 / 3, 116)].min() > 200  # blue


@pytest.mark.parametrize("options", [Look(), Look(3.0, True)])
def test_frames_are_the_same_each_time_and_whatever_came_before(tmp_path: Path, options: Look) -> None:
    recording = mixed(tmp_path)
    first, other = (Stills(recording, (320, 320), options) for _ in range(2))
    for time_s in (0.0, 7.3, 2.0):
        other.frame(time_s)
    assert other.frame(4.13) == first.frame(4.13)


def test_slow_robot_moves_by_parts_of_a_pixel(tmp_path: Path) -> None:
    stills = Stills(read_recording(write(tmp_path / "slow.feather", walkers())), (400, 400), Look())
    heights = []
    for time_s in np.arange(0.0, 0.1, 0.01):
        image = pixels(stills, time_s)
        red = np.clip(image[..., 0] - image[..., 1:].max(axis=-1), 0, None).astype(float)
        heights.append(float(red.sum(axis=1) @ np.arange(400) / red.sum()))
    scale = stills.axes.transData.get_matrix()[0, 0]  # pixels per mm
    assert np.array(heights) - heights[0] == pytest.approx(np.arange(10) * scale, abs=0.13)  # an eighth of a pixel


def test_many_sizes_of_disks_do_not_fill_the_memory(tmp_path: Path) -> None:
    stills = Stills(mixed(tmp_path), (320, 320), Look())
    stills.frame(0.0)
    brush = stills.brush
    for radius in range(100, 1500, 50):
        brush.stamp(DISK, float(radius), 0, 0)
        assert sum(own.width * own.height for own in brush.stamps.values()) < 80e6


def test_names_that_look_like_marks_of_the_page_are_names(tmp_path: Path) -> None:
    rows = walkers(records=3).assign(**{"@@HEAD@@": 1.5}, robot_category="@@SCRIPT@@")
    data = write(tmp_path / "@@DATA@@.feather", rows)
    assert film(data, "page.html") == 0
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert "<title>@@DATA@@" in page
    assert '"@@HEAD@@"' in page
