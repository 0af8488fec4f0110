"""Runs whose rows stay in their file, and are read some save times at a time."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import pyarrow as pa
import pytest
from pogosim import row_batches
from pogosim.analysis import snapshots
from pogosim.analysis.network import mean_speed_mm_s
from pogosim.analysis.snapshots import times_of
from pogosim.analysis.stored_runs import ReadAsAWhole, StoredRun, runs_of
from pogosim.analysis.sums import sum_of_parts
from pogosim.analysis.trajectories import Trajectories, trajectories_of, unwrapped, unwrapped_blocks
from pogosim.errors import AmbiguousStepsWarning
from pogosim.far_away import FARTHEST_MM
from pogosim.reports import each_run, options
from pogosim.reports.command import ANALYSES, analyze
from pogosim.utils import load_dataframe
from pyarrow import feather, ipc, parquet
from swarms import brownian_walk, metadata_of, rows_of, write_rows

BATCH = 64  # rows


def in_batches(path: Path, rows: int = BATCH) -> Path:
    """Write a Feather file again, in batches of so many rows."""
    table = feather.read_table(path)
    with ipc.new_file(path, table.schema, options=ipc.IpcWriteOptions(compression="zstd")) as writer:
        writer.write_table(table, max_chunksize=rows)
    return path


def swarm(times: int, robots: int, seed: int = 0, **columns: Any) -> pd.DataFrame:
    """Rows of robots that walk at random in a square arena."""
    start = np.random.default_rng(seed).uniform(100.0, 900.0, (robots, 2))
    position = np.clip(start + brownian_walk(times, robots, 20.0, seed), 30.0, 970.0)
    heading = np.random.default_rng(seed).uniform(-3.0, 3.0, (times, robots))
    return rows_of(position, heading, 0.1, **columns)


def several_runs() -> tuple[pd.DataFrame, dict[str, Any]]:
    """Runs of two combinations, one after the other, some of them longer."""
    parts = [
        swarm(times, 6, run + 10 * number).assign(run=run, **{"objects.robots.radius": radius})
        for number, radius in enumerate((20.0, 26.5))
        for run, times in enumerate((30, 41))
    ]
    combinations = [
        {"columns": {"objects.robots.radius": radius}, "runs": 2, "rows": 71 * 6, "failed_runs": []}
        for radius in (20.0, 26.5)
    ]
    return pd.concat(parts, ignore_index=True), metadata_of() | {"combinations": combinations}


def with_gaps() -> tuple[pd.DataFrame, dict[str, Any]]:
    """Robots that come and go in a periodic arena, and other objects between them."""
    rows = swarm(60, 9)
    rows["robot_category"] = np.where(rows["robot_id"] == 4, "trays", "robots")
    rows["x"] = np.mod(rows["x"] + 150.0 * rows["time"], 1000.0)
    rows.loc[rows.index % 7 == 3, "x"] = np.nan
    rows.loc[rows.index % 53 == 5, "x"] = 2.0 * FARTHEST_MM
    rows = rows[rows.index % 11 != 0].reset_index(drop=True)
    return rows, metadata_of(periodic=True, max_linear_speed=100.0)


def two_categories() -> tuple[pd.DataFrame, dict[str, Any]]:
    """Robots of two categories with the same ids, all of which count."""
    rows = swarm(50, 8)
    rows["robot_category"] = np.where(rows["robot_id"] >= 4, "fast", "slow")
    rows["robot_id"] = rows["robot_id"] % 4
    own = {"type": "pogobot", "radius": 26.5, "communication_radius": 80.0}
    metadata = metadata_of()
    metadata["configuration"]["objects"] = {"fast": own, "slow": own}
    return rows, metadata


FILES: dict[str, Callable[[], tuple[pd.DataFrame, dict[str, Any]]]] = {
    "one run": lambda: (swarm(80, 7), metadata_of()),
    "one robot": lambda: (swarm(200, 1), metadata_of()),
    "one time": lambda: (swarm(1, 100), metadata_of()),
    "periodic, robots come and go": with_gaps,
    "several runs": several_runs,
    "several categories": two_categories,
    "without headings": lambda: (swarm(40, 5).drop(columns="angle"), metadata_of()),
}


@pytest.fixture
def file(kind_of_file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A file whose times go across the borders of its batches, of pieces and of blocks."""
    monkeypatch.setattr(row_batches, "PIECE", 25)
    monkeypatch.setattr(snapshots, "MAX_POINTS", 31)
    return in_batches(write_rows(tmp_path / "rows.feather", *FILES[kind_of_file]()))


def same(one: npt.ArrayLike, other: npt.ArrayLike) -> bool:
    """Tell whether arrays are equal, where there is nothing, too."""
    return bool(np.array_equal(np.asarray(one, dtype=float), np.asarray(other, dtype=float), equal_nan=True))


def assert_same(one: Trajectories, other: Trajectories) -> None:
    """Compare runs."""
    assert one.labels == other.labels
    assert list(one.category) == list(other.category)
    assert one.arena.name == other.arena.name
    assert one.arena.is_periodic == other.arena.is_periodic
    for name in ("time_s", "robot_id", "position_mm", "heading_rad", "present"):
        assert same(getattr(one, name), getattr(other, name)), name
    for name in ("radius_mm", "reach_mm", "top_speed_mm_s"):
        assert same(getattr(one.sizes, name), getattr(other.sizes, name)), name


@pytest.mark.filterwarnings("ignore:.*rows are left out.*:RuntimeWarning")
@pytest.mark.parametrize("kind_of_file", FILES)
@pytest.mark.parametrize("kind", ["feather", "parquet"])
def test_runs_in_a_file_are_those_of_all_its_rows(file: Path, kind: str) -> None:
    path = file
    if kind == "parquet":
        path = file.with_suffix(".parquet")
        parquet.write_table(feather.read_table(file), path, row_group_size=BATCH)
    stored, whole = runs_of(path), trajectories_of(*load_dataframe(file))
    assert len(stored) == len(whole)
    for run, every in zip(stored, whole, strict=True):
        assert_same(run.whole(), every)
        assert same(run.present, every.present)
        assert same(run.at(-1).position_mm[0], every.position_mm[-1])
        blocks = list(run.blocks(times_of(run.present)))
        assert len(blocks) > 1 or len(every.time_s) < 3
        for times, block in blocks:
            assert same(block.position_mm, every.position_mm[times])
            assert same(block.column("x"), every.column("x")[times])


@pytest.mark.filterwarnings("ignore:.*rows are left out.*:RuntimeWarning")
@pytest.mark.parametrize(
    "kind_of_file", ["one robot", "periodic, robots come and go", "several runs", "several categories"]
)
@pytest.mark.parametrize("name", sorted(set(ANALYSES.own) - {"messages"}))
def test_analyses_write_the_same_bytes_wherever_the_rows_are(
    file: Path, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("pogosim.reports.figures.FORMATS", ())
    monkeypatch.setattr("pogosim.reports.locomotion.draw_traces", lambda *_: None)
    printed, written = [], []
    for place in ("file", "memory"):
        if place == "memory":
            monkeypatch.setattr(options, "stored_runs", lambda *_: None)
        folder = tmp_path / place
        assert analyze(name, ["-i", str(file), "-o", str(folder)], "analyze") == 0
        printed.append(capsys.readouterr().err)
        written.append({path.name: path.read_bytes() for path in folder.rglob("*") if path.is_file()})
    assert printed[0] == printed[1]
    assert written[0]
    assert written[0] == written[1]


def test_column_of_neighbours_is_read_with_the_rows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(row_batches, "PIECE", 10)
    rows = swarm(20, 4).assign(neighbors_list=[f"{(place + 1) % 4}" for place in range(80)])
    path = in_batches(write_rows(tmp_path / "rows.feather", rows, metadata_of()))
    (run,) = runs_of(path)
    found = [block.column("neighbors_list") for _, block in run.blocks(times_of(run.present), ["neighbors_list"])]
    assert list(np.concatenate(found).ravel()) == list(rows["neighbors_list"])


@pytest.mark.parametrize("why", ["not in the order of time", "two rows of a robot", "own column run", "csv"])
def test_other_files_are_read_as_a_whole(why: str, tmp_path: Path) -> None:
    rows, metadata = swarm(30, 4), metadata_of()
    if why == "not in the order of time":
        rows = rows.sort_values(["robot_id", "time"], ignore_index=True)
    elif why == "two rows of a robot":
        rows = pd.concat([rows, rows.iloc[-1:]], ignore_index=True)
    path = in_batches(write_rows(tmp_path / "rows.feather", rows, metadata))
    if why == "own column run":
        table = feather.read_table(path)
        table = table.append_column("run", pa.array(range(table.num_rows)))
        table = table.replace_schema_metadata({**(table.schema.metadata or {}), b"program_version": b"1"})
        feather.write_feather(table, path)
    elif why == "csv":
        path = tmp_path / "rows.csv"
        rows.to_csv(path, index=False)
    with pytest.raises(ReadAsAWhole):
        runs_of(path)


def test_rows_in_another_order_have_the_same_results(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pogosim.reports.figures.FORMATS", ())
    rows = swarm(30, 4)
    tables = []
    for name, by in (("times", ["time", "robot_id"]), ("robots", ["robot_id", "time"])):
        path = write_rows(tmp_path / f"{name}.feather", rows.sort_values(by, ignore_index=True), metadata_of())
        assert analyze("network", ["-i", str(path), "-o", str(tmp_path / name)], "analyze") == 0
        tables.append({path.name: path.read_bytes() for path in Path(tmp_path / name).glob("*.csv")})
    assert tables[0] == tables[1]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [([], "it has no row with a time and a position"), (["--category", "tea"], "it has no rows of the category 'tea'")],
)
def test_file_without_rows_says_so(
    arguments: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_rows(tmp_path / "rows.feather", swarm(3, 2).iloc[:0], metadata_of())
    assert analyze("network", ["-i", str(path), "-o", str(tmp_path / "out"), *arguments], "analyze") == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize("count", [0, 1, 7, 130, 1 << 16, (1 << 16) + 1, 1_000_003])
def test_sum_of_parts_is_that_of_the_whole_array_to_the_last_bit(count: int) -> None:
    values = np.random.default_rng(count).lognormal(0.0, 3.0, count)
    parts = np.split(values, np.sort(np.random.default_rng(1).integers(0, count + 1, 9)))
    assert sum_of_parts(parts, count) == np.sum(values)


def parts_of(times: int, length: int) -> list[slice]:
    """Divide times into blocks of this length, the last one perhaps shorter."""
    return [slice(begin, min(begin + length, times)) for begin in range(0, times, length)]


def test_paths_across_periodic_borders_do_not_depend_on_blocks(tmp_path: Path) -> None:
    path = write_rows(tmp_path / "rows.feather", *with_gaps())
    with pytest.warns(RuntimeWarning, match="rows are left out"):
        (stored,) = runs_of(path)
    whole = stored.whole()
    fast = whole.sizes.top_speed_mm_s
    assert np.all(fast == 100.0)
    blocks = parts_of(len(whole.time_s), 7)
    path_mm = np.concatenate([own for _, _, own in unwrapped_blocks(stored, blocks)])
    assert same(path_mm, unwrapped(whole))
    speed = np.linalg.norm(np.diff(path_mm, axis=0), axis=2) / np.diff(whole.time_s)[:, None]
    assert mean_speed_mm_s(stored) == speed[np.isfinite(speed)].mean()


@pytest.mark.parametrize("robots", [{"max_linear_speed": 100.0}, {}], ids=["known", "unknown"])
def test_steps_that_may_be_others_are_told_once_for_all_blocks(robots: dict[str, float], tmp_path: Path) -> None:
    position = np.mod(brownian_walk(40, 3, 300.0) + 500.0, 1000.0)
    path = write_rows(tmp_path / "rows.feather", rows_of(position, period_s=6.0), metadata_of(periodic=True, **robots))
    (stored,) = runs_of(path)
    with pytest.warns(AmbiguousStepsWarning) as told:
        unwrapped(stored.whole())
        list(unwrapped_blocks(stored, parts_of(40, 9)))
    one, other = (str(warning.message) for warning in told)
    assert one == other


def test_bar_goes_on_within_a_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(snapshots, "MAX_POINTS", 100)
    (run,) = runs_of(write_rows(tmp_path / "rows.feather", swarm(100, 5), metadata_of()))
    places = []

    def work(run: StoredRun) -> int:
        for _ in run.blocks(times_of(run.present)):
            places.append(bar.now)
        return len(places)

    with each_run.Bar("rows", [2 * len(run.time_s) * 5]) as bar:
        list(bar.after_each(map(work, [run])))
        assert len(places) > 4
        assert places == sorted(set(places))
        assert 400 <= places[-1] < 500
        assert bar.now == 1000


PEAK = """
import sys
from pathlib import Path
from pogosim.analysis.coverage import coverage_over_time
from pogosim.analysis.network import graph_over_time, mean_speed_mm_s
from pogosim.analysis.stored_runs import runs_of

for run in runs_of(Path(sys.argv[1])):
    print(len(graph_over_time(run)), mean_speed_mm_s(run))
status = dict(line.split(":") for line in Path("/proc/self/status").read_text().splitlines())
print(status["VmHWM"].split()[0])  # what getrusage says has that of the parent in it
"""


@pytest.mark.skipif(sys.platform != "linux", reason="without /proc")
def test_eight_times_the_rows_need_no_more_memory(tmp_path: Path) -> None:
    peaks = []
    for times in (2_000, 16_000):
        rows = rows_of(np.tile(np.random.default_rng(0).uniform(0.0, 1000.0, (1, 100, 2)), (times, 1, 1)))
        path = in_batches(write_rows(tmp_path / "rows.feather", rows, metadata_of(communication_radius=10.0)), 65536)
        done = subprocess.run([sys.executable, "-c", PEAK, str(path)], check=True, capture_output=True, text=True)
        peaks.append(int(done.stdout.split()[-1]))
    assert peaks[1] < 1.25 * peaks[0], f"{peaks} kB"
