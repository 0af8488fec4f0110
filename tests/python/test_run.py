"""From a configuration to a picture: runs of a built example, read with the Python tools."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import yaml
from pogosim.swarm_picture import main as draw
from pogosim.utils import load_dataframe

ROOT = Path(__file__).resolve().parents[2]
HANABI = ROOT / "examples" / "hanabi" / "hanabi"
NB = 12
SURFACE_MM2 = 2.0e5

SCENE: dict[str, Any] = {
    "arena_file": "arenas/disk.csv",
    "arena_surface": SURFACE_MM2,
    "simulation_time": 12.0,
    "time_step": 0.01,
    "save_data_period": 0.5,
    "data_logger_led": True,
    "initial_formation": "random",
    "objects": {
        "global_light": {
            "type": "static_light",
            "geometry": "global",
            "value": 200,
            "photo_start_at": 1.0,
            "photo_start_duration": 1.0,
        },
        "robots": {"type": "pogobot", "geometry": "disk", "nb": NB, "radius": 26.5, "max_linear_speed": 100.0},
    },
    "parameters": {"moving_robots": True},
}


def simulate(folder: Path, seed: int = 0, **changes: object) -> subprocess.CompletedProcess[str]:
    """Run the scene; the data file is data.feather in the folder, unless changed."""
    folder.mkdir(exist_ok=True)
    config = folder / "scene.yaml"
    config.write_text(yaml.safe_dump({**SCENE, "data_filename": str(folder / "data.feather"), **changes}))
    command = [str(HANABI), "-c", str(config), "-g", "-s", str(seed)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120, check=False)


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("run")
    result = simulate(folder, seed=5)
    assert result.returncode == 0, result.stderr
    return folder / "data.feather"


def test_pandas_reads_the_columns_in_their_order_and_types(data: Path) -> None:
    frame = pd.read_feather(data)
    columns = "time robot_category robot_id pogobot_ticks x y angle led_rgb age rgb_colors_index"
    assert list(frame.columns) == columns.split()
    types = {name: str(dtype) for name, dtype in frame.dtypes.items() if name != "robot_category"}
    assert types == {
        "time": "float64",
        "robot_id": "int32",
        "pogobot_ticks": "int64",
        "x": "float32",
        "y": "float32",
        "angle": "float32",
        "led_rgb": "int32",
        "age": "int32",
        "rgb_colors_index": "int16",
    }
    assert set(frame["robot_category"]) == {"robots"}


def test_every_robot_has_a_row_at_each_multiple_of_the_period_after_the_start(data: Path) -> None:
    frame, _ = load_dataframe(data)
    last_s = SCENE["simulation_time"]
    late = frame[frame["time"] > 2.0]
    times = np.arange(2.5, last_s + 0.01, 0.5)
    np.testing.assert_allclose([t for t in late["time"].unique() if t < last_s], [t for t in times if t < last_s])
    for _, rows in late.groupby("time"):
        assert rows["robot_id"].tolist() == list(range(NB))


def test_metadata_hold_version_seed_and_an_arena_of_the_asked_surface(data: Path) -> None:
    _, metadata = load_dataframe(data)
    assert metadata["program_version"].startswith("v")
    assert metadata["configuration"]["seed"] == 5
    assert metadata["configuration"]["objects"]["robots"]["nb"] == NB
    (polygon,) = metadata["arena_polygons"]
    x, y = polygon.T
    area = abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2
    assert area == pytest.approx(SURFACE_MM2, rel=1e-3)


def test_robots_stay_in_the_arena_with_headings_within_half_a_turn(data: Path) -> None:
    frame, _ = load_dataframe(data)
    radius = np.sqrt(SURFACE_MM2 / np.pi)
    distance = np.hypot(frame["x"] - radius, frame["y"] - radius)
    assert distance.max() < radius - 26.5 + 5.0
    assert frame["angle"].between(-np.pi, np.pi).all()


def test_same_seed_gives_the_same_bytes_and_another_seed_another_run(data: Path, tmp_path: Path) -> None:
    # The file names its own path in its configuration, so the twin has to lie in the same place.
    before = data.read_bytes()
    assert simulate(data.parent, seed=5).returncode == 0
    assert data.read_bytes() == before
    assert simulate(tmp_path, seed=6).returncode == 0
    first, _ = load_dataframe(data)
    other, _ = load_dataframe(tmp_path / "data.feather")
    assert not np.array_equal(first["x"], other["x"])


def test_only_asked_columns_and_batches_of_any_size_are_written(tmp_path: Path) -> None:
    result = simulate(tmp_path, data_logger_fields=["time", "x", "age"], data_logger_flush_row_count=7)
    assert result.returncode == 0, result.stderr
    assert list(pd.read_feather(tmp_path / "data.feather").columns) == ["time", "x", "age"]


@pytest.mark.parametrize("path", ["/dev/full", "/dev/null/data.feather", "."])
def test_output_that_cannot_be_written_is_an_error_that_names_it(tmp_path: Path, path: str) -> None:
    result = simulate(tmp_path, data_filename=path)
    assert result.returncode == 2
    assert f"cannot write the data file '{path}'" in result.stderr + result.stdout


def test_run_can_be_drawn(data: Path, tmp_path: Path) -> None:
    assert draw([str(data), str(tmp_path / "swarm.png")]) == 0
    assert (tmp_path / "swarm.png").read_bytes().startswith(b"\x89PNG")
