"""The pictures, tables and texts of the pages that programs make are what the tree does today."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pandas as pd
import pytest
import quotes
import window
from all import SCRIPTS, check, differences
from matplotlib.figure import Figure
from pictures import DOCS, Picture, difference, from_figure, keep
from PIL import Image
from pogosim.utils import load_dataframe
from quotes import Quote, keep_quote, quote_difference, quoted
from running import ROOT, example
from studies import STUDIES
from times import STAMP, TIMES


# Those of the tutorials are compared by test_docs.py and test_parameter_study.py, which follow them anyway.
@pytest.mark.parametrize("script", sorted(set(SCRIPTS) - {"first_program", "parameter_study"}))
def test_pictures_and_texts_are_what_the_tree_makes_today(script: str, tmp_path: Path) -> None:
    today = SCRIPTS[script].draw(tmp_path)
    assert set(today) == set(SCRIPTS[script].NAMES)
    assert differences(today) == [], "to renew: .venv/bin/python docs/figures/all.py; then look at the pictures"


@pytest.mark.parametrize("study", ["engines", "boxes", "learning", "learners"])
def test_numbers_of_studies_are_those_of_the_tree(study: str) -> None:
    """Those of tuning and validation are compared by their own tests, which run a little of them anyway."""
    assert check(study) == [], "to renew: .venv/bin/python docs/figures/all.py"


@pytest.mark.parametrize("name", TIMES)
def test_times_on_pages_say_when_and_where_they_were_measured(name: str) -> None:
    page, _, region = TIMES[name].quote.partition(": ")
    *lines, last = quoted(DOCS / page, region)
    assert lines
    assert STAMP.match(last), last


def test_demonstration_ends_while_new_colours_spread(tmp_path: Path) -> None:
    """If something else changes its run, another seed in conf/demo.yaml shows them again."""
    data = tmp_path / "data.feather"
    command = [str(example("hanabi")), "-c", "conf/demo.yaml", "-g", "-q", "--set", f"data_filename={data}"]
    subprocess.run(command, cwd=ROOT, check=True, timeout=120)
    rows = load_dataframe(data)[0]
    counts = window.colours(rows[rows["time"] == rows["time"].max()])
    assert len([count for count in counts if count >= window.ROBOTS]) >= window.COLOURS
    assert window.moment(rows)[0] <= window.LAST_S


def test_robots_of_the_page_on_learning_drive_with_the_weights_that_it_quotes() -> None:
    page = DOCS / "learning.md"
    (learnt,) = (line for line in quoted(page, "returns") if re.match(r"light +policy: ", line))
    (used,) = re.findall(r"parameters\.policy=(\[.*\])", page.read_text())
    assert used == learnt.partition("policy: ")[2]


def quotes_on_pages() -> set[str]:
    """Return the names of all quotes that stand on pages."""
    found = {
        page: re.findall(r"^<!-- (\w+) -->$", (DOCS / page).read_text(), re.MULTILINE)
        for page in ("../README.md", "../bench/README.md", *(path.name for path in DOCS.glob("*.md")))
    }
    return {f"{page}: {name}" for page, names in found.items() for name in names}


def test_every_quote_of_a_page_is_made_by_a_program() -> None:
    made = {name for script in SCRIPTS.values() for name in script.NAMES if not name.endswith(".png")}
    made |= {study.quote for study in STUDIES.values()} | {times.quote for times in TIMES.values()}
    made |= {"learning.md: caption", "learners.md: made", "physics.md: steps"}  # beside the numbers of their studies
    assert quotes_on_pages() == made


def test_every_picture_of_the_docs_is_made_by_a_script_and_shown_on_a_page() -> None:
    made = {name for script in SCRIPTS.values() for name in script.NAMES if name.endswith(".png")}
    made |= {name for study in STUDIES.values() for name in study.pictures}
    for benchmark in ("table", "batch_runs"):
        made |= set(re.findall(r'"(\w+\.png)"', (ROOT / "bench" / f"{benchmark}.py").read_text()))
    assert {path.name for path in DOCS.glob("*.*g") if path.suffix in (".png", ".svg", ".jpg", ".jpeg")} == made
    pages = [ROOT / "README.md", *DOCS.glob("*.md")]
    shown = {Path(target).name for page in pages for target in re.findall(r"!\[[^]]*\]\(([^)]+)\)", page.read_text())}
    assert shown == made


@pytest.fixture
def page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A page with a code block, a paragraph and a table, whose record is beside it."""
    monkeypatch.setattr(quotes, "RECORD", tmp_path / "quotes.json")
    path = tmp_path / "page.md"
    path.write_text(
        "A\n\n<!-- code -->\n\n```text\n1\n\n2\n```\n\n<!-- text -->\n\na 1\nb\n\n<!-- table -->\n\n| a |\n"
    )
    return path


def test_quotes_are_blocks_paragraphs_or_tables(page: Path) -> None:
    assert [quoted(page, name) for name in ("code", "text", "table")] == [["1", "", "2"], ["a 1", "b"], ["| a |"]]
    for name, lines in (("code", ("3", "", "4 \\1")), ("text", ("c",)), ("table", ("| b |", "| c |"))):
        keep_quote(f"page.md: {name}", page, Quote(lines))
    assert page.read_text() == (
        "A\n\n<!-- code -->\n\n```text\n3\n\n4 \\1\n```\n\n<!-- text -->\n\nc\n\n<!-- table -->\n\n| b |\n| c |\n"
    )
    with pytest.raises(SystemExit, match="expected one place"):
        keep_quote("page.md: other", page, Quote(("c",)))


def test_text_that_a_program_no_longer_says_is_out_of_date(page: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    keep_quote("page.md: text", page, Quote(("12 robots",)))
    assert quote_difference("page.md: text", page, Quote(("12 robots",))) == ""
    assert "13 robots" in quote_difference("page.md: text", page, Quote(("13 robots",)))

    # On another platform numbers may differ, words do not.
    monkeypatch.setattr("quotes.drawn_on", lambda: {"Platform": "riscv64"})
    assert quote_difference("page.md: text", page, Quote(("13 robots",))) == ""
    assert quote_difference("page.md: text", page, Quote(("13 lamps",))) != ""


def test_numbers_of_many_runs_are_out_of_date_when_a_short_run_differs(
    page: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    name, kept = "page.md: text", Quote(("0.5",), data="1 x 1 0123")
    assert "out of date" in quote_difference(name, page, kept), "never made"
    keep_quote(name, page, kept)
    assert quote_difference(name, page, Quote((), data="1 x 1 0123")) == ""
    assert "out of date" in quote_difference(name, page, Quote((), data="1 x 1 4567"))
    monkeypatch.setattr("quotes.processor", lambda: "another one")
    assert quote_difference(name, page, Quote((), data="1 x 1 4567")) == ""


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
