from __future__ import annotations

import contextlib
import io
import pickle
import shutil
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pandas as pd
import pytest
from pogosim import am
from pogosim.reports import collective
from pogosim.reports.collective_metrics import METRICS
from pogosim.reports.command import analyze as command
from swarms import Floats, metadata_of, rows_of, write_rows

KEYS = [
    *("polar_order", "local_polar", "local_polar_dist", "local_pair_align", "local_pair_align_dist"),
    *("align_corr", "align_corr_len", "psi_k", "largest_cluster", "g_r", "S_k", "number_fluct", "Teff_ratio"),
    *("vortex_summary", "vortex_field_dist", "milling"),
]
PROG = "pogosim analyze collective"
SMALL = ["--sk-nx", "16", "--sk-ny", "16", "--vort-nx", "8", "--vort-ny", "8"]


def swarm(times: int = 3, robots: int = 40, seed: int = 1) -> pd.DataFrame:
    """Robots that turn around the centre of a square of 1000 mm."""
    generator = np.random.default_rng(seed)
    radius, angle = 400.0 * np.sqrt(generator.random(robots)), generator.uniform(-np.pi, np.pi, robots)
    phase = angle + 0.1 * np.arange(times)[:, None]
    position = 500.0 + np.stack([radius * np.cos(phase), radius * np.sin(phase)], axis=2)
    return rows_of(position, phase)


@pytest.fixture
def data(tmp_path: Path) -> Path:
    """A data file of one run."""
    return write_rows(tmp_path / "data.feather", swarm(), metadata_of())


def analyze(data: Path, *options: str, draw: bool = False) -> Path:
    """Run the command, with or without figures, which take most of its time; returns the folder, which is new."""
    folder = data.parent / f"results{len(list(data.parent.iterdir()))}"
    arguments = ["-i", str(data), "-o", str(folder), *SMALL, *options]
    if draw:
        assert command("collective", arguments, PROG) == 0
    else:
        with patch.object(collective, "draw_metric"), patch.object(collective, "draw_vorticity_fields"):
            assert command("collective", arguments, PROG) == 0
    return folder


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """A folder with all tables and figures of the data file, and what was said of them."""
    data = write_rows(tmp_path_factory.mktemp("drawn") / "data.feather", swarm(), metadata_of())
    said = io.StringIO()
    with contextlib.redirect_stderr(said):
        folder = analyze(data, draw=True)
    return folder, said.getvalue()


def refused(data: Path, capsys: pytest.CaptureFixture[str], *options: str) -> str:
    """Run the command in vain; returns what it says, one line."""
    assert command("collective", ["-i", str(data), "-o", str(data.parent / "results"), *SMALL, *options], PROG) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1
    return said.err.removeprefix(f"{PROG}: ")


def test_each_metric_has_its_table_and_its_figures(drawn: tuple[Path, str]) -> None:
    assert [metric.key for metric in METRICS] == KEYS
    folder, said = drawn
    assert said == ""
    names = {path.name for path in folder.iterdir()}
    figures = {metric.figure for metric in METRICS} | {"vortex_field"}
    assert {"polar_order_time", "milling_time", "g_r", "local_polar_dist"} < figures
    expected = {f"{key}.csv" for key in KEYS} | {f"{name}{suffix}" for name in figures for suffix in (".pdf", ".png")}
    summaries = {f"SUMMARY_{name}.txt" for name in ("global", "per_arena", "metric_details")}
    assert names == expected | summaries | {"metrics.pkl"}


def test_tables_have_what_the_swarm_does(data: Path) -> None:
    folder = analyze(data)
    milling = pd.read_csv(folder / "milling.csv")
    assert milling.columns.tolist() == ["run", "time_s", "tangential_alignment", "angular_momentum"]
    assert milling["time_s"].tolist() == [0, 1, 2]
    assert milling["angular_momentum"].iloc[1:].to_numpy() == pytest.approx(1.0, abs=0.05)
    vortices = pd.read_csv(folder / "vortex_summary.csv")
    assert vortices["vorticity_per_s"].iloc[1:].to_numpy() == pytest.approx(0.2, rel=0.01)
    assert pd.read_csv(folder / "Teff_ratio.csv")["Teff_ratio"].mean() == pytest.approx(1.0)
    density = pd.read_csv(folder / "local_polar_dist.csv")
    assert density["probability_density"].sum() / 40 == pytest.approx(1.0)


def test_options_change_what_they_say(data: Path) -> None:
    folder = analyze(
        data,
        *("--direction", "heading", "--v2-ref", "2.5", "--gr-rmax", "90", "--gr-dr", "30", "--aligncorr-rmax", "120"),
        *("--aligncorr-dr", "40", "--milling-center", "arena", "--psi-k", "4"),
    )
    assert pd.read_csv(folder / "g_r.csv")["distance_mm"].tolist() == [15, 45, 75]
    assert pd.read_csv(folder / "align_corr.csv")["distance_mm"].tolist() == [20, 60, 100]
    assert np.isfinite(pd.read_csv(folder / "polar_order.csv")["polar_order"][0])  # headings, at the first time too
    ratio = pd.read_csv(folder / "Teff_ratio.csv")
    np.testing.assert_allclose(ratio["Teff_ratio"], ratio["mean_square_speed_mm2_s2"] / 2.5)
    assert pd.read_csv(folder / "milling.csv")["tangential_alignment"][1] == pytest.approx(np.cos(0.05))
    details = (folder / "SUMMARY_metric_details.txt").read_text()
    assert "k = 4; milling about the centre of the arena" in details
    assert "v2_ref = 2.5 mm2/s2" in details


def test_the_reach_decides_which_robots_are_neighbours(data: Path) -> None:
    near, far = (pd.read_csv(analyze(data, "--rc", rc) / "largest_cluster.csv") for rc in ("1", "2000"))
    assert near["clusters"].tolist() == [40, 40, 40]
    assert far["largest_cluster"].tolist() == [1, 1, 1]


def test_without_csv_there_are_no_csv_files(data: Path) -> None:
    for option in ("-N", "--no-csv"):
        folder = analyze(data, option)
        assert not list(folder.glob("*.csv"))
        assert (folder / "metrics.pkl").exists()


def test_the_pickle_has_the_tables(data: Path) -> None:
    folder = analyze(data)
    tables = pickle.loads((folder / "metrics.pkl").read_bytes())
    assert list(tables) == KEYS
    pd.testing.assert_frame_equal(tables["psi_k"], pd.read_csv(folder / "psi_k.csv"))


def test_two_calls_write_the_same_bytes(drawn: tuple[Path, str], data: Path) -> None:
    first, second = drawn[0], analyze(data, draw=True)
    files = sorted(path.name for path in first.iterdir())
    assert files == sorted(path.name for path in second.iterdir())
    assert [name for name in files if (first / name).read_bytes() != (second / name).read_bytes()] == []


def test_runs_of_a_batch_are_averaged_by_arena(tmp_path: Path) -> None:
    parts = [
        swarm(seed=10 * run + number).assign(run=run, arena_file=arena)
        for run in (0, 1, 2)
        for number, arena in enumerate(("disk", "square"))
    ]
    folder = analyze(write_rows(tmp_path / "data.feather", pd.concat(parts), metadata_of()))
    table = pd.read_csv(folder / "polar_order.csv")
    assert table.columns[:3].tolist() == ["run", "arena_file", "time_s"]
    assert len(table) == 6 * 3
    per_arena = (folder / "SUMMARY_per_arena.txt").read_text()
    assert "arena_file disk: 3 runs\n" in per_arena
    assert "arena_file square: 3 runs\n" in per_arena
    momentum = [line for line in (folder / "SUMMARY_global.txt").read_text().splitlines() if "angular_momentum" in line]
    assert momentum[0].startswith("  milling: mean angular_momentum = 0.9")
    assert momentum[0].endswith("(6 runs)")


def test_one_robot_at_one_time_gives_what_there_is(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = rows_of(np.full((1, 1, 2), 500.0))
    folder = analyze(write_rows(tmp_path / "data.feather", rows, metadata_of()), "--direction", "heading", draw=True)
    said = capsys.readouterr().err
    assert said.startswith(f"{PROG}: warning: no values of local_polar, local_polar_dist, local_pair_align")
    assert said.endswith("too few robots (1) or times (1), or robots that stand\n")
    assert said.count("\n") == 1
    assert pd.read_csv(folder / "polar_order.csv")["polar_order"].tolist() == [1.0]
    assert pd.read_csv(folder / "psi_k.csv")["psi_local"].isna().all()
    assert not (folder / "psi_k_time.pdf").exists()


def test_robots_that_stand_have_no_direction(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = rows_of(np.repeat(np.random.default_rng(0).uniform(100.0, 900.0, (1, 20, 2)), 3, axis=0))
    folder = analyze(write_rows(tmp_path / "data.feather", rows, metadata_of()))
    assert "no values of polar_order, local_polar, " in capsys.readouterr().err
    assert np.isfinite(pd.read_csv(folder / "g_r.csv")["g_r"]).any()
    assert pd.read_csv(folder / "vortex_summary.csv")["enstrophy_per_s2"].dropna().eq(0.0).all()


def test_files_without_an_arena_are_analysed_without_what_needs_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    data = write_rows(tmp_path / "data.feather", swarm(), {})
    folder = analyze(data)
    said = capsys.readouterr().err
    assert said == f"{PROG}: warning: 1 of 1 runs do not say what the arena is: without g_r, S_k, number_fluct\n"
    assert np.isfinite(pd.read_csv(folder / "vortex_summary.csv")["vorticity_per_s"]).any()
    assert "what the arena is" in refused(data, capsys, "--milling-center", "arena")


def test_positions_that_are_missing_are_left_out(tmp_path: Path) -> None:
    rows = swarm(times=4)
    rows.loc[rows["robot_id"].eq(3) & rows["time"].eq(1), "x"] = np.nan
    folder = analyze(write_rows(tmp_path / "data.feather", rows.drop(index=[80, 81, 82]), metadata_of()))
    assert np.isfinite(pd.read_csv(folder / "milling.csv")["angular_momentum"].iloc[1:]).all()


def test_what_cannot_be_analysed_is_said_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def said_of(rows: pd.DataFrame, *options: str) -> str:
        return refused(write_rows(tmp_path / "data.feather", rows, metadata_of()), capsys, *options)

    where = f"cannot analyse {tmp_path / 'data.feather'}: "
    assert said_of(swarm().drop(columns="x")).startswith(f"{where}it has no column x; it has time, ")
    assert said_of(swarm()[:0]) == f"{where}it has no row with a time and a position\n"
    assert said_of(swarm().assign(y=np.nan)) == f"{where}it has no row with a time and a position\n"
    assert said_of(swarm(), "--category", "boxes") == f"{where}it has no rows of the category 'boxes'; it has robots\n"
    assert said_of(swarm().drop(columns="angle"), "--direction", "heading").startswith(
        f"{where}it has no column angle; "
    )
    assert said_of(swarm(), "--gr-dr", "1e-9") == (
        "--gr-dr is too small for --gr-rmax: there would be more than 100000 bins\n"
    )
    assert not (tmp_path / "results").exists()


def test_files_that_are_no_data_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "missing.feather" in refused(tmp_path / "missing.feather", capsys)
    (tmp_path / "text.feather").write_text("Hello")
    assert "text.feather" in refused(tmp_path / "text.feather", capsys)


def test_outputs_do_not_take_the_place_of_inputs_or_files(data: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (data.parent / "results").write_text("mine")
    assert refused(data, capsys) == f"{data.parent / 'results'} is a file; -o wants a folder\n"
    assert (data.parent / "results").read_text() == "mine"
    (data.parent / "results").unlink()
    (data.parent / "results").mkdir()
    own = data.parent / "results" / "g_r.csv"
    shutil.copy(data, own)
    assert "is an input" in refused(own, capsys, "-o", str(own.parent))
    assert own.read_bytes() == data.read_bytes()


@pytest.mark.parametrize(
    "options",
    [
        ["--psi-k", "0"],
        ["--gr-dr", "-1"],
        ["--sk-nx", "2"],
        ["--v2-ref", "nan"],
        ["--milling-center", "sun"],
        ["-Z"],
    ],
)
def test_wrong_options_are_refused(options: list[str], data: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        command("collective", ["-i", str(data), *options], PROG)
    assert end.value.code == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_the_module_am_is_the_same_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert am.main(["-i", "none.feather"]) == 2
    assert capsys.readouterr().err == "python -m pogosim.am: none.feather: no such file or directory\n"
    direction: Floats = np.array([[[1.0, 0.0], [0.0, 1.0]]])
    assert am.polar_order(direction) == pytest.approx(np.sqrt(0.5))
