"""`links` of a configuration in complete runs: those of the page, files beside the configuration, batches, mistakes."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import yaml
from batches import run_main
from running import ROOT, by_robot, example, run, run_command, warnings, write_scene

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


def moved(name: str, folder: Path, engine: str) -> pd.DataFrame:
    """Return the robots' rows of a configuration of the page that has run for 10 s."""
    (folder / name).write_text(dict(BLOCKS)[name])
    settings = ["simulation_time=10", "save_data_period=0.5", "seed=1", f"physics_engine={engine}"]
    arguments = ["-c", name, "-g", *(word for setting in settings for word in ("--set", setting))]
    done = run_command(example("helloworld"), folder, arguments)
    assert warnings(done) == []
    rows = done.frame()
    return rows[rows["robot_category"] == "robots"]


@pytest.mark.parametrize("engine", ["disk", "box2d"])
def test_exoskeleton_of_the_page_moves_within_its_pinned_rim(engine: str, tmp_path: Path) -> None:
    rows = moved("exoskeleton.yaml", tmp_path, engine)
    places = np.stack([by_robot(rows, "x"), by_robot(rows, "y")], axis=-1)
    furthest = np.linalg.norm(places - places[0], axis=-1).max(axis=0)
    assert furthest[19:].max() < 0.5
    assert furthest[:19].min() > 1.0
    assert np.linalg.norm(places - places[0, 0], axis=-1).max() < 3 * 80 + 0.5


@pytest.mark.parametrize("engine", ["disk", "box2d"])
def test_link_bot_of_the_page_keeps_its_v(engine: str, tmp_path: Path) -> None:
    rows = moved("link_bot.yaml", tmp_path, engine)
    turned = np.degrees(np.diff(by_robot(rows, "angle"), axis=1)[:, 0])
    against_start = (turned - turned[0] + 180.0) % 360.0 - 180.0
    assert against_start.min() > -15.0 - 3.0
    assert against_start.max() < 30.0 + 3.0
    places = np.stack([by_robot(rows, "x"), by_robot(rows, "y")], axis=-1)
    assert np.linalg.norm(places[:, 1] - places[:, 0], axis=-1).max() < 60.0 + 0.5
    assert np.linalg.norm(places[-1] - places[0], axis=-1).min() > 20.0
