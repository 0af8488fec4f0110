"""What the simulator says of a value in a batch or a search is said with the file and the line of the user."""

from __future__ import annotations

from pathlib import Path

import pytest
from batches import batch, subcommand
from pogosim.batch.configurations.combinations import combinations_of
from pogosim.batch.configurations.configuration import Configuration
from pogosim.batch.runs.places import line_in
from running import ROOT
from searches import search, write_search

BEGIN = f"""\
# A comment, which is not in the configuration of a run.
arena_file: {ROOT}/arenas/disk.csv
arena_surface: 1.0e6

simulation_time: 0.1
save_data_period: 0.1
objects:
    robots:
        type: pogobot
"""
NB = 10  # the line after these


def write(folder: Path, text: str, name: str = "many.yaml") -> Path:
    """Write a configuration that begins as above."""
    path = folder / name
    path.write_text(BEGIN + text)
    return path


@pytest.mark.parametrize(
    ("text", "line", "options"),
    [
        ("        nb: many\n", NB, ""),
        ("        nb: {batch_options: [2, many]}\n", NB, "objects.robots.nb: 'many'"),
        (
            "        nb:\n            batch_options:\n            - 2\n            - many\n",
            13,
            "objects.robots.nb: 'many'",
        ),
        ("        nb:\n            batch_options_range: {start: -1, stop: 2, step: 2}\n", NB, "objects.robots.nb: -1"),
        (
            "        batch_hierarchical_options:\n            few: {nb: 2}\n"
            "            more:\n                nb: many\n",
            13,
            "objects.robots.nb: 'many', objects.robots: 'more'",
        ),
    ],
)
def test_refused_value_is_named_with_the_line_of_the_user(text: str, line: int, options: str, tmp_path: Path) -> None:
    write(tmp_path, text)
    result = batch(tmp_path, "-r", "1")
    assert result.code == 3
    assert f"Error: many.yaml:{line}: objects.robots.nb: expected an integer" in result.errors
    assert result.errors.count("test.yaml") == 1, result.errors  # the command
    assert (f"options: {options}\n" in result.errors) == bool(options), result.errors
    assert ("options: " in result.errors) == bool(options)


@pytest.mark.parametrize("state", ["{output_file: own.flash}", "{output_file: own.flash, create_if_missing: true}"])
@pytest.mark.parametrize(
    ("text", "wrong"),
    [
        ("        nb: 1\n        radius: -1\n{state}", "many.yaml:11: objects.robots.radius: "),
        ("        nb: 1\n{state}time_step: 0\n", "many.yaml:12: time_step: "),
        ("        nb: 1\n{state}frames_format: 3\ntime_step: 0\n", "many.yaml:13: time_step: "),
    ],
)
def test_output_in_a_map_moves_no_line(text: str, wrong: str, state: str, tmp_path: Path) -> None:
    write(tmp_path, text.format(state=f"flash_state: {state}\n"))
    for result in (batch(tmp_path, "-r", "1"), subcommand(tmp_path, "task", "--seed", "1", folder_of="one")):
        assert result.code == 3
        assert wrong in result.errors
    assert "output_file: '" in (tmp_path / "one" / "pogobatch_effective.yaml").read_text()


def test_warnings_of_runs_have_the_line_of_the_user_and_are_said_once(tmp_path: Path) -> None:
    write(tmp_path, "        nb: {batch_options: [1, 2]}\n        raduis: 3\nparameters:\n    never_read: 1\n")
    result = batch(tmp_path, "-r", "2")
    assert result.code == 0
    assert sorted(result.errors.splitlines()) == [
        "pogobatch: results/result.feather: no column tells its combinations apart; add to result_new_columns: "
        "objects.robots.nb",
        "pogobatch: warning of a run: many.yaml:11: unknown key 'objects.robots.raduis' is ignored; "
        "did you mean 'radius'?",
        "pogobatch: warning of a run: parameters never read by the program: never_read (many.yaml:13)",
    ]


def test_output_that_a_batch_writes_in_its_own_way_is_named_by_the_file(tmp_path: Path) -> None:
    configuration = Configuration(write(tmp_path, "        nb: 1\n"))
    assert line_in(configuration, ("data_filename",), configuration.entries) == 0
    assert line_in(configuration, ("objects", "robots", "nb"), configuration.entries) == NB


def test_search_names_the_line_of_the_user(tmp_path: Path) -> None:
    domain = {"optimization_domain": {"choices": ["a", "b"]}}
    write_search(tmp_path, {"objects.robots.radius": domain}, "def objective_fn(df): return 1")
    lines = (tmp_path / "space.yaml").read_text().splitlines()
    line = next(number for number, text in enumerate(lines, 1) if text.strip() == "radius:")
    result = search(tmp_path, "--max-evals", "2", "--optimizer", "random", "-R", "0")
    assert result.code == 3
    assert f"Error: space.yaml:{line}: objects.robots.radius: expected a number" in result.errors


def test_value_of_each_combination_has_its_own_line(tmp_path: Path) -> None:
    text = """\
        nb: 1
parameters:
    plain: 1
    p:
        batch_options:
            - {q: 1}
            - q: {batch_options: [2, 3]}
            - q:
                - 4
    batch_hierarchical_options:
        default: {plain: 3}
        slow:
            plain: 2
        fast:
            other: 1
"""
    configuration = Configuration(write(tmp_path, text))
    found = [
        (
            line_in(configuration, ("parameters", "p", "q"), entries),
            line_in(configuration, ("parameters", "plain"), entries),
        )
        for entries in combinations_of(configuration.entries)
    ]
    first = [(15, 22), (16, 22), (16, 22), (17, 22)]
    assert found == [*first, *((line, 12) for line, _ in first)]
