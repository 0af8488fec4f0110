"""pogosim report: a page that holds all that it shows, and says what is in the data."""

from __future__ import annotations

import base64
import json
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
import yaml
from chromium import CHROMIUM
from in_process import pogosim, refusal
from playwright.sync_api import sync_playwright
from pogosim.analysis.quantities import Quantity, quantities_of
from pogosim.analysis.trajectories import trajectories_of
from pogosim.picture.swarm import read_recording
from pogosim.run_report.thinning import ordinal, thinned
from pogosim.utils import load_dataframe
from pyarrow import feather
from recordings import walkers, write

HOSTILE = "<script>alert(1)</script>\"'&@@STYLE@@$x$"
VOID = {"meta", "link", "img", "br", "input"}


class Page(HTMLParser):
    """What is in a page. A tag that is not closed, or closed twice, is an error."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attributes)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.tags if name == tag]

    @property
    def addresses(self) -> list[str]:
        return [str(own[name]) for _, own in self.tags for name in ("src", "href", "action", "data") if name in own]


def reported(data: Path, *options: str) -> Page:
    result = pogosim(data.parent, "report", data.name, "-o", "report.html", *options)
    assert result.code == 0, result.text
    return Page((data.parent / "report.html").read_text(encoding="utf-8"))


def runs_of(count: int, slope: float = 0.0) -> pd.DataFrame:
    """Runs of walkers, each `slope` faster than the one before: the rows of a batch."""
    parts = []
    for run in range(count):
        rows = walkers()
        parts.append(rows.assign(run=run, heard=rows["heard"] + run * slope))
    return pd.concat(parts, ignore_index=True)


def quantities(rows: pd.DataFrame, folder: Path) -> dict[str, Quantity]:
    loaded, metadata = load_dataframe(write(folder / "q.feather", rows))
    (run,) = trajectories_of(loaded, metadata)
    return {own.name: own for own in quantities_of(run)}


def test_quantities_are_those_of_robots_that_go_straight(tmp_path: Path) -> None:
    found = quantities(walkers(), tmp_path)
    assert list(found) == [
        *("displacement", "speed", "neighbours", "polar order"),
        *("column heard", "column fed"),
    ]
    assert found["displacement"].over_time == pytest.approx([0.0, 50.0, 100.0, 150.0, 200.0], abs=1e-3)
    assert (found["speed"].mean, found["speed"].final) == pytest.approx((100.0, 100.0), abs=1e-3)
    assert found["neighbours"].mean == 0.0  # they are 333 mm apart
    assert found["polar order"].over_time[1:] == pytest.approx(1.0)
    assert found["column heard"].over_time == pytest.approx([10.0, 11.0, 12.0, 13.0, 14.0])
    assert found["column heard"].low == pytest.approx([5.0, 6.0, 7.0, 8.0, 9.0])
    assert found["column heard"].high == pytest.approx([15.0, 16.0, 17.0, 18.0, 19.0])
    assert found["column fed"].over_time == pytest.approx(1.0 / 3.0)


def test_values_that_are_not_finite_are_no_values(tmp_path: Path) -> None:
    rows = walkers().assign(heard=lambda own: np.where(own["robot_id"] == 0, np.inf, 4.0), none=np.nan)
    found = quantities(rows, tmp_path)
    assert found["column heard"].over_time == pytest.approx(4.0)
    assert "column none" not in found


def test_empty_truth_values_are_no_values(tmp_path: Path) -> None:
    rows = walkers().assign(fed=pd.Series([None, True, False] * 5, dtype=object))
    assert quantities(rows, tmp_path)["column fed"].over_time == pytest.approx(0.5)


def test_page_holds_all_that_it_shows(tmp_path: Path) -> None:
    page = reported(write(tmp_path / "run.feather", walkers(), seed=7))
    assert all(address.startswith("data:") for address in page.addresses)
    assert not re.search(r"https?://(?!www\.w3\.org/)", (tmp_path / "report.html").read_text())
    assert all(own["alt"] for own in page.all("img"))
    assert "displacement" in page.text
    assert "seed7" in page.text.replace("\n", "")
    (frame,) = page.all("iframe")
    assert frame["sandbox"] == "allow-scripts"
    replay = Page(str(frame["srcdoc"]))
    head = json.loads(re.search(r'id="head">(.*?)</script>', str(frame["srcdoc"]), re.DOTALL)[1])  # type: ignore[index]
    assert head["times"] == [0.0, 0.5, 1.0, 1.5, 2.0]
    assert len(replay.all("canvas")) == 1


def test_figures_are_pictures_that_follow_the_page(tmp_path: Path) -> None:
    page = reported(write(tmp_path / "run.feather", walkers()))
    prefix = "data:image/svg+xml;base64,"
    figures = [base64.b64decode(own[len(prefix) :]) for own in page.addresses if own.startswith(prefix)]
    assert len(figures) == 6
    for figure in figures:
        ElementTree.fromstring(figure)
        assert b"prefers-color-scheme:dark" in figure
        assert figure.count(b"var(--ink)") > 5
    (alt,) = [own["alt"] for own in page.all("img") if str(own["alt"]).startswith("column heard")]
    assert alt == "column heard over time: from 10 to 14"


def test_numbers_are_means_over_runs_with_their_spread(tmp_path: Path) -> None:
    page = reported(write(tmp_path / "runs.feather", runs_of(3, slope=2.0)))
    # Means over time are 12, 14 and 16; at the end 14, 16 and 18.
    assert "column heard14 ± 2 (3)16 ± 2 (3)" in page.text


def test_hostile_names_stay_text(tmp_path: Path) -> None:
    rows = walkers().rename(columns={"heard": HOSTILE}).assign(state=HOSTILE, robot_category=HOSTILE)
    robots = {"type": "pogobot", "geometry": "disk", "radius": 26.5}
    data = write(tmp_path / "run.feather", rows, objects={HOSTILE: robots}, note=HOSTILE)
    page = reported(data, "--title", HOSTILE, "--program", HOSTILE)
    assert page.all("script") == []
    assert HOSTILE in page.text
    (frame,) = page.all("iframe")
    assert len(Page(str(frame["srcdoc"])).all("script")) == 3  # its own


def test_control_characters_of_names_are_shown(tmp_path: Path) -> None:
    page = reported(write(tmp_path / "run.feather", walkers().rename(columns={"heard": "a\x1b\u202eb"})))
    assert "\x1b" not in page.text
    assert "\\x1b" in page.text


def test_configuration_of_the_page_is_that_of_the_file(tmp_path: Path) -> None:
    data = write(tmp_path / "run.feather", walkers(), seed=7)
    stored = feather.read_table(data).schema.metadata[b"configuration"].decode()
    page = reported(data, "--program", "vicsek")
    (link,) = page.all("a")
    assert link["download"] == "run.yaml"
    content = base64.b64decode(str(link["href"]).partition(",")[2]).decode()
    assert yaml.safe_load(content) == yaml.safe_load(stored)
    assert "./vicsek -c run.yaml -g --set data_filename=run_again.feather" in page.text


def test_names_in_the_command_are_quoted_for_the_shell(tmp_path: Path) -> None:
    page = reported(write(tmp_path / "a b.feather", walkers()), "--program", "/x/my program")
    assert "'/x/my program' -c 'a b.yaml' -g --set 'data_filename=a b_again.feather'" in page.text


def with_metadata(data: Path, **entries: str) -> Path:
    table = feather.read_table(data)
    own = {**table.schema.metadata, **{name.encode(): text.encode() for name, text in entries.items()}}
    feather.write_feather(table.replace_schema_metadata(own), data)
    return data


def test_touched_run_and_warnings_of_the_log_are_told(tmp_path: Path) -> None:
    data = with_metadata(write(tmp_path / "run.feather", walkers()), touched="once from t = 1 s on: objects moved")
    (tmp_path / "log.txt").write_text("[info] a\n[2026-01-01] [warning] beware of <b>\n[warning] beware of <b>\n")
    page = reported(data, "--log", "log.txt")
    assert page.text.count("beware of <b>") == 1
    assert "once from t = 1 s on: objects moved" in page.text
    assert any(own.get("class") == "warnings" for own in page.all("section"))


def test_log_that_a_batch_kept_is_found(tmp_path: Path) -> None:
    (tmp_path / "frames").mkdir()
    data = write(tmp_path / "frames" / "data.feather", walkers())
    (tmp_path / "log.txt").write_text("[warning] beware\n")
    assert "beware" not in reported(data).text  # of another program, perhaps
    (tmp_path / "pogobatch_task.json").write_text("{}")
    assert "beware" in reported(data).text


def batch(path: Path, **entry: Any) -> Path:
    rows = pd.concat([runs_of(2), runs_of(2).assign(heard=99)], ignore_index=True)
    rows["parameters.a"] = np.repeat([1, 2], len(rows) // 2)
    each = [
        {"columns": {"parameters.a": a}, "runs": 2, "rows": len(rows) // 2, "failed_runs": [], **entry} for a in (1, 2)
    ]
    return with_metadata(write(path, rows), combinations=yaml.safe_dump(each))


def test_batch_is_told_by_combination_and_one_run_is_replayed(tmp_path: Path) -> None:
    data = batch(tmp_path / "result.feather")
    page = reported(data, "--combination", "1", "--run", "1")
    assert "4 (2 combinations of parameters.a)" in page.text
    assert "pogosim batch -c result.yaml -S ./PROGRAM -r 2 -o result_again" in page.text
    assert "column hearda 199" not in page.text
    assert "column hearda 299 ± 0 (2)99 ± 0 (2)" in page.text
    assert "It shows run 1 of the file." in page.text
    (frame,) = page.all("iframe")
    assert '"values":[99]' in str(frame["srcdoc"])


def test_seeds_of_a_batch_are_in_its_command(tmp_path: Path) -> None:
    assert (
        "pogosim batch run -c b.yaml -S ./PROGRAM --seeds 5:6"
        in reported(batch(tmp_path / "b.feather", seeds=[5, 6])).text
    )
    assert "no single command repeats" in reported(batch(tmp_path / "b.feather", seeds=[5, 9])).text


def test_failed_runs_are_told(tmp_path: Path) -> None:
    data = batch(tmp_path / "b.feather", failed_runs=[2])
    assert "2 runs of the batch failed, and are not here." in reported(data).text


def test_several_files_are_one_report(tmp_path: Path) -> None:
    for seed in (3, 4):
        write(tmp_path / f"{seed}.feather", walkers().assign(heard=seed), seed=seed)
    result = pogosim(tmp_path, "report", "*.feather", "-o", "all.html")
    assert result.code == 0, result.text
    text = Page((tmp_path / "all.html").read_text()).text
    assert "3.feather, 4.feather" in text
    assert "seeds3, 4" in text
    assert "each has its own configuration" in text


def test_long_run_is_thinned_and_says_so(tmp_path: Path) -> None:
    recording = read_recording(write(tmp_path / "run.feather", walkers(3, 101)))
    shorter = thinned(recording, most_values=3 * 12 * 20)
    assert shorter.records <= 20
    times = shorter.recording.times_s
    assert (times[0], times[-1]) == (0.0, 50.0)
    assert np.allclose(np.diff(times)[:-1], shorter.stride * 0.5)
    assert shorter.told == f"every {ordinal(shorter.stride)} of 101 records, and the last one"
    assert thinned(recording).told == ""
    assert thinned(recording, most_values=1).records == 2


def test_page_of_a_long_run_is_small(tmp_path: Path) -> None:
    generator = np.random.default_rng(1)
    rows = walkers(20, 6000)
    rows = rows.assign(
        x=generator.uniform(100, 900, len(rows)),
        y=generator.uniform(100, 900, len(rows)),
        heard=generator.uniform(size=len(rows)),
    )
    page = reported(write(tmp_path / "run.feather", rows))
    assert (tmp_path / "report.html").stat().st_size < 6e6
    assert "of 6000 records, and the last one" in page.text
    assert "with the ways they went in the last 2.5e+03 s" in page.text


def test_many_columns_are_left_out_and_counted(tmp_path: Path) -> None:
    rows = walkers().assign(**{f"c{number}": number for number in range(30)})
    page = reported(write(tmp_path / "run.feather", rows))
    assert len(page.all("figure")) == 24 + 1
    assert "Left out: 12 columns." in page.text
    assert "column c29" in page.text  # in the table


@pytest.mark.parametrize(
    "rows",
    [
        walkers().iloc[:1],
        walkers(1),
        walkers().drop(columns=["angle", "led_rgb"]),
        walkers().drop(columns=["robot_category", "robot_id"]).iloc[::3],
        walkers().assign(x=lambda own: own["x"].where(own["time"] != 1.0)),
        walkers().assign(heard=[10**300] * 15),
        walkers().assign(heard=pd.Series([None] * 15, dtype="Int32")),
    ],
    ids=["one row", "one robot", "places only", "no names", "gaps", "huge", "empty column"],
)
def test_page_shows_what_is_there(tmp_path: Path, rows: pd.DataFrame) -> None:
    reported(write(tmp_path / "run.feather", rows.assign(heard=rows["heard"].astype("float64"))))


def test_file_without_metadata_says_that_nothing_repeats_it(tmp_path: Path) -> None:
    feather.write_feather(pa.Table.from_pandas(walkers()), tmp_path / "run.feather")
    page = reported(tmp_path / "run.feather")
    assert "no command can repeat it" in page.text
    assert "has no metadata of a run" in page.text


def test_unfinished_file_is_reported_on_with_a_warning(tmp_path: Path) -> None:
    data = write(tmp_path / "run.feather", walkers())
    table = feather.read_table(data)
    with pa.OSFile(str(data), "wb") as file:
        file.write(b"ARROW1\0\0")
        schema = table.schema.with_metadata({**table.schema.metadata, b"incomplete": b"1"})
        with pa.ipc.new_stream(file, schema) as stream:
            stream.write_table(table.replace_schema_metadata(schema.metadata))
    assert "its run is still going on, or was killed" in reported(data).text


def test_report_without_a_replay_has_a_picture(tmp_path: Path) -> None:
    page = reported(write(tmp_path / "run.feather", walkers()), "--no-replay")
    assert page.all("iframe") == []
    assert any(str(own["src"]).startswith("data:image/png") for own in page.all("img"))


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["none.feather", "-o", "a.html"], "cannot read 'none.feather': no such file"),
        (["*.none", "-o", "a.html"], "no file fits the pattern '*.none'"),
        (["run.feather", "-o", "a.pdf"], "a report is a page for the browser; let it end in .html"),
        (["run.feather", "-o", "run.feather"], "would take the place of the data file run.feather"),
        (["run.feather", "-o", "none/a.html"], "there is no folder"),
        (["run.feather"], "the following arguments are required: -o/--output"),
        (["run.feather", "-o", "a.html", "--log", "none.txt"], "none.txt"),
        (["run.feather", "-o", "a.html", "--run", "4"], "it has no run 4"),
        (["run.feather", "-o", "a.html", "--combination", "4"], "it has no combination 4"),
        (["run.feather", "-o", "a.html", "--category", "sheep"], "no rows of the category 'sheep'"),
        (["run.feather", "-o", "a.html", "--color-by", "herd"], "did you mean 'heard'?"),
        (["run.feather", "-o", "a.html", "--speed", "0"], "0 is not above 0"),
        (["text.feather", "-o", "a.html"], "text.feather"),
        (["empty.feather", "-o", "a.html"], "it has no row with a time and a position"),
        (["bare.feather", "-o", "a.html"], "it has no column time, x, y"),
        (["words.feather", "-o", "a.html"], "its column x holds"),
        (["damaged.feather", "-o", "a.html"], "damaged"),
    ],
)
def test_what_cannot_be_reported_on_is_one_line(tmp_path: Path, options: list[str], said: str) -> None:
    write(tmp_path / "run.feather", walkers())
    (tmp_path / "text.feather").write_text("no table")
    write(tmp_path / "empty.feather", walkers().iloc[:0])
    write(tmp_path / "bare.feather", pd.DataFrame({"a": [1]}))
    write(tmp_path / "words.feather", walkers().assign(x="here"))
    write(tmp_path / "damaged.feather", walkers(50, 50))
    content = bytearray((tmp_path / "damaged.feather").read_bytes())
    content[2000:6000] = bytes(4000)
    (tmp_path / "damaged.feather").write_bytes(content)
    before = sorted(path.name for path in tmp_path.iterdir())
    assert said in refusal(pogosim(tmp_path, "report", *options))
    assert sorted(path.name for path in tmp_path.iterdir()) == before


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium: on macOS, none is installed for tests")
def test_browser_shows_the_replay_in_the_page_and_asks_for_nothing(tmp_path: Path) -> None:
    reported(write(tmp_path / "run.feather", walkers()))
    said: list[str] = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 900, "height": 700})
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.on("request", lambda request: said.append(request.url) if request.url.startswith("http") else None)
        page.goto((tmp_path / "report.html").as_uri())
        frame = page.frames[1]
        frame.wait_for_selector("#play")
        frame.evaluate("replay.ready")
        assert frame.evaluate("replay.count") == 3
        broken = page.evaluate("[...document.images].filter((image) => !image.naturalWidth).length")
        assert broken == 0
        # The wheel scrolls the page, not the replay, until that is clicked.
        place = page.locator("iframe").bounding_box()
        assert place is not None
        page.mouse.move(place["x"] + 200, 650)
        page.mouse.wheel(0, 100)
        for _ in range(200):  # the page forbids what wait_for_function() would evaluate
            if page.evaluate("window.scrollY") == 100:
                break
            page.wait_for_timeout(50)
        assert page.evaluate("window.scrollY") == 100
        page.emulate_media(media="print")
        assert not page.locator("iframe").is_visible()
        assert page.locator(".state img").is_visible()
        browser.close()
    assert said == []
