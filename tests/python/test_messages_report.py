from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from pogosim.analysis.reception import attempts, outcomes, reception_rates, wilson_interval
from pogosim.communication.reception_law import DynamicLaw
from pogosim.errors import AnalysisError
from pogosim.reports.command import analyze
from running import run_shipped
from swarms import metadata_of, rows_of, write_rows

PROG = "pogosim analyze messages"
TABLES = {"messages.csv", "reception_by_distance.csv", "reception_by_cluster_size.csv"}
FIGURES = {"reception.pdf", "reception.png"}


def log_of(*parts: tuple[str, int, float, int, int], queue_full: int = 0) -> pd.DataFrame:
    """Rows of a log: category, cluster size, probability, attempts, lost; of the heard, some find the queue full."""
    rows: list[dict[str, object]] = []
    for category, cluster_size, probability, count, lost in parts:
        for number in range(count):
            outcome = "lost" if number < lost else "queue_full" if number < lost + queue_full else "heard"
            rows.append(
                {
                    "time": 0.01 * number,
                    "message": len(rows),
                    "sender_category": category,
                    "receiver": 1.0,
                    "distance": 10.0 * cluster_size,
                    "cluster_size": cluster_size,
                    "probability": probability,
                    "outcome": outcome,
                }
            )
    return pd.DataFrame(rows)


def to_nobody(category: str, count: int) -> pd.DataFrame:
    nothing: dict[str, Any] = {"receiver": np.nan, "distance": np.nan, "probability": np.nan}
    rows = log_of((category, 1, 0.5, count, 0)).assign(**nothing, outcome="nobody_in_reach")
    return rows.assign(message=rows["message"] + 1000000)


def test_rates_are_shares_of_what_the_law_let_through_full_queues_or_not() -> None:
    log = pd.concat([log_of(("a", 2, 0.8, 100, 30), ("a", 3, 0.5, 200, 100), queue_full=5), to_nobody("a", 40)])
    table = reception_rates(attempts(log), ["cluster_size"])
    assert table["attempts"].tolist() == [100, 200]
    assert table["received"].tolist() == [70, 100]
    assert table["rate"].tolist() == pytest.approx([0.7, 0.5])
    assert table["law"].tolist() == pytest.approx([0.8, 0.5])
    assert table["z"].tolist() == pytest.approx([(70 - 80) / math.sqrt(100 * 0.8 * 0.2), 0.0])


def test_certain_messages_have_no_deviation() -> None:
    assert reception_rates(log_of(("a", 2, 1.0, 10, 0)), ["cluster_size"])["z"].isna().all()


def test_wilson_interval_has_the_values_of_the_textbook() -> None:
    # Newcombe (1998), Statistics in Medicine 17, table I, method 3.
    for successes, trials, low, high in [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0, 0.1611)]:
        assert wilson_interval(successes, trials) == pytest.approx((low, high), abs=5e-5)


def test_interval_contains_the_probability_as_often_as_it_says() -> None:
    generator = np.random.default_rng(3)
    low, high = wilson_interval(generator.binomial(60, 0.7, 20000), 60)
    assert ((low <= 0.7) & (high >= 0.7)).mean() == pytest.approx(0.95, abs=0.02)


def test_outcomes_are_counted_by_sender() -> None:
    log = pd.concat([log_of(("a", 2, 0.8, 10, 3), ("b", 3, 0.5, 20, 20), queue_full=2), to_nobody("b", 7)])
    table = outcomes(log, ["sender_category"]).set_index("sender_category")
    assert table.loc["a"].to_dict() == {
        "messages": 10,
        "nobody_in_reach": 0,
        "attempts": 10,
        "heard": 5,
        "lost": 3,
        "queue_full": 2,
    }
    columns = ["messages", "nobody_in_reach", "attempts", "heard", "lost"]
    assert table.loc[["b"], columns].to_numpy().tolist() == [[27, 7, 20, 0, 20]]


@pytest.mark.parametrize("column", ["outcome", "probability", "distance"])
def test_table_without_the_columns_of_a_log_is_refused(column: str) -> None:
    with pytest.raises(AnalysisError, match=f"no column {column}"):
        attempts(log_of(("a", 2, 0.8, 10, 3)).drop(columns=column))


# ---- the command ----


def analyzed(tmp_path: Path, log: pd.DataFrame, *options: str) -> Path:
    path = write_rows(tmp_path / "m.feather", log, metadata_of())
    folder = tmp_path / "out"
    assert analyze("messages", ["-i", str(path), "-o", str(folder), *options], PROG) == 0
    return folder


def test_command_writes_its_tables_and_its_figure(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = analyzed(tmp_path, log_of(("a", 2, 0.8, 100, 30), ("b", 3, 0.5, 50, 20)), "--bin", "25")
    assert {path.name for path in folder.iterdir()} == TABLES | FIGURES
    distance = pd.read_csv(folder / "reception_by_distance.csv")
    assert distance[["sender_category", "distance_from_mm", "distance_to_mm"]].to_numpy().tolist() == [
        ["a", 0.0, 25.0],
        ["b", 25.0, 50.0],
    ]
    printed = capsys.readouterr()
    assert (printed.out, printed.err) == (f"written to {folder}\n", "")


def test_senders_of_one_category_are_taken_alone(tmp_path: Path) -> None:
    folder = analyzed(tmp_path, log_of(("a", 2, 0.8, 100, 30), ("b", 3, 0.5, 50, 20)), "--category", "b")
    assert pd.read_csv(folder / "messages.csv")["sender_category"].tolist() == ["b"]


def test_messages_that_reach_no_robot_are_counted_with_a_warning(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = analyzed(tmp_path, to_nobody("a", 7))
    assert pd.read_csv(folder / "messages.csv")["nobody_in_reach"].tolist() == [7]
    assert {path.name for path in folder.iterdir()} == {"messages.csv"}
    assert "no message reached a robot" in capsys.readouterr().err


def test_messages_to_walls_have_no_distance_but_a_cluster_size(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = log_of(("a", 2, 0.8, 10, 3))
    log.loc[:3, "distance"] = np.nan
    folder = analyzed(tmp_path, log)
    assert pd.read_csv(folder / "reception_by_distance.csv")["attempts"].tolist() == [6]
    assert pd.read_csv(folder / "reception_by_cluster_size.csv")["attempts"].tolist() == [10]
    assert "4 rows to or from walls and membranes have no distance" in capsys.readouterr().err


def test_messages_to_walls_alone_have_a_figure(tmp_path: Path) -> None:
    folder = analyzed(tmp_path, log_of(("a", 2, 0.8, 10, 3)).assign(distance=np.nan))
    assert {path.name for path in folder.iterdir()} == TABLES | FIGURES


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ([], "is no message log (it has no column outcome): set message_log in the configuration"),
        (["--bin", "0"], "--bin"),
    ],
)
def test_what_is_no_log_is_one_message(
    options: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_rows(tmp_path / "data.feather", rows_of(np.zeros((2, 3, 2))), metadata_of())
    try:
        code = analyze("messages", ["-i", str(path), "-o", str(tmp_path / "out"), *options], PROG)
    except SystemExit as end:
        code = int(end.code or 0)
    assert code == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_file_among_logs_that_is_none_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = write_rows(tmp_path / "log.feather", log_of(("a", 2, 0.8, 10, 3)), metadata_of())
    data = write_rows(tmp_path / "data.feather", rows_of(np.zeros((2, 3, 2))), metadata_of())
    for files in ([log, data], [data, log], [tmp_path / "*.feather"]):
        assert analyze("messages", ["-i", *map(str, files), "-o", str(tmp_path / "out")], PROG) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert f"{data} is no message log (it has no column outcome): set message_log in the configuration" in line


def test_unknown_category_and_empty_log_are_one_message(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = log_of(("a", 2, 0.8, 10, 3))
    path = write_rows(tmp_path / "m.feather", log, metadata_of())
    assert analyze("messages", ["-i", str(path), "--category", "c"], PROG) == 2
    assert "no robot of the category 'c' sends; senders: a\n" in capsys.readouterr().err
    write_rows(path, log.iloc[:0], metadata_of())
    assert analyze("messages", ["-i", str(path)], PROG) == 2
    assert "has no message: no robot sent one\n" in capsys.readouterr().err
    assert analyze("messages", ["-i", str(tmp_path / "none.feather")], PROG) == 2
    assert "none.feather" in capsys.readouterr().err


def test_run_of_probes_follows_the_articles_equation(tmp_path: Path) -> None:
    changes = {"message_log": str(tmp_path / "m.feather"), "parameters.send_percent": 80}
    run_shipped("probes", tmp_path, {"simulation_time": 20.0, "save_data_period": 0, **changes})
    assert analyze("messages", ["-i", str(tmp_path / "m.feather"), "-o", str(tmp_path / "out")], PROG) == 0
    table = pd.read_csv(tmp_path / "out" / "reception_by_cluster_size.csv").set_index("cluster_size")
    law = DynamicLaw().probability(6, 0.8, table.index.to_numpy(float))
    np.testing.assert_allclose(table["law"], law, rtol=1e-6)
    assert table["attempts"].sum() > 10000
    assert (table["z"].abs() < 4.0).all()
    assert (table["rate"] - table["law"]).abs().max() < 0.05


def test_several_logs_have_a_curve_for_each_combination(tmp_path: Path) -> None:
    for percent in (20, 80):
        changes = {"message_log": str(tmp_path / f"{percent}.feather"), "parameters.send_percent": percent}
        run_shipped("probes", tmp_path, {"simulation_time": 2.0, "save_data_period": 0, **changes})
    assert analyze("messages", ["-i", str(tmp_path / "[28]0.feather"), "-o", str(tmp_path / "out")], PROG) == 0
    table = pd.read_csv(tmp_path / "out" / "reception_by_cluster_size.csv")
    assert set(table["parameters.send_percent"]) == {20, 80}
    messages = pd.read_csv(tmp_path / "out" / "messages.csv")
    assert messages["run"].tolist() == [0, 1]
