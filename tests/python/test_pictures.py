"""The pictures of docs/ show what the tree does today."""

from __future__ import annotations

import re
from pathlib import Path

import learn
import pandas as pd
import pytest
import tune
from all import SCRIPTS
from matplotlib.figure import Figure
from pictures import DOCS, Picture, difference, from_figure, keep
from PIL import Image
from running import ROOT


# Those of the tutorials are compared by test_docs.py and test_parameter_study.py, which follow them anyway. Those
# of the validation take many runs: test_validation.py does fewer.
@pytest.mark.parametrize("script", sorted(set(SCRIPTS) - {"first_program", "parameter_study", "validation"}))
def test_pictures_show_what_the_tree_draws_today(script: str, tmp_path: Path) -> None:
    today = SCRIPTS[script].draw(tmp_path)
    assert set(today) == set(SCRIPTS[script].NAMES)
    found = [text for name, picture in today.items() if (text := difference(DOCS / name, picture))]
    assert found == [], "to redraw: .venv/bin/python docs/figures/all.py; then look at the pictures"


def test_every_picture_of_the_docs_is_made_by_a_script_and_shown_on_a_page() -> None:
    made = {name for script in (*SCRIPTS.values(), learn, tune) for name in script.NAMES}
    made |= set(re.findall(r'"(\w+\.png)"', (ROOT / "bench" / "table.py").read_text()))
    assert {path.name for path in DOCS.glob("*.*g") if path.suffix in (".png", ".svg", ".jpg", ".jpeg")} == made
    pages = [ROOT / "README.md", *DOCS.glob("*.md")]
    shown = {Path(target).name for page in pages for target in re.findall(r"!\[[^]]*\]\(([^)]+)\)", page.read_text())}
    assert shown == made


def drawn(rows: pd.DataFrame) -> Picture:
    figure = Figure(figsize=(2, 2))
    figure.add_axes((0.0, 0.0, 1.0, 1.0)).plot(rows["x"], rows["y"])
    return from_figure(figure, 50, rows)


@pytest.fixture
def rows() -> pd.DataFrame:
    return pd.DataFrame({"x": [0.0, 1.0, 2.0], "y": [0.0, 1.0, 0.5], "name": ["a", "b", "c"]})


def test_picture_that_is_up_to_date_has_no_difference(rows: pd.DataFrame, tmp_path: Path) -> None:
    keep(drawn(rows), tmp_path / "run.png")
    assert difference(tmp_path / "run.png", drawn(rows.copy())) == ""


def test_picture_of_other_rows_differs(rows: pd.DataFrame, tmp_path: Path) -> None:
    keep(drawn(rows), tmp_path / "run.png")
    moved = rows.assign(x=[0.0, 1.0, 2.001])
    assert difference(tmp_path / "run.png", drawn(moved)).startswith("run.png was drawn from 3 x 3 ")
    assert difference(tmp_path / "run.png", drawn(rows.assign(name=["a", "c", "c"]))) != ""
    assert difference(tmp_path / "run.png", drawn(rows[:2])) != ""


def test_picture_that_is_drawn_in_another_way_differs(rows: pd.DataFrame, tmp_path: Path) -> None:
    keep(drawn(rows), tmp_path / "run.png")
    white = Picture(from_figure(Figure(figsize=(2, 2)), 50, rows).image, drawn(rows).data)
    assert "looks different" in difference(tmp_path / "run.png", white)
    larger = Picture(from_figure(Figure(figsize=(4, 2)), 50, rows).image, drawn(rows).data)
    assert "pixels" in difference(tmp_path / "run.png", larger)


def test_picture_drawn_by_hand_or_elsewhere_is_compared_as_far_as_that_goes(rows: pd.DataFrame, tmp_path: Path) -> None:
    path = tmp_path / "run.png"
    keep(drawn(rows), path)
    with Image.open(path) as image:
        image.save(tmp_path / "bare.png")
    assert "nothing" in difference(tmp_path / "bare.png", drawn(rows))

    # Rows of another platform may differ in their last bits, but there are as many.
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("pictures.drawn_on", lambda: {"Platform": "riscv64", "Software": "matplotlib 0"})
        assert difference(path, drawn(rows.assign(x=[0.0, 1.0, 2.0000001]))) == ""
        assert difference(path, drawn(rows[:2])) != ""
