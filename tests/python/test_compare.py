"""pogosim compare: where two runs or two batches differ."""

from __future__ import annotations

import itertools
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import yaml
from in_process import pogosim, refusal
from pogosim.comparison.rows import compare_rows
from pogosim.comparison.statistics import difference_interval, holm, least_p, two_sample_p
from pyarrow import feather
from recordings import walkers, write
from running import Run

# ---- statistics ------------------------------------------------------------------------------------------------------


def test_holm_is_that_of_an_example_by_hand() -> None:
    # In order 0.005, 0.01, 0.03, 0.04: times 4, 3, 2, 1, and never less than the one before.
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert holm([0.5, 0.9]) == [1.0, 1.0]
    assert holm([]) == []


def test_what_was_not_tested_does_not_count_for_holm() -> None:
    found = holm([0.01, math.nan, 0.02])
    assert (found[0], found[2]) == pytest.approx((0.02, 0.02))
    assert math.isnan(found[1])


@pytest.mark.parametrize("test", ["mann-whitney", "permutation"])
@pytest.mark.parametrize(("n", "m"), [(3, 3), (4, 6), (5, 5)])
def test_samples_apart_have_the_least_probability(test: str, n: int, m: int) -> None:
    a, b = np.arange(n, dtype=np.float64), np.arange(1000, 1000 + m, dtype=np.float64)
    assert two_sample_p(a, b, test) == pytest.approx(least_p(n, m, test))
    assert two_sample_p(b, a, test) == pytest.approx(two_sample_p(a, b, test))


def test_permutations_are_those_counted_by_hand() -> None:
    a, b = np.array([1.0, 2.0, 4.0]), np.array([3.0, 8.0])
    pooled = [*a, *b]
    observed = abs(a.mean() - b.mean())
    apart = []
    for chosen in itertools.combinations(range(5), 3):
        others = [pooled[i] for i in range(5) if i not in chosen]
        apart.append(abs(np.mean([pooled[i] for i in chosen]) - np.mean(others)))
    assert two_sample_p(a, b, "permutation") == np.mean(np.array(apart) >= observed - 1e-12)


@pytest.mark.parametrize("test", ["mann-whitney", "permutation"])
def test_probabilities_of_equal_distributions_are_uniform(test: str) -> None:
    generator = np.random.default_rng(5)
    found = [two_sample_p(generator.normal(size=5), generator.normal(size=5), test) for _ in range(400)]
    assert 0.02 < np.mean(np.array(found) <= 0.05) < 0.08
    assert 0.4 < np.mean(np.array(found) <= 0.5) < 0.6


@pytest.mark.parametrize("test", ["mann-whitney", "permutation"])
def test_equal_values_do_not_differ(test: str) -> None:
    assert two_sample_p(np.full(5, 3.0), np.full(4, 3.0), test) == 1.0
    assert math.isnan(two_sample_p(np.array([1.0]), np.array([2.0, 3.0]), test))


def test_interval_of_a_known_difference_covers_it_as_often_as_it_says() -> None:
    generator = np.random.default_rng(7)
    covered = 0
    for _ in range(100):
        low, high = difference_interval(generator.normal(0.0, 1.0, 40), generator.normal(2.0, 1.0, 40))
        covered += low <= 2.0 <= high
    assert 88 <= covered <= 100


def test_interval_of_constants_is_their_difference() -> None:
    assert difference_interval(np.full(3, 1.0), np.full(3, 4.0)) == (3.0, 3.0)
    assert all(map(math.isnan, difference_interval(np.array([1.0]), np.full(3, 4.0))))


# ---- rows ------------------------------------------------------------------------------------------------------------


def compared(folder: Path, *arguments: str) -> Run:
    result = pogosim(folder, "compare", *arguments)
    assert result.code in (0, 1), result.text
    return result


def found(folder: Path, *arguments: str) -> dict[str, Any]:
    result = compared(folder, *arguments, "--json")
    entries: dict[str, Any] = json.loads(result.output)
    assert entries["differ"] == (result.code == 1)
    return entries


def test_file_equals_its_copy(tmp_path: Path) -> None:
    write(tmp_path / "a.feather", walkers(), seed=1)
    write(tmp_path / "b.feather", walkers(), seed=1)
    result = compared(tmp_path, "a.feather", "b.feather")
    assert result.code == 0
    assert result.output.startswith("equal: all 15 rows are the same\n")
    assert "configurations: equal" in result.output
    assert compared(tmp_path, "a.feather", "b.feather", "-q").output == "equal: all 15 rows are the same\n"


def changed(rows: pd.DataFrame, row: int, column: str, value: Any) -> pd.DataFrame:
    rows = rows.copy()
    rows.loc[row, column] = value
    return rows


def test_one_changed_value_is_found(tmp_path: Path) -> None:
    write(tmp_path / "a.feather", walkers())
    write(tmp_path / "b.feather", changed(walkers(), 7, "heard", 99))
    result = compared(tmp_path, "a.feather", "b.feather")
    assert result.code == 1
    assert result.output.startswith("differ: rows differ from row 7 (time 1 s, robots 1) on, in heard\n")
    assert found(tmp_path, "a.feather", "b.feather")["rows"] == {
        "equal": False,
        "counts": [15, 15],
        "only_in": [[], []],
        "types": {},
        "first": {
            "row": 7,
            "place": {"time": 1.0, "robot_category": "robots", "robot_id": 1},
            "values": {"heard": [12, 99]},
        },
        "columns": [{"name": "heard", "rows": 1, "first_row": 7, "largest": 87.0}],
    }


def test_first_row_is_the_first_of_all_columns_and_each_column_has_its_own(tmp_path: Path) -> None:
    write(tmp_path / "a.feather", walkers())
    rows = changed(changed(walkers(), 9, "x", 1.5), 4, "state", "runs")
    write(tmp_path / "b.feather", changed(rows, 12, "x", 2.5))
    own = found(tmp_path, "a.feather", "b.feather")["rows"]
    assert own["first"]["row"] == 4
    assert own["first"]["values"] == {"state": ["waits", "runs"]}
    assert [(column["name"], column["rows"], column["first_row"]) for column in own["columns"]] == [
        ("x", 2, 9),
        ("state", 1, 4),
    ]


def table(**columns: Any) -> pa.Table:
    return pa.table(columns)


def rows_of(folder: Path, a: pa.Table, b: pa.Table, tolerance: float = 0.0, chunk: int | None = None) -> Any:
    feather.write_feather(a, folder / "a.feather", chunksize=chunk)
    feather.write_feather(b, folder / "b.feather")
    return compare_rows(folder / "a.feather", folder / "b.feather", tolerance)


def test_missing_values_and_no_numbers_equal_each_other(tmp_path: Path) -> None:
    values = pa.array([None, math.nan, math.inf, 1.0])
    assert rows_of(tmp_path, table(v=values), table(v=values)).is_equal
    other = rows_of(tmp_path, table(v=values), table(v=pa.array([math.nan, None, -math.inf, 1.0])))
    assert (other.columns[0].rows, other.columns[0].first_row, other.columns[0].largest) == (3, 0, None)


@pytest.mark.parametrize(
    ("a", "b", "is_equal"),
    [
        (pa.array([1, 2], pa.int8()), pa.array([1, 2], pa.int64()), True),
        (pa.array([0.1, 0.2], pa.float32()), pa.array([0.1, 0.2], pa.float64()), True),
        (pa.array([0.1, 0.2], pa.float32()), pa.array([0.1, 0.3], pa.float64()), False),
        (pa.array(["a", None]), pa.array(["a", None]).dictionary_encode(), True),
        (pa.array(["a", "b"]), pa.array(["a", "c"], pa.large_string()), False),
        (pa.array([1, 2]), pa.array(["1", "2"]), False),
        (pa.array([True, None]), pa.array([True, None]), True),
        (pa.array([True, False]), pa.array([True, None]), False),
        (pa.array([2**62, 2**62 + 1]), pa.array([2**62, 2**62]), False),
        (pa.array([[1], [2, 3]]), pa.array([[1], [2, 3]]), True),
        (pa.array([[1], [2, 3]]), pa.array([[1], [2]]), False),
        (pa.array([b"a", b"\xff"]), pa.array([b"a", b"\xfe"]), False),
        (pa.array([None, None]), pa.array([None, 1]), False),
    ],
    ids=str,
)
def test_values_are_compared_as_what_they_are(tmp_path: Path, a: pa.Array, b: pa.Array, is_equal: bool) -> None:
    result = rows_of(tmp_path, table(v=a), table(v=b))
    assert result.is_equal == is_equal
    if not is_equal:
        assert result.columns[0].rows == 1 or pa.types.is_string(b.type)


def test_tolerance_is_a_share_and_as_much(tmp_path: Path) -> None:
    a, b = table(v=[1e6, 0.0, 5.0]), table(v=[1e6 + 5.0, 5e-6, 5.1])
    assert rows_of(tmp_path, a, b).columns[0].rows == 3
    near = rows_of(tmp_path, a, b, tolerance=1e-5)
    assert (near.columns[0].rows, near.first.row) == (1, 2)
    assert not rows_of(tmp_path, table(v=[1]), table(v=[2]), tolerance=10.0).is_equal  # integers are exact


@pytest.mark.parametrize("chunk", [1, 7, 1000])
def test_batches_of_a_file_do_not_matter(tmp_path: Path, chunk: int) -> None:
    numbers = np.arange(5000)
    other = numbers.copy()
    other[4321] = -1
    assert rows_of(tmp_path, table(n=numbers), table(n=numbers), chunk=chunk).is_equal
    result = rows_of(tmp_path, table(n=numbers), table(n=other), chunk=chunk)
    assert (result.first.row, result.rows) == (4321, (5000, 5000))


def test_rows_and_columns_that_only_one_file_has_are_told(tmp_path: Path) -> None:
    write(tmp_path / "a.feather", walkers(records=5))
    write(tmp_path / "b.feather", walkers(records=4))
    result = compared(tmp_path, "a.feather", "b.feather", "-q")
    assert result.output == "differ: one has 15 rows, the other 12; those that both have are the same\n"
    write(tmp_path / "b.feather", walkers().drop(columns=["fed", "heard"]))
    result = compared(tmp_path, "a.feather", "b.feather", "-q")
    assert result.output == "differ: only a.feather has the columns heard, fed\n"
    assert "columns only in a: heard, fed" in compared(tmp_path, "a.feather", "b.feather").output


def test_formats_do_not_matter(tmp_path: Path) -> None:
    write(tmp_path / "a.feather", walkers())
    own = feather.read_table(tmp_path / "a.feather")
    pq.write_table(own, tmp_path / "b.parquet")
    assert compared(tmp_path, "a.feather", "b.parquet").code == 0


def test_tables_that_are_no_runs_are_compared_too(tmp_path: Path) -> None:
    feather.write_feather(table(n=[1, 2]), tmp_path / "a.feather")
    feather.write_feather(table(n=[1, 3]), tmp_path / "b.feather")
    entries = found(tmp_path, "a.feather", "b.feather")
    assert entries["rows"]["first"]["row"] == 1
    assert "configurations: not in the files" in compared(tmp_path, "a.feather", "b.feather").output


# ---- configurations --------------------------------------------------------------------------------------------------


def test_keys_that_differ_are_listed_without_seeds_and_outputs(tmp_path: Path) -> None:
    write(tmp_path / "a.feather", walkers(), seed=1, data_filename="a", time_step=0.01, parameters={"speed": 1})
    write(tmp_path / "b.feather", walkers(), seed=2, data_filename="b", time_step=0.02, arena_file="x.csv")
    entries = found(tmp_path, "a.feather", "b.feather")
    assert entries["configurations"] == [
        {"key": "parameters.speed", "a": 1},
        {"key": "time_step", "a": 0.01, "b": 0.02},
        {"key": "arena_file", "b": "x.csv"},
    ]
    assert [own["seeds"] for own in entries["files"]] == [[1], [2]]
    assert entries["verdict"] == "equal: all 15 rows are the same; configurations differ in 3 keys"


def with_metadata(data: Path, **entries: str) -> Path:
    table = feather.read_table(data)
    own = {**table.schema.metadata, **{name.encode(): text.encode() for name, text in entries.items()}}
    feather.write_feather(table.replace_schema_metadata(own), data)
    return data


def test_versions_and_arenas_are_told(tmp_path: Path) -> None:
    with_metadata(write(tmp_path / "a.feather", walkers()), program_version="v1")
    outline = yaml.safe_dump([[{"x": 0, "y": 0}, {"x": 1, "y": 0}, {"x": 0, "y": 1}]])
    with_metadata(write(tmp_path / "b.feather", walkers()), program_version="v2", arena_polygons=outline)
    entries = found(tmp_path, "a.feather", "b.feather")
    assert [own["version"] for own in entries["files"]] == ["v1", "v2"]
    assert [own["key"] for own in entries["configurations"]] == ["outline of the arena"]


def test_programs_are_compared_where_a_batch_has_kept_their_hash(tmp_path: Path) -> None:
    for name, own in (("a", "12"), ("b", "34")):
        (tmp_path / name / "frames").mkdir(parents=True)
        write(tmp_path / name / "frames" / "data.feather", walkers())
        (tmp_path / name / "pogobatch_task.json").write_text(json.dumps({"program_hash": own}))
    result = compared(tmp_path, "a/frames/data.feather", "b/frames/data.feather")
    assert "programs: they differ" in result.output
    assert result.code == 0
    for text in ("[]", "{", '{"program_hash": 3}'):
        (tmp_path / "b" / "pogobatch_task.json").write_text(text)
        result = compared(tmp_path, "a/frames/data.feather", "b/frames/data.feather")
        assert "programs: not compared" in result.output


# ---- batches ---------------------------------------------------------------------------------------------------------


def batch(path: Path, heard: list[float], seeds: list[int] | None = None, name: str = "", **settings: Any) -> Path:
    """Runs of walkers with a number each that they have heard at all times."""
    rows = pd.concat([walkers().assign(run=run, heard=value) for run, value in enumerate(heard)], ignore_index=True)
    columns = {}
    if name:
        rows["parameters.a"] = name
        columns = {"parameters.a": name}
    entry = {"columns": columns, "runs": len(heard), "rows": len(rows), "failed_runs": []}
    entry |= {} if seeds is None else {"seeds": seeds}
    return with_metadata(write(path, rows, **settings), combinations=yaml.safe_dump([entry]))


LOW, HIGH = [1.0, 2.0, 3.0, 4.0, 5.0], [11.0, 12.0, 13.0, 14.0, 15.0]
OTHER_SEEDS = [100, 101, 102, 103, 104]


def numbers(entries: dict[str, Any]) -> dict[str, dict[str, Any]]:
    return {own["number"]: own for own in entries["distributions"]["numbers"]}


def test_known_difference_of_two_batches_is_found(tmp_path: Path) -> None:
    batch(tmp_path / "a.feather", LOW)
    batch(tmp_path / "b.feather", HIGH, OTHER_SEEDS)
    entries = found(tmp_path, "a.feather", "b.feather")
    assert (entries["differ"], entries["rows"]) == (True, None)
    own = numbers(entries)["column heard, mean"]
    assert (own["means"], own["difference"], own["runs"]) == ([3.0, 13.0], 10.0, [5, 5])
    assert own["interval"][0] < 10.0 < own["interval"][1]
    assert own["p"] == pytest.approx(2.0 / math.comb(10, 5))
    # The other numbers are equal in all runs, and so are no tests: two are left, mean and end.
    assert entries["distributions"]["tests"] == 2
    assert own["p_corrected"] == pytest.approx(2 * own["p"])
    assert numbers(entries)["speed, mean"]["p"] is None
    result = compared(tmp_path, "a.feather", "b.feather", "-q")
    assert result.output == (
        "differ: 2 of 2 numbers differ at the level 0.05 (Mann-Whitney, Holm): "
        "column heard, mean; column heard, final\n"
    )


def test_batches_of_one_distribution_do_not_differ(tmp_path: Path) -> None:
    batch(tmp_path / "a.feather", LOW)
    batch(tmp_path / "b.feather", [value + 0.1 for value in LOW], OTHER_SEEDS)
    result = compared(tmp_path, "a.feather", "b.feather")
    assert result.code == 0
    first = result.output.splitlines()[0]
    assert first == "no difference found: none of 2 numbers differs at the level 0.05 (Mann-Whitney, Holm)"


def test_level_and_test_are_those_of_the_options(tmp_path: Path) -> None:
    batch(tmp_path / "a.feather", LOW)
    batch(tmp_path / "b.feather", HIGH, OTHER_SEEDS)
    assert compared(tmp_path, "a.feather", "b.feather", "--level", "0.01").code == 0
    entries = found(tmp_path, "a.feather", "b.feather", "--test", "permutation", "--level", "0.02")
    assert entries["distributions"]["test"] == "permutation"
    assert entries["differ"]


def test_few_runs_say_that_they_cannot_show_a_difference(tmp_path: Path) -> None:
    batch(tmp_path / "a.feather", LOW[:3])
    batch(tmp_path / "b.feather", HIGH[:3], OTHER_SEEDS[:3])
    result = compared(tmp_path, "a.feather", "b.feather")
    assert result.code == 0
    assert "so few runs cannot show any difference" in result.output.splitlines()[0]
    assert "p is at least 0.2 after the correction, above 0.05" in result.output


def test_batches_of_the_same_seeds_are_compared_row_by_row(tmp_path: Path) -> None:
    batch(tmp_path / "a.feather", LOW)
    batch(tmp_path / "b.feather", [*LOW[:4], 6.0])
    result = compared(tmp_path, "a.feather", "b.feather")
    assert result.code == 1
    assert result.output.startswith("differ: rows differ from row 60 (run 4, time 0 s, robots 0) on, in heard; none of")
    assert compared(tmp_path, "a.feather", "b.feather", "--no-rows").code == 0


def test_combinations_are_compared_with_their_own(tmp_path: Path) -> None:
    parts = [batch(tmp_path / f"{name}.feather", heard, name=name) for name, heard in (("x", LOW), ("y", HIGH))]
    rows = pd.concat([pd.read_feather(part) for part in parts], ignore_index=True)
    entry = {"runs": 5, "rows": len(rows) // 2, "failed_runs": []}

    def both(path: Path, seeds: list[int], names: tuple[str, str], more: float) -> None:
        own = rows.assign(
            **{"parameters.a": np.repeat(names, len(rows) // 2)},
            heard=rows["heard"] + more * (rows["parameters.a"] == "y"),
        )
        entries = [{**entry, "columns": {"parameters.a": name}, "seeds": seeds} for name in names]
        with_metadata(write(path, own), combinations=yaml.safe_dump(entries))

    both(tmp_path / "a.feather", [0, 1, 2, 3, 4], ("x", "y"), 0.0)
    both(tmp_path / "b.feather", OTHER_SEEDS, ("x", "y"), 100.0)
    entries = found(tmp_path, "a.feather", "b.feather")
    significant = [own for own in entries["distributions"]["numbers"] if (own["p_corrected"] or 1.0) < 0.05]
    assert {(own["combination"], own["number"]) for own in significant} == {
        ("parameters.a y", "column heard, mean"),
        ("parameters.a y", "column heard, final"),
    }
    both(tmp_path / "c.feather", OTHER_SEEDS, ("x", "z"), 0.0)
    entries = found(tmp_path, "a.feather", "c.feather")
    assert entries["distributions"]["only_in"] == [["parameters.a y"], ["parameters.a z"]]
    assert "different combinations" in entries["verdict"]


def test_single_combinations_with_different_options_belong_together(tmp_path: Path) -> None:
    batch(tmp_path / "a.feather", LOW, name="x")
    batch(tmp_path / "b.feather", HIGH, OTHER_SEEDS, name="y")
    entries = found(tmp_path, "a.feather", "b.feather")
    assert numbers(entries)["column heard, mean"]["difference"] == 10.0
    assert {"key": "parameters.a", "a": ["x"], "b": ["y"]} in entries["configurations"]


def test_patterns_of_files_are_batches(tmp_path: Path) -> None:
    for seed, (low, high) in enumerate(zip(LOW, HIGH, strict=True)):
        write(tmp_path / f"a{seed}.feather", walkers().assign(heard=low), seed=seed)
        write(tmp_path / f"b{seed}.feather", walkers().assign(heard=high), seed=seed)
    entries = found(tmp_path, "a*.feather", "b*.feather")
    assert entries["differ"]
    assert numbers(entries)["column heard, final"]["difference"] == 10.0
    assert "Rows are not compared" in entries["notes"][0]


@pytest.mark.parametrize("ending", ["png", "pdf", "svg"])
def test_figure_is_drawn(tmp_path: Path, ending: str) -> None:
    batch(tmp_path / "a.feather", LOW)
    batch(tmp_path / "b.feather", HIGH, OTHER_SEEDS)
    assert compared(tmp_path, "a.feather", "b.feather", "-o", f"f.{ending}").code == 1
    assert (tmp_path / f"f.{ending}").stat().st_size > 3000
    before = (tmp_path / f"f.{ending}").read_bytes()
    compared(tmp_path, "a.feather", "b.feather", "-o", f"f.{ending}")
    assert (tmp_path / f"f.{ending}").read_bytes() == before or ending == "svg"


def test_figure_of_single_runs_is_drawn(tmp_path: Path) -> None:
    write(tmp_path / "a.feather", walkers().rename(columns={"heard": "$x_{"}))
    result = compared(tmp_path, "a.feather", "a.feather", "-o", "f.png")
    assert result.code == 0
    assert "Figure of the numbers over time: f.png" in result.output.splitlines()
    assert (tmp_path / "f.png").exists()


def test_runs_of_other_lengths_are_told(tmp_path: Path) -> None:
    write(tmp_path / "a.feather", walkers(3, 5))
    write(tmp_path / "b.feather", walkers(3, 9))
    both = compared(tmp_path, "a.feather", "b.feather", "--category", "robots").output
    assert "Runs of a end at 2 s, those of b at 4 s: means and ends are not of the same time." in both
    assert "Runs of a" not in compared(tmp_path, "a.feather", "a.feather", "--category", "robots").output


def test_control_characters_are_escaped(tmp_path: Path) -> None:
    write(tmp_path / "a.feather", walkers())
    write(tmp_path / "b.feather", walkers().assign(state="\x1b[31m").rename(columns={"fed": "a\x07b"}))
    assert "\x1b" not in compared(tmp_path, "a.feather", "b.feather").output
    assert "\x07" not in compared(tmp_path, "a.feather", "b.feather").output


def test_lists_are_cut_at_most_lines(tmp_path: Path) -> None:
    many = {f"c{number}": 1 for number in range(30)}
    write(tmp_path / "a.feather", walkers().assign(**many))
    write(tmp_path / "b.feather", walkers().assign(**dict.fromkeys(many, 2)))
    text = compared(tmp_path, "a.feather", "b.feather").output
    assert "... and 10 more columns; --most N lists more" in text
    assert "c29" in compared(tmp_path, "a.feather", "b.feather", "--most", "100").output


# ---- bad input -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["a.feather"], "the following arguments are required: B.feather"),
        (["a.feather", "none.feather"], "none.feather"),
        (["none*.feather", "a.feather"], "no file fits the pattern 'none*.feather'"),
        (["a.feather", "text.feather"], "text.feather"),
        (["a.feather", "."], "."),
        (["a.feather", "damaged.feather"], "damaged.feather is damaged"),
        (["a.feather", "a.feather", "--tolerance", "-1"], "-1 is below 0"),
        (["a.feather", "a.feather", "--tolerance", "nan"], "'nan' is not a finite number"),
        (["a.feather", "a.feather", "--level", "1"], "1 is not between 0 and 1"),
        (["a.feather", "a.feather", "--test", "t"], "invalid choice"),
        (["a.feather", "a.feather", "--most", "0"], "not a whole number"),
        (["a.feather", "a.feather", "-o", "a.gif"], "unknown format of a figure"),
        (["a.feather", "a.feather", "-o", "none/a.png"], "there is no folder"),
        (["a.feather", "a.feather", "-o", "a.feather"], "would take the place of the data file"),
        (["a.feather", "b.feather", "--category", "sheep"], "no rows of the category 'sheep'"),
        (["a.feather", "b.feather", "--no-rows"], "cannot be compared"),
        (["a.feather", "bare.feather", "--no-rows"], "cannot be compared"),
        (["bare.feather", "bare.feather", "-o", "a.png"], "it has no column time, x, y"),
    ],
)
def test_what_cannot_be_compared_is_one_line(tmp_path: Path, arguments: list[str], said: str) -> None:
    write(tmp_path / "a.feather", walkers())
    write(tmp_path / "b.feather", walkers().assign(heard=1))
    write(tmp_path / "bare.feather", pd.DataFrame({"a": [1]}))
    (tmp_path / "text.feather").write_text("no table")
    write(tmp_path / "damaged.feather", walkers(50, 50))
    content = bytearray((tmp_path / "damaged.feather").read_bytes())
    content[2000:6000] = bytes(4000)
    (tmp_path / "damaged.feather").write_bytes(content)
    line = refusal(pogosim(tmp_path, "compare", *arguments))
    assert line.startswith("pogosim compare: ")
    assert said in line
    assert not list(tmp_path.glob("*.png"))
