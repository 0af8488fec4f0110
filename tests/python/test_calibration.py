"""`pogosim calibrate` finds the parameters with which robots were simulated, and says what their tracks cannot tell."""

from __future__ import annotations

import json
import math
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import yaml
from pogosim.batch.configurations.configuration import Configuration
from pogosim.batch.rows import Runs
from pogosim.batch.runs.run_policy import RunPolicy
from pogosim.batch.workers.backends import Workers
from pogosim.calibration import rounding, statistics
from pogosim.calibration.command import main
from pogosim.calibration.fit import bias_range
from pogosim.calibration.identifiability import verdicts, weakest_direction, without_own_effect
from pogosim.calibration.parameters import start_bias, start_values
from pogosim.calibration.reading import TrackTable, column_of, read_track_table
from pogosim.calibration.results import PROTOCOL
from pogosim.calibration.scene_of_tracks import handedness, read_scene
from pogosim.calibration.tracks import Tracks, continuous, cut, frame_numbers, on_grid
from pogosim.calibration.units import UnitOptions, in_millimetres, in_radians, y_down
from pogosim.errors import CalibrationError
from running import SCENE, Run, build_folder, compile_program, run

ARENA: dict[str, Any] = {"arena_file": "arenas/square.csv", "arena_surface": 2.25e6}  # 1.5 m
TRUE = {
    "max_linear_speed": 75.0,
    "max_angular_speed": 1.6,
    "linear_noise_stddev": 0.4,
    "angular_noise_stddev": 0.4,
}
BIAS = [-30, 50]
START = {"max_linear_speed": 110.0, "max_angular_speed": 1.0, "body_linear_damping": 0.3}
ROBOTS, LENGTH_S, PERIOD_S = 16, 55.0, 0.04
MM_PER_PIXEL = 0.8
NOISE_MM, NOISE_RAD = 1.0, 0.02


@pytest.fixture(scope="module")
def protocol(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compile_program(tmp_path_factory.mktemp("protocol") / "protocol", PROTOCOL)


@pytest.fixture(scope="module")
def filmed(protocol: Path, tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A run of the protocol with known parameters."""
    robots = {**SCENE["objects"]["robots"], **TRUE, "angular_systematic_bias_domain": BIAS, "nb": ROBOTS}
    settings = {**ARENA, "objects.robots": robots, "simulation_time": LENGTH_S, "save_data_period": PERIOD_S}
    return run(protocol, tmp_path_factory.mktemp("filmed"), settings)


@pytest.fixture(scope="module")
def camera(filmed: Run) -> pd.DataFrame:
    """What a camera sees of it, in mm and rad: with errors, and robots that are lost for a while."""
    rows, draws = filmed.frame(), np.random.default_rng(5)
    rows = rows[(rows["time"] + 1.7 * rows["robot_id"]) % 13.0 > 0.6].reset_index(drop=True)
    position = rows[["x", "y"]].to_numpy(dtype=float) + NOISE_MM * draws.standard_normal((len(rows), 2))
    angle = rows["angle"].to_numpy(dtype=float) + NOISE_RAD * draws.standard_normal(len(rows))
    seen = {
        "time": rows["time"].round(4),
        "id": rows["robot_id"],
        "x": position[:, 0],
        "y": position[:, 1],
        "angle": angle,
    }
    return pd.DataFrame(seen)


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder to work in, with conf.yaml and the simulator under test."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("POGOSIM_DIR", str(build_folder()))
    write_configuration(tmp_path / "conf.yaml")
    return tmp_path


def write_configuration(path: Path, **changes: Any) -> None:
    path.write_text(yaml.safe_dump({**ARENA, "objects": {"robots": {"type": "pogobot", "nb": 3, **START}}, **changes}))


def write(rows: pd.DataFrame, path: Path) -> None:
    rows.to_csv(path, index=False, float_format="%.5f")


def result(folder: Path) -> dict[str, Any]:
    content: dict[str, Any] = json.loads((folder / "calibration.json").read_text())
    return content


def calibrated(folder: Path, *options: str) -> dict[str, Any]:
    """Calibrate with few runs, and return the result."""
    arguments = ["tracks.csv", "-c", "conf.yaml", "-o", "out", "--runs", "1", "-j", "1", *options]
    assert main(arguments) == 0
    return result(folder / "out")


# The whole command.


def test_parameters_of_a_run_are_found_in_its_film_within_a_tenth(
    here: Path, camera: pd.DataFrame, protocol: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pixels = camera.assign(
        x=camera["x"] / MM_PER_PIXEL, y=camera["y"] / MM_PER_PIXEL, angle=np.degrees(camera["angle"])
    )
    write(pixels, here / "tracks.csv")
    found = calibrated(here, "--mm-per-pixel", str(MM_PER_PIXEL))
    for key in ("max_linear_speed", "max_angular_speed", "linear_noise_stddev", "angular_noise_stddev"):
        assert found["parameters"][key]["value"] == pytest.approx(TRUE[key], rel=0.1), key
        assert found["parameters"][key]["fitted"], key
    low, high = BIAS
    assert found["angular_systematic_bias_domain"]["value"] == pytest.approx([low, high], abs=0.1 * (high - low))
    assert found["tracker"]["tracker_noise_mm"] == pytest.approx(NOISE_MM, rel=0.1)
    assert found["tracker"]["tracker_noise_rad"] == pytest.approx(NOISE_RAD, rel=0.1)
    assert found["turns"] == "same"
    # What it cannot tell, it says, and leaves alone.
    for key, speed in (("body_linear_damping", "max_linear_speed"), ("body_angular_damping", "max_angular_speed")):
        assert found["parameters"][key]["value"] == START.get(key, 0.0)
        assert not found["parameters"][key]["fitted"]
        assert f"cannot be told from {speed}" in found["parameters"][key]["remark"]
    output = capsys.readouterr().out
    assert "lengths: px of 0.8 mm (given)" in output
    assert "angles: deg (recognised by the directions of motion)" in output
    # The lines that it prints are accepted by the simulator, in place of the old ones.
    block = (here / "out" / "calibration.yaml").read_text()
    assert block in output
    robots = yaml.safe_load(block)["objects"]["robots"]
    pasted = {**ARENA, "objects.robots": {"type": "pogobot", "nb": 3, **robots}, "simulation_time": 0.1}
    ended = run(protocol, here / "pasted", pasted, ["--strict", "-q"])
    assert (ended.code, ended.text) == (0, "")
    assert (here / "out" / "calibration.png").stat().st_size > 10_000


def test_tracks_without_angles_still_show_speeds(
    here: Path, camera: pd.DataFrame, capsys: pytest.CaptureFixture[str]
) -> None:
    write(camera.drop(columns="angle"), here / "tracks.csv")
    found = calibrated(here, "--parameters", "max_linear_speed,max_angular_speed,linear_noise_stddev")
    assert found["parameters"]["max_linear_speed"]["value"] == pytest.approx(TRUE["max_linear_speed"], rel=0.1)
    assert found["parameters"]["max_angular_speed"]["value"] == pytest.approx(TRUE["max_angular_speed"], rel=0.15)
    assert set(found["parameters"]) == {"max_linear_speed", "max_angular_speed", "linear_noise_stddev"}
    assert "the tracks have no angles" in capsys.readouterr().err


def test_a_mirrored_film_is_noticed(here: Path, camera: pd.DataFrame, capsys: pytest.CaptureFixture[str]) -> None:
    write(camera.assign(y=1500.0 - camera["y"], angle=-camera["angle"]), here / "tracks.csv")
    options = ["tracks.csv", "-c", "conf.yaml", "--runs", "1", "--parameters", "max_linear_speed"]
    assert main(options) == 0
    assert "is the film mirrored" in capsys.readouterr().err
    assert main([*options, "--y-up"]) == 0
    captured = capsys.readouterr()
    assert "mirrored" not in captured.err
    # Noise and turning speed that are not fitted, and wrong, do not spoil what is.
    line = next(line for line in captured.out.splitlines() if "max_linear_speed:" in line)
    assert float(line.split()[1]) == pytest.approx(TRUE["max_linear_speed"], rel=0.1)


def test_one_robot_and_a_data_file_will_do(
    here: Path, filmed: Run, protocol: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = pd.read_feather(filmed.folder / "data.feather")
    rows[rows["robot_id"] == 0].reset_index(drop=True).to_feather(here / "one.feather")
    options = [
        "one.feather",
        "-c",
        "conf.yaml",
        "-S",
        str(protocol),
        "--runs",
        "1",
        "--parameters",
        "max_angular_speed",
    ]
    assert main(options) == 0
    line = next(line for line in capsys.readouterr().out.splitlines() if "max_angular_speed" in line)
    assert float(line.split()[1]) == pytest.approx(TRUE["max_angular_speed"], rel=0.1)


@pytest.mark.parametrize("noise_of_the_start", [0.0, 0.3])
@pytest.mark.parametrize("kind", ["spots", "data file", "rounded"])
def test_film_without_any_noise_gives_the_parameters_of_its_run(
    kind: str, noise_of_the_start: float, here: Path, protocol: Path
) -> None:
    true = {"max_linear_speed": 100.0, "max_angular_speed": 2.0}
    robots = {**SCENE["objects"]["robots"], **true, "nb": 12}
    settings = {**ARENA, "objects.robots": robots, "simulation_time": 33.0, "save_data_period": PERIOD_S}
    film = run(protocol, here, settings)
    if kind == "spots":
        write_spots(film.frame().rename(columns={"robot_id": "id"}), here / "film", "mm")
        shutil.move(here / "film", here / "tracks.csv")
    elif kind == "rounded":
        rows = film.frame().rename(columns={"robot_id": "id"})[["time", "id", "x", "y", "angle"]]
        write(rows.round({"x": 0, "y": 0, "angle": 2}), here / "tracks.csv")
    else:
        shutil.copy(film.folder / "data.feather", here / "tracks.csv")
    noises = {"linear_noise_stddev": noise_of_the_start, "angular_noise_stddev": noise_of_the_start}
    objects = {"robots": {"type": "pogobot", "nb": 3, **START, **noises}}
    write_configuration(here / "conf.yaml", objects=objects)
    everything = calibrated(here)
    found = everything["parameters"]
    for key, value in true.items():
        assert found[key]["value"] == pytest.approx(value, rel=0.03), key
    of_rounding = {"rounded": [1.0 / math.sqrt(12.0), 0.01 / math.sqrt(12.0)]}.get(kind, [0.0, 0.0])
    assert list(everything["tracker"].values()) == pytest.approx(of_rounding, rel=0.05, abs=0.005)
    for key in noises.keys() & found.keys():
        assert found[key]["value"] == 0.0, key


def test_noise_of_motors_is_found_in_rounded_tracks(
    here: Path, filmed: Run, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = filmed.frame().rename(columns={"robot_id": "id"})[["time", "id", "x", "y", "angle"]]
    pixels = rows.assign(x=rows["x"] / 2.0, y=rows["y"] / 2.0, angle=np.degrees(rows["angle"]))
    write(pixels.round({"x": 0, "y": 0, "angle": 0}), here / "tracks.csv")
    found = calibrated(here, "--mm-per-pixel", "2")
    for key in TRUE:
        assert found["parameters"][key]["value"] == pytest.approx(TRUE[key], rel=0.15), key
    text = "rounded: positions to 2 mm (noise of 0.58 mm), angles to 0.017 rad (noise of 0.005 rad)"
    assert text in capsys.readouterr().out


@pytest.mark.parametrize("step", [1.0, 0.5, 0.25, 0.1, 0.01, 0.8 / 3.0])
@pytest.mark.parametrize("offset", [0.0, 0.37])
def test_step_of_rounded_numbers_is_found(step: float, offset: float) -> None:
    numbers = np.random.default_rng(4).uniform(-700.0, 1500.0, (500, 20))
    numbers[3, 4] = np.nan
    assert rounding.step_of(np.rint(numbers / step) * step + offset) == pytest.approx(step)


def test_numbers_that_are_not_rounded_have_no_step() -> None:
    numbers = np.random.default_rng(4).uniform(-700.0, 1500.0, (500, 20))
    assert rounding.step_of(numbers) == 0.0
    assert rounding.step_of(np.rint(numbers) + 0.1 * (numbers > 1000.0)) == pytest.approx(0.1)
    assert rounding.step_of(numbers.astype(np.float32).astype(float)) < rounding.LEAST_RAD
    assert rounding.step_of(np.array([1.0, 1.0, 2.0, np.nan])) == 0.0
    assert rounding.step_of(np.full(4, np.nan)) == 0.0


@pytest.mark.parametrize("name", ["tracks.arrow", "tracks.ipc", "tracks", "tracks.txt"])
def test_data_file_of_a_run_is_read_whatever_its_name(name: str, tmp_path: Path) -> None:
    rows = pd.DataFrame({"time": [0.0, 0.1], "robot_id": [0, 0], "x": [1.0, 2.0], "y": 3.0, "angle": 0.5})
    rows.assign(robot_category="robots").to_feather(tmp_path / name)
    table, said = read_spots(tmp_path / name)
    assert (table.rows["x"].tolist(), table.units["x"], said) == ([1.0, 2.0], "mm", [])


def test_protocol_is_written_once(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--protocol", "main.c"]) == 0
    assert (here / "main.c").read_text() == PROTOCOL.read_text()
    (here / "main.c").write_text("mine")
    assert main(["--protocol", "main.c"]) == 2
    assert (here / "main.c").read_text() == "mine"
    assert "main.c exists already" in capsys.readouterr().err


def test_protocol_becomes_a_project_that_runs_in_the_simulator(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--protocol", "film"]) == 0
    assert (here / "film" / "main.c").read_text() == PROTOCOL.read_text()
    assert capsys.readouterr().out == "made: film, a project whose main.c is the program of the protocol\n"
    command = [sys.executable, "-m", "pogosim", "run", "film", "-g", "-q", "--set", "simulation_time=1"]
    assert subprocess.run(command, cwd=here, check=False, timeout=120).returncode == 0
    assert main(["--protocol", "film"]) == 2
    assert "film is there already, with files in it" in capsys.readouterr().err


# TrackMate.

MANY = ("LABEL", "ID", "TRACK_ID", "QUALITY", "POSITION_X", "POSITION_Y", "POSITION_Z", "POSITION_T", "FRAME", "RADIUS")


def write_spots(
    rows: pd.DataFrame, path: Path, length: str = "pixel", time: str = "sec", encoding: str = "utf-8"
) -> None:
    """Write tracks as TrackMate exports the table of spots; the first spot is of no track."""
    spots = [f"ID{9000 + i},{9000 + i}" for i in range(len(rows))]
    lines = [
        ",".join(MANY),
        "Label,Spot ID,Track ID,Quality,X,Y,Z,T,Frame,Radius",
        "Label,Spot ID,Track ID,Quality,X,Y,Z,T,Frame,R",
        f",,,(quality),({length}),({length}),({length}),({time}),,({length})",
        "ID1,1,,0.5,1,1,0,0,0,5",
        *(
            f"{spot},{robot:.0f},0.9,{x:.4f},{y:.4f},0,{at:.4f},{at / PERIOD_S:.0f},5"
            for spot, (at, robot, x, y) in zip(spots, rows[["time", "id", "x", "y"]].to_numpy(float), strict=True)
        ),
    ]
    path.write_text("\n".join(lines) + "\n", encoding=encoding)


def read_spots(path: Path) -> tuple[TrackTable, list[str]]:
    """Read tracks, and return them with all warnings."""
    said: list[str] = []
    return read_track_table(path, "robots", said.append), said


@pytest.mark.parametrize(
    ("length", "unit", "encoding"),
    [
        ("pixel", "px", "utf-8"),
        ("mm", "mm", "utf-8"),
        ("\u00b5m", "um", "utf-8"),
        ("\u00b5m", "um", "latin-1"),
        ("micron", "um", "utf-8"),
        ("inch", "inch", "utf-8"),
    ],
)
def test_spots_of_trackmate_are_read_as_they_are_exported(
    length: str, unit: str, encoding: str, tmp_path: Path
) -> None:
    tracks = short_tracks()
    write_spots(tracks, tmp_path / "spots.csv", length, encoding=encoding)
    table, said = read_spots(tmp_path / "spots.csv")
    assert (table.units["x"], table.units["time"]) == (unit, "s")
    assert said == [f"{tmp_path / 'spots.csv'}: 1 of 201 rows without a time, an id or a position are left out"]
    np.testing.assert_allclose(table.rows[["time", "x", "y"]], tracks[["time", "x", "y"]], atol=1e-4)
    assert table.rows["id"].astype(int).tolist() == tracks["id"].tolist()


def test_spots_of_trackmate_whose_times_count_frames_need_the_frame_rate(tmp_path: Path) -> None:
    tracks = short_tracks()
    write_spots(tracks.assign(time=tracks["time"] * 10.0), tmp_path / "spots.csv", time="frame")
    table, _ = read_spots(tmp_path / "spots.csv")
    assert "time" not in table.rows
    with pytest.raises(CalibrationError, match="frame numbers but no times; say how many frames a second: --fps N"):
        frame_numbers(table, None, pytest.fail)
    _, frame_s = frame_numbers(table, 25.0, pytest.fail)
    assert frame_s == 0.04


def test_another_table_of_trackmate_says_which_is_needed(tmp_path: Path) -> None:
    (tmp_path / "edges.csv").write_text("LABEL,TRACK_ID,SPOT_SOURCE_ID\nLabel,Track ID,Source\na,0,1\n")
    with pytest.raises(
        CalibrationError, match=r"has no column x, y, time; .*; of TrackMate, export the table of spots"
    ):
        read_spots(tmp_path / "edges.csv")


def test_tracks_of_trackmate_are_calibrated(
    here: Path, camera: pd.DataFrame, capsys: pytest.CaptureFixture[str]
) -> None:
    pixels = camera.assign(x=camera["x"] / MM_PER_PIXEL, y=camera["y"] / MM_PER_PIXEL)
    write_spots(pixels, here / "tracks.csv")
    found = calibrated(here, "--mm-per-pixel", str(MM_PER_PIXEL), "--parameters", "max_linear_speed")
    assert found["parameters"]["max_linear_speed"]["value"] == pytest.approx(TRUE["max_linear_speed"], rel=0.1)
    assert f"tracks: {ROBOTS} robots, " in capsys.readouterr().out


# What is wrong with the input is said in one line.


def short_tracks() -> pd.DataFrame:
    """Two robots that drive along x for ten seconds."""
    time = np.repeat(np.arange(0.0, 10.0, 0.1), 2)
    robot = np.tile([0, 1], len(time) // 2)
    seen = {"time": time, "id": robot, "x": 200.0 + 50.0 * time, "y": 300.0 + 300.0 * robot, "angle": 0.0}
    return pd.DataFrame(seen)


BAD_TRACKS = {
    "": "tracks.csv is empty",
    "time,id,x,y\n": "has no row",
    "time,id,x\n0,1,2\n": "has no column y",
    "frame,id,x,y\n0,1,2,3\n1,1,2,3\n": "--fps",
    "time,id,x,y\n0,1,2,3\n": "one moment only",
    "time,id,x,y\n0,1,2,3\n0.04,1,2,3\n": "expected 5 s or more",
    "time,id,x,y\n0,1,2,3\n40,1,2,3\n80,1,2,3\n": "40 s from row to row",
    "time,id,x,y\n0,1,two,3\n": "row 1: x is 'two'; expected a number",
    "time,id,x,y\n,,nan,\n": "has no row",
    "\x00\x01\xff\xfe": "not a CSV file",
}


@pytest.mark.parametrize("text", list(BAD_TRACKS))
def test_bad_tracks_are_refused_in_a_line(text: str, here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (here / "tracks.csv").write_bytes(text.encode("latin-1"))
    assert main(["tracks.csv", "-c", "conf.yaml"]) == 2
    (line,) = [line for line in capsys.readouterr().err.splitlines() if "warning" not in line]
    assert "tracks.csv" in line
    assert BAD_TRACKS[text] in line


BAD_OPTIONS = {
    ("none.csv", "-c", "conf.yaml"): "none.csv: no such file or directory",
    ("tracks.csv", "-c", "none.yaml"): "cannot read the configuration none.yaml",
    (".", "-c", "conf.yaml"): "is not a file",
    ("tracks.csv", "-c", "conf.yaml", "--parameters", "speed"): "no parameter speed; expected some of max_linear_speed",
    ("tracks.csv", "-c", "conf.yaml", "--category", "dogs"): "no robots 'dogs'",
    ("tracks.csv", "-c", "conf.yaml", "-S", "none"): "there is no project, source file or program none",
    ("tracks.csv", "-c", "conf.yaml", "-S", "conf.yaml"): "a .c or .cpp file, a firmware, nor a program",
    ("tracks.csv", "-c", "conf.yaml", "--length-unit", "px"): "--mm-per-pixel",
    ("tracks.csv", "-c", "conf.yaml", "--length-unit", "m"): "the arena is 1500 x 1500 mm",
    ("tracks.csv", "-c", "conf.yaml", "-o", "tracks.csv"): "tracks.csv is not a folder",
    ("tracks.csv", "-c", "calibration.yaml", "-o", "."): "is an input, which would be lost",
    ("tracks.csv", "-c", "torus.yaml"): "periodic arena",
    ("tracks.csv", "-c", "empty.yaml"): "no robots of type pogobot",
    ("damaged.feather", "-c", "conf.yaml"): "damaged.feather",
}


@pytest.mark.parametrize("options", list(BAD_OPTIONS), ids=" ".join)
def test_bad_options_are_refused_in_a_line(
    options: tuple[str, ...], here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(short_tracks(), here / "tracks.csv")
    write_configuration(here / "calibration.yaml")
    write_configuration(here / "torus.yaml", boundary_condition="periodic")
    write_configuration(here / "empty.yaml", objects={})
    (here / "damaged.feather").write_bytes(b"ARROW1\0\0" + bytes(100))
    before = {path: path.read_bytes() for path in here.iterdir()}
    assert main(options) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("pogosim calibrate: ")
    assert BAD_OPTIONS[options] in line
    assert {path: path.read_bytes() for path in here.iterdir()} == before


def test_what_is_known_of_robots_is_what_the_simulator_says(protocol: Path, here: Path) -> None:
    (here / "own.yaml").write_text("radius: 31\nmax_linear_speed: 77\n")
    robots = {"type": "pogobot", "nb": 3, "robot_model": "own.yaml", "max_angular_speed": 2.5}
    write_configuration(here / "conf.yaml", objects={"robots": robots}, time_step=0.008)
    configuration = Configuration("conf.yaml")
    runs = Runs(configuration, str(protocol), "tmp", "out", Workers(number=1), RunPolicy(retries=0))
    with runs.opened():
        scene = read_scene(runs, configuration.resolved(), "robots")
    assert (scene.radius_mm, scene.time_step_s, scene.size_mm.tolist()) == (31.0, 0.008, [1500.0, 1500.0])
    values = start_values(scene.settings)
    assert (values["max_linear_speed"], values["max_angular_speed"]) == (77.0, 2.5)
    assert (values["linear_noise_stddev"], start_bias(scene.settings)) == (0.0, (0, 0))


def test_robots_that_stand_are_not_calibrated(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    draws = np.random.default_rng(6)
    rows = short_tracks()
    shaken = 0.5 * draws.standard_normal((2, len(rows)))
    write(rows.assign(x=200.0 + shaken[0], y=rows["y"] + shaken[1]), here / "tracks.csv")
    assert main(["tracks.csv", "-c", "conf.yaml", "--length-unit", "mm"]) == 2
    assert capsys.readouterr().err.splitlines()[-1].startswith("pogosim calibrate: the robots hardly move")


# Reading.


def no_warning(text: str) -> None:
    raise AssertionError(text)


def grid(rows: pd.DataFrame, warnings: list[str] | None = None, fps: float | None = None) -> Tracks:
    warn = no_warning if warnings is None else warnings.append
    table = TrackTable(rows, "tracks.csv")
    return cut(on_grid(table, *frame_numbers(table, fps, warn), warn), 26.5, warn)


@pytest.mark.parametrize(
    ("name", "meaning"),
    [
        ("t", ("time", "")),
        ("Robot_ID", ("id", "")),
        ("x [px]", ("x", "px")),
        ("y_mm", ("y", "mm")),
        ("theta (deg)", ("angle", "deg")),
        ("heading_rad", ("angle", "rad")),
        ("time_ms", ("time", "ms")),
        ("led", None),
    ],
)
def test_columns_are_known_by_other_names(name: str, meaning: tuple[str, str] | None) -> None:
    assert column_of(name) == meaning


@pytest.mark.parametrize("wrong_s", [1e6, 1e9, 1e300])
def test_row_with_a_wrong_time_is_named_and_takes_no_memory(wrong_s: float) -> None:
    rows = pd.DataFrame([(0.1 * i, 0, float(i), 0.0) for i in range(100)], columns=["time", "id", "x", "y"])
    rows.loc[41, "time"] = wrong_s
    with pytest.raises(
        CalibrationError, match=r"row 42 is .* away from the middle of the others; expected 1000000 frames"
    ):
        grid(rows)


def test_tracks_are_cut_at_gaps_and_jumps_and_nowhere_else() -> None:
    rows = short_tracks()
    assert grid(rows).piece.max() == 0
    warnings: list[str] = []
    assert grid(rows[~rows["time"].between(4.0, 4.5)], warnings).piece.max(axis=0).tolist() == [1, 1]
    assert "2 gaps" in warnings[0]
    warnings.clear()
    swapped = rows.assign(id=np.where(rows["time"] > 6.0, 1 - rows["id"], rows["id"]))
    assert grid(swapped, warnings).piece.max(axis=0).tolist() == [1, 1]
    assert "2 jumps" in warnings[0]
    warnings.clear()
    assert grid(pd.concat([rows, rows.iloc[:3]]), warnings).robots == 2
    assert "3 rows of a robot that the same frame has already" in warnings[0]


def test_frame_numbers_and_milliseconds_are_times() -> None:
    rows = short_tracks()
    numbered = rows.drop(columns="time").assign(frame=np.rint(rows["time"] * 10))
    assert grid(numbered, fps=10.0).length_s == pytest.approx(9.9)
    table = TrackTable(rows.assign(time=1000.0 * rows["time"]), "tracks.csv", {"time": "ms"})
    assert frame_numbers(table, None, no_warning)[1] == pytest.approx(0.1)


def test_irregular_times_and_late_robots_are_put_into_their_frames() -> None:
    rows, draws = short_tracks(), np.random.default_rng(7)
    shaken = rows.assign(time=rows["time"] + 0.015 * draws.standard_normal(len(rows)))
    warnings: list[str] = []
    numbers, frame_s = frame_numbers(TrackTable(shaken, "tracks.csv"), None, warnings.append)
    assert frame_s == pytest.approx(0.1, rel=0.002)
    assert numbers.tolist() == np.rint(rows["time"] * 10).astype(int).tolist()
    assert "irregular by 1" in warnings[0]


SIZE_MM = np.array([1000.0, 1000.0])


@pytest.mark.parametrize(("unit", "mm"), [("mm", 1.0), ("cm", 10.0), ("m", 1000.0)])
def test_unit_of_lengths_is_recognised_by_the_arena(unit: str, mm: float) -> None:
    rows, said = short_tracks(), list[str]()
    tracks = grid(rows.assign(x=rows["x"] / mm, y=rows["y"] / mm))
    found = in_millimetres(tracks, None, UnitOptions(), SIZE_MM, said.append, no_warning)
    assert np.nanmax(found.position_mm[..., 0]) == pytest.approx(695.0)
    assert said[0].startswith(f"lengths: {unit} (recognised")


def circling(sign: float = 1.0) -> Tracks:
    """A robot on a circle of 200 mm, 1 rad/s, clockwise on the screen for sign 1."""
    time = np.arange(0.0, 20.0, 0.04)
    position = 500.0 + 200.0 * np.stack([np.cos(time), sign * np.sin(time)], axis=-1)[:, None]
    angle = sign * (time + math.pi / 2.0)
    return Tracks(position, angle[:, None], np.zeros((len(time), 1), dtype=np.int64), 0.04)


@pytest.mark.parametrize("marker_rad", [0.0, math.pi / 2.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("unit", ["rad", "deg"])
def test_angles_are_recognised_by_the_direction_of_motion(unit: str, sign: float, marker_rad: float) -> None:
    true, said = circling(), list[str]()
    angle = sign * np.angle(np.exp(1j * (true.angle_rad + marker_rad)))
    file = replace(true, angle_rad=np.degrees(angle) if unit == "deg" else angle)
    found = continuous(in_radians(file, None, UnitOptions(), said.append, no_warning))
    assert np.cos(found.angle_rad - true.angle_rad).min() == pytest.approx(1.0, abs=1e-3)
    assert said[0].startswith(f"angles: {unit} (recognised by the directions of motion)")
    assert ("sign is changed" in said[0]) == (sign < 0)
    assert ("turned by" in said[0]) == (marker_rad > 0)


def test_y_up_turns_positions_and_angles() -> None:
    up = circling()
    turned = y_down(up, UnitOptions(y_up=True), 1000.0, lambda _text: None)
    assert turned.position_mm == pytest.approx(circling(-1.0).position_mm)
    assert turned.angle_rad == pytest.approx(circling(-1.0).angle_rad)


# Statistics.


def test_circle_has_its_speed_and_turn_rate() -> None:
    tracks = circling()
    chord = 2.0 * 200.0 * math.sin(0.2) / 0.4
    assert statistics.speeds(tracks) == pytest.approx(chord)
    assert statistics.turn_rates(tracks) == pytest.approx(1.0)
    expected = 2.0 * 200.0**2 * (1.0 - np.cos([0.4, 2.0]))
    assert statistics.mean_square_displacement(tracks, np.array([0.4, 2.0])) == pytest.approx(expected)


def test_noise_of_the_tracker_is_that_of_robots_at_rest() -> None:
    draws = np.random.default_rng(1)
    shape = (4000, 5)
    tracks = Tracks(
        2.0 * draws.standard_normal((*shape, 2)),
        0.03 * draws.standard_normal(shape),
        np.zeros(shape, dtype=np.int64),
        0.04,
    )
    assert statistics.tracker_noise(tracks) == pytest.approx((2.0, 0.03), rel=0.03)


def test_jitter_of_a_random_walk_grows_with_the_root_of_the_lag() -> None:
    draws = np.random.default_rng(2)
    walk = np.cumsum(draws.standard_normal((6000, 8, 2)), axis=0)
    tracks = Tracks(walk, np.zeros((6000, 8)), np.zeros((6000, 8), dtype=np.int64), 0.04)
    # Second differences of a walk with steps of variance 1 have the variance 2 lag in x and in y.
    for lag in (1, 4, 16):
        expected = math.sqrt(2.0 * lag) * math.sqrt(-2.0 * math.log(0.75))
        assert statistics.position_jitter(tracks, lag).mean() == pytest.approx(expected, rel=0.05)


# What tracks can tell.


def test_columns_that_are_alike_cannot_be_told_apart() -> None:
    sensitivity = np.array([[10.0, 20.0, 0.0, 0.0], [10.0, 20.0, 0.0, 0.1], [0.0, 0.0, 4.0, 0.0], [0.0, 0.1, 0.0, 0.0]])
    found = verdicts(sensitivity, ["speed", "damping", "noise", "nothing"])
    assert not found["speed"].is_identified
    assert found["speed"].like == ("damping",)
    assert found["noise"].is_identified
    assert found["noise"].error == pytest.approx(0.25)
    assert not found["nothing"].has_effect
    names = ["speed", "damping", "noise", "nothing"]
    assert without_own_effect(sensitivity, names, ["damping", "nothing"]) == ["damping", "nothing"]
    value, parts = weakest_direction(sensitivity[:3, :2], ["speed", "damping"])
    assert value == pytest.approx(0.0, abs=1e-9)
    assert parts["speed"] / parts["damping"] == pytest.approx(-2.0)


def test_range_of_the_bias_is_that_of_uniform_draws() -> None:
    draws = np.random.default_rng(4)
    ends = [bias_range(draws.uniform(-30.0, 50.0, 20), 0.1) for _ in range(300)]
    assert np.mean(ends, axis=0) == pytest.approx([-30.0, 50.0], abs=1.0)
    noisy = [bias_range(draws.uniform(-30.0, 50.0, 200) + 12.0 * draws.standard_normal(200), 12.0) for _ in range(100)]
    assert np.mean(noisy, axis=0) == pytest.approx([-30.0, 50.0], abs=1.0)
    low, high = bias_range(10.0 + 5.0 * draws.standard_normal(50), 5.0)
    assert low == high == pytest.approx(10.0, abs=2.0)
    assert bias_range(np.array([np.nan]), 1.0) == (0, 0)
    assert bias_range(np.array([7.2, np.nan]), 1.0) == (7, 7)


def test_side_of_turns_is_told_whenever_the_program_began() -> None:
    cycle = np.repeat([0.0, -1.0, 1.0, 0.0], [30, 30, 20, 30])
    program = np.tile(cycle, 5)
    for shift in (0, 17, 60, 100):
        assert handedness(np.roll(program, shift), program, 0.1) == "same"
        assert handedness(-np.roll(program, shift), program, 0.1) == "mirrored"
    assert handedness(np.zeros(100), np.ones(100), 0.1) == "unknown"
    draws = np.random.default_rng(3)
    assert handedness(draws.standard_normal(1000), draws.standard_normal(1000), 0.1) == "unknown"
