from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import matplotlib.image as mpimg
import numpy as np
import numpy.typing as npt
import pandas as pd
import pyarrow as pa
import pytest
import yaml
from pogosim import swarm_picture
from pogosim.swarm_picture import led_brightness, led_colours, main, radii, read_swarm, round_length, thinned
from pyarrow import feather

SQUARE = [{"x": 0, "y": 0}, {"x": 400, "y": 0}, {"x": 400, "y": 400}, {"x": 0, "y": 400}]
HOLE = [{"x": 150, "y": 150}, {"x": 250, "y": 150}, {"x": 250, "y": 250}, {"x": 150, "y": 250}]


def rows(**columns: Any) -> pd.DataFrame:
    """Two robots at two times, standing still; columns may be replaced."""
    frame = {
        "time": np.float32([0, 0, 1, 1]),
        "robot_category": ["robots"] * 4,
        "robot_id": np.int32([0, 1, 0, 1]),
        "x": np.float32([100, 300, 100, 300]),
        "y": np.float32([50, 350, 50, 350]),
        "angle": np.float32([0, 0, 0, 0]),
        "led_rgb": np.int32([0x190000, 0x000019] * 2),
    }
    return pd.DataFrame({**frame, **columns})


def write(
    folder: Path,
    frame: pd.DataFrame,
    polygons: str | None = None,
    configuration: str = "objects: {robots: {type: pogobot, geometry: disk, radius: 26.5}}",
) -> Path:
    metadata = {"arena_polygons": yaml.safe_dump([SQUARE]) if polygons is None else polygons}
    table = pa.Table.from_pandas(frame, preserve_index=False)
    table = table.replace_schema_metadata({**metadata, "configuration": configuration})
    path = folder / "data.feather"
    feather.write_feather(table, path)
    return path


def picture(folder: Path, data: Path, *options: str) -> npt.NDArray[np.float64]:
    out = folder / "out.png"
    assert main([str(data), str(out), *options]) == 0
    return np.asarray(mpimg.imread(out), dtype=float)[..., :3]


def centre_of_mass(image: npt.NDArray[np.float64], channel: int) -> tuple[float, float]:
    """Mean row and column of the pixels where this channel alone is bright."""
    others = [c for c in range(3) if c != channel]
    mask = (image[..., channel] > 0.7) & (image[..., others] < 0.2).all(axis=-1)
    assert mask.sum() > 100
    r, c = np.nonzero(mask)
    return float(r.mean()), float(c.mean())


# ---- colours ---------------------------------------------------------------------------------------------------------


def test_led_is_dark_at_0_and_saturates_at_25() -> None:
    np.testing.assert_allclose(led_brightness([0, 1, 13, 25, 26, 255]) * 255, [0, 100, 155, 210, 210, 210])


def test_packed_colours_are_red_green_blue() -> None:
    np.testing.assert_allclose(led_colours([0x190000, 0x001900, 0x000019]), np.eye(3) * 210 / 255)


def test_robot_with_its_led_off_is_grey_not_black() -> None:
    (grey,) = led_colours([0])
    assert grey[0] == grey[1] == grey[2] > 0.3


# ---- reading ---------------------------------------------------------------------------------------------------------


def test_radius_is_that_of_the_disk_around_the_shape() -> None:
    objects = {
        "robots": {"radius": "2.65e1"},
        "box": {"geometry": "Rectangle", "body_width": 30, "body_height": 40},
        "tri": {"geometry": "triangle", "side_length": 30},
        "plain": {},
        "odd": {"radius": "large"},
        "text": "not a map",
    }
    assert radii({"objects": objects}) == pytest.approx(
        {"robots": 26.5, "box": 25.0, "tri": 30 / math.sqrt(3), "plain": 26.5, "odd": 26.5}
    )
    assert radii({}) == radii({"objects": [1]}) == {}


def test_walls_without_a_pose_and_parts_of_membranes_are_left_out(tmp_path: Path) -> None:
    frame = rows(x=np.float32([100, np.nan, 100, np.nan]), subpart_id=np.int16([-1, -1, 5, -1]))
    assert len(read_swarm(write(tmp_path, frame)).rows) == 1


def test_only_the_first_of_several_runs_is_drawn(tmp_path: Path) -> None:
    swarm = read_swarm(write(tmp_path, rows(run=[3, 3, 2, 2])))
    assert swarm.rows["run"].tolist() == [2, 2]


def test_same_id_in_two_categories_means_two_objects(tmp_path: Path) -> None:
    frame = rows(robot_id=np.int32([0, 0, 0, 0]), robot_category=["a", "b", "a", "b"])
    assert read_swarm(write(tmp_path, frame)).rows["object"].tolist() == [0, 1, 0, 1]


def test_without_polygons_the_floor_is_the_box_around_all_robots(tmp_path: Path) -> None:
    (box,) = read_swarm(write(tmp_path, rows(), polygons="")).polygons
    assert box.min(axis=0).tolist() == [100 - 26.5, 50 - 26.5]
    assert box.max(axis=0).tolist() == [300 + 26.5, 350 + 26.5]


def test_thinning_keeps_the_first_and_last_time() -> None:
    frame = pd.DataFrame({"time": np.repeat(np.arange(1000), 3)})
    thin = thinned(frame, 7)
    assert thin["time"].nunique() == 7
    assert thin["time"].min() == 0
    assert thin["time"].max() == 999
    assert len(thin) == 21
    assert len(thinned(frame, 1000)) == 3000


def test_step_across_the_seam_of_a_periodic_arena_is_no_line() -> None:
    frame = pd.DataFrame({"object": 0, "time": range(4), "x": [300.0, 390.0, 10.0, 60.0], "y": 5.0})
    segments, ends = swarm_picture.trail_segments(frame, np.array([400.0, 400.0]))
    np.testing.assert_array_equal(segments[:, :, 0], [[300, 390], [10, 60]])
    assert ends["time"].tolist() == [1, 3]


def test_trails_do_not_join_different_objects() -> None:
    frame = pd.DataFrame({"object": [0, 1, 0, 1], "time": [0, 0, 1, 1], "x": [0.0, 9.0, 1.0, 8.0], "y": 0.0})
    segments, _ = swarm_picture.trail_segments(frame, np.array([400.0, 400.0]))
    np.testing.assert_array_equal(segments[:, :, 0], [[0, 1], [9, 8]])


@pytest.mark.parametrize(("width", "length"), [(1128.7, 200), (400, 100), (40, 10), (8000, 2000), (0.9, 0.2)])
def test_scale_bar_is_round_and_at_most_a_quarter(width: float, length: float) -> None:
    assert round_length(width) == pytest.approx(length)


# ---- drawing ---------------------------------------------------------------------------------------------------------


def test_robots_stand_in_their_led_colours_where_they_ended_with_y_downwards(tmp_path: Path) -> None:
    frame = rows(x=np.float32([300, 300, 100, 300]), y=np.float32([350, 50, 50, 350]))
    image = picture(tmp_path, write(tmp_path, frame), "--tail", "0.001")
    red, blue = centre_of_mass(image, 0), centre_of_mass(image, 2)
    assert red[0] < blue[0]  # red ended at y = 50: above
    assert red[1] < blue[1]  # and at x = 100: left
    # 200 mm to the right and 300 mm down, by one scale.
    assert (blue[0] - red[0]) / (blue[1] - red[1]) == pytest.approx(1.5, rel=0.02)


def test_disks_have_the_true_radius(tmp_path: Path) -> None:
    image = picture(tmp_path, write(tmp_path, rows()), "--tail", "0.001")
    red, blue = centre_of_mass(image, 0), centre_of_mass(image, 2)
    pixels_per_mm = (blue[1] - red[1]) / 200
    mask = (image[..., 0] > 0.7) & (image[..., 1:] < 0.2).all(axis=-1)
    columns = np.flatnonzero(mask.any(axis=0))
    width_mm = (columns[-1] - columns[0]) / pixels_per_mm
    assert width_mm == pytest.approx(53.0, rel=0.05)


@pytest.mark.parametrize("turned", [False, True])
def test_hole_of_the_arena_shows_the_paper_whatever_its_winding(tmp_path: Path, turned: bool) -> None:
    hole = HOLE[::-1] if turned else HOLE
    image = picture(tmp_path, write(tmp_path, rows(), polygons=yaml.safe_dump([SQUARE, hole])))
    red, blue = centre_of_mass(image, 0), centre_of_mass(image, 2)
    middle = image[round((red[0] + blue[0]) / 2), round((red[1] + blue[1]) / 2)]
    assert middle.tolist() == [1.0, 1.0, 1.0]


def test_dpi_scales_the_picture(tmp_path: Path) -> None:
    data = write(tmp_path, rows())
    small, large = picture(tmp_path, data, "--dpi", "50"), picture(tmp_path, data, "--dpi", "100")
    assert large.shape[0] == pytest.approx(2 * small.shape[0], abs=2)


@pytest.mark.parametrize(
    "frame",
    [
        rows().drop(columns="led_rgb"),
        rows().drop(columns=["robot_category", "robot_id", "angle", "led_rgb"]),
        rows(angle=np.float32([np.nan] * 4)),
        rows().iloc[:1],
        rows(x=np.float32([100, np.nan, np.nan, 300])),
        rows(led_rgb=np.int32([0] * 4)),
    ],
    ids=["no leds", "places only", "no angles", "one row", "gaps", "dark"],
)
def test_what_is_missing_in_a_file_does_not_stop_the_picture(tmp_path: Path, frame: pd.DataFrame) -> None:
    assert picture(tmp_path, write(tmp_path, frame), "--dpi", "40").size > 0


# ---- errors ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("frame", "polygons", "message"),
    [
        (rows().drop(columns=["x", "time"]), None, "it has no column time, x"),
        (rows().iloc[:0], None, "no object with a position"),
        (rows(x=np.float32([np.nan] * 4)), None, "no object with a position"),
        (rows(), "[1, 2]", "'arena_polygons'"),
        (rows(), "[[{x: 1}]]", "'arena_polygons'"),
        (rows(), "[[", "'arena_polygons'"),
    ],
)
def test_file_that_cannot_be_drawn_ends_with_its_reason_and_code_2(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], frame: pd.DataFrame, polygons: str | None, message: str
) -> None:
    data = write(tmp_path, frame, polygons)
    assert main([str(data), str(tmp_path / "out.png")]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert str(data) in error


def test_missing_file_and_unwritable_picture_end_with_code_2(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([str(tmp_path / "none.feather"), str(tmp_path / "out.png")]) == 2
    assert "none.feather" in capsys.readouterr().err
    data = write(tmp_path, rows())
    assert main([str(data), str(tmp_path / "no folder" / "out.png")]) == 2
    assert "no folder" in capsys.readouterr().err
    assert main([str(data), str(tmp_path / "out.xyz")]) == 2
    assert "xyz" in capsys.readouterr().err


@pytest.mark.parametrize("options", [[], ["a"], ["a", "b", "c"], ["a", "b", "--dpi", "0"], ["a", "b", "--tail", "nan"]])
def test_wrong_usage_ends_with_code_2(options: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(options)
    assert ended.value.code == 2
    assert "usage" in capsys.readouterr().err
