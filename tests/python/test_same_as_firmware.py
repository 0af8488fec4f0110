"""Each example does the same as a program in C and as firmware, where code takes no time and random numbers are equal.

What differs between the two elsewhere, docs/firmware.md says: parameters, columns and callbacks of the simulator,
rand() of another C library, and the last digits of its sines.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import pandas as pd
import pytest
import yaml
from firmwares import firmware_in, project_of
from running import ROOT, example, ran

EXAMPLES = sorted({path.parent for path in ROOT.glob("examples/*/main.c*")})
CONFIGURATIONS = {
    "avoid_walls": "walls_and_membranes",
    "hanabi": "simple",
    "heartbeat_sdk": "heartbeat",
    "helloworld": "test",
    "lighthouse_localization": "lighthouse",
    "run_and_tumble": "simple",
    "walls": "walls_and_membranes",
}
# Walls and pucks run the program, too: a firmware is that of one category.
BUILT_IN = ["time", "robot_category", "robot_id", "pogobot_ticks", "x", "y", "angle", "led_rgb"]
# Its program writes into the USERDATA of robots.
NOT_COMPARED = {"supervisor": ["led_rgb"]}
SETTINGS = {
    "simulation_time": 2,  # later, positions differ where sinf() does
    "parameters": "{}",
    "GUI": "false",
    "enable_data_logging": "true",
    "enable_console_logging": "false",
    "save_video_period": -1,
    "save_data_period": 0.1,
    "message_log": "''",
}


def rows(folder: Path, name: str, settings: dict[str, object]) -> pd.DataFrame:
    configuration = ROOT / "conf" / f"{CONFIGURATIONS.get(name, name)}.yaml"
    arguments = ["-c", str(configuration), "-g", "-q", "-nr", "-s", "11"]
    for key, value in {**SETTINGS, "data_filename": folder / "data.feather", **settings}.items():
        arguments += ["--set", f"{key}={value}"]
    result = ran(folder, example(name), *arguments)
    assert result.code == 0, result.text
    frame = result.frame()
    return frame.loc[frame["robot_category"] == "robots", [name for name in BUILT_IN if name in frame]]


@pytest.mark.parametrize("folder", EXAMPLES, ids=lambda path: path.name)
def test_example_does_the_same_as_firmware(folder: Path, tmp_path: Path) -> None:
    sources = [path for path in folder.iterdir() if path.suffix in {".c", ".cpp", ".h"}]
    for header in ROOT.glob("examples/*/*.h"):  # one example includes a header of another
        (tmp_path / header.parent.name).mkdir(exist_ok=True)
        shutil.copy(header, tmp_path / header.parent.name)
    firmware = firmware_in(project_of(tmp_path / "project", *sources))
    configuration = ROOT / "conf" / f"{CONFIGURATIONS.get(folder.name, folder.name)}.yaml"
    assert "robots" in yaml.safe_load(configuration.read_text())["objects"]
    brain = f"{{firmware: '{firmware}', random: simulator}}"
    native = rows(tmp_path, folder.name, {})
    emulated = rows(tmp_path, folder.name, {"objects.robots.brain": brain})
    shown = native.merge(emulated, on=["time", "robot_category", "robot_id"], suffixes=("", "_firmware"))
    assert len(shown) == len(native) > 0  # a program may leave rows out
    for column in BUILT_IN[3:]:
        if column in native and column not in NOT_COMPARED.get(folder.name, []):
            pd.testing.assert_series_equal(shown[column], shown[f"{column}_firmware"], check_names=False)
