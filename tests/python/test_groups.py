"""Which runs are in which panel of a figure, and in which colour."""

from __future__ import annotations

from itertools import product

import numpy as np
import pandas as pd
from pogosim.analysis.trajectories import Trajectories, trajectories_of
from pogosim.reports.figures import draw_over_time, drawn_by_combination
from pogosim.reports.groups import by_panel, panel_label
from swarms import metadata_of, rows_of


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
