"""Links between bodies in pictures, films and replays of a data file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from pogosim.errors import PictureError
from pogosim.film.first_picture import first_picture
from pogosim.film.frames import ABOVE_PX, FILLED, Frames
from pogosim.film.replay import replay_data
from pogosim.picture import layers
from pogosim.picture.body_links import BodyLinks, placed_at
from pogosim.picture.palette import PALETTE, tension_colours
from pogosim.picture.swarm import OBJECT, read_recording, read_swarm
from recordings import link_table, linked


def links_in(path: Path) -> BodyLinks:
    links = read_recording(path).last.links
    assert links is not None
    return links


def test_ends_turn_with_their_bodies(tmp_path: Path) -> None:
    swarm = read_swarm(linked(tmp_path / "a.feather", link_table()))
    assert swarm.links is not None
    found = placed_at(swarm.links, swarm.rows.groupby(OBJECT).tail(1), OBJECT, swarm.end_s, None)
    # Robots head down at y = 300 mm, at the end.
    np.testing.assert_allclose(found.start, [[166.667, 320.0], [833.333, 300.0]], atol=1e-3)
    np.testing.assert_allclose(found.end, [[500.0, 300.0], [500.0, 900.0]], atol=1e-3)
    assert found.kind.tolist() == ["spring", "rod"]
    assert found.is_pinned.tolist() == [False, True]
    assert found.load.tolist() == [1.0, 0.0]  # pulled, and as much as any spring


def test_load_is_tension_by_breaking_force(tmp_path: Path) -> None:
    swarm = read_swarm(linked(tmp_path / "a.feather", link_table(breaking_n=[2.0, None], rest_mm=[600, 500])))
    assert swarm.links is not None
    (load, _) = placed_at(swarm.links, swarm.rows.groupby(OBJECT).tail(1), OBJECT, swarm.end_s, None).load
    length = np.hypot(500.0 - 166.667, 20.0)
    assert load == pytest.approx(2e-3 * (length - 600.0) / 2.0, rel=1e-4)


def test_link_across_the_border_is_the_short_one(tmp_path: Path) -> None:
    path = linked(tmp_path / "a.feather", link_table(b=[2, -1]), boundary_condition="periodic")
    swarm = read_swarm(path)
    assert swarm.links is not None
    box = (np.zeros(2), np.full(2, 1000.0))
    found = placed_at(swarm.links, swarm.rows.groupby(OBJECT).tail(1), OBJECT, swarm.end_s, box)
    np.testing.assert_allclose(found.end[0], [833.333 - 1000.0, 300.0], atol=1e-3)


def test_links_that_are_made_and_cut_hold_in_between(tmp_path: Path) -> None:
    made = {**link_table(), "time_s": [0.5, 1.0]}
    changes = {"made": made, "cut": {"link": [0, 2], "time_s": [1.5, 2.0]}}
    links = links_in(linked(tmp_path / "a.feather", link_table(), changes))
    assert [len(links.at(time_s)) for time_s in (0.0, 0.4, 0.5, 1.0, 1.5, 2.0)] == [2, 2, 3, 4, 3, 2]
    only_made = links_in(linked(tmp_path / "b.feather", None, changes={**changes, "cut": {"link": [], "time_s": []}}))
    assert [len(only_made.at(time_s)) for time_s in (0.0, 0.5, 1.0)] == [0, 1, 2]


def test_links_that_are_not_drawn_or_have_no_rows_are_left_out(tmp_path: Path) -> None:
    hidden = link_table(categories=[{"name": "skin", "drawn": False}])
    assert read_recording(linked(tmp_path / "a.feather", hidden)).last.links is None
    others = link_table(objects=[["robots", 0], ["pucks", 1], ["robots", 2]])
    assert len(links_in(linked(tmp_path / "b.feather", others))) == 1
    assert read_recording(linked(tmp_path / "c.feather")).last.links is None


@pytest.mark.parametrize(
    "links", [{}, link_table(a=[0, 7]), link_table(kind=["spring"]), link_table(end_a_mm=[[1], [2]])]
)
def test_metadata_that_are_none_are_refused(tmp_path: Path, links: dict[str, Any]) -> None:
    path = linked(tmp_path / "a.feather", links)
    with pytest.raises(PictureError, match="its metadata 'links' or 'link_changes' are not those of the simulator"):
        read_recording(path)


def test_colours_lead_from_pushed_to_pulled() -> None:
    expected = [to_rgb(PALETTE[name]) for name in ("link_pushed", "link_at_rest", "link_pulled")]
    np.testing.assert_allclose(tension_colours([-1.0, 0.0, 1.0]), expected)
    np.testing.assert_allclose(tension_colours([0.5])[0], np.mean(expected[1:], axis=0))


def test_picture_has_a_line_for_each_link(tmp_path: Path) -> None:
    swarm = read_swarm(linked(tmp_path / "a.feather", link_table()))
    axes = Figure(figsize=(5, 5)).add_subplot()
    layers.draw_scene(axes, swarm)
    lines = [own for own in axes.collections if isinstance(own, LineCollection) and own.get_zorder() == 4.6]
    drawn = [segment for own in lines for segment in own.get_segments()]
    assert len(drawn) == 4  # each with an edge
    np.testing.assert_allclose(drawn[0], [[833.333, 300.0], [500.0, 900.0]], atol=1e-3)


def test_frame_of_a_film_has_the_links_of_its_time(tmp_path: Path) -> None:
    changes = {"made": {**link_table(), "time_s": [9, 9]}, "cut": {"link": [1], "time_s": [1.0]}}
    recording = read_recording(linked(tmp_path / "a.feather", link_table(), changes))
    frames = Frames(recording, (400, 400 + ABOVE_PX), {})

    def on_the_rod(time_s: float, y_mm: float) -> list[int]:
        """Halfway between robot 2, at this y, and the place that it is linked to."""
        frame = np.empty((400 + ABOVE_PX, 400, 3), np.uint8)
        frames.draw(time_s, frame)
        scale = FILLED * 400 / 1000
        x = 200 + scale * ((833.333 + 500.0) / 2.0 - 500.0)
        y = ABOVE_PX + 200 + scale * ((y_mm + 900.0) / 2.0 - 500.0)
        return [int(channel) for channel in frame[int(y), int(x)]]

    at_rest = [round(255 * channel) for channel in to_rgb(PALETTE["link_at_rest"])]
    np.testing.assert_allclose(on_the_rod(0.0, 100.0), at_rest, atol=60)
    assert max(on_the_rod(1.5, 250.0)) < 60  # the floor


def test_replay_has_the_links_and_its_first_picture_shows_them(tmp_path: Path) -> None:
    path = linked(tmp_path / "a.feather", link_table(breaking_n=[0.5, None]))
    head, _, picture, _ = replay_data(read_recording(path), (0.0, 2.0))
    links = head["bodyLinks"]
    assert (links["a"], links["b"], links["kind"]) == ([0, 2], [1, -1], ["spring", "rod"])
    assert links["breaking"] == [0.5, None]
    assert links["stiffness"] == [0.002, 0.0]
    assert links["cut"] == [5.0, 5.0]
    assert picture.count(PALETTE["link_at_rest"]) == 1
    assert "M833.33 100L500 900" in picture
    without = replay_data(read_recording(linked(tmp_path / "b.feather")), (0.0, 2.0))[0]
    assert without["bodyLinks"] is None
    assert first_picture(without, np.full((3, 3), np.nan), ["#000000"] * 3).count("<path") == 2
