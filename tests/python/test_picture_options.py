"""pogosim picture at chosen times, coloured by a column, with links, of one run of several."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from pogosim.errors import PictureError
from pogosim.picture.colouring import Legend, Scale, colouring_of
from pogosim.picture.figure import draw, draw_series
from pogosim.picture.links import link_segments, links_at_end, proximity_pairs
from pogosim.picture.palette import NO_LED
from pogosim.picture.selection import one_run
from pogosim.picture.swarm import OBJECT, RGB, read_recording
from pogosim.swarm_picture import main
from recordings import walkers, write


@pytest.fixture
def data(tmp_path: Path) -> Path:
    return write(tmp_path / "data.feather", walkers())


def texts(figure: Figure) -> str:
    own = [text.get_text() for axes in figure.axes for text in [*axes.texts, axes.title]]
    return "\n".join([*own, *(text.get_text() for text in figure.texts)])


@pytest.mark.parametrize(("time_s", "record"), [(0.0, 0), (0.5, 1), (0.74, 1), (1.9999, 3), (2.0, 4)])
def test_state_at_a_time_is_the_last_one_saved(data: Path, time_s: float, record: int) -> None:
    swarm = read_recording(data).until(time_s)
    assert swarm.end_s == record * 0.5
    last = swarm.rows.groupby(OBJECT).tail(1)
    assert last["y"].tolist() == [100.0 + 50.0 * record] * 3


def test_time_in_single_precision_is_found_by_its_decimal_number(tmp_path: Path) -> None:
    rows = walkers().assign(time=lambda frame: np.float32(0.2) * frame["time"])
    assert read_recording(write(tmp_path / "a.feather", rows)).until(0.3).end_s == pytest.approx(0.3)


def test_each_time_is_a_panel_under_its_time(data: Path) -> None:
    recording = read_recording(data)
    figure = draw_series([recording.until(time_s) for time_s in (0.0, 0.5, 2.0, 1.0, 1.5)])
    assert [axes.get_title() for axes in figure.axes] == ["0 s", "0.5 s", "2 s", "1 s", "1.5 s"]
    assert "3\u00a0robots" in texts(figure)


def test_numbers_go_from_the_first_to_the_last_colour_and_gaps_are_blue_grey() -> None:
    rows = pd.DataFrame({"a": [4.0, 0.0, np.nan, 8.0, 4.0]})
    scale = colouring_of(rows, "a")
    assert isinstance(scale, Scale)
    assert (scale.low, scale.high) == (0.0, 8.0)
    colours = scale.colours(rows["a"])
    np.testing.assert_array_equal(colours[[1, 3]], scale.shades[[0, -1]])
    np.testing.assert_array_equal(colours[2], NO_LED)
    np.testing.assert_array_equal(colours[0], colours[4])


@pytest.mark.parametrize(
    ("values", "labels"),
    [
        (["b", "a", None, "b"], ("a", "b")),
        ([True, False, None, True], ("false", "true")),
        (pd.Categorical(["x", "y", "x", None], categories=["y", "x", "unused"]), ("x", "y")),
        ([None, None, None, None], ()),
    ],
)
def test_names_have_a_colour_each(values: object, labels: tuple[str, ...]) -> None:
    rows = pd.DataFrame({"a": values})
    legend = colouring_of(rows, "a")
    assert isinstance(legend, Legend)
    assert legend.labels == labels
    colours = legend.colours(rows["a"])
    missing = rows["a"].isna().to_numpy()
    assert (colours[missing] == NO_LED).all()
    assert len(np.unique(colours[~missing], axis=0)) == len(labels)


def test_column_colours_robots_and_their_key_names_it(data: Path) -> None:
    recording = read_recording(data, color_by="heard")
    last = recording.until().rows.groupby(OBJECT).tail(1)
    assert last[RGB].to_numpy()[2].tolist() == recording.last.colouring.shades[-1].tolist()  # type: ignore[union-attr]
    assert "heard" in draw(recording.until()).axes[1].get_ylabel()
    figure = draw(read_recording(data, color_by="state").until())
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["waits", "walks"]
    assert legend.get_title().get_text() == "state"


@pytest.mark.parametrize("categories", [("robots",), ("robots", "others")])
def test_categories_without_leds_have_a_legend_if_there_are_several(tmp_path: Path, categories: tuple[str]) -> None:
    rows = walkers().drop(columns="led_rgb")
    rows["robot_category"] = np.array(categories)[rows["robot_id"] % len(categories)]
    recording = read_recording(write(tmp_path / "a.feather", rows, {name: {"type": "pogobot"} for name in categories}))
    legends = draw(recording.until()).legends
    shown = [[text.get_text() for text in legend.get_texts()] for legend in legends]
    assert shown == ([["others", "robots"]] if len(categories) > 1 else [])
    if legends:
        (legend,) = legends
        swatches = [to_rgb(line.get_markerfacecolor()) for line in legend.get_lines()]
        own = recording.last.rows.groupby("robot_category")[RGB].first().to_numpy().tolist()
        assert swatches == [pytest.approx(colour) for colour in own]
        assert legend.get_title().get_text() == "robot_category"


@pytest.mark.parametrize(
    ("column", "said"),
    [
        ("none", "it has no column none; it has time, "),
        ("heared", "it has no column heared; did you mean 'heard'\\?"),
        ("sped", "it has no column sped; did you mean 'speed'\\?"),
        ("subpart_id", "it has no column subpart_id; it has time, "),
        ("lists", "holds neither numbers nor names nor truth values"),
    ],
)
def test_column_that_gives_no_colours_is_refused(tmp_path: Path, column: str, said: str) -> None:
    data = write(tmp_path / "a.feather", walkers().assign(lists=pd.Series([[1]] * 15)))
    with pytest.raises(PictureError, match=said):
        read_recording(data, color_by=column)


RANGE, RADIUS = np.full(3, 80.0), np.full(3, 26.5)


@pytest.mark.parametrize(("gap", "linked"), [(132.9, True), (133.0, True), (133.1, False)])
def test_robots_are_linked_within_range_and_two_radii(gap: float, linked: bool) -> None:
    place = np.array([[100.0, 100.0], [100.0 + gap, 100.0], [900.0, 900.0]])
    assert proximity_pairs(place, RANGE, RADIUS).tolist() == ([[0, 1]] if linked else [])


def test_links_cross_the_border_of_a_periodic_arena_only() -> None:
    place = np.array([[20.0, 500.0], [980.0, 500.0], [500.0, 500.0]])
    box = (np.zeros(2), np.full(2, 1000.0))
    assert proximity_pairs(place, RANGE, RADIUS).tolist() == []
    pairs = proximity_pairs(place, RANGE, RADIUS, box)
    assert pairs.tolist() == [[0, 1]]
    assert link_segments(place, pairs, box).tolist() == [[[20, 500], [-20, 500]], [[980, 500], [1020, 500]]]


def test_pairs_are_those_of_comparing_all() -> None:
    random = np.random.default_rng(1)
    place, ranges = random.uniform(0, 1000, (80, 2)), random.choice([0.0, 40.0, 120.0], 80)
    radii = random.uniform(5, 40, 80)
    size = np.full(2, 1000.0)
    expected = []
    for i in range(80):
        for j in range(i + 1, 80):
            step = np.abs(place[i] - place[j])
            reach = max(ranges[i], ranges[j])
            if reach and np.hypot(*np.minimum(step, size - step)) <= reach + radii[i] + radii[j]:
                expected.append([i, j])
    assert len(expected) > 50
    assert proximity_pairs(place, ranges, radii, (np.zeros(2), size)).tolist() == expected


def test_objects_without_a_program_are_not_linked(tmp_path: Path) -> None:
    rows = walkers(2).assign(x=lambda frame: 400 + 60 * frame["robot_id"])
    box = rows[rows["robot_id"] == 0].assign(robot_category="box", x=340.0)
    data = write(tmp_path / "a.feather", pd.concat([rows, box]), {"box": {"type": "passive_object", "radius": 20}})
    assert links_at_end(read_recording(data).until()).tolist() == [[[400, 300], [460, 300]]]
    alone = write(tmp_path / "b.feather", box, {"box": {"type": "passive_object", "radius": 20}})
    assert len(links_at_end(read_recording(alone).until())) == 0


def test_run_is_chosen_by_its_number(tmp_path: Path) -> None:
    rows = pd.concat([walkers(2).assign(run=3), walkers(4).assign(run=5)])
    data = write(tmp_path / "a.feather", rows)
    assert read_recording(data).last.rows[OBJECT].nunique() == 2
    assert read_recording(data, run=5).last.rows[OBJECT].nunique() == 4
    with pytest.raises(PictureError, match="it has no run 4, only 3 to 5"):
        read_recording(data, run=4)


def test_combinations_of_a_batch_are_not_mixed() -> None:
    rows = pd.concat([walkers(2).assign(run=0), walkers(4).assign(run=0)])
    arena = np.array([[0.0, 0.0], [9.0, 0.0], [9.0, 9.0]])
    metadata = {"combinations": [{"rows": 10}, {"rows": 20, "arena_polygons": [arena]}]}
    first, polygons, left_out = one_run(rows, metadata, None, None)
    assert (len(first), polygons) == (10, [])
    assert "2 combinations" in left_out
    second, polygons, left_out = one_run(rows, metadata, 0, 1)
    assert (len(second), left_out) == (20, "")
    assert polygons[0] is arena
    with pytest.raises(PictureError, match="no combination 2"):
        one_run(rows, metadata, None, 2)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--at", "3"], "it has rows from 0 s to 2 s, none at 3 s"),
        (["--at", "0", "-1"], "none at -1 s"),
        (["--color-by", "none"], "it has no column none; it has time, robot_category"),
        (["--run", "1"], "it has no run 1: no column run numbers several runs"),
        (["--combination", "0"], "it has no combination 0"),
    ],
)
def test_what_is_not_in_the_file_is_one_line(
    data: Path, options: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([str(data), str(data.parent / "out.png"), *options]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"swarm_picture: cannot draw {data}: ")
    assert said in line
    assert not (data.parent / "out.png").exists()


def test_all_options_at_once(data: Path) -> None:
    out = data.parent / "out.png"
    options = ["--at", "0", "1", "--color-by", "fed", "--links", "--tail", "1", "--dpi", "40", "--run", "0"]
    assert main([str(data), str(out), *options]) == 0
    assert out.stat().st_size > 1000


def test_speed_is_that_since_the_record_before(data: Path) -> None:
    rows = read_recording(data, color_by="speed").last.rows
    assert rows.loc[rows["time"] == 0.0, "speed"].isna().all()
    np.testing.assert_allclose(rows.loc[rows["time"] > 0.0, "speed"], 100.0, rtol=1e-5)
    own = read_recording(write(data, walkers().assign(speed=7.0)), color_by="speed").last.rows
    assert set(own["speed"]) == {7.0}


@pytest.mark.parametrize(("boundary", "speed"), [("periodic", 100.0), ("solid", 1900.0)])
def test_speed_across_a_periodic_border_is_that_of_the_short_way(boundary: str, speed: float, tmp_path: Path) -> None:
    rows = walkers(records=2)
    rows["y"] = np.where(rows["time"] > 0.0, 15.0, 965.0)
    rows["y"] = rows["y"].astype(np.float32)
    recording = read_recording(write(tmp_path / "a.feather", rows, boundary_condition=boundary), color_by="speed")
    np.testing.assert_allclose(recording.last.rows["speed"].tail(3), speed, rtol=1e-5)


def test_a_picture_may_show_speeds(data: Path) -> None:
    assert main([str(data), str(data.parent / "speed.png"), "--color-by", "speed"]) == 0
