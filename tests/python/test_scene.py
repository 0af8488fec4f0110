from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from pogosim.object_facts import entries_in
from pogosim.scene import Lamp, kinds_in, lamps_in, light_levels, unseen_light
from pogosim.shapes import Shape, shape_of

SQUARE = np.array([[0.0, 0.0], [1000.0, 0.0], [1000.0, 1000.0], [0.0, 1000.0]])
HOLE = np.array([[400.0, 400.0], [600.0, 400.0], [600.0, 600.0], [400.0, 600.0]])


def level(settings: dict[str, Any], x: float, y: float, time_s: float = 10.0) -> float:
    """Light of one static_light at a point of a square with a hole."""
    lamps = lamps_in(entries_in({"objects": {"lamp": {"type": "static_light", "value": 1000, **settings}}}))
    return float(light_levels(lamps, [SQUARE, HOLE], np.array([[x, y]]), time_s)[0])


# ---- shapes ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("settings", "radius"),
    [
        ({"radius": "2.65e1"}, 26.5),
        ({"geometry": "Rectangle", "body_width": 30, "body_height": 40}, 25.0),
        ({"geometry": "triangle", "side_length": 30}, 30 / math.sqrt(3)),
        ({}, 26.5),
        ({"radius": "large"}, 26.5),
        ({"type": "passive_object"}, 10.0),
        ({"type": "Pogobot"}, 26.5),
    ],
)
def test_radius_is_that_of_the_disk_around_the_shape(settings: dict[str, Any], radius: float) -> None:
    assert shape_of(settings).bounding_radius_mm == pytest.approx(radius)
    corners = shape_of(settings).outline()
    assert np.hypot(*corners.T).max() == pytest.approx(radius)


def test_one_corner_of_a_triangle_is_up_and_its_sides_are_equal() -> None:
    corners = Shape(kind="triangle", side_length_mm=30.0).outline()
    assert corners[0] == pytest.approx([0.0, -30.0 / math.sqrt(3.0)])
    assert np.hypot(*(corners - np.roll(corners, 1, axis=0)).T) == pytest.approx([30.0] * 3)


def test_reach_ends_on_the_border_along_the_heading() -> None:
    for shape in (Shape(), Shape("rectangle", width_mm=40.0), Shape("triangle", side_length_mm=30.0)):
        inside, outside = shape.holds(np.array([[0.99, 0.0], [1.01, 0.0]]) * shape.reach_mm)
        assert inside
        assert not outside


def test_only_maps_are_objects_and_lamps_are_none() -> None:
    objects = {
        "walls": {"type": "Pogowall", "x": 3, "y": "4e0"},
        "half": {"type": "pogowall", "x": 3},
        "lamp": {"type": "static_light"},
        "ray": {"type": "rotating_ray_of_light"},
        "text": "not a map",
    }
    found = {kind.category: kind for kind in kinds_in(entries_in({"objects": objects}))}
    assert list(found) == ["walls", "half"]
    assert found["walls"].is_wall
    assert found["walls"].position_mm == (3.0, 4.0)
    assert found["half"].position_mm is None
    assert unseen_light(entries_in({"objects": objects})) == ["beams of ray"]
    assert entries_in({}) == entries_in({"objects": [1]}) == []


def test_membrane_is_as_thick_as_its_dots_or_its_segments() -> None:
    objects = {
        "dots": {"type": "membrane", "dot_radius": 7},
        "segments": {"type": "rectmembrane", "dot_radius": 7},
        "thick": {"type": "rectmembrane", "rect_thickness": 12},
        "robots": {"type": "pogobot"},
    }
    found = kinds_in(entries_in({"objects": objects}))
    assert [own.half_thickness_mm for own in found] == [7.0, 3.5, 6.0, 0.0]


# ---- light -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("settings", "inside", "outside"),
    [
        ({"geometry": "disk", "radius": 100, "x": 300, "y": 300}, (300, 399), (371, 371)),
        ({"geometry": "rectangle", "body_width": 50, "body_height": 200, "x": 300, "y": 300}, (320, 390), (330, 300)),
        ({"geometry": "triangle", "side_length": 100, "x": 300, "y": 300}, (300, 245), (300, 330)),
    ],
)
def test_lamp_lights_its_shape(
    settings: dict[str, Any], inside: tuple[float, float], outside: tuple[float, float]
) -> None:
    assert level(settings, *inside) == 1000
    assert level(settings, *outside) == 0


def test_global_light_is_everywhere_and_that_of_the_arena_in_its_polygons() -> None:
    assert level({"geometry": "global"}, -500, 500) == 1000
    assert level({"geometry": "arena"}, -500, 500) == 0
    assert level({"geometry": "arena"}, 500, 500) == 1000  # in the hole, too


def test_gradient_falls_to_the_edge_value_at_its_radius_and_stays() -> None:
    settings = {"geometry": "global", "light_mode": "gradient", "edge_value": 200, "gradient_radius": 400}
    levels = [level(settings, x, 0) for x in (0, 100, 400, 800)]
    assert levels == pytest.approx([1000, 800, 200, 200])
    # Without a radius: at the farthest corner of the arena, or at the border of the shape.
    del settings["gradient_radius"]
    assert level(settings, 500, 500) == pytest.approx(600)
    assert level({**settings, "geometry": "disk", "radius": 100}, 50, 0) == pytest.approx(600)


def test_plane_goes_from_the_value_to_the_edge_value_along_its_normal() -> None:
    settings = {"geometry": "global", "light_mode": "plane", "x": 500, "y": 500, "plane_half_span": 200}
    assert [level(settings, x, 9) for x in (0, 300, 400, 500, 700, 999)] == pytest.approx([1000, 1000, 750, 500, 0, 0])
    down = {**settings, "plane_angle": math.pi / 2}
    assert level(down, 500, 600) == pytest.approx(250)


def test_photo_start_is_dark_then_a_flash_then_the_normal_light() -> None:
    settings = {"geometry": "global", "photo_start_at": 1.0, "photo_start_duration": 2.0, "photo_start_value": 5000}
    assert [level(settings, 0, 0, t) for t in (0.5, 1.5, 3.5)] == [0, 5000, 1000]


def test_lamps_add_up_to_the_brightest_a_sensor_tells() -> None:
    assert level({"geometry": "global", "nb": 3}, 0, 0) == 3000
    assert level({"geometry": "global", "nb": 50}, 0, 0) == 32767


def test_orbiting_lamp_is_where_it_is_by_then() -> None:
    settings = {"type": "orbiting_static_light", "geometry": "disk", "radius": 50, "center_x": 500, "y": 400}
    orbit = {"orbit_radius": 300, "orbit_angular_speed": math.pi, "orbit_phase": math.pi / 2}
    (lamp,) = lamps_in(entries_in({"objects": {"lamp": {**settings, **orbit}}}))
    assert lamp.centre_at(0.0) == pytest.approx([500, 700])
    assert lamp.centre_at(0.5) == pytest.approx([200, 400])  # clockwise on the screen
    assert Lamp(Shape(), (1.0, 2.0)).centre_at(7.0).tolist() == [1.0, 2.0]


def test_light_of_a_periodic_arena_is_that_of_the_nearest_image() -> None:
    period = np.array([1000.0, 1000.0])
    places = np.array([[995.0, 505.0], [5.0, 505.0], [405.0, 505.0], [805.0, 305.0]])
    for shape in (Shape("disk", radius_mm=220.0), Shape("global")):
        for mode in ("static", "gradient", "plane"):
            middle = Lamp(shape, (505.0, 505.0), mode=mode, value=1000.0, plane_half_span_mm=200.0)
            moved = Lamp(shape, (985.0, 55.0), mode=mode, value=1000.0, plane_half_span_mm=200.0)
            shifted = np.mod(places + np.array([480.0, -450.0]), period)
            levels = light_levels([middle], [SQUARE], places, 0.0, period)
            np.testing.assert_allclose(light_levels([moved], [SQUARE], shifted, 0.0, period), levels)
            assert levels.any()
    seam = Lamp(Shape("disk", radius_mm=220.0), (5.0, 505.0), value=1000.0)
    assert light_levels([seam], [SQUARE], places, 0.0, period).tolist() == [1000.0, 1000.0, 0.0, 0.0]
    assert light_levels([seam], [SQUARE], places, 0.0).tolist() == [0.0, 1000.0, 0.0, 0.0]


# ---- rounded and put together ----------------------------------------------------------------------------------------

TRAY: dict[str, Any] = {
    "type": "pogobject",
    "geometry": "compound",
    "parts": [
        {"geometry": "rectangle", "body_width": 12, "body_height": 120},
        {"geometry": "rectangle", "body_width": 68, "body_height": 12, "x": 40, "y": -54},
        {"geometry": "rectangle", "body_width": 68, "body_height": 12, "x": 40, "y": 54, "angle_deg": 180},
    ],
}


def area_of(corners: Any) -> float:
    x, y = corners.T
    return abs(float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))) / 2.0


def test_capsule_is_a_rectangle_with_half_circles() -> None:
    shape = shape_of({"geometry": "capsule", "body_width": 60, "body_height": 20})
    assert shape.bounding_radius_mm == pytest.approx(30.0)
    assert shape.reach_mm == pytest.approx(30.0)
    assert area_of(shape.outline()) == pytest.approx(800 + 100 * np.pi, rel=0.005)


def test_corner_radius_cuts_corners_off() -> None:
    box = {"geometry": "rectangle", "body_width": 60, "body_height": 40, "corner_radius": 5}
    assert area_of(shape_of(box).outline()) == pytest.approx(2400 - (4 - np.pi) * 25, rel=0.001)
    assert np.abs(shape_of(box).outline()).max(axis=0) == pytest.approx([30.0, 20.0])


def test_polygon_has_its_centre_of_mass_in_the_origin() -> None:
    shape = shape_of({"geometry": "polygon", "corners": [[100, 100], [160, 100], [160, 140], [100, 140]]})
    assert shape.outline().mean(axis=0) == pytest.approx([0.0, 0.0])
    assert shape.reach_mm == pytest.approx(30.0)


def test_outline_of_a_compound_goes_around_its_parts() -> None:
    shape = shape_of(TRAY)
    assert len(shape.outline()) == 8
    assert area_of(shape.outline()) == pytest.approx(12 * 120 + 2 * 68 * 12, rel=0.001)
    inside = shape.holds(np.array([[0.0, 0.0], [40.0, 54.0], [-21.0, 0.0]]))
    assert inside.tolist() == [False, True, True]
    assert shape.reach_mm == 0.0  # its opening is ahead


def test_hole_of_a_compound_stays_open() -> None:
    bars = [{"geometry": "rectangle", "body_width": 100, "body_height": 10, "y": y} for y in (-45, 45)]
    posts = [{"geometry": "rectangle", "body_width": 10, "body_height": 80, "x": x} for x in (-45, 45)]
    shape = shape_of({"type": "passive_object", "geometry": "compound", "parts": bars + posts})
    assert area_of(shape.outline()) == pytest.approx(100 * 100 - 80 * 80, rel=0.001)
    assert shape.holds(np.array([[0.0, 0.0], [0.0, 45.0]])).tolist() == [False, True]


@pytest.mark.parametrize("parts", [None, [], "x", [3], [{"geometry": "polygon"}]])
def test_compound_that_cannot_be_read_is_a_disk(parts: Any) -> None:
    shape = shape_of({"type": "passive_object", "geometry": "compound", "parts": parts})
    assert np.isfinite(shape.outline()).all()
