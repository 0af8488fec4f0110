"""The section `view` of a configuration: what pictures show, and what is no view."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pogosim
import pytest
from matplotlib import colormaps
from PIL import Image
from running import PROGRAMS, SHARED, Run, compile_program, example, run, write_scene

SIDE = 300
FRAMES: dict[str, object] = {
    "save_video_period": 1.0,
    "window_width": SIDE,
    "window_height": SIDE,
    "simulation_time": 1.0,
    "objects.robots.nb": 8,
    "objects.robots.communication_radius": 500,
}
COLUMN = """
#include "pogobase.h"
typedef struct { int unused; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
void user_init(void) {}
void user_step(void) {}
static void declare(void) { data_add_column_int16("heard"); data_add_column_string("name"); }
static void export_row(void) {
    data_set_value_int16("heard", pogobot_helper_getid() * 5);
    data_set_value_string("name", "x");
}
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_create_data_schema, declare);
    SET_CALLBACK(callback_export_data, export_row);
    return 0;
}
"""


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program whose column `heard` is 5 times the id of a robot."""
    folder = tmp_path_factory.mktemp("column")
    (folder / "main.c").write_text(COLUMN)
    return compile_program(folder / "main", folder / "main.c")


@pytest.fixture(scope="module")
def talking(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program whose robots have LEDs in three colours, drive in circles and talk."""
    return compile_program(tmp_path_factory.mktemp("talking") / "talking", PROGRAMS / "window.c")


def picture(path: Path) -> npt.NDArray[np.uint8]:
    """Colours of a frame. Shape (rows, columns, 3)."""
    with Image.open(path / "frames" / "f00001.0000.png") as image:
        return np.asarray(image.convert("RGB"))


def shown(folder: Path, view: dict[str, object], program: Path) -> npt.NDArray[np.uint8]:
    lamp = {"type": "static_light", "geometry": "disk", "radius": 200, "x": 300, "y": 300, "value": 500}
    result = run(program, folder, {**FRAMES, "objects.lamp": lamp, "view": view})
    assert result.code == 0, result.text
    return picture(folder)


def refused(folder: Path, view: dict[str, object], program: Path, **more: object) -> Run:
    """Run with a view that is none, where there is a data file of an earlier run, which must stay."""
    folder.mkdir(exist_ok=True)
    (folder / "data.feather").write_bytes(b"earlier")
    result = run(program, folder, {**FRAMES, "view": view, **more})
    assert result.code == 2, result.text
    assert (folder / "data.feather").read_bytes() == b"earlier"
    assert len(result.errors.splitlines()) == 1, result.errors
    return result


@pytest.mark.parametrize(
    "view",
    [
        {"time": False},
        {"scale_bar": False},
        {"links": "above"},
        {"trails": True},
        {"labels": True},
        {"velocities": True},
        {"heard": True},
        {"color_by": "speed"},
        {"heat_map": "density"},
        {"heat_map": "light"},
        {"theme": "light"},
        {"palette": "color_blind"},
        {"follow": 3},
        {"zoom": 2.0},
    ],
    ids=lambda view: "-".join(view),
)
def test_each_option_changes_the_picture(talking: Path, tmp_path: Path, view: dict[str, object]) -> None:
    plain = shown(tmp_path / "plain", {}, talking)
    assert np.any(shown(tmp_path / "view", view, talking) != plain)


def test_colours_are_those_of_the_values(program: Path, tmp_path: Path) -> None:
    poses = [[200, 500, 0], [500, 500, 0], [800, 500, 0]]
    view = {"color_by": "heard", "time": False, "scale_bar": False}
    scene = {**FRAMES, "objects.robots.nb": 3, "objects.robots.poses": poses, "view": view, "arena_surface": 1e6}
    assert run(program, tmp_path, {**scene, "arena_file": "arenas/square.csv"}).code == 0
    pixels = picture(tmp_path)
    scale, middle = 0.95 * SIDE / 1000.0, SIDE / 2
    for robot, (x, y, _) in enumerate(poses):
        column, row = int(middle + scale * (x - 8 - 500)), int(middle + scale * (y - 500))
        expected = 255.0 * np.array(colormaps["viridis"](0.15 + 0.85 * robot / 2)[:3])
        np.testing.assert_allclose(pixels[row, column], expected, atol=6)


def test_render_shows_the_view_of_the_configuration(tmp_path: Path) -> None:
    hosted = compile_program(tmp_path / "hosted.so", PROGRAMS / "hosted.c", flags=SHARED)
    scene = write_scene(tmp_path, {"objects.robots.nb": 5})
    pictures = []
    for theme in ("dark", "light"):
        with pogosim.Simulation(hosted, scene, set={"view.theme": theme}) as simulation:
            simulation.step(10)
            pictures.append(simulation.render(SIDE, SIDE))
    assert pictures[1].mean() > pictures[0].mean() + 50


def test_view_changes_no_byte_of_the_rows(tmp_path: Path) -> None:
    results = []
    for name, view in (("plain", {}), ("all", {"heard": True, "color_by": "speed", "heat_map": "x", "trails": True})):
        assert run(example("hanabi"), tmp_path / name, {**FRAMES, "view": view}).code == 0
        results.append(pogosim.utils.load_dataframe(tmp_path / name / "data.feather")[0])
    assert results[0].equals(results[1])


def test_value_that_no_robot_has_is_told_with_those_that_they_have(program: Path, tmp_path: Path) -> None:
    result = refused(tmp_path, {"color_by": "herd"}, program)
    assert "scene.yaml:" in result.errors
    assert (
        "view.color_by: the robots have no value 'herd'; expected one of speed, x, y, angle, light, heard; "
        "did you mean 'heard'?" in result.errors
    )
    assert "view.heat_map: the robots have no value 'name'" in refused(tmp_path, {"heat_map": "name"}, program).errors
    errors = refused(tmp_path, {"color_by": "heard"}, program, enable_data_logging=False).errors
    assert "columns of the program need enable_data_logging: true" in errors
    assert "view.follow: there is no robot 99" in refused(tmp_path, {"follow": 99}, program).errors


def test_condition_that_makes_no_sense_is_a_mistake_of_the_configuration(program: Path, tmp_path: Path) -> None:
    errors = refused(tmp_path, {"pause_when": "herd > 10"}, program).errors
    assert "scene.yaml:" in errors
    assert "view.pause_when: 'herd > 10', character 1: there is no value 'herd'" in errors
    assert "did you mean 'heard'" in errors
    assert (
        "view.pause_when: 'x >', character 4: expected a value"
        in refused(tmp_path, {"pause_when": "x >"}, program).errors
    )
    errors = refused(tmp_path, {"pause_when": "heard > 10"}, program, enable_data_logging=False).errors
    assert "columns of the program need enable_data_logging: true" in errors
    assert "at most 1000 characters" in refused(tmp_path, {"pause_when": "x" + "+1" * 500}, program).errors


@pytest.mark.parametrize(
    ("view", "message"),
    [
        ({"theme": "lite"}, "view.theme: expected dark or light, found 'lite'"),
        ({"links": True}, "view.links: expected one of hidden, below, above"),
        ({"zoom": 0}, "view.zoom: expected a number from 0.1 to 100"),
        ({"history": -1}, "view.history: expected a number from 0 to 3600"),
        ({"follow": "me"}, "view.follow: expected"),
        ([1], "view: expected a map of keys"),
    ],
)
def test_mistake_in_a_view_is_told_with_its_place(tmp_path: Path, view: object, message: str) -> None:
    result = run(example("helloworld"), tmp_path, {**FRAMES, "view": view})
    assert result.code == 2, result.text
    assert message in result.errors


def test_option_that_does_not_exist_is_told(tmp_path: Path) -> None:
    result = run(example("helloworld"), tmp_path, {**FRAMES, "view": {"trail": True}})
    assert "view.trail" in result.errors
    assert "did you mean 'trails'?" in result.errors
