"""Files of results stay in their folder, whatever names a configuration makes."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from batches import batch, script, write_options


@pytest.mark.parametrize(
    ("pattern", "name"),
    [
        ("../x.feather", "../x.feather"),
        ("a/../../x.feather", "a/../../x.feather"),
        ("/tmp/x.feather", "/tmp/x.feather"),
        ("..", ".."),
        ("{up}/x.feather", "../x.feather"),
        ("{objects.robots}.feather", "../../high.feather"),
    ],
)
def test_name_of_results_that_leads_out_of_their_folder_is_refused_before_any_run(
    pattern: str, name: str, tmp_path: Path
) -> None:
    changes: dict[str, object] = {
        "result_filename_format": pattern,
        "up": "..",
        "objects.robots.batch_hierarchical_options": {"../../high": {"nb": 2}},
    }
    write_options(tmp_path / "batch", changes)
    ran = script(tmp_path / "ran", f"touch {tmp_path}/has_run")
    before = sorted(tmp_path.rglob("*"))
    result = batch(tmp_path / "batch", program=ran)
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert re.match(
        rf"pogobatch: many\.yaml:\d+: result_filename_format: '{re.escape(name)}' is not in the folder of the results;",
        line,
    )
    assert sorted(tmp_path.rglob("*")) == before
    assert batch(tmp_path / "batch", "--list-outputs", program=ran).code == 2


@pytest.mark.parametrize("link", ["results/sub", "results/result.feather"])
def test_symbolic_link_out_of_the_folder_of_results_is_refused_before_any_run(link: str, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    folder = tmp_path / "batch"
    (folder / "results").mkdir(parents=True)
    (folder / link).symlink_to(tmp_path / "elsewhere")
    name = "sub/result.feather" if link.endswith("sub") else "result.feather"
    write_options(folder, {"result_filename_format": name})
    result = batch(folder)
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert line.startswith(f"pogobatch: results/{name} leads out of the folder of the results, to {tmp_path}/elsewhere")
    assert list((tmp_path / "elsewhere").iterdir()) == []


def test_folders_and_links_within_the_folder_of_results_will_do(tmp_path: Path) -> None:
    (tmp_path / "disk").mkdir()
    (tmp_path / "results").symlink_to(tmp_path / "disk")
    write_options(tmp_path, {"result_filename_format": "a/../b/{objects.robots.nb}.feather"})
    assert batch(tmp_path).code == 0
    assert sorted(path.name for path in (tmp_path / "disk" / "b").iterdir()) == ["2.feather", "3.feather"]
