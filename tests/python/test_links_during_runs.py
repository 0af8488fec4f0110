"""Links between bodies from Python: `Simulation.links`, `link` and `cut`."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pogosim
import pytest
from pogosim.picture.swarm import read_recording
from pogosim.simulation import ConfigurationError
from running import ROOT, write_scene

PUCK = {"type": "passive_object", "nb": 1, "geometry": "disk", "radius": 20.0}
MEMBRANE = {"type": "membrane", "nb": 1, "geometry": "disk", "radius": 100.0, "num_dots": 40}
PUCK_INDEX = 3  # objects in the order of the scene: three robots, a puck


@pytest.fixture
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("POGOSIM_DIR", str(ROOT))
    return write_scene(
        tmp_path,
        {"objects.pucks": PUCK, "objects.robots.nb": 3, "arena_file": str(ROOT / "arenas" / "disk.csv")},
    )


@pytest.fixture
def still(hosted: Path, scene: Path) -> Iterator[pogosim.Simulation]:
    """A run without a data file."""
    with pogosim.Simulation(hosted, scene, set={"enable_data_logging": False}) as simulation:
        yield simulation


def between(sim: pogosim.Simulation, a: int, b: int) -> float:
    return math.dist(sim.objects[a].position, sim.objects[b].position)


def test_links_are_read_as_arrays(sim: pogosim.Simulation) -> None:
    assert len(sim.links) == 0
    puck = sim.objects.of("pucks")[0]
    assert sim.link(0, 1, stiffness=2.0, damping=0.5, breaking_force=3.0, length=40.0, end_a=(20.0, 5.0)) == 0
    assert sim.link(sim.objects[2], puck, "rod") == 1
    assert sim.link(1, (500.0, 510.0), "spring", damping=1) == 2
    links = sim.links
    assert links["kind"].tolist() == ["spring", "rod", "spring"]
    assert links["a"].tolist() == [0, 2, 1]
    assert links["b"].tolist() == [1, PUCK_INDEX, -1]
    assert links["robot_a"].tolist() == [0, 2, 1]
    assert links["robot_b"].tolist() == [1, -1, -1]
    np.testing.assert_allclose(links["end_a_mm"][0], [20.0, 5.0])
    np.testing.assert_allclose(links["end_b_mm"][2], [500.0, 510.0])
    np.testing.assert_allclose(links["rest_mm"], [40.0, between(sim, 2, 3), links["length_mm"][2]], rtol=1e-5)
    assert links["stiffness_n_m"].tolist() == [2.0, 0.0, 0.0]
    assert links["damping_n_s_m"].tolist() == [0.5, 0.0, 1.0]
    assert links["breaking_n"].tolist() == [3.0, np.inf, np.inf]
    assert links["length_mm"][1] == pytest.approx(between(sim, 2, 3), rel=1e-5)
    assert links["tension_n"].tolist() == [0.0, 0.0, 0.0]
    assert links["is_cut"].tolist() == [False] * 3


def test_hinge_holds_what_is_halfway_and_has_limits(sim: pogosim.Simulation) -> None:
    sim.link(0, 1, "hinge", limits=(-0.5, 1.0))
    (hinge,) = sim.links
    assert hinge["length_mm"] == pytest.approx(0.0, abs=1e-3)
    assert (hinge["least_rad"], hinge["most_rad"], hinge["rest_mm"]) == (-0.5, 1.0, 0.0)
    assert np.hypot(*hinge["end_a_mm"]) == pytest.approx(between(sim, 0, 1) / 2.0, rel=1e-5)


def test_links_are_cut_by_index_by_array_or_where_something_is_true(sim: pogosim.Simulation) -> None:
    for stiffness in (1.0, 2.0, 3.0, 4.0, 5.0):
        sim.link(0, 1, stiffness=stiffness)
    sim.cut(4)
    assert sim.links["is_cut"].tolist() == [False] * 4 + [True]
    sim.cut(np.array([0, 4]))
    sim.cut(sim.links["stiffness_n_m"] == 2.0)
    sim.cut([])
    assert sim.links["is_cut"].tolist() == [True, True, False, False, True]
    assert sim.link(0, 2, stiffness=1.0) == 5


@pytest.mark.parametrize(
    ("arguments", "options", "message"),
    [
        ((0, 0), {"stiffness": 1}, "object 0 cannot be linked to itself"),
        ((0, 9), {}, "b: there is no object 9: the run has 4"),
        ((-1, 1), {}, "a: there is no object -1: the run has 4"),
        ((0, "x"), {}, "b: expected an integer, found 'x'"),
        ((0, (1.0, 2.0, 3.0)), {}, r"b: expected 2 numbers, found \(1.0, 2.0, 3.0\)"),
        ((0, 1, "rope"), {}, "kind: expected 'spring', 'rod' or 'hinge', found 'rope'"),
        ((0, 1), {}, "stiffness: a spring without stiffness and damping would do nothing"),
        ((0, 1), {"stiffness": -1}, r"stiffness: expected a number from 0 to 1e\+09, found -1"),
        ((0, 1), {"stiffness": math.inf}, "stiffness: expected a finite number, found inf"),
        ((0, 1), {"stiffness": 1, "breaking_force": math.nan}, "breaking force: expected a number above 0, found nan"),
        ((0, 1, "rod"), {"length": 1.0}, "length: a rod of 1 mm does not fit ends that are "),
        ((0, 1), {"stiffness": 1, "limits": (-1, 1)}, "limits: only hinges have some"),
        ((0, 1, "hinge"), {"limits": (-60, 60)}, "limits: expected angles in rad, up to 2 pi, found -60"),
        ((0, 1, "hinge"), {"limits": (0.5, 1)}, "least angle: expected a number of at most 0, found 0.5"),
        ((0, (1, 2)), {"stiffness": 1, "end_b": (0, 0)}, "end_b: b is a place, which has no end of its own"),
    ],
)
def test_wrong_link_is_refused(
    sim: pogosim.Simulation, arguments: tuple[Any, ...], options: dict[str, Any], message: str
) -> None:
    with pytest.raises(ConfigurationError, match=message):
        sim.link(*arguments, **options)
    assert len(sim.links) == 0


@pytest.mark.parametrize(
    ("links", "message"),
    [
        (1, "links: there is no link 1: the run has 1"),
        ([0, -1], "links: there is no link -1: the run has 1"),
        ([True, False], "links: expected 1 values of True or False, one for each, found 2"),
        (0.5, "links: expected an index, an array of indices, or True or False for each link, found 0.5"),
        ("all", "links: expected an index"),
    ],
)
def test_wrong_cut_is_refused_and_cuts_nothing(sim: pogosim.Simulation, links: Any, message: str) -> None:
    sim.link(0, 1, stiffness=1.0)
    with pytest.raises(ConfigurationError, match=message):
        sim.cut(links)
    assert not sim.links["is_cut"].any()


def test_data_file_says_that_links_were_made_and_when(sim: pogosim.Simulation) -> None:
    sim.step(10)
    sim.link(0, PUCK_INDEX, stiffness=1e-3)
    sim.link(1, (500.0, 500.0), stiffness=1e-3)
    sim.step(10)
    sim.cut(0)
    sim.step(10)
    sim.end()
    rows = sim.to_dataframe()
    assert rows.attrs["touched"] == f"3 times from t = {10 * sim.time_step:.4f} s on: links made or cut"
    changes = json.loads(rows.attrs["link_changes"])
    assert changes["made"]["objects"] == [["robots", 0], ["robots", 1], ["pucks", sim.objects[PUCK_INDEX].id]]
    assert changes["made"]["b"] == [2, -1]
    np.testing.assert_allclose(changes["made"]["time_s"], [11 * sim.time_step] * 2)
    assert changes["cut"]["link"] == [0]
    np.testing.assert_allclose(changes["cut"]["time_s"], [21 * sim.time_step])
    links = read_recording(sim.data_file).last.links
    assert links is not None
    assert [len(links.at(steps * sim.time_step)) for steps in (10, 11, 20, 21)] == [0, 2, 2, 1]


def test_rod_keeps_a_driving_robot_at_its_distance(sim: pogosim.Simulation) -> None:
    x, y = sim.objects[0].position
    sim.link(0, (x + 60.0, y), "rod")
    sim.step(300)
    assert math.dist(sim.objects[0].position, (x, y)) > 5.0  # it drives on
    (rod,) = sim.links
    assert rod["length_mm"] == pytest.approx(60.0, abs=0.5)
    assert rod["tension_n"] != 0.0


def test_spring_breaks_and_the_data_file_says_when(sim: pogosim.Simulation) -> None:
    sim.link(0, 1, stiffness=10.0, length=0.0, breaking_force=1e-3)
    sim.link(1, 2, stiffness=1e-3)
    sim.step(5)
    assert sim.links["is_cut"].tolist() == [True, False]
    assert sim.links["tension_n"][0] == 0.0
    sim.end()
    cut = json.loads(sim.to_dataframe().attrs["link_changes"])["cut"]
    assert cut["link"] == [0]
    assert 0.0 < cut["time_s"][0] < 6 * sim.time_step


def test_run_goes_on_from_a_state_with_its_links(still: pogosim.Simulation) -> None:
    still.link(0, 1, stiffness=1e-3)
    still.step(10)
    saved, before = still.save(), still.links
    still.cut(0)
    still.link(0, 2, stiffness=1e-3)
    still.link(1, PUCK_INDEX, "rod")
    still.step(10)
    first = still.state_hash
    assert still.links["is_cut"].tolist() == [True, False, False]
    still.restore(saved)
    np.testing.assert_array_equal(still.links, before)
    still.cut(0)
    still.link(0, 2, stiffness=1e-3)
    still.link(1, PUCK_INDEX, "rod")
    still.step(10)
    assert still.state_hash == first


def test_state_hash_has_the_links(still: pogosim.Simulation) -> None:
    without = still.state_hash
    still.link(0, 1, stiffness=1.0)
    linked = still.state_hash
    still.cut(0)
    assert len({without, linked, still.state_hash}) == 3


def test_membrane_cannot_be_linked(hosted: Path, scene: Path) -> None:
    with pogosim.Simulation(hosted, scene, set={"objects.skin": MEMBRANE}) as sim:
        (skin,) = sim.objects.of("skin")
        with pytest.raises(ConfigurationError, match="of category 'skin' is a membrane, which cannot be linked"):
            sim.link(0, skin, stiffness=1.0)
