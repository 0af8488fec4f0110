"""What data files say of the objects of their run, which tools take in place of the types of the configuration."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa
import pytest
from batches import batch, write_options
from pogosim.analysis.trajectories import trajectories_of
from pogosim.film.replay import replay_data
from pogosim.object_categories import UnknownCategoriesError, ids_of, with_categories
from pogosim.object_facts import TYPES, entries_in, entries_of
from pogosim.picture.figure import notes
from pogosim.picture.layers import wall_lines
from pogosim.picture.swarm import read_recording
from pogosim.scene import bodies_of
from pogosim.utils import load_dataframe
from pogosim.varied import facts_in_common
from pyarrow import feather
from running import example, run

DISK = {"geometry": "disk", "radius": 10}
# Each type, and a category whose entries are of several.
OBJECTS: dict[str, Any] = {
    "boxes": {"type": "passive_object", "nb": 2, **DISK},
    "walls": {"type": "pogowall", "geometry": "arena"},
    "beacons": {"type": "pogobject", "nb": 2, **DISK, "communication_radius": 33},
    "mixed": [
        {"type": "passive_object", "nb": 2, "geometry": "disk", "radius": 12},
        {"type": "pogobot", "nb": 2, "radius": 26.5, "max_linear_speed": 70},
        {"type": "active_object", "nb": 1, "geometry": "disk", "radius": 18},
    ],
    "ring": {"type": "membrane", "geometry": "disk", "radius": 60, "dot_radius": 4, "serialize_dot_pose": True},
    "band": {"type": "rectmembrane", "geometry": "disk", "radius": 60, "rect_thickness": 6},
    "spot": {"type": "static_light", "geometry": "disk", "radius": 100, "x": 500, "y": 500},
    "round": {"type": "orbiting_static_light", "geometry": "disk", "radius": 50, "orbit_radius": 100},
    "tower": {"type": "rotating_ray_of_light", "geometry": "global"},
    "towers": {"type": "alternating_rays_of_light", "geometry": "global"},
}
SCENE = {"initial_formation": "random", "arena_file": "arenas/square.csv", "simulation_time": 0.5, "objects": OBJECTS}


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The file of a run."""
    return run(example("helloworld"), tmp_path_factory.mktemp("mixed"), SCENE).folder / "data.feather"


def changed(data: Path, path: Path, objects: Any = None, types: dict[str, str] | None = None) -> Path:
    """Write the same data file with other metadata `objects` (None: none) and other names of types."""
    table = feather.read_table(data)
    metadata = dict(table.schema.metadata)
    for name in (b"configuration", b"resolved_configuration"):
        for old, new in (types or {}).items():
            metadata[name] = metadata[name].replace(f"type: {old}\n".encode(), f"type: {new}\n".encode())
    del metadata[b"objects"]
    if objects is not None:
        metadata[b"objects"] = json.dumps(objects).encode()
    feather.write_feather(pa.Table.from_batches(table.to_batches()).replace_schema_metadata(metadata), path)
    return path


def test_facts_of_the_simulator_are_those_that_the_types_had(data: Path) -> None:
    _, metadata = load_dataframe(data)
    told, by_type = entries_of(metadata), entries_in(metadata["resolved_configuration"])
    assert {own.settings["type"] for own in told} == set(TYPES) - {"orbiting_light"}
    names = ("category", "has", "drawn_as", "segments", "half_thickness_mm", "infrared_range_mm", "position_mm")
    for one, other in zip(told, by_type, strict=True):
        for name in names:
            assert getattr(one, name) == getattr(other, name), (one.category, name)
        assert pd.isna(one.top_speed_mm_s) == pd.isna(other.top_speed_mm_s)
        assert pd.isna(one.top_speed_mm_s) or one.top_speed_mm_s == other.top_speed_mm_s
    assert all(own.knows_ids for own in bodies_of(told))
    assert ids_of(bodies_of(told), is_periodic=False) == ids_of(bodies_of(by_type), is_periodic=False)


def test_ids_are_those_of_the_rows(data: Path) -> None:
    rows, metadata = load_dataframe(data)
    for category, first, last in ids_of(bodies_of(entries_of(metadata)), is_periodic=False):
        own = rows[rows["robot_category"] == category]["robot_id"]
        assert {first, last} <= set(own)


# Names that Python does not know, each for a type that it does.
RENAMED = {name: f"new_{name}" for name in TYPES}


def test_types_that_python_does_not_know_are_drawn_and_analysed_as_the_file_says(data: Path, tmp_path: Path) -> None:
    rows, metadata = load_dataframe(data)
    new = changed(data, tmp_path / "new.feather", metadata["objects"], RENAMED)
    own = load_dataframe(new)[1]
    assert own["resolved_configuration"]["objects"]["boxes"]["type"] == "new_passive_object"

    before, after = read_recording(data), read_recording(new)
    assert after.last.kinds == before.last.kinds
    assert after.last.top_speed_mm_s == before.last.top_speed_mm_s == 70
    assert [lamp.shape for lamp in after.last.lamps] == [lamp.shape for lamp in before.last.lamps]
    assert notes(after.last) == "not drawn: beams of tower, beams of towers, the shape of band (serialize_dot_pose)"
    span = (0.0, 0.5)
    assert replay_data(after, span)[:2] == replay_data(before, span)[:2]
    assert len(wall_lines(next(kind for kind in after.last.kinds if kind.is_wall), after.last.polygons)) == 1

    told = with_categories(rows.drop(columns="robot_category"), own)
    assert told["robot_category"].tolist() == rows["robot_category"].tolist()
    (robots,) = trajectories_of(rows, own)
    assert set(robots.category) == {"beacons", "mixed"}
    assert set(robots.sizes.reach_mm[robots.category == "beacons"]) == {53.0}


def test_entries_of_a_list_have_their_own_looks(data: Path) -> None:
    swarm = read_recording(data).last
    radii = {own: swarm.kinds[kind].shape.radius_mm for own, kind in swarm.rows[["robot_id", "\0kind"]].to_numpy()}
    first = {own.category: own.first_id for own in entries_of(load_dataframe(data)[1])}
    assert {radii[number] for number in (2, 3)} == {26.5}  # after two beacons
    assert radii[4] == 18
    assert first["ring"] is not None
    assert [radii[number] for number in (65531, 65532)] == [12, 12]  # before them, two boxes and a wall


def test_light_of_a_kind_that_only_the_simulator_knows_is_said_not_to_be_drawn(data: Path, tmp_path: Path) -> None:
    facts = load_dataframe(data)[1]["objects"]
    facts["spot"][0]["drawn_as"] = "nothing"
    swarm = read_recording(changed(data, tmp_path / "a.feather", facts)).last
    assert notes(swarm).startswith("not drawn: beams of tower, beams of towers, light of spot, ")
    assert len(swarm.lamps) == 1


@pytest.mark.parametrize(
    "facts", [None, [], {"mixed": [{}]}, {"mixed": 3}, {"boxes": [{"has": 7}]}, {"mixed": [{"has": ["body"]}]}]
)
def test_files_without_facts_go_by_the_types(data: Path, tmp_path: Path, facts: Any) -> None:
    rows, _ = load_dataframe(data)
    old = changed(data, tmp_path / "old.feather", facts)
    assert read_recording(old).last.kinds == read_recording(data).last.kinds
    told = with_categories(rows.drop(columns="robot_category"), load_dataframe(old)[1])
    assert told["robot_category"].tolist() == rows["robot_category"].tolist()


KEYS = {"communication_radius": 50, "max_linear_speed": 70, "dot_radius": 4, "rect_thickness": 6}
FACTS = {"infrared_range_mm": 60.0, "top_speed_mm_s": 80.0, "half_thickness_mm": 2.5}


def told_of(facts: dict[str, Any]) -> dict[str, float]:
    """Return what an entry with keys for all has, by the facts of the file."""
    told = {"has": ["body", "membrane", "robot", "motors"], "segments": True, **facts}
    (entry,) = entries_in({"objects": {"ring": KEYS}}, {"ring": [told]})
    return {name: getattr(entry, name) for name in FACTS}


def test_facts_of_the_file_count_more_than_keys() -> None:
    assert told_of(FACTS) == FACTS
    assert told_of({}) == {"infrared_range_mm": 50.0, "top_speed_mm_s": 70.0, "half_thickness_mm": 3.0}


@pytest.mark.parametrize("value", ["inf", float("inf"), float("nan"), "far", None, [1], 10**400])
def test_facts_that_are_no_finite_numbers_are_none(value: Any) -> None:
    assert told_of(dict.fromkeys(FACTS, value)) == told_of({})


def test_several_runs_have_the_facts_in_common(tmp_path: Path) -> None:
    columns = {"result_new_columns": ["objects.boxes.nb"], "objects.boxes.nb": {"batch_options": [1, 2]}}
    boxes = {"type": "passive_object", "nb": 1, **DISK}
    fields = {"data_logger_fields": ["time", "robot_id", "x", "y"]}
    objects = {"objects.boxes": boxes, "objects.robots.nb": 2}
    write_options(tmp_path, {**objects, **columns, **fields, "initial_formation": "random"})
    assert batch(tmp_path).code == 0
    (results,) = (tmp_path / "results").glob("*.feather")
    rows, metadata = load_dataframe(results)
    assert metadata["objects"]["boxes"] == [{"type": "passive_object", "has": ["body"]}]
    assert metadata["objects"]["robots"][0]["has"] == ["body", "robot", "motors"]
    told = with_categories(rows, metadata)
    assert told[told["robot_id"] >= 65534]["robot_category"].unique().tolist() == ["boxes"]
    assert [own.robot_id.tolist() for own in trajectories_of(rows, metadata)] == [[0, 1], [0, 1]]


def test_facts_in_common_are_those_of_entries_in_all_runs() -> None:
    robots = {"has": ["body", "robot"], "count": 3, "first_id": 0}
    one = {"robots": [robots], "boxes": [{"has": ["body"]}], "list": [robots, robots], "odd": [{"has": ["body"]}]}
    other = {"robots": [{**robots, "count": 4}], "list": [robots], "odd": [{"has": ["lamp"]}]}
    assert facts_in_common([one, other]) == {"robots": [{"has": ["body", "robot"], "first_id": 0}]}
    assert facts_in_common([one, one]) == one
    assert facts_in_common([one, None]) == {}


def test_ids_that_nothing_says_are_refused(data: Path, tmp_path: Path) -> None:
    rows, metadata = load_dataframe(data)
    facts = metadata["objects"]
    del facts["boxes"][0]["first_id"]
    _, own = load_dataframe(changed(data, tmp_path / "a.feather", facts))
    del own["resolved_configuration"]["objects"]["boxes"]["nb"]
    with pytest.raises(UnknownCategoriesError, match="does not say how many objects"):
        with_categories(rows.drop(columns="robot_category"), own)
