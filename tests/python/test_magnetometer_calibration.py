"""`pogosim calibrate magnetometer` recovers the curve of a table, and says what a table cannot tell."""

from __future__ import annotations

import math
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
import yaml
from pogosim.calibration.command import main
from pogosim.calibration.tracks import Floats
from pogosim.errors import CalibrationError
from pogosim.magnetometer.block import configuration_block, noise_lines, phase_near
from pogosim.magnetometer.fit import CurveFit, basis, ellipse_errors, ellipse_of, fit_curve
from pogosim.magnetometer.table import ReadingTable, read_reading_table
from running import ROOT, example, run

REFERENCE = ROOT / "conf" / "example_magnetometer_reference.csv"
HEADINGS = np.radians(np.arange(0.0, 360.0, 5.0))


def coefficients(major: float, minor: float, rotation: float, phase: float) -> Floats:
    """Return the coefficients of an ellipse with a second harmonic."""
    cosine, sine = math.cos(rotation), math.sin(rotation)
    matrix = np.array([[cosine, -sine], [sine, cosine]]) @ np.diag([major, minor])
    matrix = matrix @ [[math.cos(phase), -math.sin(phase)], [math.sin(phase), math.cos(phase)]]
    return np.array(
        [[425.0, 410.0, 400.0], [*matrix[:, 0], 15.0], [*matrix[:, 1], -10.0], [12.0, -6.0, 0.0], [0.0, 4.0, 0.0]]
    )


def table(of: Floats, noise: float = 0.0, headings: Floats = HEADINGS, field: float = 0.0) -> ReadingTable:
    readings = basis(field - headings, (len(of) - 1) // 2) @ of
    draws = np.random.default_rng(3)
    return ReadingTable(headings, readings + noise * draws.standard_normal(readings.shape), "table.csv")


def written(folder: Path, rows: Sequence[str], header: str = "angle,mag_x,mag_y,mag_z") -> Path:
    path = folder / "table.csv"
    path.write_text("\n".join([*([header] if header else []), *rows]) + "\n", encoding="utf-8")
    return path


def lines_of(readings: ReadingTable, separator: str = ",") -> list[str]:
    return [
        separator.join([f"{math.degrees(angle):.6f}", *(f"{count:.4f}" for count in counts)])
        for angle, counts in zip(readings.angle_rad, readings.reading, strict=True)
    ]


def called(folder: Path, *arguments: object) -> int:
    return main(["magnetometer", *map(str, arguments), "--picture", str(folder / "picture.png")])


@pytest.mark.parametrize("rotation", [0.3, -1.2])
@pytest.mark.parametrize("phase", [0.0, 2.5])
def test_fit_recovers_the_ellipse(rotation: float, phase: float) -> None:
    of = coefficients(160.0, 140.0, rotation, phase)
    fitted = fit_curve(table(of), 2, 0.0)
    assert np.allclose(fitted.coefficients, of, atol=1e-9)
    ellipse = ellipse_of(fitted.coefficients)
    assert np.allclose([ellipse.major, ellipse.minor], [160.0, 140.0])
    # Half a turn of the axis and of the phase is the same ellipse.
    assert abs(math.remainder(ellipse.rotation - rotation, math.pi)) < 1e-9
    assert abs(math.remainder(ellipse.rotation + ellipse.phase - rotation - phase, 2.0 * math.pi)) < 1e-9


def test_standard_errors_are_those_of_repeated_fits() -> None:
    of = coefficients(160.0, 140.0, 0.3, 0.1)
    draws = np.random.default_rng(8)
    clean = table(of)
    fits = [
        fit_curve(ReadingTable(HEADINGS, clean.reading + 3.0 * draws.standard_normal(clean.reading.shape), ""), 2, 0.0)
        for _ in range(200)
    ]
    for of_one, name in ((0, "major"), (2, "rotation")):
        found = [getattr(ellipse_of(one.coefficients), name) for one in fits]
        claimed = np.mean([getattr(ellipse_errors(one), name) for one in fits])
        assert np.std(found) == pytest.approx(claimed, rel=0.2), of_one
    assert np.std([one.coefficients[0, 0] for one in fits]) == pytest.approx(fits[0].errors()[0, 0], rel=0.15)
    assert np.mean([one.noise for one in fits]) == pytest.approx(3.0, rel=0.02)


def test_field_elsewhere_changes_the_angle_alone() -> None:
    of = coefficients(160.0, 140.0, 0.3, 0.1)
    assert np.allclose(fit_curve(table(of, field=1.2), 2, 1.2).coefficients, of)


def curve_of_block(block: str, angle_rad: Floats) -> Floats:
    """Readings as the formulas of docs/magnetometer.md give them."""
    model = yaml.safe_load(block)["magnetometer"]["procedural"]
    own = {key: value[0] for key, value in model["ellipse"].items() if key != "center"}
    rotation, phase = math.radians(own["ellipse_rotation"]), math.radians(own["sensor_phase_offset"])
    along, across = own["major_radius"], own["minor_radius"]
    rows = [
        [model["ellipse"]["center"][axis][0] for axis in "xyz"],
        [along * math.cos(rotation), along * math.sin(rotation), own["z_cos_amplitude"]],
        [-across * math.sin(rotation), across * math.cos(rotation), own["z_sin_amplitude"]],
    ]
    for harmonic in model["distortion_harmonics"]:
        rows += [[harmonic[part][axis][0] for axis in "xyz"] for part in ("cos", "sin")]
    return np.asarray(basis(angle_rad + phase, (len(rows) - 1) // 2) @ np.array(rows))


@pytest.mark.parametrize("order", [1, 2, 3])
def test_block_describes_the_fitted_curve(order: int) -> None:
    fitted = fit_curve(table(coefficients(160.0, 140.0, 0.3, 0.9), noise=0.5), order, 0.0)
    angle = np.linspace(0.0, 6.0, 50)
    block = configuration_block(fitted, 0.0)
    assert np.allclose(
        curve_of_block(block, angle), fitted.readings(angle), atol=0.05 + 0.05 * float(fitted.noise.max())
    )
    assert block.count("- order:") == order - 1
    noise = yaml.safe_load(block)["magnetometer"]["robot_variation"]["noise_stddev"]
    assert [noise[axis][0] for axis in "xyz"] == pytest.approx(fitted.noise.tolist(), rel=0.02)


def test_command_prints_a_configuration_and_draws_the_ellipse(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "pogosim.command.main", "calibrate", "magnetometer", str(REFERENCE)]
    done = subprocess.run(
        [*command, "--harmonics", "3", "--field-angle", "30"], cwd=tmp_path, capture_output=True, text=True, timeout=120
    )
    assert (done.returncode, done.stderr) == (0, "")
    model = yaml.safe_load(done.stdout)["magnetometer"]
    assert model["world_field"] == {"magnetic_north_angle": 30}
    assert model["robot_variation"]["noise_stddev"]["x"][0] == pytest.approx(2.5, rel=0.15)
    assert "counts, +- " in done.stdout
    picture = matplotlib.image.imread(tmp_path / "magnetometer.png")
    assert picture.shape[0] > 300
    assert len(np.unique(picture.reshape(-1, picture.shape[2]), axis=0)) > 50  # something is drawn


def test_reference_table_is_that_of_its_script() -> None:
    done = subprocess.run(
        [sys.executable, "-c", "import make_magnetometer_reference as made; print(made.text(), end='')"],
        cwd=ROOT / "scripts",
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    assert done.stdout == REFERENCE.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("header", "separator"),
    [("angle,mag_x,mag_y,mag_z", ","), ("Heading; MX; MY; MZ", ";"), ("", ","), ("\ufeffangle\tx\ty\tz", "\t")],
)
def test_tables_of_several_kinds_are_read(header: str, separator: str, tmp_path: Path) -> None:
    own = table(coefficients(160.0, 140.0, 0.3, 0.1))
    path = written(tmp_path, ["# a comment", *lines_of(own, separator)], header)
    warnings: list[str] = []
    read = read_reading_table(path, None, False, warnings.append)
    assert not warnings
    assert np.allclose(read.angle_rad, own.angle_rad, atol=1e-6)
    assert np.allclose(read.reading, own.reading, atol=1e-3)


def test_angles_of_at_most_a_turn_in_radians_are_radians(tmp_path: Path) -> None:
    own = table(coefficients(160.0, 140.0, 0.3, 0.1))
    rows = [f"{angle:.6f},{x},{y},{z}" for angle, (x, y, z) in zip(own.angle_rad, own.reading, strict=True)]
    path = written(tmp_path, rows)
    assert np.allclose(read_reading_table(path, None, False, print).angle_rad, HEADINGS, atol=1e-5)
    assert np.allclose(read_reading_table(path, "degrees", True, print).angle_rad, -np.radians(HEADINGS), atol=1e-5)


def test_rows_that_are_not_numbers_are_left_out_with_a_warning(tmp_path: Path) -> None:
    own = lines_of(table(coefficients(160.0, 140.0, 0.3, 0.1)))
    warnings: list[str] = []
    path = written(tmp_path, [*own, "10,?,4,5", "20,inf,1,2"])
    assert len(read_reading_table(path, None, False, warnings.append).reading) == len(own)
    assert len(warnings) == 1
    assert "2 of 74 rows are not four numbers" in warnings[0]
    assert "10, ?, 4, 5" in warnings[0]


# What a run reads with source: csv, with other bytes around the rows, or with rows among them that it skips.
READ_BY_RUNS: dict[str, tuple[bytes, bytes, str]] = {
    "a field too many": (b"", b"15,1,2,3,4\n", ""),
    "Latin-1 in a comment": (b"# turned by Andr\xe9\n", b"", ""),
    "Latin-1 in a comment below": (b"", b'  # "10 \xb0, by hand\n', ""),
    "a stray byte": (
        b"",
        b"15,1,\xff2,3\n",
        "1 of 73 rows are not four numbers, an angle and readings of 16 bits, and "
        "are left out; the first one, in line 74, is 15, 1, \\xff2, 3",
    ),
    "too few fields": (
        b"\n\n",
        b"15,1,2\n15\n",
        "2 of 74 rows are not four numbers, an angle and readings of 16 bits, "
        "and are left out; the first one, in line 76, is 15, 1, 2",
    ),
    "a comment behind a row": (b"", b"15,1,2,3 # by hand\n", "in line 74, is 15, 1, 2, 3 # by hand"),
    "what Python takes for numbers": (b"", b"1_5,1,2,3\n15,nan,2,3\n15,+-1,2,3\n", "3 of 75 rows are not"),
    "line ends in quotes": (b"", b'"15",1,2,3,"by\nhand, ""slowly"""\n\n15,1,2,?', "in line 77, is 15, 1, 2, ?"),
    "blank lines and blanks": (b"\n \t\n", b"\t \r\n 15 ,\t1,2, 3\r\r", ""),
}


@pytest.mark.parametrize("name", READ_BY_RUNS)
def test_tables_are_read_by_the_rules_of_runs(name: str, tmp_path: Path) -> None:
    before, after, expected = READ_BY_RUNS[name]
    own = lines_of(table(coefficients(160.0, 140.0, 0.3, 0.1)))
    path = tmp_path / "table.csv"
    path.write_bytes(before + "\n".join(["angle,mag_x,mag_y,mag_z", *own, ""]).encode() + after)
    warnings: list[str] = []
    read = read_reading_table(path, None, False, warnings.append)
    assert len(warnings) == bool(expected)
    assert expected in "".join(warnings)
    assert len(read.reading) - len(own) in (0, 1)
    # As many rows are left out as a run skips.
    settings = {"magnetometer": {"source": "csv", "csv": {"file": str(path)}}}
    done = run(example("helloworld"), tmp_path, settings, ["-v"])
    assert f"fitted to {len(read.reading)} rows" in done.output + done.errors
    assert ("skipped" in done.errors) == bool(expected)


def test_column_that_is_there_twice_is_a_warning_and_the_first_one_is_read(tmp_path: Path) -> None:
    own = table(coefficients(160.0, 140.0, 0.3, 0.1))
    path = written(tmp_path, [f"{row},7" for row in lines_of(own)], "angle,mag_x,mag_y,mag_z,Mag_X")
    warnings: list[str] = []
    read = read_reading_table(path, None, False, warnings.append)
    assert np.allclose(read.reading, own.reading, atol=1e-3)
    assert warnings == [f"{path}: the column 'mag_x' stands there several times; the first one is read"]


def test_quotes_that_do_not_end_are_refused_with_their_line(tmp_path: Path) -> None:
    path = written(tmp_path, [*lines_of(table(coefficients(160.0, 140.0, 0.3, 0.1))), '15,"1"",2,3', "20,1,2,3"])
    with pytest.raises(CalibrationError, match=r"table\.csv:74: a text in double quotes begins on this line and does"):
        read_reading_table(path, None, False, pytest.fail)


@pytest.mark.parametrize("row", ["1e308,1,2,3", "10,1e308,2,3", "10,1,-32769,3", "10,1,2,32768", "10,1,2,-inf"])
def test_rows_that_no_sensor_can_have_measured_are_left_out(row: str, tmp_path: Path) -> None:
    own = lines_of(table(coefficients(160.0, 140.0, 0.3, 0.1)))
    warnings: list[str] = []
    path = written(tmp_path, [*own[:9], row, *own[9:]])
    assert len(read_reading_table(path, None, False, warnings.append).reading) == len(own)
    assert len(warnings) == 1
    assert "1 of 73 rows are not four numbers, an angle and readings of 16 bits, and are left out" in warnings[0]


@pytest.mark.parametrize("text", ["," * 100000, "angle,mag_x,mag_y,mag_z\n" + "x," * 100000, "x" * 100000 + ",b\n1,2"])
def test_long_lines_are_refused_soon_and_not_repeated(text: str, tmp_path: Path) -> None:
    path = written(tmp_path, [text], header="")
    with pytest.raises(CalibrationError) as refused:
        read_reading_table(path, None, False, pytest.fail)
    assert len(str(refused.value)) < 500 + len(str(path))


OWN = lines_of(table(coefficients(160.0, 140.0, 0.3, 0.1), noise=2.0))
MIRRORED = coefficients(160.0, 140.0, 0.3, 0.1) * [1.0, -1.0, 1.0]
FLAT = ReadingTable(HEADINGS, np.random.default_rng(1).normal(400.0, 3.0, (72, 3)), "")

WRONG: dict[str, tuple[list[str], str, str]] = {
    "empty": ([], "", "is empty"),
    "header alone": ([], "angle,mag_x,mag_y,mag_z", "no row of four numbers"),
    "no column of y": (OWN, "angle,mag_x,other,mag_z", "no column mag_y; expected the columns angle, mag_x"),
    "three columns": ([row.rpartition(",")[0] for row in OWN], "", "3 columns and no header"),
    "words": (["north,a,b,c"], "angle,mag_x,mag_y,mag_z", "no row of four numbers"),
    "too few": (OWN[:5], "angle,mag_x,mag_y,mag_z", "5 rows at 5 different headings, which cover 20 of 360 degrees"),
    "one heading": ([f"90,{i},{i + 1},3" for i in range(50)], "angle,mag_x,mag_y,mag_z", "1 different headings"),
    "far too large": (
        [f"{5 * i},1e308,-1e308,1e308" for i in range(72)],
        "angle,mag_x,mag_y,mag_z",
        "readings of 16 bits",
    ),
    "narrow": ([f"{i / 10},{i % 7},{i % 5},3" for i in range(90)], "angle,mag_x,mag_y,mag_z", "cover 9 of 360"),
    "no signal": (lines_of(FLAT), "angle,mag_x,mag_y,mag_z", "hardly depend on the heading"),
    "a line": (
        [f"{row.rpartition(',')[0].rpartition(',')[0]},400,400" for row in OWN],
        "angle,mag_x,mag_y,mag_z",
        "x and y move along a line as the robot turns",
    ),
    "constant": ([f"{5 * i},400,400,400" for i in range(72)], "angle,mag_x,mag_y,mag_z", "hardly depend"),
    "half a turn": (OWN[:37], "angle,mag_x,mag_y,mag_z", "no readings in 180 of 360 degrees"),
    "a sector": ([*OWN[:9], *OWN[44:]], "angle,mag_x,mag_y,mag_z", "no readings in 180 of 360 degrees"),
    "decimal commas": (
        [row.replace(".", ",") for row in lines_of(table(coefficients(160.0, 140.0, 0.3, 0.1)), ";")],
        "angle;mag_x;mag_y;mag_z",
        "; write 0.5 for 0,5; expected the columns",
    ),
    "one wrong reading of a few": (
        [*OWN[0:48:6], "240,9999,400,425", *OWN[54::6]],
        "angle,mag_x,mag_y,mag_z",
        "table.csv: the reading 9999, 400, 425 at 240 degrees is far from the curve of the other rows; correct",
    ),
    "clockwise the other way": (lines_of(table(MIRRORED)), "angle,mag_x,mag_y,mag_z", "use its table with source: csv"),
    "y up": (lines_of(table(MIRRORED)), "angle,mag_x,mag_y,mag_z", "add --y-up"),
}


@pytest.mark.parametrize("name", WRONG)
def test_table_that_determines_no_ellipse_is_refused(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows, header, expected = WRONG[name]
    path = tmp_path / "table.csv"
    path.write_text("\n".join([*([header] if header else []), *rows]), encoding="utf-8")
    assert called(tmp_path, path) == 2
    output = capsys.readouterr()
    assert output.out == ""
    assert output.err.startswith("pogosim calibrate magnetometer: ")
    assert expected in output.err
    assert not (tmp_path / "picture.png").exists()


def test_outliers_are_a_warning_and_the_rest_is_fitted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = OWN.copy()
    for place in (10, 30, 50):
        angle, x, y, z = rows[place].split(",")
        rows[place] = f"{angle},{float(x) + 60:.0f},{y},{z}"
    assert called(tmp_path, written(tmp_path, rows)) == 0
    errors = capsys.readouterr().err
    assert len(errors.splitlines()) == 1
    assert " at 50 degrees is far from the curve of the other rows, like 2 more; correct or delete it" in errors
    assert called(tmp_path, written(tmp_path, OWN)) == 0
    assert capsys.readouterr().err == ""


def test_y_up_reads_what_would_be_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = written(tmp_path, lines_of(table(MIRRORED, noise=1.0)))
    assert called(tmp_path, path, "--y-up") == 0
    assert "magnetometer:" in capsys.readouterr().out


def test_circle_says_that_two_angles_are_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = written(tmp_path, lines_of(table(coefficients(150.0, 149.9, 0.0, 0.4), noise=3.0)))
    assert called(tmp_path, path) == 0
    assert "nearly a circle" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["absent.csv"], "absent.csv: no such file"),
        ([REFERENCE, "--harmonics", "0"], "whole number from 1 to 32"),
        ([REFERENCE, "--field-angle", "north"], "not a finite number"),
    ],
)
def test_wrong_arguments_are_named(
    arguments: list[object], expected: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        code: object = called(tmp_path, *arguments)
    except SystemExit as left:
        code = left.code
    assert code == 2
    assert expected in capsys.readouterr().err


def test_picture_does_not_replace_the_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = written(tmp_path, OWN)
    before = path.read_bytes()
    assert main(["magnetometer", str(path), "--picture", str(path)]) == 2
    assert "would be lost" in capsys.readouterr().err
    assert path.read_bytes() == before


def test_fit_that_has_no_unique_solution_is_refused() -> None:
    with pytest.raises(CalibrationError, match="4 different headings"):
        fit_curve(table(coefficients(160.0, 140.0, 0.3, 0.1), headings=np.repeat(HEADINGS[::18], 20)), 2, 0.0)


@pytest.mark.parametrize("turns", [-1, 0, 1, 2])
def test_phase_is_that_of_the_nearest_end_of_the_ellipse(turns: int) -> None:
    of = coefficients(100.0, 60.0, 0.3, 0.2)
    phase = ellipse_of(of).phase + turns * math.pi
    for near in (-0.4, 0.0, 0.4):
        assert phase_near(of, phase + near) == pytest.approx(phase)


def test_error_of_the_noise_is_that_of_the_readings_that_the_curve_leaves() -> None:
    # With n - k degrees of freedom: 2 / sqrt(2 (13 - 5)).
    of = coefficients(100.0, 60.0, 0.3, 0.2)
    fitted = CurveFit(of, np.eye(5), np.full(3, 2.0), np.zeros(13), np.zeros((13, 3)))
    assert noise_lines(fitted)[0].comment == "counts, +- 0.5, 0.5, 0.5"
