"""Which runs are in which panel of a figure, and in which colour."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure
from pogosim.analysis.trajectories import Trajectories, trajectories_of
from pogosim.reports.command import main as analyze
from pogosim.reports.figures import draw_over_time, draw_violins, drawn_by_combination
from pogosim.reports.groups import by_panel, panel_label
from swarms import metadata_of, rows_of, write_rows


def runs_of(
    *values: tuple[float, ...], names: tuple[str, ...] = ("parameters.gain", "parameters.noise")
) -> list[Trajectories]:
    """Two runs with one robot of each combination of values of these parameters."""
    parts = [
        rows_of(np.full((3, 1, 2), 500.0)).assign(run=run, **dict(zip(names, combination, strict=True)))
        for combination in product(*values)
        for run in range(2)
    ]
    metadata = metadata_of()
    metadata["configuration"]["parameters"] = {}
    return trajectories_of(pd.concat(parts, ignore_index=True), metadata)


def test_six_combinations_are_curves_of_one_panel() -> None:
    runs = runs_of((1.0, 2.0, 3.0), (0.1, 0.2))
    panels, names = by_panel(runs, runs)
    assert list(panels) == [""]
    assert len(names) == 6
    assert names[0] == "gain 1.0, noise 0.1"
    assert [len(own) for own in panels[""].values()] == [2] * 6


def test_of_more_the_option_with_the_fewest_values_has_panels_and_the_others_colours() -> None:
    runs = runs_of((1.0, 2.0, 3.0), (0.1, 0.2, 0.3, 0.4))
    assert panel_label(runs) == "parameters.gain"
    panels, names = by_panel(runs, runs)
    assert list(panels) == ["gain 1.0", "gain 2.0", "gain 3.0"]
    assert names == ["noise 0.1", "noise 0.2", "noise 0.3", "noise 0.4"]
    assert all(list(own) == names and all(len(two) == 2 for two in own.values()) for own in panels.values())


def test_many_values_of_one_option_are_curves_with_a_legend_below() -> None:
    runs = runs_of(tuple(range(9)), (0.1,))
    assert panel_label(runs) is None
    assert len(by_panel(runs, runs)[1]) == 9


def test_panels_have_the_same_axes_and_one_legend() -> None:
    runs = runs_of((1.0, 2.0), (0.1, 0.2, 0.3, 0.4))
    tables = [pd.DataFrame({"time": run.time_s, "speed": run.labels["parameters.gain"] * np.ones(3)}) for run in runs]
    figure = drawn_by_combination(
        runs, tables, [lambda axes, groups, colours: draw_over_time(axes, groups, "speed", "speed (mm/s)", colours)]
    )
    assert [axes.get_title() for axes in figure.axes] == ["gain 1.0", "gain 2.0"]
    assert len({axes.get_ylim() for axes in figure.axes}) == 1
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["noise 0.1", "noise 0.2", "noise 0.3", "noise 0.4"]
    assert all(axes.get_legend() is None for axes in figure.axes)


def test_violins_of_panels_have_the_colours_and_places_of_one_legend() -> None:
    runs = runs_of((1.0, 2.0), (0.1, 0.2, 0.3, 0.4))[:-2]  # the last combination has no run
    tables = [pd.DataFrame({"time": run.time_s, "degree": [1.0, 2.0, 3.0]}) for run in runs]
    figure = drawn_by_combination(
        runs, tables, [lambda axes, groups, colours: draw_violins(axes, groups, "degree", "degree", colours)]
    )
    assert [len(axes.collections[0].get_paths()) for axes in figure.axes] == [1, 1]
    assert len({axes.get_xlim() for axes in figure.axes}) == 1
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [f"noise 0.{n}" for n in range(1, 5)]


def test_constant_curve_is_within_the_axes() -> None:
    runs = runs_of((1.0,), (0.1,))
    tables = [pd.DataFrame({"time": run.time_s, "area": [20000.0] * 3}) for run in runs]
    figure = drawn_by_combination(
        runs, tables, [lambda axes, groups, colours: draw_over_time(axes, groups, "area", "area (mm²)", colours)]
    )
    low, high = figure.axes[0].get_ylim()
    assert (low, high > 20500.0) == (0.0, True)


# Figures with a panel or mark for each combination, or that do not tell them apart: see docs/analyses.md.
APART = ("degree_histogram_first_last", "speed_box", "peclet_hist", "arena_heatmaps", "heatmap", "voronoi_diagram")
TRACES = "square_"  # of single runs


@pytest.mark.parametrize("name", ["neighbors", "network", "coverage", "locomotion"])
def test_figures_of_many_combinations_are_rows_of_panels(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    random = np.random.default_rng(1)
    walk = [random.uniform(300.0, 700.0, (1, 5, 2)) + random.normal(0.0, 9.0, (4, 5, 2)).cumsum(0) for _ in range(27)]
    names = ("parameters.gain", "parameters.noise", "parameters.range")
    parts = [
        rows_of(own).assign(run=0, **dict(zip(names, values, strict=True)))
        for own, values in zip(walk, product((1, 2, 3), repeat=3), strict=True)
    ]
    metadata = metadata_of()
    metadata["configuration"]["parameters"] = {}
    write_rows(tmp_path / "data.feather", pd.concat(parts, ignore_index=True), metadata)
    drawn: dict[str, Figure] = {}
    monkeypatch.setattr(Figure, "savefig", lambda figure, path, **_: drawn.setdefault(Path(path).stem, figure))
    assert analyze([name, "-i", str(tmp_path / "data.feather"), "-o", str(tmp_path / "out")]) == 0
    panels = {stem: figure for stem, figure in drawn.items() if not stem.startswith((*APART, TRACES))}
    assert len(panels) >= 4
    for stem, figure in panels.items():
        assert {axes.get_title() for axes in figure.axes} == {"gain 1", "gain 2", "gain 3"}, stem
        (legend,) = figure.legends
        assert len(legend.get_texts()) == 9
        for axes in figure.axes:
            assert axes.bbox.width > 0.5 * figure.bbox.width / (len(figure.axes) / 3)
            # Labels and legend are within the picture.
            box = axes.get_tightbbox()
            assert box is not None
            assert figure.bbox.x0 - 1 <= box.x0 <= box.x1 <= figure.bbox.x1 + 1
        whole = legend.get_window_extent()
        assert figure.bbox.x0 <= whole.x0 <= whole.x1 <= figure.bbox.x1
        assert figure.bbox.y0 <= whole.y0
