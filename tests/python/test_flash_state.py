"""Flash memory outlives a run in an archive (flash_state), which is written as a whole or not at all."""

from __future__ import annotations

import random
import re
import signal
import struct
import subprocess
import sys
from pathlib import Path

import pogosim
import pytest
import yaml
from batches import batch, write_options
from conftest import Compile
from display import Display, shown
from flash_files import EMPTY, FLASH, Record, archive, checksum, mark, written
from running import PROGRAMS, ROOT, Run, Settings, compile_program, run, run_command, start, write_scene
from searches import search, write_search

WALLS = {"type": "pogowall", "geometry": "arena", "nb": 1}
RECORD = len(archive([Record(0)])) - len(EMPTY)  # bytes, of category robots


def flash(
    program: Compile, folder: Path, kind: str, state: Settings, settings: Settings | None = None, *arguments: str
) -> Run:
    changes = {"parameters.kind": kind, "flash_state": dict(state), "enable_data_logging": False, **(settings or {})}
    return run(program("flash.c"), folder, changes, arguments)


def left_in(folder: Path) -> list[str]:
    """Return the files of a folder but for the configuration and the data file."""
    return sorted(path.name for path in folder.iterdir() if path.name not in ("scene.yaml", "data.feather"))


# ---- The layout ----


def test_archives_have_the_bytes_of_the_test_vectors() -> None:
    assert archive([]) == EMPTY
    record = Record(1, powers=(512, 600, 700))
    assert len(archive([record])) - len(EMPTY) == 1507355
    assert checksum(record.body) == 0x13BB686737A2BBAE


def test_archive_has_every_robot_by_category_and_id(program: Compile, tmp_path: Path) -> None:
    ball = {"type": "passive_object", "geometry": "disk", "radius": 30, "nb": 1}
    objects = {"walls": WALLS, "zebras": {"type": "pogobot", "nb": 1}, "robots": {"type": "pogobot", "nb": 3}}
    settings: Settings = {"objects": {**objects, "ball": ball, "Ants": {"type": "pogobot", "nb": 1}}}
    result = flash(program, tmp_path, "write", {"output_file": "a/b/x.flash"}, settings)
    assert result.code == 0, result.text
    # The ball has no program.
    expected = [Record(4, "Ants"), *(written(i) for i in (1, 2, 3)), written(65535, "walls"), Record(0, "zebras")]
    assert (tmp_path / "a" / "b" / "x.flash").read_bytes() == archive(expected)
    assert left_in(tmp_path / "a" / "b") == ["x.flash"]


def test_two_runs_write_the_same_bytes(program: Compile, tmp_path: Path) -> None:
    for name in ("x", "y"):
        assert flash(program, tmp_path, "write", {"output_file": name}).code == 0
    assert (tmp_path / "x").read_bytes() == (tmp_path / "y").read_bytes()


# ---- Two runs ----


def test_second_run_finds_what_the_first_one_wrote(program: Compile, tmp_path: Path) -> None:
    settings: Settings = {"objects.walls": WALLS}
    assert flash(program, tmp_path, "write", {"output_file": "x.flash"}, settings).code == 0
    result = flash(program, tmp_path, "read", {"input_file": "x.flash"}, settings)
    assert result.code == 0, result.text
    blank = f"page 1: 255 255 255 255 ..., sum {255 * 256}"
    for robot in (0, 1, 2, 65535):
        lines = [line for line in result.robot_lines if line.startswith(f"[ROBOT #{robot}] ")]
        first, last = (mark(robot, page) for page in (0, 5887))
        assert lines == [
            f"[ROBOT #{robot}] [PRINTF] {text}"
            for text in (
                f"motors: 1 0 1, 500 600 {(700 + robot) % 65536}",
                f"page 0: {first[0]} {first[1]} {first[2]} {first[3]} ..., sum {sum(first)}",
                blank,
                f"page 5887: {last[0]} {last[1]} {last[2]} {last[3]} ..., sum {sum(last)}",
            )
        ]


def test_one_archive_goes_from_run_to_run(program: Compile, tmp_path: Path) -> None:
    for number in (1, 2, 3):
        result = flash(program, tmp_path, "count", {"input_file": "x", "output_file": "./x"})
        assert result.code == 0, result.text
        assert [line[-5:] for line in result.robot_lines] == [f"run {number}"] * 3
    assert left_in(tmp_path) == ["x"]


def test_what_callbacks_at_the_end_write_is_kept(program: Compile, tmp_path: Path) -> None:
    assert flash(program, tmp_path, "write_at_end", {"output_file": "x"}).code == 0
    expected = [Record(robot, pages={1: mark(robot, 1)}) for robot in range(3)]
    assert (tmp_path / "x").read_bytes() == archive(expected)


def test_run_that_its_program_stops_saves(program: Compile, tmp_path: Path) -> None:
    result = flash(program, tmp_path, "stop", {"output_file": "x"}, {"simulation_time": 1e6})
    assert result.code == 0
    assert (tmp_path / "x").read_bytes() == archive([written(robot) for robot in range(3)])


def test_records_of_others_stay_in_their_order(program: Compile, tmp_path: Path) -> None:
    others = [Record(9, pages={3: bytes(256)}), Record(0, "ants", (7, 8, 9), (1, 2, 65535))]
    records = [others[0], Record(2), Record(0), others[1], Record(1)]
    (tmp_path / "x").write_bytes(archive(records))
    assert flash(program, tmp_path, "write", {"input_file": "x", "output_file": "y"}).code == 0
    expected = [others[0], written(2), written(0), others[1], written(1)]
    assert (tmp_path / "y").read_bytes() == archive(expected)
    assert (tmp_path / "x").read_bytes() == archive(records)


def test_links_permissions_and_other_names_stay(program: Compile, tmp_path: Path) -> None:
    (tmp_path / "real").write_bytes(EMPTY)
    (tmp_path / "real").chmod(0o640)
    (tmp_path / "link").symlink_to("real")
    assert flash(program, tmp_path, "write", {"output_file": "link"}).code == 0
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real").stat().st_mode & 0o777 == 0o640
    assert (tmp_path / "real").stat().st_size == len(EMPTY) + 3 * RECORD


# ---- An input that is not there ----


def test_missing_input_becomes_an_archive_without_records(program: Compile, tmp_path: Path) -> None:
    result = flash(program, tmp_path, "read", {"input_file": "new/x"})
    assert result.code == 0
    assert "flash_state.input_file: there was no 'new/x': it is now an archive without records" in result.output
    assert (tmp_path / "new" / "x").read_bytes() == EMPTY
    assert left_in(tmp_path / "new") == ["x"]
    again = flash(program, tmp_path, "read", {"input_file": "new/x"})
    assert again.code == 0
    assert "there was no" not in again.output


def test_input_without_records_is_a_warning_in_each_run_that_nothing_is_restored(
    program: Compile, tmp_path: Path
) -> None:
    """A misspelt name looks the same, and the program then finds no calibration."""
    said = "flash_state.input_file: 'x' has no records, so the flash memory of all robots is blank at the start"
    for _ in range(2):
        result = flash(program, tmp_path, "read", {"input_file": "x", "output_file": "y"}, {"simulation_time": 0.1})
        assert (result.code, result.errors.count(said)) == (0, 1), result.errors
    write_options(tmp_path, {"parameters.kind": "read", "flash_state": {"input_file": "z"}})
    said = said.replace("'x'", "'z'")
    for _ in range(2):
        many = batch(tmp_path, "-r", "2", program=program("flash.c"))
        assert (many.code, many.errors.count(said)) == (0, 1), many.errors
    assert (tmp_path / "z").read_bytes() == EMPTY


def test_empty_archive_with_more_bytes_is_refused_by_a_check_too(program: Compile, tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(EMPTY + b"x")
    for arguments in ([], ["--check-config"]):
        result = flash(program, tmp_path, "read", {"input_file": "x"}, None, *arguments)
        assert result.code == 2
        assert "bytes follow its last record, which ends after 18 bytes" in result.errors


def test_first_run_of_an_archive_that_goes_from_run_to_run_has_no_warning(program: Compile, tmp_path: Path) -> None:
    for _ in range(2):
        result = flash(program, tmp_path, "write", {"input_file": "x", "output_file": "./x"})
        assert (result.code, result.errors.count("has no records")) == (0, 0)


def test_missing_input_may_be_an_error(program: Compile, tmp_path: Path) -> None:
    result = flash(program, tmp_path, "read", {"input_file": "x", "create_if_missing": False, "output_file": "y"})
    assert result.code == 2
    assert f"flash_state.input_file: 'x': there is no such file in '{tmp_path}' (create_if_missing: f" in result.errors
    assert result.robot_lines == []
    assert left_in(tmp_path) == []


# ---- Refusals ----

ROBOTS = [Record(0), Record(1), Record(2)]
GOOD = archive(ROBOTS)


def changed(place: int, *data: int) -> bytes:
    return GOOD[:place] + bytes(data) + GOOD[place + len(data) :]


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"", "it is empty, not an archive of flash memory"),
        (b"ARROW1\0\0" + bytes(100), "it is not an archive of flash memory: it does not begin with PGFLASH"),
        (GOOD[:7], "it ends in its first 18 bytes, after 7 bytes"),
        (changed(8, 2, 0), "its version is 2, expected 1"),
        (changed(8, 0, 1), "its version is 256, expected 1"),  # 1 with the bytes of the other order
        (
            changed(10, 0, 0, 1, 0),
            "its robots have 65536 bytes of flash memory, expected 1507328; it is of robots before",
        ),
        (changed(10, 0, 0x17, 0, 0), "its robots have 5888 bytes of flash memory, expected 1507328"),
        (GOOD[:17], "it ends in its first 18 bytes"),
        (GOOD[:18], "it ends in record 1 of 3, after 18 bytes"),
        (GOOD[:-1], f"it ends in record 3 of 3, after {len(GOOD) - 1} bytes"),
        (GOOD[: 18 + RECORD], f"it ends in record 2 of 3, after {18 + RECORD} bytes"),
        (archive(ROBOTS, count=2**32 - 1), "it ends in record 4 of 4294967295"),
        (GOOD + b"\0", f"bytes follow its last record, which ends after {len(GOOD)} bytes"),
        (archive(ROBOTS, count=2), "bytes follow its last record"),
        (archive([*ROBOTS, Record(1)]), "it has two records of robot #1 of category 'robots'"),
        (changed(18 + RECORD + 700_000, 0), "record 2 of 3 is damaged: its checksum is "),
        (changed(18 + RECORD - 1, 0), "record 1 of 3 is damaged: its checksum is "),
        (
            archive(ROBOTS[:2]),
            "it has no record of robot #2 of category 'robots' (2 records in all, for 3 robots); take an archive of "
            "these robots, or make one with: pogosim flash make",
        ),
        (
            archive([Record(i, "ants") for i in range(5)]),
            "it has no record of robot #0 of category 'robots', and of 2 more (5 records in all, for 3 robots)",
        ),
    ],
)
def test_unfit_archive_is_refused_before_any_program_runs(
    program: Compile, tmp_path: Path, data: bytes, reason: str
) -> None:
    (tmp_path / "x").write_bytes(data)
    result = flash(program, tmp_path, "read", {"input_file": "x", "output_file": "y"})
    assert result.code == 2
    line = (tmp_path / "scene.yaml").read_text().splitlines().index("  input_file: x") + 1
    assert result.errors.startswith(f"Error: scene.yaml:{line}: flash_state.input_file: 'x': {reason}")
    assert result.robot_lines == []
    assert (tmp_path / "x").read_bytes() == data
    assert left_in(tmp_path) == ["x"]


@pytest.mark.parametrize("seed", range(12))
def test_no_damage_goes_unnoticed(program: Compile, tmp_path: Path, seed: int) -> None:
    """One byte is changed, or a piece is taken out or put in."""
    chance = random.Random(seed)
    data = bytearray(archive([written(robot) for robot in range(3)]))
    place = chance.choice([chance.randrange(60), chance.randrange(len(data))])
    kind = seed % 3
    if kind == 0:
        data[place] ^= 1 << chance.randrange(8)
    elif kind == 1:
        del data[place : place + chance.randrange(1, 300)]
    else:
        data[place:place] = chance.randbytes(chance.randrange(1, 300))
    (tmp_path / "x").write_bytes(data)
    result = flash(program, tmp_path, "read", {"input_file": "x"})
    assert result.code == 2, result.text
    assert "flash_state.input_file: 'x': " in result.errors
    assert len(result.errors.splitlines()) == 1


@pytest.mark.parametrize(
    ("state", "message"),
    [
        ({"input_file": "."}, "flash_state.input_file: '.': it is not a file"),
        ({"output_file": "."}, "flash_state.output_file: cannot write '.': it is not a file"),
        ({"output_file": "/dev/null"}, "flash_state.output_file: cannot write '/dev/null': it is not a file"),
        (
            {"output_file": "scene.yaml/x"},
            "flash_state.output_file: cannot write 'scene.yaml/x': cannot make the folder",
        ),
        ({"output_file": "scene.yaml"}, "flash_state.output_file: 'scene.yaml' is the same file as the configuration"),
        ({"input_file": "scene.yaml"}, "flash_state.input_file: 'scene.yaml': it is not an archive of flash memory"),
        ({"output_file": "y" * 250}, "File name too long"),
        ({"output_file": "y/"}, "flash_state.output_file: cannot write 'y/': this is the name of a folder"),
        ({"output_file": "y/z/."}, "flash_state.output_file: cannot write 'y/z/.': this is the name of a folder"),
        ({"input_file": "y/"}, "flash_state.input_file: cannot write 'y/' (create_if_missing): this is the name of"),
        ({"output_file": ["a"]}, "flash_state.output_file: expected a string, found a list"),
        ({"create_if_missing": "perhaps"}, "flash_state.create_if_missing: expected true or false"),
    ],
)
def test_wrong_files_are_refused(program: Compile, tmp_path: Path, state: Settings, message: str) -> None:
    result = flash(program, tmp_path, "read", state)
    assert result.code == 2
    assert message in result.errors
    assert result.robot_lines == []
    assert left_in(tmp_path) == []


def test_name_of_a_folder_is_told_by_a_check_too(program: Compile, tmp_path: Path) -> None:
    result = flash(program, tmp_path, "read", {"output_file": "y/"}, None, "--check-config")
    assert result.code == 2
    assert "flash_state.output_file: 'y/' cannot be written: this is the name of a folder" in result.errors


def test_archive_is_no_other_file_of_the_run(program: Compile, tmp_path: Path) -> None:
    both: Settings = {"enable_data_logging": True, "data_filename": "x"}
    result = flash(program, tmp_path, "read", {"output_file": "x"}, both)
    assert result.code == 2
    assert "data_filename: 'x' is the same file as flash_state.output_file 'x' (scene.yaml:" in result.errors
    (tmp_path / "x").write_bytes(EMPTY)
    result = flash(program, tmp_path, "read", {"input_file": "x"}, both)
    assert result.code == 2
    assert "is the same file as flash_state.input_file 'x'" in result.errors
    assert (tmp_path / "x").read_bytes() == EMPTY


def test_misspelt_key_is_named(program: Compile, tmp_path: Path) -> None:
    result = flash(program, tmp_path, "read", {"outputfile": "x"})
    assert "unknown key 'flash_state.outputfile' is ignored; did you mean 'output_file'?" in result.errors
    result = flash(program, tmp_path, "read", {}, {"flash_state": "x"})
    assert result.code == 2
    assert "flash_state: expected a map of keys, such as {input_file: a.flash, output_file: b.flash}" in result.errors


# ---- Runs that do not end well ----


@pytest.mark.parametrize("is_new", [False, True])
@pytest.mark.parametrize(("kind", "code"), [("crash", 3), ("exit", 0)])
def test_run_whose_program_fails_leaves_the_archive_as_it_is(
    program: Compile, tmp_path: Path, kind: str, code: int, is_new: bool
) -> None:
    if not is_new:
        (tmp_path / "x").write_bytes(GOOD)
    result = flash(program, tmp_path, kind, {"output_file": "x"})
    assert result.code == code
    assert "Flash memory is not saved; 'x' (flash_state.output_file) is as before" in result.errors
    assert left_in(tmp_path) == ([] if is_new else ["x"])
    if not is_new:
        assert (tmp_path / "x").read_bytes() == GOOD


def begun(program: Compile, folder: Path, state: Settings) -> subprocess.Popen[str]:
    """Start a run without an end, and wait until its robots take their steps."""
    settings = {"parameters.kind": "long", "flash_state": dict(state), "simulation_time": 1e8}
    process = start(program("flash.c"), folder, settings)
    assert process.stdout is not None
    assert any("goes on" in line for line in process.stdout)
    return process


def test_interrupted_run_does_not_save_and_says_so(program: Compile, tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(GOOD)
    process = begun(program, tmp_path, {"input_file": "x", "output_file": "x"})
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Flash memory is not saved; 'x' (flash_state.output_file) is as before" in errors
    assert (tmp_path / "x").read_bytes() == GOOD


def test_killed_run_leaves_the_old_archive_whole(program: Compile, tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(GOOD)
    process = begun(program, tmp_path, {"input_file": "x", "output_file": "x"})
    process.kill()
    process.communicate(timeout=60)
    assert (tmp_path / "x").read_bytes() == GOOD
    assert left_in(tmp_path) == ["x"]
    assert flash(program, tmp_path, "write", {"input_file": "x", "output_file": "x"}).code == 0


def test_killed_run_leaves_no_archive_that_would_be_refused(program: Compile, tmp_path: Path) -> None:
    process = begun(program, tmp_path, {"output_file": "x"})
    process.kill()
    process.communicate(timeout=60)
    assert (tmp_path / "x").read_bytes() == EMPTY


def test_two_runs_cannot_write_one_archive(program: Compile, tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(GOOD)
    process = begun(program, tmp_path / "first", {"output_file": "../x"})
    try:
        result = flash(program, tmp_path / "second", "write", {"output_file": "../x"})
        assert result.code == 2
        assert "flash_state.output_file: cannot write '../x': in use by another run; wait for it" in result.errors
        # Reading is no harm.
        assert flash(program, tmp_path / "second", "read", {"input_file": "../x"}).code == 0
    finally:
        process.kill()
        process.communicate(timeout=60)


def test_archive_that_does_not_fit_on_the_disk_leaves_the_old_one(program: Compile, tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(GOOD)
    write_scene(tmp_path, {"parameters.kind": "write", "flash_state.output_file": "x", "enable_data_logging": False})
    limited = ["-c", 'ulimit -f 2000; exec "$0" -c scene.yaml -g', str(program("flash.c"))]
    result = run_command(Path("/bin/bash"), tmp_path, limited)
    assert result.code == 2
    assert "cannot write the archive of flash memory 'x' (flash_state.output_file): File too large" in result.errors
    assert (tmp_path / "x").read_bytes() == GOOD
    assert left_in(tmp_path) == ["x"]


@pytest.mark.skipif(sys.platform != "linux", reason="needs /proc, where even root makes no file")
def test_folder_where_no_file_can_be_made_is_known_at_the_start(program: Compile, tmp_path: Path) -> None:
    result = flash(program, tmp_path, "read", {"output_file": "/proc/x"})
    assert result.code == 2
    assert "flash_state.output_file: cannot write '/proc/x'" in result.errors
    assert result.robot_lines == []


def test_strict_run_that_is_refused_at_its_end_does_not_save(program: Compile, tmp_path: Path) -> None:
    settings = {"parameters": {"kind": "write", "unread": 3}, "flash_state.output_file": "x"}
    result = run(program("flash.c"), tmp_path, settings, ["--strict"])
    assert result.code == 2
    assert left_in(tmp_path) == []


# ---- Python and batches ----


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    flags = ("-shared", "-fPIC", "-g", "-Wall", "-Wextra")
    return compile_program(tmp_path_factory.mktemp("flash") / "flash.so", PROGRAMS / "flash.c", flags=flags)


def test_closed_simulation_saves_and_the_next_one_finds_it(
    library: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    scene = write_scene(tmp_path, {"parameters.kind": "write", "arena_file": str(ROOT / "arenas" / "disk.csv")})
    state = {"flash_state.input_file": "x", "flash_state.output_file": "x"}
    with pogosim.Simulation(library, scene, set={**state, "parameters.kind": "count"}) as sim:
        sim.step(10)
        assert (tmp_path / "x").read_bytes() == EMPTY
        sim.reset()
        sim.step(10)
    counted = [Record(robot, pages={1: bytes([2]).ljust(256, b"\xff")}) for robot in range(3)]
    assert (tmp_path / "x").read_bytes() == archive(counted)
    # Without files, each run begins anew.
    with pogosim.Simulation(library, scene) as sim:
        sim.step(10)
    assert (tmp_path / "x").read_bytes() == archive(counted)


def test_simulation_refuses_an_unfit_archive(library: Path, tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(b"something else")
    scene = write_scene(tmp_path, {"arena_file": str(ROOT / "arenas" / "disk.csv")})
    with pytest.raises(pogosim.ConfigurationError, match="is not an archive of flash memory"):
        pogosim.Simulation(library, scene, set={"flash_state.input_file": str(tmp_path / "x")})


def test_runs_that_cannot_write_one_archive_leave_it(library: Path, tmp_path: Path) -> None:
    blank = archive([Record(robot) for robot in range(3)])
    (tmp_path / "x").write_bytes(blank)
    scene = write_scene(tmp_path, {"arena_file": str(ROOT / "arenas" / "disk.csv"), "parameters.kind": "count"})
    state = {f"flash_state.{key}": str(tmp_path / "x") for key in ("input_file", "output_file")}
    with pytest.raises(pogosim.ConfigurationError, match="in use by another run"):
        pogosim.VectorSimulation(library, scene, seeds=range(3), set=state)
    assert (tmp_path / "x").read_bytes() == blank
    with pogosim.VectorSimulation(library, scene, seeds=range(1), set=state) as runs:
        runs.step(1)
    assert (tmp_path / "x").read_bytes() != blank


def test_failed_simulation_does_not_save(library: Path, tmp_path: Path) -> None:
    scene = write_scene(tmp_path, {"arena_file": str(ROOT / "arenas" / "disk.csv"), "parameters.kind": "crash"})
    sim = pogosim.Simulation(library, scene, set={"flash_state.output_file": str(tmp_path / "x")})
    with pytest.raises(pogosim.ProgramFailedError):
        sim.step(100)
    sim.close()
    assert left_in(tmp_path) == []


def test_runs_of_a_batch_have_archives_of_their_own(program: Compile, tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(GOOD)
    state = {"input_file": "x", "output_file": "x"}
    write_options(tmp_path, {"parameters.kind": "write", "flash_state": state})
    result = batch(tmp_path, "-r", "2", "--keep-temp", program=program("flash.c"))
    assert (result.code, result.errors) == (0, "")
    assert (tmp_path / "x").read_bytes() == GOOD
    archives = sorted((tmp_path / "tmp").glob("sim_*/frames/x"))
    assert len(archives) == 4
    two = archive([written(0), written(1), Record(2)])
    three = archive([written(robot) for robot in range(3)])
    assert sorted(path.read_bytes() for path in archives) == sorted([two, two, three, three])


def test_batch_knows_finished_runs_by_the_archive_that_they_read(program: Compile, tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(GOOD)
    write_options(tmp_path, {"parameters.kind": "read", "flash_state": {"input_file": "x", "output_file": "y"}})
    assert batch(tmp_path, "--keep-temp", program=program("flash.c")).code == 0
    before = len(list((tmp_path / "tmp").rglob("*.feather")))
    write_options(tmp_path, {"parameters.kind": "read", "flash_state": {"input_file": "x", "output_file": "z"}})
    assert batch(tmp_path, "--keep-temp", program=program("flash.c")).code == 0
    assert len(list((tmp_path / "tmp").rglob("*.feather"))) == before
    (tmp_path / "x").write_bytes(archive([written(robot) for robot in range(3)]))
    assert batch(tmp_path, "--keep-temp", program=program("flash.c")).code == 0
    assert len(list((tmp_path / "tmp").rglob("*.feather"))) > before


def test_checksum_of_the_archive_is_in_little_endian(program: Compile, tmp_path: Path) -> None:
    assert flash(program, tmp_path, "write", {"output_file": "x"}, {"objects.robots.nb": 1}).code == 0
    data = (tmp_path / "x").read_bytes()
    assert data[:8] == b"PGFLASH\0"
    assert struct.unpack("<HII", data[8:18]) == (1, FLASH, 1)
    assert data[18:28] == b"\0\0\x06\0robots"
    assert data[28:37] == bytes([1, 0, 1, 0xF4, 0x01, 0x58, 0x02, 0xBC, 0x02])
    assert int.from_bytes(data[-8:], "little") == checksum(data[18:-8])


def test_search_leaves_the_archive_of_the_user(program: Compile, tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(archive(ROBOTS[:2]))
    state = {"input_file": "x", "output_file": "x"}
    write_search(tmp_path, {"parameters.kind": "write", "flash_state": state})
    result = search(tmp_path, "--optimizer", "random", "--max-evals", "2", "-r", "1", program=program("flash.c"))
    assert result.code == 0, result.text
    assert (tmp_path / "x").read_bytes() == archive(ROBOTS[:2])
    best = yaml.safe_load((tmp_path / "opt_out" / "best_config.yaml").read_text())
    assert best["flash_state"] == state


# ---- An output that is something else ----


@pytest.mark.parametrize("through_link", [False, True])
@pytest.mark.parametrize("data", [b"int main(void) { return 0; }\n", b"PG", b"PGFLASH", b"PGFLASHX" + GOOD[8:]])
def test_file_that_is_no_archive_is_never_replaced(
    program: Compile, tmp_path: Path, data: bytes, through_link: bool
) -> None:
    (tmp_path / "main.c").write_bytes(data)
    name = "link" if through_link else "main.c"
    if through_link:
        (tmp_path / name).symlink_to("main.c")
    files = left_in(tmp_path)
    for arguments in ((), ("--check-config",)):
        result = flash(program, tmp_path, "write", {"output_file": name, "input_file": "new/x"}, None, *arguments)
        assert result.code == 2
        assert re.fullmatch(
            rf"Error: scene\.yaml:\d+: flash_state\.output_file: '{name}' is not an archive of flash memory, and would "
            r"be lost: it does not begin with PGFLASH; choose another file, or remove it\n",
            result.errors,
        )
        assert result.robot_lines == []
        assert (tmp_path / "main.c").read_bytes() == data
        assert left_in(tmp_path) == files


@pytest.mark.parametrize("data", [b"", EMPTY, GOOD, GOOD[:100]])
def test_archive_is_replaced_even_if_it_is_empty_or_damaged(program: Compile, tmp_path: Path, data: bytes) -> None:
    (tmp_path / "x").write_bytes(data)
    assert flash(program, tmp_path, "write", {"output_file": "x"}).code == 0
    assert (tmp_path / "x").read_bytes() == archive([written(robot) for robot in range(3)])


def test_simulation_in_python_does_not_replace_other_files(library: Path, tmp_path: Path) -> None:
    (tmp_path / "main.c").write_text("int main(void);")
    scene = write_scene(tmp_path, {"arena_file": str(ROOT / "arenas" / "disk.csv")})
    with pytest.raises(pogosim.ConfigurationError, match="is not an archive of flash memory, and would be lost"):
        pogosim.Simulation(library, scene, set={"flash_state.output_file": str(tmp_path / "main.c")})
    assert (tmp_path / "main.c").read_text() == "int main(void);"


# ---- The window ----


def test_watched_run_does_not_rename_what_is_no_archive(display: Display, program: Compile, tmp_path: Path) -> None:
    (tmp_path / "main.c").write_text("int main(void);")
    state = {"output_file": "main.c"}
    write_scene(tmp_path, {"GUI": True, "parameters.kind": "write", "flash_state": state})
    command = [str(program("flash.c")), "-c", "scene.yaml"]
    ended = subprocess.run(
        command, cwd=tmp_path, env=display.environment, capture_output=True, text=True, timeout=60, check=False
    )
    assert ended.returncode == 2
    assert "flash_state.output_file: 'main.c' is not an archive of flash memory" in ended.stderr
    assert (tmp_path / "main.c").read_text() == "int main(void);"
    assert left_in(tmp_path) == ["main.c"]


def test_closed_window_saves(display: Display, program: Compile, tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(GOOD)
    settings: dict[str, object] = {"simulation_time": 1e4, "parameters.kind": "write"}
    settings["flash_state"] = {"input_file": "x", "output_file": "x"}
    with shown(display, program("flash.c"), tmp_path, settings) as window:
        window.keys("Escape")
        assert window.end()[0] == 0
    assert (tmp_path / "x").read_bytes() == archive([written(robot) for robot in range(3)])


def test_watched_run_keeps_the_archive_of_an_earlier_one(display: Display, program: Compile, tmp_path: Path) -> None:
    (tmp_path / "x.flash").write_bytes(GOOD)
    settings: dict[str, object] = {"simulation_time": 1e4, "parameters.kind": "write"}
    settings["flash_state"] = {"output_file": "x.flash"}
    with shown(display, program("flash.c"), tmp_path, settings) as window:
        window.keys("Escape")
        assert window.end()[0] == 0
    assert (tmp_path / "x.flash").read_bytes() == archive([written(robot) for robot in range(3)])
    assert (tmp_path / "x.1.flash").read_bytes() == GOOD
