"""Lamps that cast shadows: casts_shadows, walls_block_light and blocks_light."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from running import Run, compile_text, run

# Robots drive straight on, or stand still, and record what their sensors say. The supervisor moves the first object.
PROGRAM = """#include "pogobase.h"
#include "pogosim/world.h"
typedef struct { int32_t light[3]; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
int32_t power = 0;
int32_t moved = -1;
static void user_init(void) {}
static void user_step(void) {
    pogobot_motor_set(motorL, power);
    pogobot_motor_set(motorR, power);
    for (uint8_t i = 0; i < 3; ++i) {
        mydata->light[i] = pogobot_photosensors_read(i);
    }
}
static void setup(void) { init_from_configuration(power); init_from_configuration(moved); }
static void supervise(void) {
    if (moved >= 0) {
        pogosim_pose_t pose;
        pogosim_world_pose((uint32_t)moved, &pose);
        pogosim_world_set_pose((uint32_t)moved, pose.x_mm, pose.y_mm + 1.0, pose.heading_rad);
    }
}
static void schema(void) {
    data_add_column_int32("back");
    data_add_column_int32("left");
    data_add_column_int32("right");
}
static void row(void) {
    data_set_value_int32("back", mydata->light[0]);
    data_set_value_int32("left", mydata->light[1]);
    data_set_value_int32("right", mydata->light[2]);
}
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, setup);
    SET_CALLBACK(callback_global_step, supervise);
    SET_CALLBACK(callback_create_data_schema, schema);
    SET_CALLBACK(callback_export_data, row);
    return 0;
}
"""

LAMP = {"type": "static_light", "geometry": "disk", "radius": 3000, "x": 200, "y": 500, "value": 5000}
CASTING = {**LAMP, "casts_shadows": True}
PILLAR = {"type": "passive_object", "x": 400, "y": 500, "geometry": "disk", "radius": 60, "body_fixed": True}
# In front of the pillar, behind it, and beside its shadow.
ROBOTS = {"type": "pogobot", "nb": 3, "poses": [[300, 500, 0], [600, 500, 0], [600, 700, 0]]}


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compile_text(tmp_path_factory.mktemp("sees"), PROGRAM)


def outcome(program: Path, folder: Path, objects: dict[str, Any], **settings: Any) -> Run:
    common = {"arena_file": "arenas/square.csv", "simulation_time": 0.5}
    result = run(program, folder, {**common, "objects": objects, **settings})
    assert (result.code, result.errors) == (0, "")
    return result


def lights(result: Run) -> list[list[int]]:
    """What the sensors of the robots said last."""
    rows = result.frame()
    last = rows[(rows["time"] == rows["time"].max()) & (rows["robot_category"] == "robots")].sort_values("robot_id")
    values: list[list[int]] = last[["back", "left", "right"]].astype(int).to_numpy().tolist()
    return values


def test_robot_behind_a_pillar_is_in_the_dark(program: Path, tmp_path: Path) -> None:
    lit, dark = [5000] * 3, [0] * 3
    objects = {"robots": ROBOTS, "it": PILLAR}
    assert lights(outcome(program, tmp_path / "a", {**objects, "lamp": LAMP})) == [lit, lit, lit]
    assert lights(outcome(program, tmp_path / "b", {**objects, "lamp": CASTING})) == [lit, dark, lit]
    ambient = {"type": "static_light", "geometry": "global", "value": 7}
    both = {**objects, "lamp": CASTING, "ambient": ambient}
    assert lights(outcome(program, tmp_path / "c", both)) == [[5007] * 3, [7] * 3, [5007] * 3]
    flat = {**objects, "lamp": CASTING, "it": {**PILLAR, "blocks_light": False}}
    assert lights(outcome(program, tmp_path / "d", flat)) == [lit, lit, lit]


def test_robots_throw_shadows_if_asked_to(program: Path, tmp_path: Path) -> None:
    lit, dark = [5000] * 3, [0] * 3
    for blocks in (False, True):
        objects = {"robots": {**ROBOTS, "blocks_light": blocks}, "lamp": CASTING}
        expected = [lit, dark if blocks else lit, lit]
        assert lights(outcome(program, tmp_path / str(blocks), objects)) == expected


def test_shadow_follows_what_moves(program: Path, tmp_path: Path) -> None:
    objects = {"robots": ROBOTS, "it": PILLAR, "lamp": CASTING}
    result = outcome(program, tmp_path, objects, parameters={"moved": 3}, simulation_time=1.5)
    rows = result.frame()
    behind = rows[(rows["robot_id"] == 1) & (rows["time"] > 0.1)].sort_values("time")["back"].tolist()
    assert set(behind) == {0, 5000}
    assert behind == sorted(behind)


def test_without_the_key_all_bytes_are_as_before(program: Path, tmp_path: Path) -> None:
    tables = []
    for name, lamp in {"absent": LAMP, "false": {**LAMP, "casts_shadows": False}}.items():
        objects = {"robots": {**ROBOTS, "blocks_light": False}, "it": {**PILLAR, "blocks_light": True}, "lamp": lamp}
        if name == "absent":
            objects = {"robots": ROBOTS, "it": PILLAR, "lamp": lamp}
        table = outcome(program, tmp_path / name, objects, walls_block_light=True).table()
        resolved = (table.schema.metadata or {})[b"resolved_configuration"]
        assert b"shadows" not in resolved
        assert b"block_light" not in resolved
        assert b"blocks_light" not in resolved
        tables.append((resolved, table.replace_schema_metadata(None)))
    assert tables[0][0] == tables[1][0]
    assert tables[0][1].equals(tables[1][1])


def test_any_number_of_threads_gives_the_same_bytes(program: Path, tmp_path: Path) -> None:
    objects = {
        "robots": {"type": "pogobot", "nb": 300, "blocks_light": True},
        "boxes": {"type": "passive_object", "nb": 20, "geometry": "rectangle", "body_width": 60, "body_height": 20},
        "ray": {"type": "rotating_ray_of_light", "geometry": "global", "value": 900, "casts_shadows": True},
        "lamp": CASTING,
    }
    frames = []
    for threads in (1, 3):
        settings: dict[str, Any] = {"arena_surface": 4e6, "threads": threads, "parameters": {"power": 512}}
        settings |= {"arena_file": "arenas/square.csv", "simulation_time": 0.5, "objects": objects}
        result = run(program, tmp_path / str(threads), settings)
        assert result.code == 0, result.text
        frames.append(result.frame())
    assert frames[1].equals(frames[0])
    assert frames[0]["back"].nunique() > 1


def test_light_without_a_place_casts_none(program: Path, tmp_path: Path) -> None:
    lamp = {"type": "static_light", "geometry": "global", "casts_shadows": True}
    result = run(program, tmp_path, {"objects": {"robots": ROBOTS, "lamp": lamp}})
    assert result.code != 0
    assert "objects.lamp.casts_shadows: this light comes from no place" in result.errors
