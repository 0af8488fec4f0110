"""Names are drawn as they are written: matplotlib takes none of them for a formula, and leaves none out of a legend."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure
from matplotlib.mathtext import MathTextParser
from matplotlib.text import Text
from pogosim.command.main import main
from pogosim.fonts import literal
from pogosim.optimize.plots import draw_archive
from pogosim.picture.colouring import Legend
from pogosim.picture.figure import draw_key
from pogosim.reports.command import ANALYSES
from pogosim.reports.figures import draw_bands
from swarms import brownian_walk, metadata_of, rows_of, write_rows

# Not a formula, although it begins like one; a formula, which would be in italics; and a name that legends leave out.
NAMES = ["$x_{$", "a$b$c", "_d"]


@pytest.fixture
def formulas(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The texts that are drawn as formulas."""
    found: list[str] = []
    parse = MathTextParser.parse

    def recording(self: Any, text: str, *arguments: Any, **options: Any) -> Any:
        found.append(text)
        return parse(self, text, *arguments, **options)

    monkeypatch.setattr(MathTextParser, "parse", recording)
    return found


def results(folder: Path, names: list[str]) -> Path:
    """Write results of a batch whose arenas, parameters and columns have names, a run for each."""
    rows = []
    for run, name in enumerate(names):
        columns: dict[str, Any] = {"run": run, "arena_file": name, "parameters.p": name, names[0]: 1.5}
        rows.append(rows_of(brownian_walk(3, 4, 20.0, seed=run) + 500.0, **columns).assign(robot_category=names[0]))
    metadata = metadata_of()
    metadata["configuration"]["objects"] = {names[0]: metadata["configuration"]["objects"]["robots"]}
    return write_rows(folder / "data.feather", pd.concat(rows, ignore_index=True), metadata)


@pytest.mark.parametrize("analysis", [name for name in ANALYSES.own if name != "messages"])
def test_figures_of_analyses_draw_names_as_they_are(analysis: str, formulas: list[str], tmp_path: Path) -> None:
    data = results(tmp_path, NAMES)
    assert main(["analyze", analysis, "-i", str(data), "-o", str(tmp_path / "out")]) == 0
    assert list((tmp_path / "out").glob("**/*.p*"))
    assert [text for text in formulas if any(name in text for name in NAMES)] == []


@pytest.mark.parametrize("name", NAMES[:2])
def test_pictures_and_films_draw_names_as_they_are(name: str, formulas: list[str], tmp_path: Path) -> None:
    data = str(results(tmp_path, [name]))
    for options in (["--color-by", "robot_category"], ["--color-by", name, "--at", "0", "2"]):
        assert main(["picture", data, str(tmp_path / "p.png"), "--dpi", "30", "-q", *options]) == 0
    film = str(tmp_path / "f.gif")
    assert main(["film", data, "-o", film, "--fps", "1", "--color-by", "robot_category", "-q"]) == 0
    assert formulas == []


def test_reports_and_comparisons_draw_names_as_they_are(formulas: list[str], tmp_path: Path) -> None:
    data = str(results(tmp_path, NAMES))
    assert main(["report", data, "-o", str(tmp_path / "r.html"), "--no-replay", "-q"]) == 0
    assert main(["compare", data, data, "-o", str(tmp_path / "c.png"), "-q"]) == 0
    assert [text for text in formulas if any(name in text for name in NAMES)] == []


@pytest.mark.parametrize("name", NAMES)
def test_legends_and_axes_have_every_name(name: str, formulas: list[str], tmp_path: Path) -> None:
    figure = Figure()
    axes = figure.subplots()
    draw_bands(axes, {name: [pd.Series([1.0, 2.0])], "other": [pd.Series([2.0, 1.0])]})
    legend = axes.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == [literal(name), "other"]
    draw_key(figure, Legend(name, (name, "other"), np.zeros((2, 3))), 0.8, 1.0)
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [literal(name), "other"]
    figure.savefig(tmp_path / "f.png")
    draw_archive(tmp_path / "archive", np.array([[1.0, np.nan]]), [(0.0, 1.0), (0.0, 1.0)], [name, name])
    assert formulas == []


def test_other_texts_are_drawn_as_before() -> None:
    assert [literal(text) for text in ("robots", "10 %", 3, "a_b")] == ["robots", "10 %", "3", "a_b"]
    assert Text(text=literal("a_b")).get_text() == "a_b"
