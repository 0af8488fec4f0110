"""Numbers that look like ones in another unit, or are cut, are warned of."""

from __future__ import annotations

from pathlib import Path

import pytest
from running import ROOT, Run, Settings, example, run, warnings

SQUARE: Settings = {"arena_file": str(ROOT / "arenas/square.csv"), "simulation_time": 0.1, "time_step": 0.001}


def greet(folder: Path, settings: Settings) -> Run:
    return run(example("helloworld"), folder, {**SQUARE, **settings})


@pytest.mark.parametrize(
    ("settings", "text"),
    [
        (
            {"objects.robots.nb": 2.5},
            "objects.robots.nb: expected an integer, found 2.5; 2 is used",
        ),
        (
            {"objects.robots.angular_systematic_bias_domain": [-1.5, 2]},
            "objects.robots.angular_systematic_bias_domain.0: expected an integer, found -1.5; -1 is used",
        ),
        ({"seed": 0.5}, "seed: expected an integer, found 0.5; 0 is used"),
    ],
    ids=["nb", "list", "seed"],
)
def test_fraction_of_an_integer_is_warned_of_once(tmp_path: Path, settings: Settings, text: str) -> None:
    (warning,) = warnings(greet(tmp_path, settings))
    assert warning.startswith("scene.yaml:")
    assert warning.endswith(text)


BODY = {"type": "passive_object", "geometry": "rectangle", "body_width": 9, "body_height": 9, "x": 500, "y": 500}
LAMP = {"type": "static_light", "light_mode": "plane", "geometry": "disk", "radius": 500, "x": 500, "y": 500}


@pytest.mark.parametrize(
    ("key", "value", "unit", "hint"),
    [
        ("robots.radius", 0.0265, "mm", "small; if you meant metres, write 26.5"),
        ("robots.communication_radius", 0.08, "mm", "small; if you meant metres, write 80"),
        ("robots.max_linear_speed", 0.1, "mm/s", "small; if you meant metres per second, write 100"),
        ("robots.max_angular_speed", 114.6, "rad/s", "large; if you meant degrees per second, write 2.00015"),
        ("robots.angular_noise_stddev", 57.3, "rad/s", "large; if you meant degrees per second, write 1.00007"),
        ("body.body_width", 0.3, "mm", "small; if you meant metres, write 300"),
        ("lamp.y", 0.5, "mm", "small; if you meant metres, write 500"),
        ("lamp.radius", 0.5, "mm", "small; if you meant metres, write 500"),
        ("lamp.plane_angle", 90, "rad", "large; if you meant degrees, write 1.5708"),
    ],
)
def test_number_in_another_unit_is_warned_of_with_the_one_that_was_meant(
    tmp_path: Path, key: str, value: float, unit: str, hint: str
) -> None:
    settings = {"objects.body": dict(BODY), "objects.lamp": dict(LAMP), f"objects.{key}": value}
    # A lamp of half a millimetre also lights no cell, and slow robots move by few units of their coordinates.
    others = ("lights no cell", "speeds are rounded")
    (warning,) = [text for text in warnings(greet(tmp_path, settings)) if not any(other in text for other in others)]
    assert warning.endswith(f": objects.{key}: {value} {unit} is unusually {hint}")


def test_list_in_another_unit_is_warned_of_once_for_each_unit(tmp_path: Path) -> None:
    # 60 obstacles in metres and degrees: 119 coordinates (one is 0), 59 angles.
    poses = [[0.01 * i, 0.5 + 0.002 * i, 10.0 * (i % 36) + 7.0] for i in range(60)]
    corner = {"type": "passive_object", "geometry": "disk", "radius": 1, "body_fixed": True, "poses": poses}
    units = [text for text in warnings(greet(tmp_path, {"objects.corner": corner})) if " is unusually " in text]
    assert [warning.partition(": objects.")[2] for warning in units] == [
        "corner.poses.0.1: 0.5 mm is unusually small, like 118 other numbers of this list; "
        "if you meant metres, write 500",
        "corner.poses.0.2: 7.0 rad is unusually large, like 59 other numbers of this list; "
        "if you meant degrees, write 0.122173",
    ]


@pytest.mark.parametrize(
    ("first", "text"),
    [
        (0.1, "area.0.0: 0.1 mm is unusually small, like 2 other numbers of this list; if"),
        (0, "area.0.1: 0.1 mm is unusually small, like another number of this list; if"),
    ],
)
def test_area_in_another_unit_is_warned_of_once(tmp_path: Path, first: float, text: str) -> None:
    (warning,) = warnings(greet(tmp_path, {"objects.robots.area": [[first, 0.1], [900, 0.1], [900, 900]]}))
    assert text in warning


def test_arena_of_a_square_metre_is_warned_of_before_it_has_no_room(tmp_path: Path) -> None:
    result = greet(tmp_path, {"arena_surface": 1.0})
    assert result.code == 2
    warning, error = result.errors.splitlines()
    assert warning.endswith("1.0 mm2 is unusually small; if you meant square metres, write 1000000")
    assert error.startswith("Error: ")


def test_small_and_computed_numbers_that_are_meant_are_not_warned_of(tmp_path: Path) -> None:
    settings = {
        "arena_surface": 1.0e4,
        "objects.robots.radius": 1.0,
        "objects.robots.communication_radius": 0,
        "objects.robots.max_linear_speed": 0,
        "objects.body": {**BODY, "body_width": 5, "body_height": 1, "x": 50, "y": 50},
        "objects.lamp": {**LAMP, "x": 6.1e-15, "y": 0, "plane_angle": 6.2831853},
    }
    assert warnings(greet(tmp_path, settings)) == []
