"""`links` of a configuration in complete runs: those of the page, files beside the configuration, batches, mistakes."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
import yaml
from batches import run_main
from running import ROOT, example, run, run_command, warnings, write_scene

PAGE = ROOT / "docs" / "links.md"
BLOCKS = re.findall(r"^```yaml\n# (\w+\.yaml)\n(.*?)^```$", PAGE.read_text(), flags=re.DOTALL | re.MULTILINE)

PAIRS: dict[str, Any] = {
    "initial_formation": "lattice",
    "lattice_distance_between_neighbors": 80,
    "objects.robots.nb": 7,
    "simulation_time": 0.1,
    "links": {"skeleton": {"between": "robots", "topology": "list", "file": "pairs.csv"}},
}


@pytest.mark.parametrize(("name", "text"), BLOCKS, ids=[name for name, _ in BLOCKS])
def test_configurations_of_the_page_run_without_a_warning(name: str, text: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text(text)
    arguments = ["-c", name, "-g", "--strict", "--set", "simulation_time=1"]
    assert warnings(run_command(example("helloworld"), tmp_path, arguments)) == []
    assert len(BLOCKS) == 3


def test_list_of_links_is_found_beside_the_configuration(tmp_path: Path) -> None:
    conf = write_scene(tmp_path / "conf", PAIRS)
    (conf.parent / "pairs.csv").write_text("a,b\n0,1\n1,2\n")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    assert warnings(run_command(example("helloworld"), elsewhere, ["-c", str(conf), "-g"])) == []
    options = ["-c", str(conf), "-S", str(example("helloworld")), "-t", "tmp", "-o", "results", "-r", "1"]
    done = run_main(elsewhere, options)
    assert done.code == 0, done.text
    (conf.parent / "pairs.csv").write_text("a,b\n0,7\n")
    done = run_main(elsewhere, options)
    assert "pairs.csv:2: b: expected the number of an object, 0 to 6, found 7" in done.errors


def test_list_of_links_is_not_overwritten(tmp_path: Path) -> None:
    (tmp_path / "pairs.csv").write_text("a,b\n0,1\n")
    done = run(example("helloworld"), tmp_path, PAIRS | {"data_filename": "pairs.csv"})
    assert done.code == 2
    assert "data_filename: 'pairs.csv' is the same file as the list of links 'pairs.csv'" in done.errors


def test_mistakes_are_told_with_file_and_line_and_all_at_once(tmp_path: Path) -> None:
    links = {
        "skin": {"between": "robot", "topology": "chain"},
        "core": {"between": "robots", "topology": "square"},
        "rope": {"between": "robots", "topology": "chain", "stiffness": -3},
    }
    done = run(example("helloworld"), tmp_path, PAIRS | {"links": links}, ["--check-config"])
    assert done.code == 2
    for path in ("skin.between: there is no category", "core.topology: the lattice is", "rope.stiffness: expected"):
        assert re.search(rf"scene\.yaml:\d+: links\.{path}", done.errors), done.errors


def test_options_of_links_are_combinations_of_a_batch(tmp_path: Path) -> None:
    skeleton = {"between": "robots", "topology": "triangular", "stiffness": {"batch_options": [1, 10]}}
    settings = PAIRS | {"links": {"skeleton": skeleton}, "result_new_columns": ["links.skeleton.stiffness"]}
    conf = write_scene(tmp_path, settings)
    options = ["-c", str(conf), "-S", str(example("helloworld")), "-t", "tmp", "-o", "results", "-r", "1"]
    done = run_main(tmp_path, options)
    assert done.code == 0, done.text
    tables = [pd.read_feather(path) for path in (tmp_path / "results").glob("*.feather")]
    assert sorted({value for table in tables for value in table["links.skeleton.stiffness"]}) == [1, 10]


def test_links_are_in_the_resolved_configuration(tmp_path: Path) -> None:
    links = {"skeleton": {"between": "robots", "topology": "triangular", "stiffness": 3}}
    done = run(example("helloworld"), tmp_path, PAIRS | {"links": links})
    assert done.code == 0, done.text
    metadata = done.table().schema.metadata or {}
    resolved = yaml.safe_load(metadata[b"resolved_configuration"])
    assert resolved["links"]["skeleton"]["stiffness"] == 3
    assert resolved["links"]["skeleton"]["rest_length"] == "initial"
