"""Simulation.save_data writes the rows and metadata of a run in the format that the name of the file says."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd
import pogosim
import pytest
from pogosim.table_formats import format_in
from pogosim.utils import load_dataframe
from running import ROOT, write_scene

FORMATS = {".feather": "feather", ".arrow": "feather", ".ipc": "feather", ".parquet": "parquet", ".csv": "csv"}


def simulation(hosted: Path, folder: Path, ending: str, **settings: Any) -> pogosim.Simulation:
    """Begin a run of three robots and 2 s."""
    scene = write_scene(folder, {"arena_file": str(ROOT / "arenas" / "disk.csv"), "save_data_period": 0.5})
    return pogosim.Simulation(hosted, scene, seed=1, set=settings, data_file=folder / f"rows{ending}")


def refusal(sim: pogosim.Simulation, name: str | Path) -> str:
    """Return the one line with which a copy is refused."""
    with pytest.raises(pogosim.SimulationError) as caught:
        sim.save_data(name)
    text = str(caught.value)
    assert "\n" not in text
    assert "PosixPath" not in text
    return text


@pytest.mark.parametrize("own", FORMATS)
@pytest.mark.parametrize("other", [*FORMATS, ""])
def test_copy_has_the_format_of_its_name_and_the_same_rows(
    own: str, other: str, hosted: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("POGOSIM_DIR", str(ROOT))
    with simulation(hosted, tmp_path, own) as sim:
        sim.run()
        sim.save_data(tmp_path / f"copy{other}")
        rows, metadata = load_dataframe(tmp_path / f"rows{own}")
    copied, copied_metadata = load_dataframe(tmp_path / f"copy{other}")
    assert format_in(tmp_path / f"copy{other}") == FORMATS[other or ".feather"]
    pd.testing.assert_frame_equal(copied, rows)
    assert copied_metadata["configuration"] == metadata["configuration"] != {}
    assert copied_metadata.keys() == metadata.keys()


def test_copy_in_the_same_format_has_the_same_bytes(hosted: Path, tmp_path: Path) -> None:
    with simulation(hosted, tmp_path, ".csv") as sim:
        sim.run()
        (tmp_path / "copy.csv").write_text("old", encoding="utf-8")
        sim.save_data(tmp_path / "copy.csv")
    for ending in ("csv", "csv.yaml"):
        assert (tmp_path / f"copy.{ending}").read_bytes() == (tmp_path / f"rows.{ending}").read_bytes()


def test_name_that_says_no_format_or_is_taken_is_refused_in_a_line(hosted: Path, tmp_path: Path) -> None:
    (tmp_path / "notes.csv.yaml").write_text("mine: 1\n", encoding="utf-8")
    (tmp_path / "link.feather").symlink_to(tmp_path / "rows.feather")
    with simulation(hosted, tmp_path, ".feather") as sim:
        for name in ("copy.xlsx", "copy.feather.gz", "copy.txt"):
            assert "expected a name that ends in .feather" in refusal(sim, tmp_path / name)
            assert not (tmp_path / name).exists()
        for name in ("rows.feather", "link.feather"):
            assert refusal(sim, tmp_path / name).endswith(f"{name} is the data file itself; choose another name")
        assert "there is no folder" in refusal(sim, tmp_path / "missing" / "copy.csv")
        assert "notes.csv.yaml is no file of the simulator" in refusal(sim, tmp_path / "notes.csv")
        (tmp_path / "folder.csv").mkdir()
        assert "is a folder" in refusal(sim, tmp_path / "folder.csv")
        sim.save_data(tmp_path / "copy.feather")
        sim.save_data("/dev/null")
    assert Path("/dev/null").is_char_device()
    assert (tmp_path / "notes.csv.yaml").read_text(encoding="utf-8") == "mine: 1\n"
    assert not (tmp_path / "notes.csv").exists()
    assert not list(tmp_path.glob("*.pogosim-new"))


def test_run_without_rows_and_run_whose_rows_were_removed_are_told_apart(hosted: Path, tmp_path: Path) -> None:
    with simulation(hosted, tmp_path, ".feather", enable_data_logging=False) as sim:
        sim.run()
        assert "enable_data_logging: false" in refusal(sim, tmp_path / "copy.csv")
    with simulation(hosted, tmp_path, ".feather") as sim:
        sim.run()
        sim.data_file.unlink()
        with pytest.raises(pogosim.SimulationError, match=r"rows\.feather is not there any more"):
            sim.to_dataframe()
        sim.end()  # has written it again
        sim.data_file.unlink()
        assert "rows.feather is not there any more" in refusal(sim, tmp_path / "copy.csv")


@pytest.mark.parametrize("name", ["program", "configuration", "data_file"])
def test_files_of_a_run_cannot_be_set(name: str, hosted: Path, tmp_path: Path) -> None:
    with simulation(hosted, tmp_path, ".feather") as sim, pytest.raises(AttributeError):
        setattr(sim, name, "elsewhere")
