"""Bodies of all shapes in runs from a file to a picture: capsules, polygons, rounded corners, compounds."""

from __future__ import annotations

import math
import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import yaml
from pogosim import Simulation
from pogosim.object_facts import entries_in
from pogosim.picture.swarm import KIND, read_recording
from pogosim.scene import kinds_in
from pogosim.view.kinds import category_data
from running import ROOT, example, run

TRAY: dict[str, Any] = {
    "geometry": "compound",
    "parts": [
        {"geometry": "rectangle", "body_width": 12, "body_height": 160},
        {"geometry": "rectangle", "body_width": 90, "body_height": 12, "x": 45, "y": -74},
        {"geometry": "rectangle", "body_width": 90, "body_height": 12, "x": 45, "y": 74},
    ],
}
SHAPES: dict[str, dict[str, Any]] = {
    "capsule": {"geometry": "capsule", "body_width": 90, "body_height": 24},
    "polygon": {"geometry": "polygon", "corners": [[0, 0], [60, 10], [50, 50], [10, 60]], "corner_radius": 5},
    "rounded": {"geometry": "rectangle", "body_width": 70, "body_height": 40, "corner_radius": 12},
    "tray": TRAY,
}
SQUARE = {"arena_file": "arenas/square.csv", "arena_surface": 1.0e6}


def state_hashes(engine: str, threads: int) -> list[str]:
    """Run conf/shapes.yaml for two seconds; return the hashes of its states."""
    command = [str(example("run_and_tumble")), "-c", str(ROOT / "conf/shapes.yaml"), "-g", "--hash", "50"]
    for setting in (f"threads={threads}", f"physics_engine={engine}", "simulation_time=2", "enable_data_logging=false"):
        command += ["--set", setting]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    return re.findall(r"state after step \d+: (\w+)", done.stdout + done.stderr)


def test_example_runs_with_both_engines_and_the_same_bytes_for_any_threads() -> None:
    ours = state_hashes("disk", 1)
    assert len(ours) == 4
    assert state_hashes("disk", 2) == ours
    assert len(state_hashes("box2d", 1)) == 4


def simulation(tmp_path: Path, objects: dict[str, Any], **settings: Any) -> Simulation:
    """Start a run without a program."""
    path = tmp_path / "conf.yaml"
    path.write_text(yaml.safe_dump({**SQUARE, "enable_data_logging": False, "objects": objects, **settings}))
    return Simulation(None, str(path), seed=1)


@pytest.mark.parametrize("engine", ["disk", "box2d"])
@pytest.mark.parametrize("name", SHAPES)
def test_robot_of_any_shape_drives_straight_and_turns_about_its_centre_of_mass(
    tmp_path: Path, name: str, engine: str
) -> None:
    robot = {"type": "pogobot", "brain": "host", **SHAPES[name], "x": 500, "y": 500, "angle": 0.3}
    quiet = {"linear_noise_stddev": 0.0, "angular_noise_stddev": 0.0, "temporal_noise_stddev": 0.0}
    with simulation(tmp_path, {"robots": {**robot, **quiet}}, physics_engine=engine) as sim:
        motors = sim.brain("robots").motors
        motors[:] = [1023, 1023, 0]
        start = sim.positions[0].copy()
        sim.step(200)
        way = sim.positions[0] - start
        assert math.atan2(way[1], way[0]) == pytest.approx(0.3, abs=0.01)
        assert np.hypot(*way) == pytest.approx(200.0, rel=0.03)
        motors[:] = [0, 1023, 0]  # turning on the spot needs both; with one, it drives a circle
        sim.step(100)
        assert np.isfinite(sim.positions).all()


@pytest.mark.parametrize("engine", ["disk", "box2d"])
def test_tray_collects_what_it_is_driven_over(tmp_path: Path, engine: str) -> None:
    body = {"body_linear_damping": 5, "body_angular_damping": 5}
    objects = {
        "tray": {"type": "pogobot", "brain": "host", **TRAY, "x": 200, "y": 500, "angle": 0.0, "body_density": 100},
        "pucks": {
            "type": "passive_object",
            "geometry": "disk",
            "radius": 12,
            "poses": [[400, 470], [500, 520], [600, 500]],
            **body,
        },
    }
    with simulation(tmp_path, objects, physics_engine=engine) as sim:
        sim.brain("tray").motors[:] = [1023, 1023, 0]
        sim.step(600)
        places = np.array([each.position for each in sim.objects])
        tray, pucks = places[0], places[1:]
        ahead = pucks - tray
        assert tray[0] > 700.0
        assert (np.abs(ahead[:, 1]) < 68.0).all(), "between its sides"
        assert (ahead[:, 0] > -16.0).all(), "in front of its back"


def test_infrared_passes_the_opening_of_a_tray_and_not_its_back(tmp_path: Path) -> None:
    objects = {
        "robots": {
            "type": "pogobot",
            "brain": {"script": "talk.yaml"},
            "poses": [[500, 500], [650, 500], [350, 500]],
            "communication_radius": 200,
        },
        "tray": {"type": "passive_object", **TRAY, "x": 500, "y": 500, "angle": 0, "body_fixed": True}
        | {"blocks_infrared": True},
    }
    lines = "".join(f"  - {{time_s: {time}, message: hello}}\n" for time in (0, 0.5, 1, 1.5))
    (tmp_path / "talk.yaml").write_text("script:\n" + lines)
    settings = {
        **SQUARE,
        "simulation_time": 2,
        "message_log": "log.feather",
        "data_filename": "data.feather",
        "communication_ignore_occlusions": True,
        "objects": objects,
    }
    (tmp_path / "conf.yaml").write_text(yaml.safe_dump(settings))
    command = [str(ROOT / "build/release/src/pogosim-without-program"), "-c", "conf.yaml", "-g"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    log = pd.read_feather(tmp_path / "log.feather")
    heard = {(int(s), int(r)) for s, r in log[["sender_id", "receiver_id"]].dropna().to_numpy() if r >= 0}
    assert (0, 1) in heard and (1, 0) in heard
    assert (0, 2) not in heard and (2, 0) not in heard


def test_overlaps_are_those_of_the_outline_and_not_of_the_disk_around_it(tmp_path: Path) -> None:
    inside = {"type": "passive_object", "geometry": "disk", "radius": 30, "x": 510, "y": 500, "body_fixed": True}
    tray = {"type": "passive_object", **TRAY, "x": 500, "y": 500, "angle": 0, "body_fixed": True}
    for x, is_told in ((516, False), (470, True)):
        settings = {"objects.tray": tray, "objects.post": inside | {"x": x}, "arena_file": "arenas/square.csv"}
        done = run(example("run_and_tumble"), tmp_path, settings, ["--check-config"])
        assert done.code == 0, done.errors
        assert ("overlaps" in done.output + done.errors) == is_told


def test_pictures_and_replays_know_the_outline() -> None:
    configuration = yaml.safe_load((ROOT / "conf/shapes.yaml").read_text())
    kinds = {kind.category: kind for kind in kinds_in(entries_in(configuration))}
    outline = np.array(category_data("trays", kinds["trays"])["outline"])
    assert len(outline) == 8
    assert np.ptp(outline, axis=0) == pytest.approx([96.0, 160.0])
    assert category_data("robots", kinds["robots"])["outline"] is None


def test_objects_of_a_list_are_drawn_as_their_own_entries(tmp_path: Path) -> None:
    """Whatever their ids: those of robots count upwards, those of passive objects downwards."""
    passive = {"type": "passive_object", "nb": 1, "x": 200, "y": 200}
    robot = {"type": "pogobot", "nb": 1, "x": 800, "y": 800}
    boxes = [
        {**passive, "geometry": "rectangle", "body_width": 80, "body_height": 40},
        {**passive, "geometry": "disk", "radius": 30, "x": 500},
        {**passive, "geometry": "disk", "radius": 30, "x": 600},
    ]
    robots = [
        {**robot, "geometry": "disk", "radius": 26.5},
        {**robot, "geometry": "disk", "radius": 26.5, "x": 600},
        {**robot, "geometry": "triangle", "side_length": 70, "x": 200},
    ]
    data = tmp_path / "data.feather"
    settings = {
        "objects.boxes": boxes,
        "objects.robots": robots,
        "arena_file": "arenas/square.csv",
        "enable_data_logging": True,
        "data_filename": str(data),
        "simulation_time": 1.0,
    }
    done = run(example("run_and_tumble"), tmp_path, settings)
    assert done.code == 0, done.errors
    swarm = read_recording(data).last
    first = swarm.rows[swarm.rows["time"] == swarm.rows["time"].min()]
    kinds = [swarm.kinds[number].shape.kind for number in first[KIND]]
    found = sorted(zip(first["robot_category"], kinds, strict=True))
    assert found == [("boxes", "disk")] * 2 + [("boxes", "rectangle")] + [("robots", "disk")] * 2 + [
        ("robots", "triangle")
    ]
    for category, shape in (("boxes", "rectangle"), ("robots", "triangle")):
        is_own = (first["robot_category"] == category).to_numpy() & (np.array(kinds) == shape)
        assert first["x"].to_numpy()[is_own] == pytest.approx([200.0], abs=60.0)
