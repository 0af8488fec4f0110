"""`pogosim analyze neighbors`, `network` and `coverage`, as a user runs them."""

from __future__ import annotations

import pickle
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from in_process import pogosim
from matplotlib.figure import Figure
from pogosim.analysis.listed_neighbours import listed_distance, listed_neighbours
from pogosim.analysis.trajectories import trajectories_of
from pogosim.reports.command import main as analyze
from pogosim.reports.groups import endings
from swarms import Floats, brownian_walk, metadata_of, rows_of, write_rows

COMMANDS = ("neighbors", "network", "coverage")
FILES = {
    "neighbors": {
        "knn_run",
        "knn_robot",
        "fano_factor_over_time_corrected",
        "fano_factor_over_time_all_runs",
        "overall_neighbor_degree_histogram",
        "overall_neighbor_degree_histogram_all_runs",
        "degree_histogram_first_last",
    },
    "network": {
        f"{table}_{kind}__arena_square"
        for table in ("network_graph", "instantaneous_eigs", "timeavg_eigs_tau_c", "timeavg_eigs_10dt")
        for kind in ("line", "violin")
    },
    "coverage": {
        "voronoi_areas__arena_square",
        "voronoi_cv__arena_square",
        "voronoi_diagram__arena_square",
        "coverage_ratio__arena_square",
        "cv_mean_across_arenas_over_time",
    },
}
TABLES = {
    "neighbors": {"neighbors_time.csv", "neighbors_degree_histogram.csv", "neighbors_stats.pkl"},
    "network": {"network_graph.csv", "instantaneous_eigs.csv", "timeavg_eigs_tau_c.csv", "timeavg_eigs_10dt.csv"},
    "coverage": {"voronoi_metrics_per_arena.csv", "cv_mean_across_arenas_over_time.csv"},
}


@pytest.fixture(autouse=True)
def without_files_of_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw figures, but do not write them, which takes much longer; except in programs of their own."""
    monkeypatch.setattr(Figure, "savefig", lambda *_, **__: None)


def walk(times: int = 3, robots: int = 6, seed: int = 1) -> Floats:
    start = np.random.default_rng(seed).uniform(300.0, 700.0, (1, robots, 2))
    return start + brownian_walk(times, robots, 10.0, seed)


def file_of(folder: Path, rows: pd.DataFrame | None = None, **metadata: object) -> Path:
    return write_rows(folder / "data.feather", rows_of(walk()) if rows is None else rows, {**metadata_of(), **metadata})


def runs_of(name: str, folder: Path, *options: str) -> int:
    return analyze([name, "-i", str(folder / "data.feather"), "-o", str(folder / "out"), *options])


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_writes_all_files_and_again_the_same_bytes(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.undo()  # with the files of figures
    data = file_of(tmp_path)
    arguments = ["analyze", name, "-i", str(data), "-o"]
    program = [sys.executable, "-m", "pogosim", *arguments, "first"]
    apart = subprocess.run(program, capture_output=True, text=True, cwd=tmp_path, check=False)
    assert (apart.returncode, apart.stdout, apart.stderr) == (0, "written to first\n", "")
    here = pogosim(tmp_path, *arguments, "second")
    assert (here.code, here.text) == (0, "written to second\n")
    first, second = (
        {path.name: path.read_bytes() for path in (tmp_path / folder).iterdir()} for folder in ("first", "second")
    )
    figures = {f"{figure}{suffix}" for figure in FILES[name] for suffix in (".pdf", ".png")}
    assert set(first) == figures | TABLES[name]
    assert first == second


@pytest.mark.parametrize("module", COMMANDS)
def test_modules_are_the_same_commands(module: str, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", f"pogosim.{module}", "-i", "missing.feather"],
        capture_output=True, text=True, cwd=tmp_path, check=False,
    )  # fmt: skip
    assert done.returncode == 2
    assert done.stderr == f"python -m pogosim.{module}: missing.feather: no such file or directory\n"


@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize(("times", "robots"), [(1, 1), (1, 6), (3, 1), (3, 2)])
def test_one_robot_and_one_time_are_analysed(
    name: str, times: int, robots: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file_of(tmp_path, rows_of(walk(times, robots)))
    assert runs_of(name, tmp_path) == 0
    said = capsys.readouterr().err
    if name == "network" and times == 1:
        assert said.splitlines()[0].startswith(
            "pogosim analyze network: warning: in 1 of 1 runs, robots do not move, or "
        )
    else:
        assert said == ""


@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize(
    ("damage", "said"),
    [
        ("missing", "no such file"),
        ("foreign", "not a complete Feather file"),
        ("empty", "no row with a time and a position"),
        ("nan", "no row with a time and a position"),
        ("column", "no column x"),
        ("text", "its column x holds"),
        ("folder", "a file; -o wants a folder"),
    ],
)
def test_bad_input_is_one_line(
    name: str, damage: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = rows_of(walk())
    data = file_of(tmp_path, {
        "empty": rows[:0], "nan": rows.assign(x=np.nan), "column": rows.drop(columns="x"), "text": rows.assign(x="a"),
    }.get(damage, rows))  # fmt: skip
    if damage == "missing":
        data.unlink()
    if damage == "foreign":
        data.write_text("time,x,y\n0,1,2\n")
    if damage == "folder":
        (tmp_path / "out").write_text("")
    assert runs_of(name, tmp_path) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.startswith(f"pogosim analyze {name}: ")
    assert error.count("\n") == 1
    assert damage == "folder" or not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", COMMANDS)
def test_tables_tell_runs_and_combinations_apart(name: str, tmp_path: Path) -> None:
    parts = [
        rows_of(walk(seed=run + 10 * radius)).assign(run=run, arena_file=arena, **{"objects.robots.radius": radius})
        for arena in ("disk", "square")
        for radius in (20, 30)
        for run in (0, 1)
    ]
    file_of(tmp_path, pd.concat(parts, ignore_index=True))
    assert runs_of(name, tmp_path) == 0
    tables = [pd.read_csv(tmp_path / "out" / table) for table in TABLES[name] if table.endswith(".csv")]
    for table in tables:
        if "run" in table:  # not that of means over arenas
            arena = "arena_name" if "arena_name" in table else "arena_file"
            assert table.groupby([arena, "objects.robots.radius", "run"]).ngroups == 8


def test_missing_positions_are_left_out(tmp_path: Path) -> None:
    lattice = np.stack(np.meshgrid([250.0, 750.0], [250.0, 750.0]), axis=2).reshape(1, 4, 2).repeat(3, axis=0)
    file_of(tmp_path, rows_of(lattice).drop(index=5).assign(y=lambda rows: rows["y"].where(rows.index != 9)))
    for name in COMMANDS:
        assert runs_of(name, tmp_path, "--rc", "510") == 0
    out = tmp_path / "out"
    assert pd.read_csv(out / "neighbors_time.csv")["n_robots"].tolist() == [4, 3, 3]
    assert pd.read_csv(out / "neighbors_time.csv")["mean_degree"].tolist() == pytest.approx([2, 4 / 3, 4 / 3])
    assert pd.read_csv(out / "instantaneous_eigs.csv")["swarm_lambda_max"].tolist() == pytest.approx([4, 3, 3])
    assert pd.read_csv(out / "voronoi_metrics_per_arena.csv")["n_cells"].tolist() == [4, 3, 3]


def test_statistics_of_neighbours_are_dataframes(tmp_path: Path) -> None:
    file_of(tmp_path)
    assert runs_of("neighbors", tmp_path, "--statBasis", "robot", "--k", "2", "--rc", "2000") == 0
    with (tmp_path / "out/neighbors_stats.pkl").open("rb") as file:
        tables = pickle.load(file)
    assert list(tables) == ["time", "degree_histogram", "knn_robot"]
    assert tables["knn_robot"]["n"].tolist() == [6, 6, 6]
    assert not (tmp_path / "out/knn_run.pdf").exists()
    assert not (tmp_path / "out/knn_run.pdf").exists()
    histogram = tables["degree_histogram"]
    assert histogram[["count", "count_first", "count_last"]].sum().tolist() == [18, 6, 6]


@pytest.mark.parametrize("form", ["text", "brackets", "lists"])
def test_listed_neighbours_count_instead_of_the_nearest(form: str, tmp_path: Path) -> None:
    position = np.array([[[0.0, 0.0], [30.0, 40.0], [60.0, 80.0]]] * 2)
    lists: list[object] = [[1, 2], [0], [], [2], [2], None]
    if form != "lists":
        around = "[{}]" if form == "brackets" else "{}"
        texts = [None if own is None else ",".join(map(str, own)) for own in lists]  # type: ignore[call-overload]
        lists = [None if text is None else around.format(text) for text in texts]
    rows = rows_of(position, neighbors_list=lists)
    (run,) = trajectories_of(rows, metadata_of())
    found = listed_distance(run, listed_neighbours(run))
    np.testing.assert_allclose(found, [[75, 50, np.nan], [100, 50, np.nan]])
    file_of(tmp_path, rows)
    assert runs_of("neighbors", tmp_path) == 0
    table = pd.read_csv(tmp_path / "out/neighbors_time.csv")
    np.testing.assert_allclose(table["neighbor_distance"], [62.5, 75])


def test_listed_ids_that_are_no_robots_are_counted_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file_of(tmp_path, rows_of(walk(1, 3), neighbors_list=["1,77", "0,2,99", ""]))
    assert runs_of("neighbors", tmp_path) == 0
    assert capsys.readouterr().err.splitlines() == [
        "pogosim analyze neighbors: warning: 2 of the listed ids are of no robot in the data; they are left out"
    ]


def test_listed_distance_is_the_shortest_across_a_border() -> None:
    rows = rows_of(np.array([[[10.0, 0.0], [990.0, 0.0]]]), seen=["1", "0"])
    (run,) = trajectories_of(rows, metadata_of(1000.0, periodic=True))
    np.testing.assert_allclose(listed_distance(run, listed_neighbours(run, "seen")), [[20.0, 20.0]])


def test_a_column_that_lists_no_ids_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file_of(tmp_path, rows_of(walk(1, 2), names=["left", "right"]))
    assert runs_of("neighbors", tmp_path, "--neighborsCol", "names") == 2
    assert "its column names holds 'left', not ids of robots" in capsys.readouterr().err
    assert runs_of("neighbors", tmp_path, "--neighborsCol", "other") == 2
    assert "it has no column other" in capsys.readouterr().err


def test_windows_can_be_chosen(tmp_path: Path) -> None:
    file_of(tmp_path, rows_of(walk(6)))
    assert runs_of("network", tmp_path, "--avg-window-s", "2", "--k-first", "2") == 0
    table = pd.read_csv(tmp_path / "out/timeavg_eigs.csv")
    assert table["n_times"].tolist() == [2, 2, 2]
    assert "swarm_lambda_nz_2" in table
    assert "swarm_lambda_nz_3" not in table
    assert not (tmp_path / "out/timeavg_eigs_tau_c.csv").exists()


@pytest.mark.parametrize("options", [("--k-first", "0"), ("--avg-window-s", "-1"), ("--zero-tol", "x"), ("--rc", "0")])
def test_wrong_options_are_one_line(options: tuple[str, str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        analyze(["network", *options])
    assert ended.value.code == 2
    assert options[0] in capsys.readouterr().err


def test_coverage_can_be_that_of_one_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file_of(tmp_path, pd.concat([rows_of(walk(seed=run)).assign(run=run) for run in (3, 5)], ignore_index=True))
    assert runs_of("coverage", tmp_path, "--run", "5") == 0
    assert set(pd.read_csv(tmp_path / "out/voronoi_metrics_per_arena.csv")["run"]) == {5}
    assert runs_of("coverage", tmp_path, "--run", "4") == 2
    assert "it has no run 4; it has 3, 5" in capsys.readouterr().err


def test_coverage_takes_the_arena_of_a_configuration(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_rows(tmp_path / "data.feather", rows_of(walk()), {})
    assert runs_of("coverage", tmp_path) == 2
    assert "no arena_polygons" in capsys.readouterr().err
    (tmp_path / "box.csv").write_text("0,0\n2,0\n2,1\n0,1\n")
    (tmp_path / "conf.yaml").write_text("arena_file: somewhere/box.csv\narena_surface: 2.0e6\n")
    options = ["-c", str(tmp_path / "conf.yaml"), "--arenas-dir", str(tmp_path)]
    assert runs_of("coverage", tmp_path, *options) == 0
    table = pd.read_csv(tmp_path / "out/voronoi_metrics_per_arena.csv")
    np.testing.assert_allclose(table["mean_area"], 2.0e6 / 6)
    assert set(table["arena_name"]) == {"box"}
    (tmp_path / "far.yaml").write_text(
        "arena_file: box\narena_surface: 2.0e6\nobjects: {robots: {communication_radius: 200, radius: 10}}\n"
    )
    assert runs_of("coverage", tmp_path, "-c", str(tmp_path / "far.yaml"), *options[2:]) == 0
    far = pd.read_csv(tmp_path / "out/voronoi_metrics_per_arena.csv")
    assert runs_of("coverage", tmp_path, *options, "--rc", "220") == 0
    by_hand = pd.read_csv(tmp_path / "out/voronoi_metrics_per_arena.csv")
    assert far["coverage_ratio"].tolist() == by_hand["coverage_ratio"].tolist()
    assert (far["coverage_ratio"] > table["coverage_ratio"]).all()
    for wrong, said in (("a: [", "is not a configuration"), ("a: 1", "has no arena_file"), ("arena_file: box", "mm2")):
        (tmp_path / "conf.yaml").write_text(wrong)
        assert runs_of("coverage", tmp_path, *options) == 2
        assert said in capsys.readouterr().err
    (tmp_path / "conf.yaml").write_text("arena_file: box\narena_surface: file\n")
    (tmp_path / "box.csv").write_text("0,0\nx,y\n")
    assert runs_of("coverage", tmp_path, *options) == 2
    assert "box.csv:2: expected a corner 'x,y'" in capsys.readouterr().err


def test_an_input_is_not_overwritten(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for analysis, name in (("neighbors", "neighbors_time.csv"), ("network", "network_graph.csv"),
                           ("coverage", "voronoi_metrics_per_arena.csv")):  # fmt: skip
        path = file_of(tmp_path).rename(tmp_path / name)
        before = path.read_bytes()
        assert analyze([analysis, "-i", str(path), "-o", str(tmp_path)]) == 2
        assert "is an input" in capsys.readouterr().err
        assert path.read_bytes() == before


@pytest.mark.parametrize("output", ["knn_run.pdf", "neighbors_stats.pkl", "stats/deep.csv"])
@pytest.mark.parametrize("link", [Path.symlink_to, Path.hardlink_to])
def test_links_to_an_input_are_not_written_over(
    output: str, link: Callable[[Path, Path], None], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = file_of(tmp_path)
    before = path.read_bytes()
    other = tmp_path / "out" / output
    other.parent.mkdir(parents=True)
    link(other, path)
    assert runs_of("neighbors", tmp_path) == 2
    assert f"{other} leads to an input, which might be overwritten" in capsys.readouterr().err
    assert path.read_bytes() == before


def test_curves_are_called_by_the_shortest_names_that_tell_parameters_apart() -> None:
    assert endings(["objects.robots.nb", "arena_file"]) == ["nb", "arena_file"]
    assert endings(["parameters.a.speed", "parameters.b.speed", "nb"]) == ["a.speed", "b.speed", "nb"]
    assert endings(["speed", "a.speed", "b.a.speed"]) == ["speed", "a.speed", "b.a.speed"]
