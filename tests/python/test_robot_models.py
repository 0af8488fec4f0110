"""Robots whose model is a table: motors, faces, sensors, LEDs and flash memory as a user configures them."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
import yaml
from conftest import Compile
from pogosim.utils import load_dataframe
from running import ROOT, Run, run, run_command, run_shipped

PLAIN: dict[str, Any] = {
    "arena_file": "arenas/square.csv",
    "arena_surface": 1e6,
    "simulation_time": 2,
    "objects.robots.nb": 1,
    "objects.robots.poses": [[500, 500, 0]],
    "objects.robots.msg_success_rate": {"type": "static", "rate": 1.0},
    "objects.lamp": {"type": "static_light", "geometry": "global", "value": 100},
}


@pytest.fixture(scope="module")
def parts(program: Compile) -> Path:
    return program("parts.c")


def end_of(parts: Path, folder: Path, settings: dict[str, Any]) -> Any:
    """Rows at the end of a run that says nothing."""
    result = run(parts, folder, {**PLAIN, **settings})
    assert (result.code, result.errors) == (0, ""), result.text
    rows = result.frame()
    return rows[rows["time"] == rows["time"].max()].set_index("robot_id")


def model_file(folder: Path, text: str) -> str:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "model.yaml").write_text(text)
    return "model.yaml"


def test_each_motor_gives_the_speed_of_its_table(parts: Path, tmp_path: Path) -> None:
    motors = {
        "right": {"linear_mm_s": 30, "angular_rad_s": 0},
        "left": {"linear_mm_s": 40},
        "back": {"linear_mm_s": -20},
    }
    for name, powers, speed in (
        ("right", {"right": 1023}, 30),
        ("left", {"left": 1023}, 40),
        ("back", {"back": 1023}, -20),
        ("all", {"right": 1023, "left": 1023, "back": 1023}, 50),
    ):
        rows = end_of(parts, tmp_path / name, {"objects.robots.motors": motors, "parameters": powers})
        assert rows["x"][0] - 500 == pytest.approx(2 * speed, rel=0.02)
        assert rows["angle"][0] == 0


def test_fastest_turn_is_max_angular_speed_of_a_model(parts: Path, tmp_path: Path) -> None:
    # Against each other, the two wheels turn the robot by 1.5 rad/s: the right one runs backwards by its direction bit.
    motors = {"right": {"angular_rad_s": -1, "linear_mm_s": 0, "forward": 1}, "left": {"angular_rad_s": 1}}
    settings = {
        "objects.robots.motors": motors,
        "objects.robots.max_angular_speed": 1.5,
        "parameters": {"right": 1023, "left": 1023},
        "simulation_time": 1,
    }
    assert end_of(parts, tmp_path, settings)["angle"][0] == pytest.approx(1.5, rel=0.02)


def test_bundled_model_changes_no_byte_of_what_robots_do(tmp_path: Path) -> None:
    settings = {"simulation_time": 10, "seed": 3}
    model = {"objects.robots.robot_model": "models/pogobot_wheels.yaml", "objects.robots.max_angular_speed": 4.0}
    plain = run_shipped(
        "active_brownian_particles", tmp_path / "plain", {**settings, "objects.robots.max_angular_speed": 1.0}
    )
    same = run_shipped("active_brownian_particles", tmp_path / "model", {**settings, **model})
    assert plain.table().equals(same.table())


def ears(folder: Path, model: str, heading_deg: float) -> dict[str, Any]:
    """Return a robot with this model, 80 mm ahead of a plain one; 0 degrees: it looks at that one."""
    return {
        "objects.ears": {
            "type": "pogobot",
            "poses": [[580, 500, math.radians(180 + heading_deg)]],
            "msg_success_rate": {"type": "static", "rate": 1.0},
            "robot_model": model_file(folder, model),
        }
    }


def test_face_of_thirty_degrees_hears_what_geometry_says(parts: Path, tmp_path: Path) -> None:
    narrow = "faces: [{angle_deg: 0, place: centre, reception_deg: 30}]\n"
    for heading_deg in (0, 14, -14, 16, -16, 80, 100, 180):
        folder = tmp_path / str(heading_deg)
        rows = end_of(parts, folder, ears(folder, narrow, heading_deg))
        assert (rows["heard"][1] > 0) == (abs(heading_deg) < 15), heading_deg
        assert rows["faces"][1] in (0, 1)
        assert (rows["heard"][0] > 0) == (abs(heading_deg) < 90)  # it sends over a half plane


def test_face_of_thirty_degrees_is_heard_where_geometry_says(parts: Path, tmp_path: Path) -> None:
    narrow = "faces: [{angle_deg: 0, place: centre, emission_deg: 30}]\n"
    for heading_deg in (0, 14, -14, 16, -16, 80, 100, 180):
        folder = tmp_path / str(heading_deg)
        rows = end_of(parts, folder, ears(folder, narrow, heading_deg))
        assert (rows["heard"][0] > 0) == (abs(heading_deg) < 15), heading_deg


def test_faces_are_numbered_as_the_table_lists_them(parts: Path, tmp_path: Path) -> None:
    three = "faces: [{angle_deg: 0}, {angle_deg: 120}, {angle_deg: 240}]\n"
    for heading_deg, face in ((0, 0), (-120, 1), (120, 2)):
        folder = tmp_path / str(heading_deg)
        rows = end_of(parts, folder, ears(folder, three, heading_deg))
        assert rows["faces"][1] == 1 << face
        assert rows["from_face"][0] == 4  # it sends in all directions
    alone = "faces: [{angle_deg: 0}]\n"
    assert end_of(parts, tmp_path / "one", ears(tmp_path / "one", alone, 0))["from_face"][0] == 0


def test_light_is_read_where_the_sensors_are(parts: Path, tmp_path: Path) -> None:
    plane = {"type": "static_light", "geometry": "global", "light_mode": "plane", "x": 500, "y": 500, "value": 20000}
    lamp = {**plane, "edge_value": 0, "plane_angle": 0, "plane_half_span": 500}
    sensors = "light_sensors: [{place: [200, 0]}, {place: centre}, {place: [-200, 0]}]\n"
    settings = {
        "objects.lamp": lamp,
        "objects.robots.robot_model": model_file(tmp_path, sensors),
        "objects.robots.radius": 200,
        "light_map_nb_bin_x": 200,
        "light_map_nb_bin_y": 200,
    }
    rows = end_of(parts, tmp_path, settings)
    assert abs(rows["light_0"][0] - rows["light_2"][0]) == pytest.approx(20000 * 400 / 1000, rel=0.03)


def test_parts_that_the_model_lacks_are_told_once_each(parts: Path, tmp_path: Path) -> None:
    poor = "faces: [{angle_deg: 0}]\nleds: [{place: centre}]\nlight_sensors: []\nflash_pages: 10\nmotors: {}\n"
    settings = {**PLAIN, "objects.robots.robot_model": model_file(tmp_path, poor), "parameters": {"asks_for_all": True}}
    result = run(parts, tmp_path, settings)
    assert result.code == 0, result.text
    for line in (
        "pogobot_led_setColors(): id is 4, expected one of the leds of this robot's model, from 0; nothing is set",
        "write_page_flash(): page is 100, expected one of the flash_pages of this robot's model, from 0; nothing is",
        "pogobot_infrared_sendLongMessage_uniSpe(): dir is 3, expected one of the faces of this robot's model, from 0",
        "pogobot_photosensors_read(): sensor_number is 0, expected none, since this robot's model has no light sensors",
        "pogobot_motor_power_set(): motor is 1, expected none, since this robot's model has no motors; it moves",
    ):
        assert result.errors.count(line) == 1, result.errors


def test_motor_that_the_model_lacks_is_told_and_without_power_it_is_not(parts: Path, tmp_path: Path) -> None:
    for power, count in ((0, 0), (5, 1)):
        result = run(parts, tmp_path / str(power), {**PLAIN, "parameters": {"left": 9, "back": power}})
        told = (
            "pogobot_motor_power_set(): motor is 2, expected one of the motors of this robot's model; it moves nothing"
        )
        assert result.errors.count(told) == count, result.text


def test_robot_without_motors_is_pushed_in_the_run_that_repeats_it_too(parts: Path, tmp_path: Path) -> None:
    pushed = {"type": "pogobot", "poses": [[560, 500, 0]], "motors": {}}
    settings = {**PLAIN, "objects.pushed": pushed, "seed": 1, "parameters": {"right": 1023, "left": 1023}}
    first = run(parts, tmp_path / "first", settings)
    _, metadata = load_dataframe(tmp_path / "first" / "data.feather")
    folder = tmp_path / "again"
    folder.mkdir()
    (folder / "again.yaml").write_text(yaml.safe_dump(metadata["resolved_configuration"], sort_keys=False))
    again = run_command(parts, folder, ["-c", "again.yaml", "-g"])
    assert again.table().equals(first.table())
    assert first.frame()["x"].max() > 600.0


def test_memory_of_the_model_bounds_what_programs_may_need(parts: Path, tmp_path: Path) -> None:
    small = "processor: {memory_bytes: 1024}\n"
    result = run(parts, tmp_path, {**PLAIN, "objects.robots.robot_model": model_file(tmp_path, small)})
    assert result.code == 0
    assert "bytes (1 KiB) of a real robot's memory" in result.errors


def test_data_file_keeps_the_model_as_the_run_had_it(parts: Path, tmp_path: Path) -> None:
    text = "communication_radius: 55\nfaces: [{angle_deg: 90, emission_deg: 45}]\n"
    result = run(parts, tmp_path, {**PLAIN, "objects.robots.robot_model": model_file(tmp_path, text)})
    kept = yaml.safe_load(result.table().schema.metadata[b"resolved_configuration"])
    robots = kept["objects"]["robots"]
    assert robots["communication_radius"] == 55
    assert robots["faces"][0]["emission_deg"] == 45
    assert "robot_model" not in robots


def failure(parts: Path, folder: Path, settings: dict[str, Any]) -> Run:
    result = run(parts, folder, {**PLAIN, **settings})
    assert result.code == 2, result.text
    assert result.text.count("Error: ") == 1, result.text
    return result


def test_mistakes_in_a_model_are_told_with_its_line(parts: Path, tmp_path: Path) -> None:
    for text, message in (
        ("faces: []\n", "model.yaml:1: objects.robots.faces: expected 1 to 4 entries, found 0"),
        ("\nfaces:\n  - {angle_deg: north}\n", "model.yaml:3: objects.robots.faces.0.angle_deg: expected a number"),
        ("nb: 5\n", "model.yaml:1: nb: a robot model says what robots have"),
        ("motors: {rigt: {linear_mm_s: 5}}\n", "did you mean 'right'?"),
    ):
        name = model_file(tmp_path, text)
        assert message in failure(parts, tmp_path, {"objects.robots.robot_model": name}).errors
    assert (
        "there is no file 'none.yaml'" in failure(parts, tmp_path, {"objects.robots.robot_model": "none.yaml"}).errors
    )


def test_run_does_not_overwrite_its_model(parts: Path, tmp_path: Path) -> None:
    name = model_file(tmp_path, "radius: 30\n")
    message = failure(parts, tmp_path, {"objects.robots.robot_model": name, "data_filename": name}).errors
    assert "is the same file as the robot model 'model.yaml', which the run would overwrite" in message
    assert (tmp_path / name).read_text() == "radius: 30\n"


def test_every_bundled_model_runs(parts: Path, tmp_path: Path) -> None:
    models = sorted(path.name for path in (ROOT / "models").glob("*.yaml"))
    assert len(models) == 5
    for name in models:
        kind = {"pogowall.yaml": "pogowall", "membrane.yaml": "membrane", "pogobject.yaml": "pogobject"}.get(name)
        other = {"type": kind or "pogobot", "geometry": "disk", "radius": 60, "robot_model": f"models/{name}"}
        settings = {"objects.others": {**other, "x": 200, "y": 200}, "objects.robots.poses": [[500, 500, 0]]}
        result = run(parts, tmp_path / name, {**PLAIN, **settings})
        assert result.code == 0, result.text
