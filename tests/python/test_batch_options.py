"""Which combinations a configuration with options has, and what they are called."""

from __future__ import annotations

import copy
import itertools
from pathlib import Path
from typing import Any

import pyarrow as pa
import pytest
from batches import batch, write_options
from hypothesis import given
from hypothesis import strategies as st
from pogosim.batch.configurations.combinations import combinations_of
from pogosim.batch.configurations.configuration import Configuration, dump_configuration
from pogosim.batch.configurations.names import NamesError, file_name, new_columns
from pogosim.batch.configurations.option_words import CombinationsError
from pogosim.pogobatch import BatchError, expand_batch_options, get_by_dotted_path, set_in_dict
from pogosim.yaml_1_2 import dump_yaml, parse_yaml
from running import ROOT, example, run_command


def expanded(text: str) -> list[dict[str, Any]]:
    return combinations_of(parse_yaml(text))


def spread(values: dict[str, Any]) -> dict[str, Any]:
    return {"batch_options_range": values}


# ---- Combinations ----


def test_configuration_without_options_is_its_only_combination() -> None:
    assert expanded("{a: 1, b: {c: [1, 2]}}") == [{"a": 1, "b": {"c": [1, 2]}}]


def test_combinations_are_the_product_in_order_of_appearance_and_the_last_option_varies_fastest() -> None:
    found = expanded("""
        arena_file: {batch_options: [disk, star], default_option: disk}
        objects: {robots: {nb: {default_option: 7, batch_options: [50, 100, 150]}}}
        seed: 3
    """)
    expected = itertools.product(["disk", "star"], [50, 100, 150])
    assert [(c["arena_file"], c["objects"]["robots"]["nb"]) for c in found] == list(expected)
    assert [list(c) for c in found] == [["arena_file", "objects", "seed"]] * 6


@given(st.lists(st.integers(1, 4), min_size=0, max_size=5))
def test_number_of_combinations_is_the_product_of_the_numbers_of_options(sizes: list[int]) -> None:
    configuration: dict[str, Any] = {
        "parameters": {f"p{i}": {"batch_options": list(range(n))} for i, n in enumerate(sizes)}
    }
    before = copy.deepcopy(configuration)
    found = [tuple(c["parameters"].values()) for c in combinations_of(configuration)]
    assert found == list(itertools.product(*(range(n) for n in sizes)))
    assert configuration == before


def test_options_are_found_in_lists_in_options_and_under_any_key() -> None:
    found = expanded("""
        objects: {lamp: [{value: {batch_options: [1, 2]}}, {value: 5}]}
        parameters: {law: {batch_options: [{alpha: {batch_options: [3, 4]}}, none]}}
    """)
    laws = [{"alpha": 3}, {"alpha": 4}, "none"]
    assert [(c["objects"]["lamp"][0]["value"], c["parameters"]["law"]) for c in found] == [
        (value, law) for value in (1, 2) for law in laws
    ]


def test_default_and_domain_are_one_value_as_in_a_single_run() -> None:
    found = expanded("""
        a: {default_option: 4}
        b: {default_option: 5, optimization_domain: {min: 0, max: 9}}
        c: {optimization_domain: {min: 0, max: 9, init: 3}}
        d: {default_option: 6, optimization_domain: {min: 0, max: 9}, batch_options: [7]}
    """)
    assert found == [{"a": 4, "b": 5, "c": 3, "d": 7}]


def test_keys_for_results_and_optimisation_are_not_expanded() -> None:
    text = "{optimization: {runs: {batch_options: [1, 2]}}, result_new_columns: [a], a: 1}"
    assert expanded(text) == [parse_yaml(text)]


def test_each_alternative_is_laid_over_its_map_and_named() -> None:
    found = expanded("""
        simulation_time: 5
        objects:
            robots:
                nb: 10
                law: {type: static, rate: 1}
                batch_hierarchical_options:
                    name: density
                    default: {nb: 1}
                    low: {nb: 20}
                    high: {nb: {batch_options: [30, 40]}, law: {rate: 2}}
        parameters: {a: {batch_options: [1, 2]}}
    """)
    robots = [c["objects"]["robots"] for c in found]
    assert [r["nb"] for r in robots] == [20, 20, 30, 30, 40, 40]
    assert [r["law"]["rate"] for r in robots] == [1, 1, 2, 2, 2, 2]
    assert [c["parameters"]["a"] for c in found] == [1, 2] * 3
    assert [c["density"] for c in found] == ["low"] * 2 + ["high"] * 4
    assert found[0]["_batch_choice_names"] == {"objects.robots": "low"}
    assert "batch_hierarchical_options" not in dump_yaml(found)


def test_alternatives_without_a_name_or_with_the_default_alone() -> None:
    unnamed = "{parameters: {batch_hierarchical_options: {x: {a: 1}, y: }}, b: 2}"
    assert [c["parameters"] for c in expanded(unnamed)] == [{"a": 1}, {}]
    alone = "{parameters: {batch_hierarchical_options: {default: {a: 1}}}}"
    assert [c["parameters"] for c in expanded(alone)] == [{"a": 1}]


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ({"start": 0, "stop": 3, "step": 1}, [0, 1, 2]),
        ({"start": 0, "stop": 3, "step": 1, "inclusive": True}, [0, 1, 2, 3]),
        ({"start": 0, "stop": 1, "step": 0.25}, [0.0, 0.25, 0.5, 0.75]),
        ({"start": 0, "stop": 0.4, "step": 0.1}, [0.0, 0.1, 0.2, 0.3]),
        ({"start": 0.1, "stop": 0.5, "step": 0.2, "inclusive": True}, [0.1, 0.3, 0.5]),
        ({"start": 3, "stop": 0, "step": -1}, [3, 2, 1]),
        ({"start": 1.0, "stop": 3.0, "step": 1.0}, [1, 2]),
        ({"start": 1, "stop": 2.5, "step": 1}, [1, 2]),
        ({"start": 0, "stop": 2, "step": 1, "type": "float"}, [0.0, 1.0]),
        ({"start": 5, "stop": 5, "step": 1, "inclusive": True}, [5]),
    ],
)
def test_ranges_are_exact_and_leave_out_the_stop(values: dict[str, Any], expected: list[float]) -> None:
    found = expand_batch_options(spread(values))
    assert found == expected
    assert [type(value) for value in found] == [type(value) for value in expected]


@given(st.integers(-50, 50), st.integers(1, 50), st.integers(1, 9), st.booleans())
def test_range_of_integers_is_that_of_python(start: int, length: int, step: int, inclusive: bool) -> None:
    values = {"start": start, "stop": start + length, "step": step, "inclusive": inclusive}
    assert expand_batch_options(spread(values)) == list(range(start, start + length + inclusive, step))


@pytest.mark.parametrize(
    ("text", "where", "what"),
    [
        ("{a: {batch_options: 5}}", "a", "expected a list of values, found 5; write [5]"),
        ("{a: {b: {batch_options: []}}}", "a.b", "at least one value"),
        ("{a: {batch_options: [1], batch_options_range: {}}}", "a", "either batch_options or batch_options_range"),
        ("{a: {batch_options_range: [0, 1]}}", "a", "expected a map"),
        ("{a: {batch_options_range: {start: 0, stop: 1}}}", "a", "'step' is missing"),
        ("{a: {batch_options_range: {start: 0, stop: 1, step: 0}}}", "a", "step is 0"),
        ("{a: {batch_options_range: {start: 0, stop: 1, step: -1}}}", "a", "there is no value"),
        ("{a: {batch_options_range: {start: 0, stop: .inf, step: 1}}}", "a", "stop: expected a number"),
        ("{a: {batch_options_range: {start: x, stop: 1, step: 1}}}", "a", "start: expected a number, found 'x'"),
        ("{a: {batch_options_range: {start: 0, stop: 1, step: true}}}", "a", "step: expected a number"),
        ("{a: {batch_options_range: {start: 0, stop: 1, step: 0.5, type: int}}}", "a", "not a whole number"),
        ("{a: {batch_options_range: {start: 0, stop: 1, step: 0.5, type: long}}}", "a", "expected int or float"),
        (
            "{a: {batch_options_range: {start: 0, stop: 1, steps: 0.5}}}",
            "a.batch_options_range",
            "unknown key 'steps'; did you mean 'step'?",
        ),
        ("{a: {batch_options_range: {start: 0, stop: 1e9, step: 1}}}", "a", "larger step"),
        ("{a: {batch_hierarchical_options: 3}}", "a.batch_hierarchical_options", "expected a map of alternatives"),
        ("{a: {batch_hierarchical_options: {name: x}}}", "a.batch_hierarchical_options", "at least one alternative"),
        ("{a: {batch_hierarchical_options: {x: 3}}}", "a.batch_hierarchical_options.x", "found 3"),
        ("{a: {batch_hierarchical_options: {name: [x], y: {}}}}", "a.batch_hierarchical_options.name", "name of a key"),
    ],
)
def test_wrong_options_are_named_with_their_place(text: str, where: str, what: str) -> None:
    with pytest.raises(CombinationsError) as caught:
        expanded(text)
    assert ".".join(caught.value.path) == where
    assert what in str(caught.value)


def test_more_than_a_million_combinations_are_refused_before_they_fill_the_memory() -> None:
    options = {f"p{i}": {"batch_options": list(range(10))} for i in range(40)}
    with pytest.raises(CombinationsError, match="more than 1000000"):
        combinations_of(options)


# ---- Reading ----


def read(folder: Path, text: str) -> Configuration:
    path = folder / "many.yaml"
    path.write_text(text)
    return Configuration(path)


def test_categories_of_the_same_name_stay_as_many_and_words_stay_as_written(tmp_path: Path) -> None:
    configuration = read(
        tmp_path, "objects:\n  lamp: {x: 1}\n  lamp: {x: 2}\nparameters: {mode: on, n: 1e3, s: '1e3'}\n"
    )
    assert configuration.entries["objects"]["lamp"] == [{"x": 1}, {"x": 2}]
    text = dump_configuration(configuration.entries)
    assert "mode: on\n" in text
    assert "n: 1e3\n" in text
    assert "s: '1e3'\n" in text


WRITTEN = ["0777", "1.10", "1e3", "+5", "0x1F", "0o17", ".5", "-0", "1.0E+2", "12345678901234567890123", "3", ".inf"]


def test_numbers_reach_a_run_as_they_are_written(tmp_path: Path) -> None:
    path = tmp_path / "many.yaml"
    path.write_text(f"parameters: {{p: {{batch_options: [{', '.join(WRITTEN)}]}}, list: [007, {{a: 1.50}}]}}\n")
    combinations = combinations_of(Configuration(path).entries)
    texts = [dump_configuration(combination) for combination in combinations]
    assert [text.splitlines()[1].strip() for text in texts] == [f"p: {text}" for text in WRITTEN]
    assert texts[0].splitlines()[3:] == ["  - 007", "  - a: 1.50"]
    assert [combination["parameters"]["p"] for combination in combinations][:5] == [777, 1.1, 1000.0, 5, 31]
    assert pa.array([combination["parameters"]["p"] for combination in combinations][4:6]).to_pylist() == [31, 15]
    assert str(combinations[0]["parameters"]["p"]) == "777"
    assert dump_yaml([combinations[0]["parameters"]["p"]], is_flow=True).strip() == "[0777]"


def test_key_that_is_repeated_has_its_last_value(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    assert read(tmp_path, "a: 1\nb: 2\na: 3\n").entries == {"a": 3, "b": 2}
    assert "many.yaml:3: duplicate key 'a'" in caplog.text


def test_place_of_an_entry_has_its_line(tmp_path: Path) -> None:
    configuration = read(tmp_path, "a: 1\nobjects:\n  robots:\n    nb:\n      batch_options: 5\n")
    assert configuration.where(("objects", "robots", "nb")) == f"{tmp_path}/many.yaml:4: objects.robots.nb"


@pytest.mark.parametrize(
    ("content", "what"),
    [
        (b"", "is empty"),
        (b"# nothing\n", "is empty"),
        (b"[1, 2]", "expected a map"),
        (b"a: [1", "many.yaml:1: not valid YAML"),
        (b"a: 1\nb: !python/object:os.system {}\n", "many.yaml:2: not valid YAML"),
        (b"\xff\xfe\x00", "not text in UTF-8"),
        (b"a: 1\nb: &a [*a]\n", "many.yaml:2: this alias (*a) is inside the value it refers to"),
        (b"a: &a {b: {c: *a}}\n", "many.yaml:1: this alias (*a) is inside the value it refers to"),
        (b"a: " + b"{b: " * 20000, "many.yaml:1: nested deeper than 100 levels once aliases are followed"),
        (b"a: " + b"[" * 20000, "many.yaml:1: nested deeper than 100 levels once aliases are followed"),
        (b"".join(b" " * n + b"k:\n" for n in range(300)), "many.yaml:101: nested deeper than 100 levels"),
        (b"&a x: 1\nb: *a\nc: *d\n", "many.yaml:3: not valid YAML: found undefined alias 'd'"),
    ],
)
def test_what_is_no_configuration_is_refused_in_one_line(content: bytes, what: str, tmp_path: Path) -> None:
    path = tmp_path / "many.yaml"
    path.write_bytes(content)
    with pytest.raises((BatchError, CombinationsError)) as caught:
        combinations_of(Configuration(path).entries)
    assert what in str(caught.value)
    assert "\n" not in str(caught.value)


def test_default_of_every_option_is_what_a_single_run_uses(tmp_path: Path) -> None:
    """The combination whose options are the defaults is the configuration that the simulator resolves."""
    path = ROOT / "conf" / "batch" / "test.yaml"
    (combination,) = [
        c
        for c in combinations_of(Configuration(path).entries)
        if (c["arena_file"], c["objects"]["robots"]["nb"]) == ("arenas/disk.csv", 100)
    ]
    (tmp_path / "one.yaml").write_text(dump_yaml(combination))
    frames = []
    for name in ("one.yaml", str(path)):
        arguments = [
            "-c",
            name,
            "-g",
            "-q",
            "--strict",
            "--set",
            "simulation_time=2",
            "--set",
            "data_filename=a.feather",
        ]
        result = run_command(example("hanabi"), tmp_path, arguments)
        assert (result.code, result.text) == (0, "")
        frames.append(result.frame("a.feather"))
    assert frames[0].equals(frames[1])


# ---- Names ----

COMBINATION = {
    "arena_file": "arenas/disk.csv",
    "density": "low",
    "_batch_choice_names": {"objects.robots": "low"},
    "objects": {"robots": {"nb": 50, "poses": [[1, 2]]}, "lamp": [{"value": 0.5}]},
}


@pytest.mark.parametrize(
    ("pattern", "name"),
    [
        (None, "result.feather"),
        ("result_{objects.robots.nb}.feather", "result_50.feather"),
        ("{arena_file}_{objects.robots.nb:04d}.feather", "disk_0050.feather"),
        ("{density}/{objects.robots}.feather", "low/low.feather"),
        ("{objects.lamp.0.value:.2f}.feather", "0.50.feather"),
        ("{{}}{density!r}.feather", "{}'low'.feather"),
    ],
)
def test_name_of_the_results_is_a_format_with_dotted_keys(pattern: str | None, name: str) -> None:
    assert file_name({**COMBINATION, **({"result_filename_format": pattern} if pattern else {})}) == name


@pytest.mark.parametrize(
    ("pattern", "what"),
    [
        ("{objects.robots.n}.feather", "there is no key 'objects.robots.n'"),
        ("{}.feather", "field without a name"),
        ("{0}.feather", "field without a name"),
        ("{objects.robots.poses}.feather", "not a single value"),
        ("{density:d}.feather", "not a format"),
        ("{density", "not a format"),
        (5, "expected a name"),
        ("results/", "no name of a file"),
    ],
)
def test_wrong_format_of_names_is_an_error(pattern: object, what: str) -> None:
    with pytest.raises(NamesError, match=r"^result_filename_format: ") as caught:
        file_name({**COMBINATION, "result_filename_format": pattern})
    assert what in str(caught.value)


def test_new_columns_have_stems_names_of_alternatives_and_values() -> None:
    names = ["arena_file", "objects.robots", "objects.robots.nb", "objects.robots.poses", "no.such"]
    assert new_columns({**COMBINATION, "result_new_columns": names}) == {
        "arena_file": "disk",
        "objects.robots": "low",
        "objects.robots.nb": 50,
        "objects.robots.poses": "[[1, 2]]",
        "no.such": None,
    }


def test_dotted_paths_read_and_write_nested_maps() -> None:
    tree: dict[str, Any] = {"a": [{"b": 1}], "c": {"d": 2}}
    assert get_by_dotted_path(tree, "a.0.b") == 1
    set_in_dict(tree, "a.0.b", 5)
    set_in_dict(tree, ["c", "e", "f"], 6)
    assert tree == {"a": [{"b": 5}], "c": {"d": 2, "e": {"f": 6}}}
    with pytest.raises(KeyError):
        get_by_dotted_path(tree, "a.1")
    with pytest.raises(KeyError):
        set_in_dict(tree, "c.d.x", 1)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("a: 1\n---\nb: 2\n", 2),
        ("---\na: 1\n...\n---\nb: 2\n---\nc: 3\n", 4),
        ("a: 1\n---\n", 2),
        ("a: 1\n...\n", 0),
        ("---\na: 1\n", 0),
    ],
)
def test_of_several_documents_the_first_one_counts_with_a_warning(
    text: str, line: int, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    assert read(tmp_path, text).entries == {"a": 1}
    said = f"{tmp_path}/many.yaml:{line}: a second document starts here; only the first one is used"
    assert caplog.messages == ([said] if line else [])


def test_a_second_document_says_the_same_in_a_batch_as_in_a_single_run(tmp_path: Path) -> None:
    path = write_options(tmp_path, {"objects.robots.nb": 1})
    path.write_text(f"{path.read_text()}---\nmore: 1\n")
    words = f"{path.name}:{len(path.read_text().splitlines()) - 1}: a second document starts here; only the first one"
    assert words in run_command(example("helloworld"), tmp_path, ["-c", path.name, "-g"]).text
    result = batch(tmp_path)
    assert (result.code, words in result.errors) == (0, True)
    path.write_text(f"{path.read_text()}[1\n")
    assert run_command(example("helloworld"), tmp_path, ["-c", path.name, "-g"]).code == 2
    assert batch(tmp_path).code == 2
