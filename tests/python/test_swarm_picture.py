from __future__ import annotations

import math
import os
from pathlib import Path
from typing import Any

import matplotlib.image as mpimg
import numpy as np
import numpy.typing as npt
import pandas as pd
import pyarrow as pa
import pytest
import yaml
from matplotlib.colors import to_rgb
from pogosim import swarm_picture
from pogosim.picture.images import seen_places
from pogosim.picture.palette import PALETTE
from pogosim.picture.swarm import OBJECT
from pogosim.swarm_picture import led_brightness, led_colours, main, read_swarm, round_length, thinned
from pyarrow import feather

SQUARE = [{"x": 0, "y": 0}, {"x": 400, "y": 0}, {"x": 400, "y": 400}, {"x": 0, "y": 400}]
HOLE = [{"x": 150, "y": 150}, {"x": 250, "y": 150}, {"x": 250, "y": 250}, {"x": 150, "y": 250}]


def rows(**columns: Any) -> pd.DataFrame:
    """Two robots at two times, standing still; columns may be replaced."""
    frame = {
        "time": np.array([0, 0, 1, 1], np.float32),
        "robot_category": ["robots"] * 4,
        "robot_id": np.array([0, 1, 0, 1], np.int32),
        "x": np.array([100, 300, 100, 300], np.float32),
        "y": np.array([50, 350, 50, 350], np.float32),
        "angle": np.array([0, 0, 0, 0], np.float32),
        "led_rgb": np.array([0x190000, 0x000019] * 2, np.int32),
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


def test_walls_without_a_pose_and_parts_of_membranes_are_left_out(tmp_path: Path) -> None:
    frame = rows(x=np.array([100, np.nan, 100, np.nan], np.float32), subpart_id=np.array([-1, -1, 5, -1], np.int16))
    assert len(read_swarm(write(tmp_path, frame)).rows) == 1


def test_only_the_first_of_several_runs_is_drawn(tmp_path: Path) -> None:
    swarm = read_swarm(write(tmp_path, rows(run=[3, 3, 2, 2])))
    assert swarm.rows["run"].tolist() == [2, 2]


@pytest.mark.parametrize("own", [[True, False, True, False], [0.5, 1.5, 0.5, 1.5], ["a", "b", "a", "b"]])
def test_column_of_a_program_that_is_called_run_hides_no_robot(tmp_path: Path, own: list[object]) -> None:
    swarm = read_swarm(write(tmp_path, rows(run=own)))
    assert len(swarm.rows) == 4


@pytest.mark.parametrize("several", [False, True])
def test_column_run_in_the_file_of_one_run_hides_no_robot(tmp_path: Path, several: bool) -> None:
    frame = pd.concat([rows(run=[7] * 4), rows(run=[8] * 4)]) if several else rows(run=[7, 8, 7, 8])
    data = write(tmp_path, frame)
    table = feather.read_table(data)
    feather.write_feather(table.replace_schema_metadata({**table.schema.metadata, "program_version": "1"}), data)
    assert len(read_swarm(data).rows) == 4


def test_same_id_in_two_categories_means_two_objects(tmp_path: Path) -> None:
    frame = rows(robot_id=np.array([0, 0, 0, 0], np.int32), robot_category=["a", "b", "a", "b"])
    assert read_swarm(write(tmp_path, frame)).rows[OBJECT].tolist() == [0, 1, 0, 1]


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


def test_jump_over_half_the_arena_is_no_line() -> None:
    frame = pd.DataFrame({OBJECT: 0, "time": range(4), "x": [300.0, 390.0, 10.0, 60.0], "y": 5.0})
    segments, ends = swarm_picture.trail_segments(frame, np.array([400.0, 400.0]))
    np.testing.assert_array_equal(segments[:, :, 0], [[300, 390], [10, 60]])
    assert ends["time"].tolist() == [1, 3]


def test_step_across_the_border_of_a_periodic_arena_is_a_line_from_either_end() -> None:
    frame = pd.DataFrame({OBJECT: 0, "time": range(4), "x": [300.0, 390.0, 10.0, 60.0], "y": 5.0})
    box = (np.zeros(2), np.full(2, 400.0))
    segments, ends = swarm_picture.trail_segments(frame, np.array([400.0, 400.0]), box)
    np.testing.assert_array_equal(segments[:, :, 0], [[300, 390], [390, 410], [10, 60], [10, -10]])
    assert ends["time"].tolist() == [1, 2, 3, 2]


def test_body_is_seen_from_every_border_of_a_periodic_arena_that_it_crosses() -> None:
    box = (np.array([-100.0, 0.0]), np.array([300.0, 200.0]))
    place = np.array([[100.0, 100.0], [-95.0, 100.0], [290.0, 195.0]])
    which, seen = seen_places(place, 20.0, box)
    corner = [(290, 195), (290, -5), (-110, 195), (-110, -5)]
    assert which.tolist() == [0, 1, 1, 2, 2, 2, 2]
    assert sorted(map(tuple, seen.tolist())) == sorted([(100, 100), (-95, 100), (305, 100), *corner])
    which, seen = seen_places(place, 20.0, None)
    assert which.tolist() == [0, 1, 2]
    assert seen.tolist() == place.tolist()


def test_trails_do_not_join_different_objects() -> None:
    frame = pd.DataFrame({OBJECT: [0, 1, 0, 1], "time": [0, 0, 1, 1], "x": [0.0, 9.0, 1.0, 8.0], "y": 0.0})
    segments, _ = swarm_picture.trail_segments(frame, np.array([400.0, 400.0]))
    np.testing.assert_array_equal(segments[:, :, 0], [[0, 1], [9, 8]])


@pytest.mark.parametrize(("width", "length"), [(1128.7, 200), (400, 100), (40, 10), (8000, 2000), (0.9, 0.2)])
def test_scale_bar_is_round_and_at_most_a_quarter(width: float, length: float) -> None:
    assert round_length(width) == pytest.approx(length)


# ---- drawing ---------------------------------------------------------------------------------------------------------


def test_robots_stand_in_their_led_colours_where_they_ended_with_y_downwards(tmp_path: Path) -> None:
    frame = rows(x=np.array([300, 300, 100, 300], np.float32), y=np.array([350, 50, 50, 350], np.float32))
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


class Map:
    """A picture whose pixels are asked for in mm, by a red robot at (100, 50) and a blue one at (300, 350)."""

    def __init__(self, image: npt.NDArray[np.float64]) -> None:
        self.image = image
        red, blue = centre_of_mass(image, 0), centre_of_mass(image, 2)
        self.pixels_per_mm = (blue[1] - red[1]) / 200
        self.origin = (red[0] - 50 * self.pixels_per_mm, red[1] - 100 * self.pixels_per_mm)

    def at(self, x: float, y: float) -> npt.NDArray[np.float64]:
        row, column = (round(start + self.pixels_per_mm * mm) for start, mm in zip(self.origin, (y, x), strict=True))
        return np.asarray(self.image[row, column])

    def brightness(self, x: float, y: float) -> float:
        return float(self.at(x, y).mean())


ROBOTS = {"robots": {"type": "pogobot", "geometry": "disk", "radius": 26.5}}


def scene(folder: Path, objects: dict[str, Any], extra: pd.DataFrame | None = None) -> Map:
    """Two robots and other objects."""
    frame = rows(subpart_id=np.array([-1] * 4, np.int16))
    if extra is not None:
        frame = pd.concat([frame, extra])
    configuration = yaml.safe_dump({"objects": {**ROBOTS, **objects}})
    return Map(picture(folder, write(folder, frame, configuration=configuration), "--tail", "0.001"))


def periodic_map(folder: Path, objects: dict[str, Any], frame: pd.DataFrame) -> Map:
    """Two robots and other objects in a periodic arena, with their trails."""
    configuration = yaml.safe_dump({"boundary_condition": "periodic", "objects": {**ROBOTS, **objects}})
    frame = pd.concat([rows(subpart_id=np.array([-1] * 4, np.int16)), frame])
    return Map(picture(folder, write(folder, frame, configuration=configuration)))


def is_paper(colour: npt.NDArray[np.float64]) -> bool:
    return bool(np.abs(colour - to_rgb(PALETTE["paper"])).max() < 0.02)


def test_robot_at_a_periodic_border_is_seen_on_both_sides_and_ends_at_the_border(tmp_path: Path) -> None:
    objects = {"others": ROBOTS["robots"]}
    frame = others("others", [395], [200], angle=math.pi / 2)
    picture_mm = periodic_map(tmp_path, objects, frame)
    assert is_green(picture_mm.at(380, 200))  # the robot itself
    assert is_green(picture_mm.at(15, 200))  # its other part
    assert not is_green(picture_mm.at(25, 200))  # 26.5 mm - 5 mm is where that ends
    assert is_paper(picture_mm.at(405, 200))  # beyond the border

    plain = yaml.safe_dump({"objects": {**ROBOTS, **objects}})
    walled = Map(picture(tmp_path, write(tmp_path, pd.concat([rows(), frame]), configuration=plain)))
    assert not is_green(walled.at(15, 200))


def test_robot_in_the_corner_of_a_periodic_arena_is_seen_in_all_four(tmp_path: Path) -> None:
    picture_mm = periodic_map(tmp_path, {"others": ROBOTS["robots"]}, others("others", [398], [2], angle=0.5))
    for x, y in ((390, 10), (10, 10), (390, 390), (10, 390)):
        assert is_green(picture_mm.at(x, y))


def test_way_across_a_periodic_border_is_drawn_on_both_sides(tmp_path: Path) -> None:
    way = [others("others", [x], [200]).assign(time=np.float32(time)) for time, x in ((0, 310.0), (1, 90.0))]
    picture_mm = periodic_map(tmp_path, {"others": ROBOTS["robots"]}, pd.concat(way))
    for x in (360.0, 30.0):
        assert max(picture_mm.at(x, y)[1] for y in np.arange(198.5, 201.6, 0.25)) > 0.3
    assert is_floor(picture_mm.at(200, 200))


def test_membrane_across_a_periodic_border_is_one_ring(tmp_path: Path) -> None:
    turn = 2 * np.pi * np.arange(60) / 60
    x, y = ((370 + 80 * np.cos(turn)) % 400).tolist(), (200 + 80 * np.sin(turn)).tolist()
    ring = {"type": "membrane", "geometry": "disk", "radius": 300, "dot_radius": 6}
    picture_mm = periodic_map(tmp_path, {"ring": ring}, others("ring", x, y))
    for place in range(0, 60, 7):
        assert is_green(picture_mm.at(x[place], y[place]))
    assert is_floor(picture_mm.at(200, 200))  # no line leads across the arena
    assert is_floor(picture_mm.at(200, y[10]))


def others(category: str, x: list[float], y: list[float], angle: float = 0.0, led: int = 0x001900) -> pd.DataFrame:
    """Rows of one object at the end; more than one place makes them its parts, after a first row for all of it."""
    xs, ys = (x[:1] + x, y[:1] + y) if len(x) > 1 else (x, y)
    return rows(
        time=np.array([1] * len(xs), np.float32),
        robot_category=[category] * len(xs),
        robot_id=np.array([65535] * len(xs), np.int32),
        x=np.array(xs, np.float32),
        y=np.array(ys, np.float32),
        angle=np.array([angle] * len(xs), np.float32),
        led_rgb=np.array([led] * len(xs), np.int32),
        subpart_id=np.array([-1, *range(len(xs) - 1)], np.int16),
    )


def is_green(colour: npt.NDArray[np.float64]) -> bool:
    return bool(colour[1] > 0.7 and colour[0] < 0.2 and colour[2] < 0.2)


def is_floor(colour: npt.NDArray[np.float64]) -> bool:
    return bool(colour.max() < 0.15)


@pytest.mark.parametrize("turned", [False, True])
def test_rectangles_are_drawn_as_they_are_and_turned(tmp_path: Path, turned: bool) -> None:
    box = {"type": "active_object", "geometry": "rectangle", "body_width": 120, "body_height": 40}
    angle = math.pi / 2 if turned else 0.0
    picture_mm = scene(tmp_path, {"box": box}, others("box", [200], [200], angle))
    # Beside the tick, which is on the axis.
    along, across = ((190, 255), (255, 210)) if turned else ((255, 210), (190, 255))
    assert is_green(picture_mm.at(*along))
    assert not is_green(picture_mm.at(*across))
    assert is_green(picture_mm.at(185, 185))


def test_triangle_at_heading_0_has_a_corner_up(tmp_path: Path) -> None:
    wedge = {"type": "active_object", "geometry": "triangle", "side_length": 120}
    picture_mm = scene(tmp_path, {"wedge": wedge}, others("wedge", [200], [200]))
    assert is_green(picture_mm.at(200, 200 - 60))  # the corner is 69 mm up, the side below 35 mm down
    assert is_green(picture_mm.at(155, 228))
    assert not is_green(picture_mm.at(155, 165))
    assert not is_green(picture_mm.at(200, 245))


def test_passive_object_has_no_led_that_glows(tmp_path: Path) -> None:
    ball = {"type": "passive_object", "geometry": "disk", "radius": 40}
    picture_mm = scene(tmp_path, {"ball": ball}, others("ball", [200], [200], led=0))
    assert 0.3 < picture_mm.brightness(200, 185) < 0.5
    assert is_floor(picture_mm.at(200, 250))


def test_membrane_lies_where_its_dots_do(tmp_path: Path) -> None:
    turn = 2 * np.pi * np.arange(60) / 60
    x, y = (200 + 80 * np.cos(turn)).tolist(), (200 + 80 * np.sin(turn)).tolist()
    ring = {"type": "membrane", "geometry": "disk", "radius": 300, "dot_radius": 6}
    picture_mm = scene(tmp_path, {"ring": ring}, others("ring", x, y))
    for place in range(0, 60, 7):
        assert is_green(picture_mm.at(x[place], y[place]))
    assert is_floor(picture_mm.at(200, 200))
    assert is_floor(picture_mm.at(280 + 12, 200))


def test_membrane_without_dots_in_the_file_is_a_mark_and_a_note(tmp_path: Path) -> None:
    ring = {"type": "membrane", "geometry": "disk", "radius": 100, "dot_radius": 6}
    picture_mm = scene(tmp_path, {"ring": ring}, others("ring", [200], [200]))
    assert is_floor(picture_mm.at(200, 200))
    assert is_floor(picture_mm.at(240, 200))
    swarm = read_swarm(tmp_path / "data.feather")
    assert swarm_picture.notes(swarm) == "not drawn: the shape of ring (serialize_dot_pose)"


def test_lamp_brightens_the_floor_and_an_even_light_does_not(tmp_path: Path) -> None:
    even = {"type": "static_light", "geometry": "global", "value": 20000}
    spot = {"type": "static_light", "geometry": "disk", "x": 200, "y": 300, "radius": 40, "value": 300}
    dark = scene(tmp_path, {}).image
    np.testing.assert_array_equal(scene(tmp_path, {"even": even}).image, dark)
    lit = scene(tmp_path, {"spot": spot})
    assert lit.brightness(200, 330) > lit.brightness(200, 350) + 0.1
    assert is_floor(lit.at(200, 350))


def test_lighthouse_is_a_note(tmp_path: Path) -> None:
    scene(tmp_path, {"tower": {"type": "rotating_ray_of_light", "geometry": "global"}})
    assert swarm_picture.notes(read_swarm(tmp_path / "data.feather")) == "not drawn: beams of tower"


def test_shadows_are_a_note(tmp_path: Path) -> None:
    spot = {"type": "static_light", "geometry": "disk", "x": 200, "y": 300, "radius": 40, "value": 300}
    scene(tmp_path, {"spot": {**spot, "casts_shadows": True}, "other": {**spot, "casts_shadows": False}})
    assert swarm_picture.notes(read_swarm(tmp_path / "data.feather")) == "not drawn: shadows of spot"


def test_wall_with_a_program_glows_in_the_colour_of_its_led(tmp_path: Path) -> None:
    wall = others("walls", [200.0], [200.0], 0.0)
    picture_mm = scene(tmp_path, {"walls": {"type": "pogowall", "geometry": "arena"}}, wall)
    assert is_floor(scene(tmp_path, {}).at(4, 200))
    assert is_floor(picture_mm.at(200, 200))  # where the row of the wall says it is
    red, green, blue = picture_mm.at(4, 200)
    assert green > max(red, blue) + 0.1
    island = {"type": "pogowall", "geometry": "disk", "radius": 50, "x": 200, "y": 200}
    picture_mm = scene(tmp_path, {"walls": island}, wall)
    assert is_green(picture_mm.at(250, 200))
    assert is_floor(picture_mm.at(200, 200))
    assert is_floor(picture_mm.at(4, 200))


def test_title_counts_in_words(tmp_path: Path) -> None:
    frame = pd.concat(
        [others(name, [x], [200]) for name, x in (("glass", 50), ("membranes", 300))]
        + [others("active_objects", [x], [100]).assign(robot_id=np.int32(x)) for x in (100, 200)]
    )
    title = swarm_picture.title(read_swarm(write(tmp_path, frame)), 8.0).replace("\u00a0", " ")
    assert title.startswith("2 active objects, 1 glass, 1 membrane after ")


def test_long_notes_stay_beside_the_scale_bar(tmp_path: Path) -> None:
    towers = {f"lighthouse_{i}": {"type": "rotating_ray_of_light", "geometry": "global"} for i in range(9)}
    scene(tmp_path, towers)
    figure = swarm_picture.draw(read_swarm(tmp_path / "data.feather"))
    figure.canvas.draw()
    boxes = {text.get_text()[:3]: text.get_window_extent() for text in figure.axes[0].texts}
    assert boxes["not"].x0 > boxes["100"].x1
    assert boxes["not"].y0 >= 0


def test_long_title_has_several_lines(tmp_path: Path) -> None:
    frame = pd.concat([others(f"category_{i}", [200], [200]) for i in range(12)])
    lines = swarm_picture.title(read_swarm(write(tmp_path, frame)), 8.0).splitlines()
    assert len(lines) > 1
    assert max(len(line) for line in lines) <= 68


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
        rows(angle=np.array([np.nan] * 4, np.float32)),
        rows().iloc[:1],
        rows(x=np.array([100, np.nan, np.nan, 300], np.float32)),
        rows(led_rgb=np.array([0] * 4, np.int32)),
        rows(own=[{"a": 1}] * 4),
        rows(led_rgb=["red"] * 4, subpart_id=[0.5] * 4),
        rows(robot_category=["robots", None, "robots", None]),
    ],
    ids=["no leds", "places only", "no angles", "one row", "gaps", "dark", "maps", "own columns", "no names"],
)
def test_what_is_missing_in_a_file_does_not_stop_the_picture(tmp_path: Path, frame: pd.DataFrame) -> None:
    assert picture(tmp_path, write(tmp_path, frame), "--dpi", "40").size > 0


# ---- errors ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("frame", "polygons", "message"),
    [
        (rows().drop(columns=["x", "time"]), None, "it has no column time, x"),
        (rows().iloc[:0], None, "no object with a position"),
        (rows(x=np.array([np.nan] * 4, np.float32)), None, "no object with a position"),
        (rows(x=[{"a": 1}] * 4), None, "its column x does not hold numbers"),
        (rows(time=["0", "0", "1", "1"]), None, "its column time does not hold numbers"),
        (rows(robot_category=[{"a": 1}] * 4), None, "its column robot_category does not hold names"),
        (rows(robot_id=[{"a": 1}] * 4), None, "its column robot_id does not hold numbers"),
        (rows(), "[1, 2]", "'arena_polygons'"),
        (rows(), "[[{x: 1}]]", "'arena_polygons'"),
        (rows(), "[[", "'arena_polygons'"),
        (rows(), "[[{x: 0, y: 0}, {x: .nan, y: 1}, {x: 1, y: 1}]]", "'arena_polygons' has corners that are not finite"),
        (rows(), "[[{x: 0, y: 0}, {x: 0, y: 1}, {x: 0, y: 2}]]", "'arena_polygons' has an outer wall without width"),
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
    none = tmp_path / "none.feather"
    assert main([str(none), str(tmp_path / "out.png")]) == 2
    assert capsys.readouterr().err == f"swarm_picture: cannot read '{none}': no such file\n"
    assert main([str(tmp_path), str(tmp_path / "out.png")]) == 2
    assert capsys.readouterr().err == f"swarm_picture: cannot read '{tmp_path}': is a directory\n"
    data = write(tmp_path, rows())
    picture = tmp_path / "no folder" / "out.png"
    assert main([str(data), str(picture)]) == 2
    assert "no folder" in capsys.readouterr().err
    assert main([str(data), str(tmp_path / "out.xyz")]) == 2
    assert "xyz" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["data.png", "./data.png", "symbolic.png", "hard.png"])
def test_picture_in_the_place_of_its_data_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.chdir(tmp_path)
    data = write(tmp_path, rows()).rename("data.png")
    Path("symbolic.png").symlink_to(data)
    Path("hard.png").hardlink_to(data)
    before = data.read_bytes()
    assert main(["data.png", name]) == 2
    assert f"the picture {name} would take the place of the data file data.png" in capsys.readouterr().err
    assert data.read_bytes() == before


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("", "the name of the output file is empty"),
        (".", ". is a folder, not a file"),
        ("folder.png", "folder.png is a folder, not a file"),
        ("pipe.png", "pipe.png is a pipe, not a file"),
        (".png", ".png is not a picture file name; expected one that ends in .eps, "),
        ("out", "out is not a picture file name; expected one that ends in .eps, "),
        ("out.feather", ".pdf, .png, .ps, .svg"),
        ("out.", "out. is not a picture file name"),
        ("new/", "new/ is the name of a folder"),
        ("none/out.png", "there is no folder "),
    ],
)
def test_output_that_is_no_picture_is_refused_and_nothing_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, name: str, message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    data = write(tmp_path, rows())
    Path("folder.png").mkdir()
    os.mkfifo("pipe.png")
    before = sorted(tmp_path.iterdir())
    assert main([str(data), name]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert message in line
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize("dpi", ["1e9", "1e300", "1e-9", "0.01"])
def test_resolution_that_makes_no_picture_is_refused_and_the_older_picture_stays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], dpi: str
) -> None:
    (tmp_path / "out.png").write_bytes(b"older")
    assert main([str(write(tmp_path, rows())), str(tmp_path / "out.png"), "--dpi", dpi]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert f"with --dpi {float(dpi):g} the picture has " in line
    assert (tmp_path / "out.png").read_bytes() == b"older"


@pytest.mark.parametrize("suffix", ["pdf", "svg", "PNG", "jpg"])
def test_name_of_the_picture_says_its_format(tmp_path: Path, suffix: str) -> None:
    assert main([str(write(tmp_path, rows())), str(tmp_path / f"out.{suffix}"), "--dpi", "40"]) == 0
    start = {"pdf": b"%PDF", "svg": b"<?xml", "PNG": b"\x89PNG", "jpg": b"\xff\xd8"}[suffix]
    assert (tmp_path / f"out.{suffix}").read_bytes().startswith(start)


@pytest.mark.parametrize("options", [[], ["a"], ["a", "b", "c"], ["a", "b", "--dpi", "0"], ["a", "b", "--tail", "nan"]])
def test_wrong_usage_ends_with_code_2(options: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(options)
    assert ended.value.code == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("swarm_picture: ")
