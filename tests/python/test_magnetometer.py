"""Programs read their magnetometer: the model of the configuration, a table, threads, and every mistake."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import yaml
from conftest import Compile
from in_process import pogosim
from pogosim import Simulation
from pogosim.calibration.command import main
from pogosim.utils import load_dataframe
from running import PROGRAMS, ROOT, SHARED, Run, compile_program, compile_text, run, run_command, write_scene

REFERENCE = ROOT / "conf" / "example_magnetometer_reference.csv"
EXACT: dict[str, Any] = {"noise_stddev": {axis: [0] for axis in "xyz"}}
PLAIN: dict[str, Any] = {"robot_variation": EXACT, "procedural": {"distortion_harmonics": []}}
CSV = {"source": "csv", "csv": {"file": str(REFERENCE), "harmonic_order": 3}}
# One robot in each place, far from the others and from walls.
APART: dict[str, Any] = {"arena_file": "arenas/square.csv", "arena_surface": 1e6, "objects.robots.nb": 3}
POSES = {"objects.robots.poses": [[200, 200, 0.3], [800, 300, -2.0], [500, 800, 1.2]]}


@pytest.fixture(scope="module")
def reader(program: Compile) -> Path:
    return program("magnetometer.c")


def recorded(reader: Path, folder: Path, magnetometer: dict[str, Any], **settings: Any) -> pd.DataFrame:
    """Rows after the first tick of robots that turn, or stand with `turns=False`."""
    turns = settings.pop("turns", True)
    given = {**APART, **POSES, "magnetometer": magnetometer, "parameters": {"turns": turns}, **settings}
    result = run(reader, folder, given)
    assert (result.code, result.errors) == (0, ""), result.text
    rows = result.frame()
    return rows[rows["time"] > 0.05]


def test_readings_of_a_robot_at_rest_are_those_of_the_formulas(reader: Path, tmp_path: Path) -> None:
    rows = recorded(reader, tmp_path, PLAIN, turns=False)
    assert set(rows["status"]) == {0}
    phi = -rows["angle"]
    assert np.allclose(rows["mag_x"], 425 + 160 * np.cos(phi), atol=0.501)
    assert np.allclose(rows["mag_y"], 425 + 140 * np.sin(phi), atol=0.501)
    assert np.allclose(rows["mag_z"], 425 + 15 * np.cos(phi) - 10 * np.sin(phi), atol=0.501)


def test_field_that_is_linear_in_the_place_is_read_so(reader: Path, tmp_path: Path) -> None:
    field = {"x": 1, "gradient_x": [0.002, 0, 0], "gradient_y": [0, 0.001, 0], "origin": [200, 200]}
    rows = recorded(reader, tmp_path, {**PLAIN, "world_field": field}, turns=False)
    along, across = 1 + 0.002 * (rows["x"] - 200), 0.001 * (rows["y"] - 200)
    strength, phi = np.hypot(along, across), np.arctan2(across, along) - rows["angle"]
    assert rows["mag_x"].nunique() == 3
    assert np.allclose(rows["mag_x"], 425 + 160 * strength * np.cos(phi), atol=0.51)
    assert np.allclose(rows["mag_y"], 425 + 140 * strength * np.sin(phi), atol=0.51)


def test_heading_by_a_calibrated_magnetometer_is_the_true_one(reader: Path, tmp_path: Path) -> None:
    rows = recorded(reader, tmp_path, {"procedural": PLAIN["procedural"]}, turns=False, simulation_time=20)
    found = -np.arctan2((rows["mag_y"] - 425) / 140, (rows["mag_x"] - 425) / 160)
    error = np.remainder(found - rows["angle"] + math.pi, 2 * math.pi) - math.pi
    assert np.std(error) == pytest.approx(3 / 150, rel=0.2)
    assert np.mean(error) == pytest.approx(0, abs=0.004)


def test_calibration_of_simulated_readings_finds_the_configuration(
    reader: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ellipse = {"center": {"x": [400], "y": [430], "z": [410]}, "major_radius": [170], "minor_radius": [130]}
    model = {"procedural": {"ellipse": {**ellipse, "ellipse_rotation": [20]}, "distortion_harmonics": []}}
    # Robots at rest in 72 headings: while they turn, the reading is a little older than the row.
    poses = [[200 + 20 * (i % 9), 200 + 20 * (i // 9), math.radians(5 * i)] for i in range(72)]
    small = {"objects.robots.radius": 5, "objects.robots.nb": 72, "objects.robots.poses": poses}
    rows = recorded(reader, tmp_path / "run", model, turns=False, **small)
    table = tmp_path / "table.csv"
    rows[["angle", "mag_x", "mag_y", "mag_z"]].to_csv(table, index=False)
    given = ["magnetometer", str(table), "--angle-unit", "radians", "--harmonics", "1"]
    assert main([*given, "--picture", str(tmp_path / "picture.png")]) == 0
    printed = capsys.readouterr().out
    for key, value in (("major_radius", 170), ("minor_radius", 130), ("ellipse_rotation", 20)):
        found = re.search(rf"{key}: \[(\S+)\] +# \w+, \+- (\S+)", printed)
        assert found, printed
        assert float(found[1]) == pytest.approx(value, abs=4 * float(found[2]) + 0.1)
    noise = re.search(r"noise_stddev: \{x: \[(\S+)\]", printed)
    assert noise
    assert float(noise[1]) == pytest.approx(3, rel=0.1)


def test_table_gives_its_own_readings(reader: Path, tmp_path: Path) -> None:
    table = pd.read_csv(REFERENCE, comment="#")
    poses = [[200 + 20 * (i % 9), 200 + 20 * (i // 9), math.radians(5 * i)] for i in range(72)]
    small = {"objects.robots.radius": 5, "objects.robots.nb": 72, "objects.robots.poses": poses}
    exact = {"robot_variation": EXACT, **CSV, "csv": {**CSV["csv"], "add_fit_residual_as_noise": False}}  # type: ignore[dict-item]
    rows = recorded(reader, tmp_path / "exact", exact, turns=False, **small)
    degrees = np.degrees(rows["angle"]).round().astype(int) % 360
    measured = table.groupby("angle").mean()
    for axis in ("mag_x", "mag_y", "mag_z"):
        difference = rows[axis].to_numpy() - measured.loc[degrees, axis].to_numpy()
        assert np.abs(difference).max() < 5  # two standard errors of four readings
        assert np.std(difference) < 1.6
    # The error of the fit is the noise.
    noisy = recorded(reader, tmp_path / "noisy", {"robot_variation": EXACT, **CSV}, turns=False, **small)
    deviation = noisy["mag_x"].to_numpy() - rows["mag_x"].to_numpy()
    assert np.std(deviation) == pytest.approx(2.5, rel=0.1)


def test_robots_differ_as_the_configuration_says(reader: Path, tmp_path: Path) -> None:
    bias = {"x": [-50, 50], "y": [-50, 50], "z": [-50, 50]}
    rows = recorded(reader, tmp_path, {**PLAIN, "robot_variation": {**EXACT, "additional_bias": bias}}, turns=False)
    offset = rows["mag_x"] - (425 + 160 * np.cos(rows["angle"]))
    by_robot = offset.groupby(rows["robot_id"])
    assert by_robot.mean().nunique() == 3
    assert by_robot.std().max() < 0.01
    assert by_robot.mean().abs().max() < 51


def run_bytes(reader: Path, folder: Path, settings: dict[str, Any]) -> bytes:
    assert run(reader, folder, settings).code == 0
    return (folder / "data.feather").read_bytes()


def test_bytes_are_the_same_with_any_number_of_threads(reader: Path, tmp_path: Path) -> None:
    variation = {"additional_bias": {"x": [-9, 9]}, "signal_gain": [0.9, 1.1], "noise_stddev": {"y": [2, 5]}}
    for timing in ("at_once", "robot"):
        settings = {
            "objects.robots.nb": 40,
            "simulation_time": 1,
            "arena_surface": 4e6,
            "magnetometer": {"timing": timing, "robot_variation": variation},
        }
        one, two = (
            run_bytes(reader, tmp_path / f"{timing}{threads}", {**settings, "threads": threads}) for threads in (1, 2)
        )
        assert one == two


def test_other_numbers_are_the_same_with_or_without_a_magnetometer(reader: Path, tmp_path: Path) -> None:
    noise = {"objects.robots.linear_noise_stddev": 0.5, "objects.robots.angular_noise_stddev": 1.0}
    frames = []
    for enabled in (True, False):
        result = run(reader, tmp_path / str(enabled), {**noise, "objects.robots.magnetometer_enabled": enabled})
        assert result.code == 0
        assert f"[PRINTF] magnetometer: {int(enabled)}" in result.output
        frames.append(result.frame())
    assert set(frames[1]["status"]) == {-1, 1}
    assert set(frames[1]["mag_x"]) == {0}  # untouched
    pd.testing.assert_frame_equal(frames[0][["x", "y", "angle"]], frames[1][["x", "y", "angle"]])


def test_random_seed_changes_the_readings_alone(reader: Path, tmp_path: Path) -> None:
    rows = [recorded(reader, tmp_path / str(seed), {"random_seed": seed}, turns=False) for seed in (5, 5, 2**64 - 1)]
    pd.testing.assert_frame_equal(rows[0], rows[1])
    assert (rows[0]["mag_x"] != rows[2]["mag_x"]).mean() > 0.5
    pd.testing.assert_frame_equal(rows[0][["x", "y", "angle"]], rows[2][["x", "y", "angle"]])


@pytest.mark.parametrize("kind", ["pogobject", "membrane"])
def test_other_objects_have_none(reader: Path, tmp_path: Path, kind: str) -> None:
    others = {"type": kind, "nb": 1, "geometry": "disk", "radius": 80, "x": 500, "y": 500}
    result = run(reader, tmp_path, {**APART, "objects.robots.nb": 0, "objects.others": others})
    assert result.code == 0, result.text
    assert "[PRINTF] magnetometer: 0" in result.output
    assert result.frame()["status"].iloc[-1] == 1


def test_on_a_robot_programs_wait_for_new_data(reader: Path, tmp_path: Path) -> None:
    result = run(
        reader, tmp_path, {**APART, "magnetometer": {"timing": "robot"}, "simulation_time": 4, "save_data_period": 0.02}
    )
    assert (result.code, result.errors) == (0, "")
    rows = result.frame()
    waited = rows.loc[rows["time"] > 0.1, "waited_ms"]
    assert 0 < waited.mean() < 20
    assert waited.max() <= 20
    assert set(rows.loc[rows["time"] > 0.1, "status"]) == {0}


@pytest.mark.parametrize(("timing", "status"), [("robot", 1), ("at_once", 0)])
def test_timeout_of_zero_reads_nothing_on_a_robot(reader: Path, tmp_path: Path, timing: str, status: int) -> None:
    given = {"magnetometer": {"timing": timing}, "parameters": {"timeout_ms": 0}, "simulation_time": 0.5}
    result = run(reader, tmp_path, given)
    rows = result.frame()
    assert set(rows.loc[rows["time"] > 0.1, "status"]) == {status}
    assert result.errors.count("magn_read_XYZ() is called again and again with timeout_ms 0") == (timing == "at_once")


DISCARDS = """#include "pogobase.h"
typedef struct { int16_t x, y, z; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
static void user_init(void) {}
static void user_step(void) {
    magn_read_XYZ(&mydata->x, &mydata->y, &mydata->z, 0);
    magn_read_XYZ(&mydata->x, &mydata->y, &mydata->z, 20);
}
int main(void) { pogobot_init(); pogobot_start(user_init, user_step); return 0; }
"""


def test_program_that_discards_old_data_before_it_waits_has_no_warning(tmp_path: Path) -> None:
    result = run(compile_text(tmp_path, DISCARDS), tmp_path, {"simulation_time": 0.5})
    assert (result.code, result.errors) == (0, "")


def test_program_of_the_sdk_reads_it(tmp_path: Path) -> None:
    program = compile_program(tmp_path / "prog", PROGRAMS / "magnetometer_sdk.c", package="pogosim-sdk")
    result = run(program, tmp_path, {"objects.robots.nb": 2, "simulation_time": 1})
    assert (result.code, result.errors) == (0, ""), result.text
    assert result.output.count("check 0, init 1") == 2
    assert result.output.count("read ") > 150


def test_pose_outside_the_domain_ends_the_run_if_asked(reader: Path, tmp_path: Path) -> None:
    domain = {"x": [0, 700], "policy": "throw"}
    result = run(reader, tmp_path, {**APART, **POSES, "magnetometer": {"domain": domain}})
    assert result.code == 2
    assert "robot #1 of category 'robots'" in result.errors
    assert "magn_read_XYZ(): the pose x 800.0 mm, y 300.0 mm, heading -114.6 degrees is outside" in result.errors
    result = run(reader, tmp_path, {**APART, **POSES, "magnetometer": {"domain": {**domain, "policy": "clamp"}}})
    assert result.code == 0


WRONG: dict[str, tuple[str, dict[str, Any], str]] = {
    "no file": ("", {"file": "absent.csv"}, "there is no file 'absent.csv'; searched"),
    "folder": ("", {"file": "."}, "magnetometer.csv.file: '.' is a folder; expected a file"),
    "no column": ("heading,mag_x,mag_y,mag_z\n1,2,3,4\n", {}, "there is no column 'angle'"),
    "misspelt column": (
        "angle,mag_x,mag_y,magz\n1,2,3,4\n",
        {},
        "'mag_z' in 'angle,mag_x,mag_y,magz'; did you mean 'magz'?",
    ),
    "empty": ("", {}, "has 0 valid rows at 0 different headings"),
    "header alone": ("angle,mag_x,mag_y,mag_z\n", {}, "has 0 valid rows"),
    "too few rows": ("angle,mag_x,mag_y,mag_z\n0,1,2,3\n90,1,2,3\n", {}, "needs at least 5, all around the turn"),
    "one heading": ("angle,mag_x,mag_y,mag_z\n" + "90,1,2,3\n" * 9, {}, "has 9 valid rows at 1 different heading;"),
    "a turn further is no other heading": (
        "angle,mag_x,mag_y,mag_z\n" + "".join(f"{360 * i},1,2,3\n" for i in range(9)),
        {},
        "at 1 different heading;",
    ),
    "radians": (
        "angle,mag_x,mag_y,mag_z\n" + "".join(f"{math.radians(5 * i):.4f},1,2,3\n" for i in range(72)),
        {},
        "at 72 different headings; these cover 6 of 360 degrees, and a curve of harmonic_order 2 needs at least 5, all "
        "around the turn. If the table has radians, set magnetometer.csv.input_angle_unit to radians.",
    ),
    "semicolons": (
        "angle;mag_x;mag_y;mag_z\n1;2;3;4\n",
        {},
        """there is no column 'angle' in 'angle;mag_x;mag_y;mag_z'. Set magnetometer.csv.delimiter to ";"\n""",
    ),
    "tabs": ("angle\tmag_x\tmag_y\tmag_z\n", {}, 'Set magnetometer.csv.delimiter to "\\t"\n'),
    "other names": (
        "heading,mx,my,mz\n1,2,3,4\n",
        {},
        "Name the columns in magnetometer.csv.columns, perhaps as {angle: 'heading', x: 'mx', y: 'my', z: 'mz'}\n",
    ),
    "numbers alone": ("1,2,3,4\n", {}, "These are numbers: set magnetometer.csv.has_header to false\n"),
    "decimal commas": (
        "angle;mag_x;mag_y;mag_z\n0,5;1;2;3\n",
        {"delimiter": ";", "skip_invalid_rows": False},
        "found '0,5;1;2;3' (write 0.5 for 0,5)",
    ),
    "semicolons without a header": (
        "0.5;1;2;3\n",
        {"has_header": False, "skip_invalid_rows": False},
        """found '0.5;1;2;3' (perhaps magnetometer.csv.delimiter: ";")""",
    ),
    "invalid row": (
        "angle,mag_x,mag_y,mag_z\n0,1,2,3\n# more\n10,1,x,3\n",
        {"skip_invalid_rows": False},
        "table.csv:4: expected numbers for angle, x, y and z, found '10,1,x,3'",
    ),
    "reading that is none": (
        "angle,mag_x,mag_y,mag_z\n0,1,2,1e200\n",
        {"skip_invalid_rows": False},
        "table.csv:2: expected an angle up to a million and readings of 16 bits, from -32768 to 32767, found '0,1,2,1e",
    ),
    "open quotes": ('angle,mag_x,mag_y,mag_z\n0,"1,2,3\n', {}, "table.csv:2: a text in double quotes begins"),
}


def table_run(reader: Path, folder: Path, text: str, csv: dict[str, Any]) -> Run:
    """Run with a table of this text beside the configuration; empty: there is none, or it is empty."""
    folder.mkdir(exist_ok=True)
    (folder / "table.csv").write_text(text, encoding="utf-8")
    magnetometer = {"source": "csv", "csv": {"file": "table.csv", **csv}}
    return run(reader, folder, {"magnetometer": magnetometer, "simulation_time": 0.1})


@pytest.mark.parametrize("name", WRONG)
def test_table_that_determines_no_curve_is_refused(reader: Path, tmp_path: Path, name: str) -> None:
    text, csv, expected = WRONG[name]
    result = table_run(reader, tmp_path, text, csv)
    assert result.code == 2, result.text
    assert expected in result.errors
    assert len(result.errors.splitlines()) == 1
    assert not (tmp_path / "data.feather").exists()


def rows_of_table(separator: str = ",") -> list[str]:
    return [
        separator.join(
            [str(10 * i), *(f"{400 + 100 * f(math.radians(-10 * i)):.0f}" for f in (math.cos, math.sin)), "5"]
        )
        for i in range(36)
    ]


KINDS: dict[str, tuple[str, dict[str, Any]]] = {
    "plain": ("\n".join(["angle,mag_x,mag_y,mag_z", *rows_of_table()]), {}),
    "mark": ("\ufeff" + "\n".join(["angle,mag_x,mag_y,mag_z", *rows_of_table()]), {}),
    "quotes": ("\n".join(['"angle","mag_x","mag_y","mag_z"', *rows_of_table()]), {}),
    "windows": ("\r\n".join(["angle,mag_x,mag_y,mag_z", *rows_of_table()]), {}),
    "semicolons": ("\n".join(["angle;mag_x;mag_y;mag_z", *rows_of_table(";")]), {"delimiter": ";"}),
    "tabs": ("\n".join(["angle\tmag_x\tmag_y\tmag_z", *rows_of_table("\t")]), {"delimiter": "\t"}),
    "no header": ("\n".join(rows_of_table()), {"has_header": False}),
    "comments": ("\n".join(["% mine", "angle,mag_x,mag_y,mag_z", *rows_of_table()]), {"comment_prefix": "%"}),
    "more columns": (
        "\n".join(["id,angle,mag_x,mag_y,mag_z,text", *(f'7,{row},"a, b"' for row in rows_of_table())]),
        {},
    ),
    "names": ("\n".join(["a,mag_x,mag_y,mag_z", *rows_of_table()]), {"columns": {"angle": "a"}}),
    "places": (
        "\n".join(f"7,{row}" for row in rows_of_table()),
        {"has_header": False, "column_indices": {"angle": 1, "x": 2, "y": 3, "z": 4}},
    ),
}


@pytest.mark.parametrize("name", KINDS)
def test_tables_of_all_kinds_are_read(reader: Path, tmp_path: Path, name: str) -> None:
    result = table_run(reader, tmp_path, *KINDS[name])
    assert (result.code, result.errors) == (0, ""), result.text
    assert "2 harmonics fitted to 36 rows of 'table.csv'; root mean square of the residuals: x 0." in result.output


def test_rows_that_are_not_numbers_are_skipped_and_told_once(reader: Path, tmp_path: Path) -> None:
    text = "\n".join(["angle,mag_x,mag_y,mag_z", *rows_of_table(), "10,,,", "", "1,2,3", "5,1e999,2,3"])
    result = table_run(reader, tmp_path, text, {})
    assert result.code == 0
    assert "fitted to 36 rows" in result.output
    (warning,) = result.errors.splitlines()
    assert "table.csv:38: expected numbers for angle, x, y and z, found '10,,,'; 3 such rows are skipped" in warning


@pytest.mark.parametrize("row", ["10,1e200,2,3", "10,1,-32769,3", "10,1,2,32768", "1e308,1,2,3"])
def test_rows_that_no_sensor_can_have_measured_are_skipped(reader: Path, tmp_path: Path, row: str) -> None:
    result = table_run(reader, tmp_path, "\n".join(["angle,mag_x,mag_y,mag_z", *rows_of_table(), row]), {})
    assert result.code == 0
    assert "fitted to 36 rows of 'table.csv'; root mean square of the residuals: x 0." in result.output
    expected = "table.csv:38: expected an angle up to a million and readings of 16 bits, from -32768 to 32767, found"
    assert f"{expected} '{row}'; this row is skipped" in result.errors


def test_each_axis_has_the_noise_of_its_own_residuals(reader: Path, tmp_path: Path) -> None:
    def reading(heading: int, sign: int) -> str:
        x, y = 400 + 100 * math.cos(math.radians(heading)), 400 - 100 * math.sin(math.radians(heading))
        return f"{heading},{x},{y + 20 * sign},{400 + 5 * sign}"

    rows = [reading(10 * i, sign) for i in range(36) for sign in (-1, 1)]
    (tmp_path / "table.csv").write_text("\n".join(["angle,mag_x,mag_y,mag_z", *rows]))
    table = {"source": "csv", "csv": {"file": str(tmp_path / "table.csv")}, "robot_variation": EXACT}
    found = recorded(reader, tmp_path, table, turns=False, simulation_time=20).groupby("robot_id")
    assert found["mag_x"].std().to_numpy() == pytest.approx(0, abs=0.6)
    assert found["mag_y"].std().to_numpy() == pytest.approx(20, rel=0.15)
    assert found["mag_z"].std().to_numpy() == pytest.approx(5, rel=0.15)


def angle_of(row: str) -> int:
    return int(row.partition(",")[0])


HALVES = [
    ("below a half turn", [row for row in rows_of_table() if angle_of(row) <= 180], 180),
    ("a sector is missing", [row for row in rows_of_table() if not 45 <= angle_of(row) <= 215], 180),
    ("a quarter is missing", [row for row in rows_of_table() if not 0 < angle_of(row) < 100], 100),
]


@pytest.mark.parametrize(("rows", "gap"), [half[1:] for half in HALVES], ids=[half[0] for half in HALVES])
def test_headings_on_one_side_are_a_warning(reader: Path, tmp_path: Path, rows: list[str], gap: int) -> None:
    result = table_run(reader, tmp_path, "\n".join(["angle,mag_x,mag_y,mag_z", *rows]), {})
    assert result.code == 0, result.text
    (warning,) = result.errors.splitlines()
    assert f"magnetometer.csv.file: 'table.csv' has no readings in {gap} of 360 degrees, where" in warning
    assert "radians" not in warning


def test_headings_all_around_the_turn_are_enough(reader: Path, tmp_path: Path) -> None:
    rows = [row for row in rows_of_table() if angle_of(row) % 90 == 0]
    result = table_run(reader, tmp_path, "\n".join(["angle,mag_x,mag_y,mag_z", *rows]), {"harmonic_order": 1})
    assert (result.code, result.errors) == (0, "")


def test_table_of_headings_that_count_the_other_way_is_a_warning(reader: Path, tmp_path: Path) -> None:
    rows = [f"{-angle_of(row)},{row.partition(',')[2]}" for row in rows_of_table()]
    result = table_run(reader, tmp_path, "\n".join(["angle,mag_x,mag_y,mag_z", *rows]), {})
    assert result.code == 0
    (warning,) = result.errors.splitlines()
    assert "as the headings of 'table.csv' grow, x and y run around their ellipse the other way" in warning


@pytest.mark.parametrize(
    ("columns", "keys", "what"),
    [
        ("{0},400,400,400", {}, "hardly depend on the heading"),
        ("{0},{1},400,400", {}, "move along a line, not around an ellipse"),
        ("{0},{1},{2},400", {"input_angle_unit": "radians"}, "hardly depend on the heading"),
    ],
    ids=["constant", "a line", "degrees for radians"],
)
def test_table_whose_readings_do_not_tell_headings_is_a_warning(
    reader: Path, tmp_path: Path, columns: str, keys: dict[str, object], what: str
) -> None:
    rows = [columns.format(*row.split(",")) for row in rows_of_table()]
    result = table_run(reader, tmp_path, "\n".join(["angle,mag_x,mag_y,mag_z", *rows]), keys)
    assert result.code == 0
    (warning,) = result.errors.splitlines()
    assert f"x and y of 'table.csv' {what}, so robots cannot tell headings by them" in warning
    assert ("If the table has degrees, set magnetometer.csv.input_angle_unit to degrees." in warning) == bool(keys)


def test_columns_that_are_read_twice_are_a_warning(reader: Path, tmp_path: Path) -> None:
    rows = [f"{row},7" for row in rows_of_table()]
    text = "\n".join(["angle,mag_x,mag_y,mag_z,mag_x", *rows])
    result = table_run(reader, tmp_path, text, {})
    (warning,) = result.errors.splitlines()
    assert warning.endswith("table.csv: the column 'mag_x' stands there several times; the first one is read")
    text = text.replace(",mag_x\n", "\n")
    result = table_run(reader, tmp_path, text, {"columns": {"z": "mag_y"}})
    (warning,) = result.errors.splitlines()
    assert "table.csv: y and z are read from the same column, number 2 from 0 on" in warning


@pytest.mark.parametrize("count", [1, 3])
def test_outliers_of_a_table_are_named(reader: Path, tmp_path: Path, count: int) -> None:
    rows = rows_of_table()
    for i in range(count):
        rows[7 + 11 * i] = f"{70 + 110 * i},9999,{350 + i},5"
    result = table_run(reader, tmp_path, "\n".join(["angle,mag_x,mag_y,mag_z", *rows]), {})
    assert result.code == 0
    (warning,) = result.errors.splitlines()
    more = "" if count == 1 else ", like 2 more"
    assert f"table.csv:9: 9999, 350, 5 is far from the curve of the other rows{more}; it distorts the fit" in warning
    assert "the noise of all robots larger" in warning
    rows[7] = "70,434,330,5"  # 24 counts beside the curve
    for i in range(1, count):
        rows[7 + 11 * i] = rows_of_table()[7 + 11 * i]
    result = table_run(reader, tmp_path, "\n".join(["angle,mag_x,mag_y,mag_z", *rows]), {})
    assert "table.csv:9: 434, 330, 5 is far from the curve" in result.errors


def test_data_file_does_not_replace_the_table(reader: Path, tmp_path: Path) -> None:
    table = tmp_path / "table.csv"
    table.write_text(KINDS["plain"][0])
    csv = {"source": "csv", "csv": {"file": "table.csv"}}
    result = run(reader, tmp_path, {"magnetometer": csv, "data_filename": "table.csv"})
    assert result.code == 2
    assert "magnetometer.csv.file" in result.errors
    assert table.read_text() == KINDS["plain"][0]


def test_python_sees_what_was_read_last(tmp_path: Path) -> None:
    shared = compile_program(tmp_path / "magnetometer.so", PROGRAMS / "magnetometer.c", flags=SHARED)
    given = {**APART, **POSES, "magnetometer": PLAIN, "parameters": {"turns": False}}
    given["arena_file"] = str(ROOT / "arenas" / "square.csv")
    with Simulation(shared, write_scene(tmp_path, given)) as simulation:
        assert simulation.magnetometer.shape == (3, 3)
        assert simulation.magnetometer_samples.tolist() == [0, 0, 0]
        assert simulation.objects[0].magnetometer is None
        simulation.step(20)
        assert simulation.magnetometer_samples.min() > 5
        expected = 425 + 160 * np.cos(simulation.headings)
        assert np.allclose(simulation.magnetometer[:, 0], expected, atol=0.51)
        assert simulation.objects[1].magnetometer == tuple(simulation.magnetometer[1].tolist())
        data = simulation.user_data
        assert simulation.magnetometer[:, 2].tolist() == data["z"].tolist()


def test_batch_finds_a_table_beside_its_configuration(reader: Path, tmp_path: Path) -> None:
    beside = tmp_path / "study"
    beside.mkdir()
    (beside / "table.csv").write_text(KINDS["plain"][0])
    gain = {"batch_options": [[1], [0.5]], "default_option": [1]}
    csv = {"source": "csv", "csv": {"file": "table.csv"}, "robot_variation": {**EXACT, "signal_gain": gain}}
    given = {**APART, **POSES, "magnetometer": csv, "parameters": {"turns": False}, "simulation_time": 0.3}
    given["arena_file"] = str(ROOT / "arenas" / "square.csv")
    path = write_scene(beside, {**given, "result_new_columns": ["magnetometer.robot_variation.signal_gain"]})
    work = tmp_path / "work"
    work.mkdir()
    result = pogosim(work, "batch", "-c", str(path), "-S", str(reader), "-r", "1", "-o", "results")
    assert result.code == 0, result.text
    rows = pd.read_feather(next((work / "results").glob("*.feather")))
    last = rows[rows["time"] > 0.1]
    spread = last.groupby("signal_gain" if "signal_gain" in last else last.columns[0])["mag_x"].agg(np.ptp)
    assert len(spread) == 2


def test_configuration_in_the_metadata_gives_the_same_run(reader: Path, tmp_path: Path) -> None:
    model = {**PLAIN, "angle_unit": "radians", "robot_variation": {"angle_offset": [-0.3, 0.3]}}
    first = run(reader, tmp_path / "first", {**APART, "magnetometer": model})
    resolved = load_dataframe(tmp_path / "first" / "data.feather")[1]["resolved_configuration"]
    (tmp_path / "resolved.yaml").write_text(yaml.safe_dump(resolved, sort_keys=False))
    again = run_command(reader, tmp_path, ["-c", "resolved.yaml", "-g", "--strict"])
    assert (first.code, again.code, again.errors) == (0, 0, ""), again.text
    pd.testing.assert_frame_equal(first.frame(), again.frame())


def test_shipped_configuration_is_of_robots_that_differ(reader: Path, tmp_path: Path) -> None:
    files = ["data_filename=data.feather", "console_filename=console.txt", "frames_name=f{:010.4f}.png"]
    arguments = [word for setting in (*files, "simulation_time=1.5") for word in ("--set", setting)]
    shipped = str(ROOT / "conf" / "magnetometer.yaml")
    result = run_command(reader, tmp_path, ["-c", shipped, "-g", "--strict", *arguments])
    assert (result.code, result.errors) == (0, ""), result.text
    rows = result.frame()
    last = rows[rows["time"] == rows["time"].max()]
    assert set(last["status"]) == {0}
    assert last["mag_z"].nunique() > 5
    assert last[["mag_x", "mag_y"]].stack().between(200, 650).all()
