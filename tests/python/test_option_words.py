"""Slips in the keys of options are errors of the simulator, of batches and of searches alike, with the same words."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
import yaml
from batches import batch
from pogosim.arenas import main as draw_arena
from pogosim.batch.configurations.combinations import combinations_of
from pogosim.batch.configurations.option_words import (
    DOMAIN_WORDS,
    HIERARCHICAL_OPTIONS,
    RANGE_WORDS,
    VALUE_WORDS,
    CombinationsError,
    misspelt_option,
)
from pogosim.nearest_name import edit_distance, nearest_name
from pogosim.simulation import ConfigurationError, Simulation
from pogosim.yaml_1_2 import parse_yaml
from running import ROOT, Run, example, run_command, scene
from searches import OBJECTIVE, search

WORDS = "known are default_option, batch_options, batch_options_range, optimization_domain"

# Changes of the scene, where the slip is, and what is said of it.
SLIPS: list[tuple[str, dict[str, Any], str, str]] = [
    (
        "batch_option",
        {"objects.robots.nb": {"batch_option": [3, 4], "default_option": 3}},
        "objects.robots.nb",
        "unknown key 'batch_option' beside 'default_option'; did you mean 'batch_options'?",
    ),
    (
        "defalt_option",
        {"parameters": {"walk": {"speed": {"batch_options": [1, 2], "defalt_option": 1}}}},
        "parameters.walk.speed",
        "unknown key 'defalt_option' beside 'batch_options'; did you mean 'default_option'?",
    ),
    (
        "radius",
        {"objects.robots.nb": {"radius": 2, "default_option": 3}},
        "objects.robots.nb",
        f"unknown key 'radius' beside 'default_option'; {WORDS}",
    ),
    (
        "batch_option",
        {"objects.robots.nb": {"batch_option": [3, 4], "defalt_option": 3}},
        "objects.robots.nb",
        "unknown key 'batch_option'; did you mean 'batch_options'?",
    ),
    (
        "batch_option",
        {"parameters": {"speed": {"batch_option": [3, 4], "defalt_option": 3}}},
        "parameters.speed",
        "unknown key 'batch_option'; did you mean 'batch_options'?",
    ),
    (
        "optimisation_domain",
        {"parameters": {"list": [1, {"optimisation_domain": {"type": "float", "min": 1, "max": 2}}]}},
        "parameters.list.1",
        "unknown key 'optimisation_domain'; did you mean 'optimization_domain'?",
    ),
    (
        "batch_hierarchical_option",
        {"parameters": {"a": 1, "batch_hierarchical_option": {"name": "walk", "forward": {"a": 2}}}},
        "parameters",
        "unknown key 'batch_hierarchical_option'; did you mean 'batch_hierarchical_options'?",
    ),
    (
        "optimisation_domain",
        {"simulation_time": {"optimisation_domain": {"type": "float", "min": 1, "max": 2}}},
        "simulation_time",
        "unknown key 'optimisation_domain'; did you mean 'optimization_domain'?",
    ),
    (
        "steps",
        {"objects.robots.nb": {"default_option": 3, "batch_options_range": {"start": 1, "stop": 3, "steps": 1}}},
        "objects.robots.nb.batch_options_range",
        "unknown key 'steps'; did you mean 'step'?",
    ),
    (
        "maxi",
        {"objects.robots.nb": {"default_option": 3, "optimization_domain": {"type": "int", "min": 1, "maxi": 3}}},
        "objects.robots.nb.optimization_domain",
        "unknown key 'maxi'; did you mean 'max'?",
    ),
    (
        "batch_option",
        {
            "objects.robots.batch_hierarchical_options": {
                "default": {"nb": 3},
                "many": {"nb": {"batch_option": [30, 40], "default_option": 30}},
            }
        },
        "objects.robots.batch_hierarchical_options.many.nb",
        "unknown key 'batch_option' beside 'default_option'; did you mean 'batch_options'?",
    ),
    (
        "batch_hierachical_options",
        {"objects.robots.batch_hierachical_options": {"default": {"nb": 3}, "many": {"nb": 30}}},
        "objects.robots",
        "unknown key 'batch_hierachical_options'; did you mean 'batch_hierarchical_options'?",
    ),
    (
        "defualt",
        {"objects.robots.batch_hierarchical_options": {"defualt": {"nb": 3}, "many": {"nb": 30}}},
        "objects.robots.batch_hierarchical_options",
        "there is no 'default', which a single run takes; did you mean 'default', not 'defualt'?",
    ),
    (
        "nmae",
        {"objects.robots.batch_hierarchical_options": {"nmae": "size", "default": {"nb": 3}}},
        "objects.robots.batch_hierarchical_options.nmae",
        "expected a map of keys and values, found 'size'; did you mean 'name'?",
    ),
]
IDS = [f"{number}-{slip[0]}" for number, slip in enumerate(SLIPS)]


def written(folder: Path, changes: dict[str, Any], name: str = "many.yaml") -> Path:
    """Write a configuration with some changes."""
    path = folder / name
    path.write_text(yaml.safe_dump(scene(changes), sort_keys=False))
    return path


def line_with(path: Path, key: str) -> int:
    """Return the number of the first line that begins with a key."""
    lines = path.read_text().splitlines()
    return next(number for number, line in enumerate(lines, 1) if re.match(rf"\s*(- )?{key}:", line))


def refused(result: Run, said: str) -> None:
    """Expect exit code 2, and that line alone."""
    assert result.code == 2, result.text
    assert said in result.errors
    assert result.errors.count("\n") == 1, result.errors


@pytest.mark.parametrize(("key", "changes", "where", "message"), SLIPS, ids=IDS)
def test_slip_is_refused_by_everything_that_reads_a_configuration(
    key: str, changes: dict[str, Any], where: str, message: str, tmp_path: Path
) -> None:
    path = written(tmp_path, changes)
    said = f":{line_with(path, key)}: {where}: {message}\n"
    for more in ([], ["--strict"]):
        refused(run_command(example("helloworld"), tmp_path, ["-c", "many.yaml", "-g", *more]), f"many.yaml{said}")
    refused(batch(tmp_path), f"many.yaml{said}")
    with pytest.raises(ConfigurationError) as error:
        Simulation(example("helloworld").with_suffix(".so"), path)
    assert said.strip() in str(error.value)
    assert not (tmp_path / "results").exists()
    path.rename(tmp_path / "space.yaml")
    (tmp_path / "obj.py").write_text(OBJECTIVE)
    refused(search(tmp_path), f"space.yaml{said}")


@pytest.mark.parametrize(("key", "changes", "where", "message"), SLIPS, ids=IDS)
def test_slip_in_a_map_of_python_is_refused(key: str, changes: dict[str, Any], where: str, message: str) -> None:
    with pytest.raises(CombinationsError) as error:
        combinations_of(scene(changes))
    assert str(error.value) == f"{where}: {message}"
    assert error.value.key in (key, "")


# Options with a value that is there twice, the path of their list, and what was found.
SAME: list[tuple[str, dict[str, Any], str, str]] = [
    ("- 3", {"objects.robots.nb": {"batch_options": [3, 4, 3], "default_option": 3}}, "batch_options", "3 twice"),
    ("- 3.0", {"objects.robots.nb": {"batch_options": [3, 3.0]}}, "batch_options", "3 and 3.0, which are the same"),
    ("- '3'", {"objects.robots.nb": {"batch_options": [3, "3"]}}, "batch_options", "3 "),
    ("- -0.0", {"objects.robots.nb": {"batch_options": [0, -0.0]}}, "batch_options", "0 and -0.0, which are the same"),
    ("- '10000.0'", {"objects.robots.nb": {"batch_options": [1e4, "10000.0"]}}, "batch_options", "10000.0 "),
    ("- true", {"objects.robots.nb": {"batch_options": [True, True]}}, "batch_options", ""),
    ("- null", {"objects.robots.nb": {"batch_options": [None, 3, None]}}, "batch_options", "nothing twice"),
    ("- .nan", {"objects.robots.nb": {"batch_options": [float("nan")] * 2}}, "batch_options", ""),
    ("- walk", {"objects.robots.nb": {"batch_options": ["walk", "run", "walk"]}}, "batch_options", "'walk' twice"),
    ("- - 1", {"objects.robots.nb": {"batch_options": [[1, 2], [1, 2.0]]}}, "batch_options", ""),
    ("- a: 1", {"objects.robots.nb": {"batch_options": [{"a": 1}, {"a": 1}]}}, "batch_options", ""),
    (
        "- 2",
        {"objects.robots.nb": {"batch_options": [1, {"batch_options": [2, 2], "default_option": 1}]}},
        "batch_options.1.batch_options",
        "2 twice",
    ),
    (
        "- 5",
        {"objects.robots.nb": {"optimization_domain": {"choices": [4, 5, 5]}}},
        "optimization_domain.choices",
        "5 twice",
    ),
]


@pytest.mark.parametrize(("item", "changes", "where", "found"), SAME, ids=[same[0] for same in SAME])
def test_value_that_is_offered_twice_is_refused_by_everything(
    item: str, changes: dict[str, Any], where: str, found: str, tmp_path: Path
) -> None:
    path = written(tmp_path, changes)
    lines = path.read_text().splitlines()
    line = max(number for number, text in enumerate(lines, 1) if text.strip().removeprefix("- ").startswith(item[2:]))
    said = f":{line}: objects.robots.nb.{where}: expected different values, found {found}"
    refused(run_command(example("helloworld"), tmp_path, ["-c", "many.yaml", "-g"]), f"many.yaml{said}")
    refused(batch(tmp_path), f"many.yaml{said}")
    assert not (tmp_path / "results").exists()
    path.rename(tmp_path / "space.yaml")
    (tmp_path / "obj.py").write_text(OBJECTIVE)
    refused(search(tmp_path), f"space.yaml{said}")


# Text of a file, and whether everything that reads it refuses it.
BOTH: list[tuple[str, bool]] = [
    ("batch_optons:", True),
    ("batch_optons: []", True),
    ("batch_optons: {}", True),
    ("batch_optons: walk", False),
    ("batch_optons: {a: 1}\nresult_new_columns: [batch_optons]", False),
    ("batch_optons: {a: 1}\nresult_new_columns: [arena_file]", True),
    ("batch_optons: ''", False),
    ("batch_optons: 3", False),
    ("parameters: {p: {default_option: 1, batch_options: [true, 'true']}}", True),
    ("parameters: {p: {default_option: 1, batch_options: ['true', true]}}", True),
    ("parameters: {p: {default_option: 1, batch_options: [True, true]}}", True),
    ("parameters: {p: {default_option: 1, batch_options: ['false', False]}}", True),
    ("parameters: {p: {default_option: 1, batch_options: [True, 'True']}}", True),
    ("parameters: {p: {default_option: 1, batch_options: ['True', 'true']}}", False),
    ("parameters: {p: {default_option: 1, batch_options: [true, false]}}", False),
    ("parameters: {p: {default_option: 1, batch_options: [yes, true]}}", False),
    ("parameters: {p: {default_option: 1, batch_options: [[true], ['true']]}}", False),
    ("parameters: {p: {default_option: 1, batch_options: [0x10, 16]}}", True),
    ("parameters: {p: {default_option: 1, batch_options: [~, null]}}", True),
    ("parameters: {p: {default_option: 1, batch_options: ['', ~]}}", False),
    ("parameters: {p: {default_option: 1, batch_options: [{}, []]}}", False),
]


@pytest.mark.parametrize(("text", "is_refused"), BOTH, ids=[text for text, _ in BOTH])
def test_simulator_and_batches_refuse_the_same_files(text: str, is_refused: bool, tmp_path: Path) -> None:
    path = written(tmp_path, {"simulation_time": 0.1, "parameters": None})
    path.write_text(f"{path.read_text()}{text}\n")
    simulator = run_command(example("helloworld"), tmp_path, ["-c", "many.yaml", "-g"])
    batches = batch(tmp_path)
    assert (simulator.code, batches.code) == ((2, 2) if is_refused else (0, 0)), simulator.errors + batches.errors


DIFFERENT: list[list[Any]] = [[3, 3.5], [True, 1], [True, "true story"], ["a", "A"], [[1, 2], [2, 1]], [None, "None"]]


@pytest.mark.parametrize(
    "values", [*DIFFERENT, ["1.0", "1.00"], [{"a": 1}, {"b": 1}], [[1], [[1]]], [["1", "2"], ["1 2"]]]
)
def test_values_that_only_look_alike_are_different_options(values: list[Any], tmp_path: Path) -> None:
    assert len(combinations_of({"parameters": {"p": {"batch_options": values}}})) == len(values)
    written(tmp_path, {"simulation_time": 0.1, "parameters": {"p": {"batch_options": values, "default_option": 1}}})
    result = run_command(example("helloworld"), tmp_path, ["-c", "many.yaml", "-g"])
    assert result.code == 0, result.errors


def test_range_in_steps_that_its_numbers_cannot_show_is_refused(tmp_path: Path) -> None:
    many = {"start": 1.0, "stop": 1.00000000000000022, "step": 1e-17, "type": "float"}
    path = written(tmp_path, {"simulation_time": {"batch_options_range": many, "default_option": 1.0}})
    said = "batch_options_range: a step of 1"
    for result in (run_command(example("helloworld"), tmp_path, ["-c", path.name, "-g"]), batch(tmp_path)):
        refused(result, said)
        assert "too small to tell values apart" in result.errors


@pytest.mark.parametrize("key", ["result_new_column", "result_file_name_format", "optimisation"])
def test_keys_of_the_tools_are_looked_at_too(key: str, tmp_path: Path) -> None:
    path = written(tmp_path, {key: {"budget": 3} if key == "optimisation" else "x"})
    refused(batch(tmp_path), f"many.yaml:{line_with(path, key)}: unknown key '{key}'; did you mean '")


ORDINARY: list[dict[str, Any]] = [
    {"parameters": {"law": {"default_action": 1, "name": "x", "default": 2, "options": [1], "type": "y", "min": 2}}},
    {"parameters": {"law": {"batch_option": 3, "default_options": 2}, "other": {"batch_option": [1, 2], "b": 3}}},
    {"parameters": {"default_motion": {"speed": 3}, "choices": [1, 2], "range": {"start": 1, "stop": 2}}},
    {"objects.default_action": {"type": "pogobot", "nb": 1, "geometry": "disk"}},
    {"objects.robots.batch_hierarchical_options": {"name": "default_action", "default": {}, "batch_option": {}}},
    {"result_new_columns": ["default_action"], "default_action": "forward"},
    {"parameters": {"n": {"default_option": 1, "batch_options": [1, {"a": 2, "default": 3}]}}},
]


@pytest.mark.parametrize("changes", ORDINARY)
def test_names_that_users_choose_are_not_slips(changes: dict[str, Any], tmp_path: Path) -> None:
    written(tmp_path, {"simulation_time": 0.1, **changes})
    result = run_command(example("helloworld"), tmp_path, ["-c", "many.yaml", "-g"])
    assert (result.code, "unknown key" in result.errors) == (0, False), result.errors
    done = batch(tmp_path)
    assert done.code == 0, done.text
    own = [line for line in done.errors.splitlines() if "warning of a run: " not in line]
    assert [line for line in own if "many.yaml:" in line] == []


def test_default_of_a_parameter_that_is_misspelt_alone_is_told(tmp_path: Path) -> None:
    # A map of the program's own may look like that, so it is an error only where a number is read.
    written(tmp_path, {"simulation_time": 0.1, "parameters": {"speed": {"defalt_option": 3}}})
    result = run_command(example("helloworld"), tmp_path, ["-c", "many.yaml", "-g"])
    assert "speed.defalt_option (many.yaml:" in result.errors
    assert "; did you mean 'default_option'?)" in result.errors


def test_arena_tool_reads_the_same_words(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = written(
        tmp_path, {"arena_file": {"batch_option": ["a.csv"], "default_option": str(ROOT / "arenas/disk.csv")}}
    )
    assert draw_arena(["--config", str(path), "--output-dir", str(tmp_path)]) == 2
    assert "arena_file: unknown key 'batch_option' beside 'default_option'" in capsys.readouterr().err


def test_words_are_those_of_the_simulator() -> None:
    header = (ROOT / "src" / "config" / "option_keys.hpp").read_text()
    for words, name in ((RANGE_WORDS, "kRangeKeys"), (DOMAIN_WORDS, "kDomainKeys")):
        listed = header[header.index(f"{name}{{") + len(name) + 1 :].split("}")[0]
        assert listed.replace('"', "").replace("\n", " ").split(", ") == list(words)
    for word in (*VALUE_WORDS, HIERARCHICAL_OPTIONS):
        assert f'"{word}"' in header
        assert misspelt_option(word) is None
        assert misspelt_option(word[:-1]) == word


@pytest.mark.parametrize(
    ("typed", "known", "nearest"),
    [
        ("raduis", ["radius", "nb"], "radius"),
        ("x", ["radius"], None),
        ("NB", ["nb"], "nb"),
        ("", ["a"], None),
        ("run_duration_min", ["turn_duration_ms"], None),
    ],
)
def test_nearest_name_is_that_with_the_fewest_changes(typed: str, known: list[str], nearest: str | None) -> None:
    assert nearest_name(typed, known) == nearest
    assert edit_distance("kitten", "sitting") == 3


def test_shipped_configurations_have_no_slips() -> None:
    paths = [*ROOT.glob("conf/**/*.yaml"), *ROOT.glob("docs/**/*.yaml")]
    assert len(paths) > 20
    for path in paths:
        assert combinations_of(parse_yaml(path.read_text()))
