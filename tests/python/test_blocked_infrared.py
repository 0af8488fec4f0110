"""Walls and bodies that infrared does not pass: walls_block_infrared and blocks_infrared."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from running import Run, compile_text, run

RADIUS = 26.5  # of a robot, mm
PILLAR = 20.0

# Robots stand still, send at each tick, and count what they send and hear. The supervisor moves object `moved` along x.
PROGRAM = """#include "pogobase.h"
#include "pogosim/world.h"
typedef struct { uint32_t sent; uint32_t got; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
int32_t moved = -1;
static bool send(void) {
    uint8_t payload[4] = {0};
    mydata->sent++;
    return pogobot_infrared_sendShortMessage_omni(payload, sizeof(payload)) == 0;
}
static void get(message_t* message) { (void)message; mydata->got++; }
static void user_init(void) {
    max_nb_processed_msg_per_tick = 100;
    percent_msgs_sent_per_ticks = 100;
    msg_tx_fn = send;
    msg_rx_fn = get;
}
static void user_step(void) {}
static void setup(void) { init_from_configuration(moved); }
static void supervise(void) {
    if (moved >= 0) {
        pogosim_pose_t pose;
        pogosim_world_pose((uint32_t)moved, &pose);
        pogosim_world_set_pose((uint32_t)moved, pose.x_mm, pose.y_mm + 1.0, pose.heading_rad);
    }
}
static void schema(void) { data_add_column_int32("sent"); data_add_column_int32("got"); }
static void row(void) {
    data_set_value_int32("sent", (int32_t)mydata->sent);
    data_set_value_int32("got", (int32_t)mydata->got);
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

ROBOTS: dict[str, Any] = {
    "type": "pogobot",
    "geometry": "disk",
    "radius": RADIUS,
    "communication_radius": 250,
    "msg_success_rate": {"type": "static", "rate": 1.0},
}


def robots_at(*poses: list[float]) -> dict[str, Any]:
    return {**ROBOTS, "nb": len(poses), "poses": [list(pose) for pose in poses]}


def passive(x: float, y: float, **keys: Any) -> dict[str, Any]:
    """A fixed passive object that blocks."""
    shape = {"geometry": "disk", "radius": PILLAR} if "geometry" not in keys else {}
    return {"type": "passive_object", "x": x, "y": y, "body_fixed": True, "blocks_infrared": True, **shape, **keys}


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compile_text(tmp_path_factory.mktemp("sends"), PROGRAM)


def outcome(program: Path, folder: Path, objects: dict[str, Any], **settings: Any) -> Run:
    folder.mkdir(exist_ok=True)
    common = {"arena_file": "arenas/square.csv", "simulation_time": 1.0, "message_log": "m.feather"}
    result = run(program, folder, {**common, "objects": objects, **settings})
    assert (result.code, result.errors) == (0, "")
    return result


def heard(result: Run) -> dict[int, int]:
    """How many messages each robot has received, by id."""
    rows = result.frame()
    last = rows[(rows["time"] == rows["time"].max()) & (rows["robot_category"] == "robots")]
    return dict(zip(last["robot_id"].astype(int), last["got"].astype(int), strict=True))


def pairs(result: Run) -> set[tuple[int, int]]:
    """Sender and receiver of what is in reach, by the message log."""
    log = result.frame("m.feather")
    there = log[log["receiver"].notna()]
    return set(zip(there["sender_id"].astype(int), there["receiver_id"].astype(int), strict=True))


@pytest.mark.parametrize("ignore", [False, True])
def test_pillar_takes_away_the_messages_that_pass_it_and_no_other(program: Path, tmp_path: Path, ignore: bool) -> None:
    robots = robots_at([400, 400, 0], [600, 400, 0], [400, 600, 0])
    keys: dict[str, Any] = {"communication_ignore_occlusions": ignore}
    free = outcome(
        program, tmp_path / "free", {"robots": robots, "it": passive(500, 400, blocks_infrared=False)}, **keys
    )
    held = outcome(program, tmp_path / "held", {"robots": robots, "it": passive(500, 400)}, **keys)
    assert {(0, 1), (1, 0), (0, 2), (2, 0)} <= pairs(free)
    # With occlusions, the emitters on the line are those that count; without, all emitters look past the pillar.
    assert (0, 2) in pairs(held)
    if not ignore:
        assert pairs(free) - pairs(held) == {(0, 1), (1, 0)}
        assert heard(held)[1] < heard(free)[1]
        assert heard(held)[2] == heard(free)[2]


def test_receivers_behind_a_pillar_are_those_whose_line_passes_within_its_radius(program: Path, tmp_path: Path) -> None:
    # The sender's front emitter, and a ring of robots too far from each other to hear each other.
    angles = np.radians(np.arange(-35, 36, 14.0))
    ring = [[300 + RADIUS + 230 * math.cos(a), 500 + 230 * math.sin(a), 0.0] for a in angles]
    for y in (430.0, 480.0, 500.0, 545.0):
        objects = {"robots": robots_at([300, 500, 0], *ring), "it": passive(420, y)}
        result = outcome(program, tmp_path / str(y), objects, **{"communication_ignore_occlusions": False})
        offset = np.array([420 - 300 - RADIUS, y - 500])
        across = np.abs(np.cos(angles) * offset[1] - np.sin(angles) * offset[0])
        expected = {(0, k + 1) for k in range(len(ring)) if across[k] >= PILLAR}
        log = result.frame("m.feather")
        front = log[
            (log["sender_id"] == 0) & log["receiver"].notna() & ((log["reaching_faces"].fillna(0).astype(int) & 1) != 0)
        ]
        assert set(zip(front["sender_id"].astype(int), front["receiver_id"].astype(int), strict=True)) == expected
        assert 0 < len(expected) < len(ring)


def test_moving_box_cuts_the_line_for_as_long_as_it_stands_in_it(program: Path, tmp_path: Path) -> None:
    # At 60 mm/s, the box of 60 mm covers the line of the front emitter during 1 s, from about 1.1 s on.
    box = passive(500, 300, geometry="rectangle", body_width=20, body_height=60)
    objects = {"robots": robots_at([400, 400, 0], [600, 400, 0]), "box": box}
    result = outcome(program, tmp_path, objects, simulation_time=3.0, **{"parameters.moved": 2})
    log = result.frame("m.feather")
    of_first = log[(log["sender_id"] == 0) & log["receiver"].notna()]
    steps = np.sort(of_first["step"].unique())
    gap = np.diff(steps)
    start = steps[np.argmax(gap)]
    # A message goes every second step or so.
    assert 108 <= start <= 117
    assert 96 <= gap.max() <= 104
    assert np.sort(gap)[-2] <= 3


def test_wall_with_a_gap_is_passed_through_the_gap_alone(program: Path, tmp_path: Path) -> None:
    corners = [[0, 0], [1000, 0], [1000, 1000], [0, 1000]]
    wall = [[[495, 200], [505, 200], [505, 490], [495, 490]], [[495, 510], [505, 510], [505, 800], [495, 800]]]
    polygons = [corners, *wall]
    arena = "\n\n".join("\n".join(f"{x},{y}" for x, y in polygon) for polygon in polygons)
    (tmp_path / "gap.csv").write_text(arena + "\n", encoding="utf-8")
    robots = robots_at(*([x, y, 0.0] for x in (400, 600) for y in (300, 400, 500, 600, 700)))
    settings = {"arena_file": str(tmp_path / "gap.csv"), "arena_surface": "file"}
    free = outcome(program, tmp_path / "free", {"robots": robots}, **settings)
    held = outcome(program, tmp_path / "held", {"robots": robots}, **settings, walls_block_infrared=True)
    through = {(a, b) for a, b in pairs(held) if (a < 5) != (b < 5)}
    assert through == {(2, 7), (7, 2)}
    assert pairs(held) < pairs(free)
    assert {pair for pair in pairs(free) - pairs(held) if (pair[0] < 5) == (pair[1] < 5)} == set()


def test_pillar_at_the_border_of_a_periodic_arena_blocks_across_it(program: Path, tmp_path: Path) -> None:
    robots = robots_at([920, 500, 0], [80, 500, 0])
    settings = {"boundary_condition": "periodic", "walls_block_infrared": True}
    free = outcome(program, tmp_path / "free", {"robots": robots}, **settings)
    held = outcome(program, tmp_path / "held", {"robots": robots, "it": passive(995, 500)}, **settings)
    assert pairs(free) == {(0, 1), (1, 0)}
    assert pairs(held) == set()


def test_data_are_those_without_the_keys_when_nothing_blocks(program: Path, tmp_path: Path) -> None:
    bytes_of = []
    for name, keys in {"absent": {}, "false": {"walls_block_infrared": False}}.items():
        objects = {"robots": {**ROBOTS, "nb": 40}, "it": {**passive(500, 500), "blocks_infrared": False}}
        if name == "absent":
            del objects["it"]["blocks_infrared"]
        table = outcome(program, tmp_path / name, objects, **keys).table()
        resolved = (table.schema.metadata or {})[b"resolved_configuration"]
        assert b"infrared" not in resolved
        bytes_of.append((resolved, table.replace_schema_metadata(None)))
    assert bytes_of[0][0] == bytes_of[1][0]
    assert bytes_of[0][1].equals(bytes_of[1][1])


def test_any_number_of_threads_gives_the_same_bytes(program: Path, tmp_path: Path) -> None:
    objects = {
        "robots": {**ROBOTS, "nb": 1000, "communication_radius": 80},
        "pillars": {"type": "passive_object", "nb": 50, "geometry": "disk", "radius": 30, "blocks_infrared": True},
    }
    frames: list[pd.DataFrame] = []
    for threads in (1, 2, 3):
        folder = tmp_path / str(threads)
        folder.mkdir()
        settings = {"arena_surface": 8e6, "objects": objects, "walls_block_infrared": True, "threads": threads}
        result = run(program, folder, {**settings, "simulation_time": 0.5})
        assert result.code == 0, result.text
        frames.append(result.frame())
    assert frames[1].equals(frames[0])
    assert frames[2].equals(frames[0])
    assert frames[0]["got"].max() > 0


@pytest.mark.parametrize(
    ("key", "value", "line"),
    [
        ("walls_block_infrared", "maybe", "walls_block_infrared: expected true or false, found 'maybe'"),
        ("objects.it.blocks_infrared", 3, "objects.it.blocks_infrared: expected true or false, found 3"),
    ],
)
def test_wrong_value_is_refused_in_one_line(program: Path, tmp_path: Path, key: str, value: Any, line: str) -> None:
    result = run(program, tmp_path, {"objects.it": passive(500, 500), key: value})
    assert result.code == 2
    found = [text for text in result.errors.splitlines() if "expected" in text]
    assert len(found) == 1
    assert "scene.yaml:" in found[0]
    assert line in found[0]
