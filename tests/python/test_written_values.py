"""A batch hands over numbers and booleans as they are written, as a single run does: 0777, 1.10, 1e3, +5, TRUE."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import pytest
from batches import batch
from pogosim.batch.configurations.combinations import combinations_of
from pogosim.batch.configurations.configuration import Configuration, dump_configuration
from pogosim.batch.configurations.names import file_name, new_columns
from pogosim.batch.configurations.option_words import CombinationsError
from pogosim.batch.configurations.options import expand_batch_options
from pogosim.utils import load_dataframe
from pogosim.yaml_1_2 import dump_yaml, parse_yaml, plain
from running import compile_text, run_command

TEXTS = [
    "0777", "!!float 3", "1e3", "1E3", "+5", "-0", "TRUE", "True", "FALSE", "true", "0x1F", "0o17", ".5", "5.", "1.10",
    ".inf", "-.INF", ".NaN", "'1.10'", "!!str 5", "!!int 007", "on", "5", "1.5", "!!bool TRUE",
]  # fmt: skip

SCENE = """\
arena_file: arenas/square.csv
arena_surface: 1.0e6
simulation_time: 0.02
save_data_period: 1
seed: 0
initial_formation: random
data_filename: d.feather
result_filename_format: r.feather
objects: {robots: {type: pogobot, nb: 1}}
"""

PROGRAM = """
#include "pogobase.h"
typedef struct { int unused; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
char text[64] = "default";
static void user_init(void) {}
static void user_step(void) {}
static void setup(void) { init_array_from_configuration(text); }
static void schema(void) { data_add_column_string("seen"); }
static void row(void) { data_set_value_string("seen", text); }
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, setup);
    SET_CALLBACK(callback_create_data_schema, schema);
    SET_CALLBACK(callback_export_data, row);
    return 0;
}
"""


def test_text_parameters_are_the_same_in_a_batch_as_in_a_single_run(tmp_path: Path) -> None:
    program = compile_text(tmp_path, PROGRAM)
    single = []
    for text in TEXTS:
        (tmp_path / "one.yaml").write_text(f"{SCENE}parameters: {{text: {text}}}\n")
        assert run_command(program, tmp_path, ["-c", "one.yaml", "-g", "-q"]).code == 0
        single += load_dataframe(tmp_path / "d.feather")[0]["seen"].unique().tolist()
    different = ["0777", "!!float 3", "1e3", "+5", "TRUE", "FALSE", "0x1F", ".5", "1.10", ".inf", ".NaN", "on"]
    (tmp_path / "many.yaml").write_text(
        f"{SCENE}parameters: {{text: {{batch_options: [{', '.join(different)}], default_option: 0}}}}\n"
    )
    assert batch(tmp_path, program=program).code == 0
    options = load_dataframe(tmp_path / "results" / "r.feather")[0]["seen"].tolist()
    assert options[:: len(options) // len(different)] == [single[TEXTS.index(text)] for text in different]
    assert single[:5] == ["0777", "3", "1e3", "1E3", "+5"]


@pytest.mark.parametrize("options", ["true, TRUE", "FALSE, False", "'no', FALSE, false"])
def test_booleans_that_are_the_same_are_refused_as_options(options: str, tmp_path: Path) -> None:
    path = tmp_path / "many.yaml"
    path.write_text(f"a: {{batch_options: [{options}]}}\n")
    with pytest.raises(CombinationsError, match="their runs would be the same"):
        combinations_of(Configuration(path).entries)


@pytest.mark.parametrize("text", TEXTS)
def test_values_are_written_as_they_were_read(text: str, tmp_path: Path) -> None:
    path = tmp_path / "many.yaml"
    path.write_text(f"a: {text}\nb: [{text}]\nc: {{batch_options: [{text}]}}\n")
    (entries,) = combinations_of(Configuration(path).entries)
    for own in (entries, copy.deepcopy(entries), pickle.loads(pickle.dumps(entries))):
        for dumped in (dump_configuration(own), dump_yaml(own)):
            again = tmp_path / "again.yaml"
            again.write_text(dumped)
            found = Configuration(again).entries
            assert dump_configuration(found) == dump_configuration(entries)
            assert [str(getattr(v, "text", v)) for v in (found["a"], *found["b"], found["c"])] == [
                str(getattr(entries["a"], "text", entries["a"]))
            ] * 3
    value, other = plain(entries["a"]), parse_yaml(text)
    assert type(value) is type(other) or text == "on"
    assert value == other or value != value or text == "on"


def test_columns_and_names_of_results_have_plain_values(tmp_path: Path) -> None:
    path = tmp_path / "many.yaml"
    path.write_text(
        "result_filename_format: 'r_{a}_{b:03d}_{c}.feather'\nresult_new_columns: [a, b, c]\na: 1e3\nb: +5\nc: TRUE\n"
    )
    entries = Configuration(path).entries
    assert file_name(entries) == "r_1000.0_005_True.feather"
    columns = new_columns(entries)
    assert [(value, type(value)) for value in columns.values()] == [(1000.0, float), (5, int), (True, bool)]


def test_words_of_options_may_be_written_in_all_ways(tmp_path: Path) -> None:
    path = tmp_path / "many.yaml"
    path.write_text("n: {batch_options_range: {start: 0, stop: +2, step: 01, inclusive: TRUE}}\n")
    assert expand_batch_options(Configuration(path).entries["n"]) == [0, 1, 2]
