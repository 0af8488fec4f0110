"""`pogosim analyze locomotion`, as a user runs it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from in_process import called, refusal
from PIL import Image
from pogosim import locomotion
from pogosim.command.main import main
from pogosim.reports import figures
from pogosim.utils import load_dataframe
from swarms import brownian_walk, metadata_of, rows_of, write_rows

FIGURES = (
    "arena_heatmaps",
    "arena_heatmaps_kde",
    "arenas/square/heatmap",
    "arenas/square/heatmap_kde",
    "autocorrelation",
    "msd_linear",
    "msd_loglog",
    "peclet_hist",
    "speed_box",
    "speed_time",
    "traces/square_run_0",
)
TABLES = (
    "autocorrelation",
    "msd_per_agent",
    "msd_time_stats",
    "peclet",
    "runs",
    "speed_agent_stats",
    "speed_time_stats",
)


def walk(times: int = 40, robots: int = 5, seed: int = 1) -> pd.DataFrame:
    position = 500.0 + brownian_walk(times, robots, 5.0, seed)
    heading = np.random.default_rng(seed).uniform(-3.0, 3.0, (times, robots))
    return rows_of(position, heading, period_s=0.5)


def analyze(*arguments: str) -> int:
    return main(["analyze", "locomotion", *arguments])


def files_in(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture
def small_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Figures of one format and few pixels, where no test looks at them."""
    monkeypatch.setattr(figures, "FORMATS", (".png",))
    monkeypatch.setattr(figures, "DPI", 20)


def test_all_tables_and_figures_are_there_and_the_same_every_time(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    data = write_rows(tmp_path / "data.feather", walk(times=12), metadata_of())
    for name in ("one", "two"):
        assert analyze("-i", str(data), "-o", str(tmp_path / name), "--gif") == 0
    made = files_in(tmp_path / "one")
    expected = {f"{name}{suffix}" for name in FIGURES for suffix in (".pdf", ".png")}
    expected |= {f"stats/{name}.csv" for name in TABLES} | {"SUMMARY.txt", "traces/square_run_0.gif"}
    assert set(made) == expected
    assert made == files_in(tmp_path / "two")
    with Image.open(tmp_path / "one" / "traces" / "square_run_0.gif") as film:
        assert getattr(film, "n_frames", 1) == 12
    assert (
        "ended near their starting points" in capsys.readouterr().err
        or not pd.read_csv(tmp_path / "one" / "stats" / "peclet.csv")["peclet"].isna().any()
    )


def test_tables_hold_what_the_functions_return(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(figures, "FORMATS", ())
    rows = pd.concat([walk(seed=seed).assign(run=seed) for seed in (1, 2)])
    data = write_rows(tmp_path / "data.feather", rows, metadata_of())
    assert analyze("-i", str(data), "-o", str(tmp_path), "--characteristic-length", "100") == 0
    tables = {name: pd.read_csv(tmp_path / "stats" / f"{name}.csv") for name in TABLES}
    expected = locomotion.compute_msd_per_agent(*load_dataframe(data))
    pd.testing.assert_frame_equal(tables["msd_per_agent"], expected, check_dtype=False)
    assert {len(tables[name]) for name in ("speed_agent_stats", "peclet", "msd_per_agent")} == {2 * 5}
    assert {len(tables[name]) for name in ("speed_time_stats", "msd_time_stats", "autocorrelation")} == {2 * 40}
    peclet = tables["peclet"]
    expected_peclet = peclet["mean_speed_mm_s"] * 100.0 / peclet["diffusion_coefficient_mm2_s"]
    np.testing.assert_allclose(peclet["peclet"].dropna(), expected_peclet[peclet["peclet"].notna()])
    first = walk(seed=1)
    steps = np.diff(first[first["robot_id"] == 0][["x", "y"]].to_numpy(), axis=0)
    mean_speed = np.linalg.norm(steps, axis=1).mean() / 0.5
    assert tables["speed_agent_stats"]["mean_speed_mm_s"][0] == pytest.approx(mean_speed)
    summary = (tmp_path / "SUMMARY.txt").read_text(encoding="utf-8")
    assert "square: 2 runs, 5 robots, until 19.5 s" in summary


@pytest.mark.usefixtures("small_figures")
def test_each_arena_and_combination_has_its_own_figures(tmp_path: Path) -> None:
    parts = [
        walk(seed=run).assign(run=run, arena_file=arena, **{"objects.robots.nb": number})
        for arena in ("disk", "square")
        for number in (5, 6)
        for run in (0, 1)
    ]
    data = write_rows(tmp_path / "data.feather", pd.concat(parts), metadata_of())
    assert analyze("-i", str(data), "-o", str(tmp_path)) == 0
    made = files_in(tmp_path)
    for arena in ("disk", "square"):
        assert {f"arenas/{arena}/{name}.png" for name in ("heatmap", "speed_time", "msd_loglog")} <= set(made)
        assert {f"traces/{arena}_nb_{number}_run_0.png" for number in (5, 6)} <= set(made)
    assert "arena_file disk, nb 5: 2 runs" in (tmp_path / "SUMMARY.txt").read_text(encoding="utf-8")


def test_several_outlines_of_one_name_are_told_apart(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(figures, "FORMATS", ())
    files = [
        write_rows(tmp_path / f"{number}.feather", walk(), metadata_of(side))
        for number, side in enumerate((1000.0, 2000.0))
    ]
    assert analyze("-i", *map(str, files), "-o", str(tmp_path / "out")) == 0
    assert {path.name for path in (tmp_path / "out" / "arenas").iterdir()} == {"square", "square_2"}


@pytest.mark.usefixtures("small_figures")
@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (walk(times=1), "5 of 5 robots have one position only"),
        (walk(robots=1), ""),
        (walk().drop(columns="angle"), "1 of 1 runs have no headings (column angle)"),
        (walk().assign(time=walk()["time"].replace(1.0, 1.2)), "1 of 1 runs have unevenly spaced save times"),
        (walk()[lambda rows: ~rows["time"].isin([1.0, 1.5, 2.0])], ""),
        (walk().assign(angle=np.nan), "1 of 1 runs have no headings"),
        (walk().sample(frac=0.5, random_state=1), ""),
        (walk().assign(x=1e6, y=1e6), "5 of 5 robots ended near their starting points"),
    ],
    ids=["one time", "one robot", "no angle", "uneven", "times missing", "nan", "gaps", "still and outside"],
)
def test_result_of_what_is_there_with_a_line_about_the_rest(
    rows: pd.DataFrame, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    data = write_rows(tmp_path / "data.feather", rows, metadata_of(periodic=not said) if len(rows) > 100 else {})
    assert analyze("-i", str(data), "-o", str(tmp_path), "--steps", "1", "--bins", "1") == 0
    lines = capsys.readouterr().err.splitlines()
    assert all(line.startswith("pogosim analyze locomotion: warning: ") for line in lines)
    assert said in "\n".join(lines)
    assert {f"stats/{name}.csv" for name in TABLES} <= set(files_in(tmp_path))


def test_file_of_a_killed_run_is_analysed_with_a_warning(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    data = write_rows(tmp_path / "data.feather", walk(), metadata_of())
    data.write_bytes(data.read_bytes()[:-200])
    code = analyze("-i", str(data), "-o", str(tmp_path))
    (line,) = capsys.readouterr().err.splitlines()
    assert code == 2
    assert "to recover it" in line


def test_the_module_is_a_program(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "pogosim.locomotion", "-i", "none.feather"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "locomotion: none.feather: no such file or directory\n"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["-i", "none.feather"], "none.feather: no such file"),
        (["-i", "foreign.feather"], "foreign.feather is not a complete Feather file"),
        (["-i", "empty.feather"], "no row with a time and a position"),
        (["-i", "no_x.feather"], "it has no column x"),
        (["-i", "data.feather", "-o", "data.feather"], "data.feather is a file; -o wants a folder"),
        (["-i", "data.png", "-o", "."], "data.png is an input that might be overwritten"),
        (["-i", "data.feather", "--category", "boxes"], "no rows of the category 'boxes'"),
        (["-i", "data.feather", "--window", "0"], "0 is not above 0"),
        (["-i", "data.feather", "--window", "nan"], "'nan' is not a finite number"),
        (["-i", "data.feather", "--bins", "0"], "'0' is not a whole number from 1 to 2000"),
        (["-i", "data.feather", "--steps", "few"], "'few' is not a whole number of 1 or more"),
    ],
)
def test_what_cannot_be_done_is_one_line(arguments: list[str], said: str, tmp_path: Path) -> None:
    write_rows(tmp_path / "data.feather", walk(), metadata_of())
    write_rows(tmp_path / "data.png", walk(), metadata_of())
    write_rows(tmp_path / "empty.feather", walk()[:0], metadata_of())
    write_rows(tmp_path / "no_x.feather", walk().drop(columns="x"), metadata_of())
    (tmp_path / "foreign.feather").write_text("time,x,y\n")
    before = files_in(tmp_path)
    line = refusal(called(tmp_path, locomotion.main, *arguments))
    assert said in line
    assert line.startswith("locomotion: ")
    assert files_in(tmp_path) == before
