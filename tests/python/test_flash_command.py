"""`pogosim flash` looks into archives, takes the memory of a robot out, and makes archives that programs accept."""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
import time
import tracemalloc
from pathlib import Path

import pytest
import yaml
from conftest import Compile
from flash_files import EMPTY, FLASH, PAGE, Record, archive, checksum, written
from pogosim.command.main import main
from pogosim.flash_archive import checksum_of, records_of
from running import SCENE, example, run, start

RECORDS = [written(0), Record(1), Record(0, "ants", pages={5: bytes(PAGE)})]


@pytest.fixture(autouse=True)
def _in_the_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("x.flash").write_bytes(archive(RECORDS))


def flash(*arguments: str) -> int:
    try:
        return main(["flash", *arguments])
    except SystemExit as error:
        assert isinstance(error.code, int)
        return error.code


def configuration(objects: dict[str, object], **more: object) -> str:
    Path("c.yaml").write_text(yaml.safe_dump({**SCENE, "objects": objects, **more}, sort_keys=False))
    return "c.yaml"


# ---- show ----


def test_show_lists_robots_pages_and_motors(capsys: pytest.CaptureFixture[str]) -> None:
    assert flash("show", "x.flash") == 0
    assert capsys.readouterr().out.splitlines() == [
        "x.flash: 3 records, each of 5888 pages of 256 bytes",
        "category  id  written pages  directions  powers (right, left, back)  checksum",
        "robots    0   2              1, 0, 1     500, 600, 700               right",
        "robots    1   0              0, 1, 0     512, 512, 0                 right",
        "ants      0   1              0, 1, 0     512, 512, 0                 right",
    ]


def test_show_prints_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert flash("show", "x.flash", "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["ok"], found["flash_bytes"], len(found["records"])) == (True, FLASH, 3)
    assert found["records"][2] == {
        "category": "ants",
        "id": 0,
        "written_pages": 1,
        "directions": [0, 1, 0],
        "powers": [512, 512, 0],
        "checksum": "right",
    }


def test_show_of_an_archive_without_records(capsys: pytest.CaptureFixture[str]) -> None:
    Path("x.flash").write_bytes(EMPTY)
    assert flash("show", "x.flash") == 0
    assert capsys.readouterr().out == "x.flash: 0 records, each of 5888 pages of 256 bytes\n"


def test_show_tells_which_record_is_damaged(capsys: pytest.CaptureFixture[str]) -> None:
    data = bytearray(archive(RECORDS))
    data[2_000_000] ^= 1
    Path("x.flash").write_bytes(data)
    assert flash("show", "x.flash") == 1
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[-1] for line in lines[2:5]] == ["right", "wrong", "right"]
    assert lines[5] == "1 record damaged: the simulator refuses this archive"
    assert flash("show", "x.flash", "--json") == 1
    assert json.loads(capsys.readouterr().out)["ok"] is False


@pytest.mark.parametrize("damaged", [0, 1])
def test_damaged_record_is_no_second_one_of_its_robot(damaged: int, capsys: pytest.CaptureFixture[str]) -> None:
    data = bytearray(archive([Record(1), Record(1)]))
    data[len(EMPTY) + damaged * (len(data) - len(EMPTY)) // 2 + 1000] ^= 1
    Path("x.flash").write_bytes(data)
    assert flash("show", "x.flash") == 1
    checksums = [line.split()[-1] for line in capsys.readouterr().out.splitlines()[2:4]]
    assert checksums == (["wrong", "right"] if damaged == 0 else ["right", "wrong"])


def test_memory_does_not_grow_with_the_archive(capsys: pytest.CaptureFixture[str]) -> None:
    Path("x.flash").write_bytes(archive([Record(identifier) for identifier in range(20)]))
    for arguments in (["show", "x.flash"], ["extract", "x.flash", "-r", "3", "-o", "out.bin"]):
        assert flash(*arguments) == 0  # what is imported does not count
        tracemalloc.start()
        try:
            assert flash(*arguments) == 0
            assert tracemalloc.get_traced_memory()[1] < 8 * FLASH, arguments
        finally:
            tracemalloc.stop()
    assert "20 records" in capsys.readouterr().out


def test_make_sorts_categories_by_their_bytes() -> None:
    Path("own.bin").write_bytes(b"x")
    categories = ["b\U0001f600", "b", "b\U0001f41c", "b\u00e9", "a"]
    given = [word for category in categories for word in ("--from", category, "0", "own.bin")]
    assert flash("make", "made.flash", *given) == 0
    with Path("made.flash").open("rb") as file:
        made = [record.category for record, _ in records_of(file)]
    assert made == ["a", "b", "b\u00e9", "b\U0001f41c", "b\U0001f600"]


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"", "it is not an archive of flash memory: it does not begin with PGFLASH"),
        (EMPTY[:12], "it ends in its first 18 bytes"),
        (EMPTY[:8] + b"\2" + EMPTY[9:], "its version is 2, expected 1"),
        (
            EMPTY[:10] + b"\0\0\1\0" + EMPTY[14:],
            "its robots have 65536 bytes of flash memory, expected 1507328; it is of robots before version 3",
        ),
        (archive(RECORDS)[:-1], "it ends in record 3 of 3"),
        (archive(RECORDS) + b"x", "bytes follow its last record"),
        (archive([Record(1), Record(1)]), "it has two records of robot #1 of category 'robots'"),
    ],
)
def test_files_that_are_no_archives_are_refused(data: bytes, reason: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("x.flash").write_bytes(data)
    assert flash("show", "x.flash") == 2
    assert capsys.readouterr().err.startswith(f"pogosim flash: x.flash: {reason}")


def test_missing_file_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    assert flash("show", "y.flash") == 2
    assert capsys.readouterr().err == "pogosim flash: y.flash: no such file or directory\n"


def test_checksum_is_that_of_all_bytes_whatever_is_known_of_blank_pages() -> None:
    chance = random.Random(1)
    body = Record(3, pages={page: chance.randbytes(PAGE) for page in (0, 7, 5887)}).body
    assert checksum_of(body[:-FLASH], body[-FLASH:]) == checksum(body)


@pytest.mark.parametrize("arguments", [("show",), ("extract", "-r", "0", "-o", "a.bin")])
def test_pipe_is_no_archive_and_is_not_waited_for(
    arguments: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    os.mkfifo("pipe")
    assert flash(arguments[0], "pipe", *arguments[1:]) == 2
    told = capsys.readouterr().err
    assert told == "pogosim flash: pipe is not a file, but a pipe, a socket or a device; expected an archive\n"
    assert flash(arguments[0], ".", *arguments[1:]) == 2
    assert capsys.readouterr().err == "pogosim flash: .: is a directory\n"


@pytest.mark.parametrize(
    ("where", "code", "told"),
    [
        ("> /dev/full", 2, "pogosim flash: cannot go on: No space left on device\n"),
        ("| exec true", 141, ""),  # as the shell says of SIGPIPE
    ],
)
def test_output_that_cannot_be_printed_is_not_blamed_on_the_archive(where: str, code: int, told: str) -> None:
    command = f"{sys.executable} -m pogosim flash show x.flash {where}; exit ${{PIPESTATUS[0]}}"
    ended = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stdout, ended.stderr) == (code, "", told)


# ---- extract and make ----


def test_memory_goes_out_and_in_again(capsys: pytest.CaptureFixture[str]) -> None:
    assert flash("extract", "x.flash", "-r", "0", "--category", "ants", "-o", "ant.bin") == 0
    assert capsys.readouterr().out == "ant.bin: 1507328 bytes, 1 page not blank\n"
    assert Path("ant.bin").read_bytes() == RECORDS[2].body[-FLASH:]
    assert flash("make", "y.flash", "--from", "ants", "0", "ant.bin") == 0
    assert Path("y.flash").read_bytes() == archive([RECORDS[2]])


def test_extract_asks_for_the_category_if_it_has_to(capsys: pytest.CaptureFixture[str]) -> None:
    assert flash("extract", "x.flash", "-r", "1", "-o", "a.bin", "--json") == 0
    about = {"file": "a.bin", "category": "robots", "id": 1, "written_pages": 0}
    assert json.loads(capsys.readouterr().out) == about
    assert flash("extract", "x.flash", "-r", "0", "-o", "b.bin") == 2
    assert "several categories; add --category, one of robots, ants" in capsys.readouterr().err
    assert flash("extract", "x.flash", "-r", "7", "-o", "b.bin") == 2
    assert "x.flash has no record of robot #7; pogosim flash show lists" in capsys.readouterr().err
    assert not Path("b.bin").exists()


def test_extract_refuses_damaged_memory(capsys: pytest.CaptureFixture[str]) -> None:
    data = bytearray(archive(RECORDS))
    data[100] ^= 1
    Path("x.flash").write_bytes(data)
    assert flash("extract", "x.flash", "-r", "0", "--category", "robots", "-o", "b.bin") == 2
    assert "the record of robot #0 of category 'robots' is damaged" in capsys.readouterr().err


def test_category_may_have_a_long_name() -> None:
    Path("a.bin").write_bytes(b"")
    assert flash("make", "y.flash", "--from", "r" * 65535, "1", "a.bin", "--from", "\u00e9", "2", "a.bin") == 0
    assert Path("y.flash").read_bytes() == archive([Record(1, "r" * 65535), Record(2, "\u00e9")])
    assert flash("show", "y.flash") == 0


def test_names_that_are_not_utf_8_are_shown_escaped(capsys: pytest.CaptureFixture[str]) -> None:
    own = os.fsdecode(b"y\xff.flash")
    Path(own).write_bytes(archive([Record(2, "a\udcff\u00e9"), Record(2, "b\udc80")]))
    assert flash("show", own, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert found["file"] == "y\\xff.flash"
    assert [record["category"] for record in found["records"]] == ["a\\xff\u00e9", "b\\x80"]
    assert flash("show", own) == 0
    assert "\na\\xff\u00e9    2   0 " in capsys.readouterr().out
    assert flash("extract", own, "-r", "2", "-o", "b.bin") == 2
    assert "a\\xff\u00e9, b\\x80" in capsys.readouterr().err
    assert flash("extract", own, "-r", "2", "--category", "b\udc80", "-o", "b.bin", "--json") == 0
    assert json.loads(capsys.readouterr().out)["category"] == "b\\x80"


def test_short_binary_is_followed_by_blank_memory() -> None:
    Path("a.bin").write_bytes(b"abc")
    assert flash("make", "y.flash", "--from", "robots", "2", "a.bin") == 0
    page = b"abc".ljust(PAGE, b"\xff")
    assert Path("y.flash").read_bytes() == archive([Record(2, pages={0: page})])


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        ((), "expected the robots of the archive: -c CONFIG, or --from CATEGORY ID FILE.bin"),
        (("--from", "robots", "x", "a.bin"), "--from: expected an id from 0 to 65535, found 'x'"),
        (("--from", "robots", "65536", "a.bin"), "expected an id from 0 to 65535, found '65536'"),
        (("--from", "robots", "1", "b.bin"), "b.bin: no such file or directory"),
        (("--from", "robots", "1", "long.bin"), "long.bin is longer than flash memory, which has 1507328 bytes"),
        (("--from", "r", "1", "a.bin", "--from", "r", "1", "a.bin"), "--from r 1 is given twice"),
        (("--from", "r" * 65536, "1", "a.bin"), "expected at most 65535 bytes"),
        (("--from", "\u00e9" * 32768, "1", "a.bin"), "expected at most 65535 bytes"),
        (("--from", "a\udcff", "1", "a.bin"), "the category 'a\\xff' is no text in UTF-8, as names in an archive are"),
        (("--from", "robots", "1", "pipe"), "pipe is not a file, but a pipe, a socket or a device; expected flash"),
        (("--from", "robots", "1", "."), ".: is a directory"),
        (("-c", "missing.yaml"), "cannot read the configuration missing.yaml"),
        (("-c", "c.yaml", "--from", "robots", "9", "a.bin"), "c.yaml has no robot #9 of category 'robots'"),
    ],
)
def test_wrong_makings_are_refused(arguments: tuple[str, ...], reason: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.bin").write_bytes(b"a")
    Path("long.bin").write_bytes(bytes(FLASH + 1))
    os.mkfifo("pipe")
    configuration({"robots": {"type": "pogobot", "nb": 2}})
    assert flash("make", "y.flash", *arguments) == 2
    assert reason in capsys.readouterr().err
    assert not Path("y.flash").exists()


def test_made_archive_fits_the_robots_of_its_configuration(program: Compile, tmp_path: Path) -> None:
    """Numbered as the simulator does, over all types of objects; and the run's own archive has the same owners."""
    objects: dict[str, object] = {
        "lamp": {"type": "static_light", "nb": 1, "geometry": "global", "value": 100},
        "walls": {"type": "pogowall", "nb": 2, "geometry": "arena"},
        "robots": {"type": "pogobot", "nb": {"default_option": 3, "batch_options": [3, 4]}, "radius": 10},
        "balls": {"type": "passive_object", "nb": 2, "geometry": "disk", "radius": 10},
        "ring": {"type": "membrane", "nb": 1, "geometry": "disk", "radius": 60, "num_dots": 30, "dot_radius": 5},
        "heads": {"type": "pogobject", "nb": 1, "geometry": "disk", "radius": 20},
        "rest": [
            {"type": "active_object", "nb": 1, "geometry": "disk", "radius": 10},
            {"type": "pogobot", "poses": [[500, 500, 0], [600, 600, 0]], "radius": 10},
        ],
    }
    arena = {"arena_file": "arenas/disk.csv", "arena_surface": 1e6}
    assert flash("make", "made.flash", "-c", configuration(objects, **arena)) == 0
    changes = {"objects": objects, "parameters.kind": "x", "flash_state.input_file": "made.flash", "simulation_time": 0}
    result = run(program("flash.c"), tmp_path, {**changes, "flash_state.output_file": "left.flash"})
    assert result.code == 0, result.text
    del changes["flash_state.input_file"]
    result = run(program("flash.c"), tmp_path, {**changes, "flash_state.output_file": "own.flash"})
    assert result.code == 0, result.text
    assert Path("made.flash").read_bytes() == Path("own.flash").read_bytes() == Path("left.flash").read_bytes()


def test_make_asks_for_a_run_where_only_the_simulator_knows_a_type(capsys: pytest.CaptureFixture[str]) -> None:
    robots = {"robots": {"type": "pogobot", "nb": 2}}
    assert flash("make", "y.flash", "-c", configuration({**robots, "posts": {"type": "beacon", "nb": 1}})) == 2
    told = capsys.readouterr().err
    assert "c.yaml: only the simulator knows what a beacon has; run the program with --set simulation_time=0" in told
    assert not Path("y.flash").exists()


def test_make_replaces_an_archive_as_a_whole(capsys: pytest.CaptureFixture[str]) -> None:
    own = ("-c", configuration({"robots": {"type": "pogobot", "nb": 2}}), "--force", "--json")
    assert flash("make", "x.flash", *own) == 0
    found = json.loads(capsys.readouterr().out)
    assert found == {"file": "x.flash", "records": [{"category": "robots", "id": i} for i in range(2)]}
    assert Path("x.flash").read_bytes() == archive([Record(0), Record(1)])
    assert sorted(path.name for path in Path().iterdir()) == ["c.yaml", "x.flash"]


# ---- What would be lost ----


def test_make_never_replaces_what_it_reads(capsys: pytest.CaptureFixture[str]) -> None:
    name = configuration({"robots": {"type": "pogobot", "nb": 2}})
    text = Path(name).read_bytes()
    Path("a.bin").write_bytes(b"abc")
    for link, target in (("link.yaml", name), ("link.bin", "a.bin")):
        Path(link).symlink_to(target)
    Path("hard.bin").hardlink_to("a.bin")
    for archive_name, arguments in {
        name: ("-c", name),
        "link.yaml": ("-c", name),
        "a.bin": ("--from", "robots", "0", "a.bin"),
        "link.bin": ("-c", name, "--from", "robots", "0", "a.bin"),
        "hard.bin": ("--from", "robots", "0", "x.flash", "--from", "robots", "1", "a.bin"),
    }.items():
        for more in ((), ("--force",)):
            assert flash("make", archive_name, *arguments, *more) == 2
            told = capsys.readouterr().err
            assert told == f"pogosim flash: {archive_name} is an input, which would be lost; choose another archive\n"
    assert Path(name).read_bytes() == text
    assert Path("a.bin").read_bytes() == b"abc"


@pytest.mark.parametrize("through_link", [False, True])
@pytest.mark.parametrize(
    ("data", "what"),
    [
        (archive(RECORDS), "has the flash memory of 3 robots"),
        (archive(RECORDS[:1]), "has the flash memory of 1 robot"),
        (b"int main(void) {}", "is not an archive of flash memory"),
        (EMPTY[:-1], "is not an archive of flash memory"),
    ],
)
def test_make_replaces_what_is_there_only_if_it_is_told_to(
    data: bytes, what: str, through_link: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("x.flash").write_bytes(data)
    name = "link" if through_link else "x.flash"
    if through_link:
        Path(name).symlink_to("x.flash")
    Path("a.bin").write_bytes(b"a")
    assert flash("make", name, "--from", "robots", "0", "a.bin") == 2
    told = capsys.readouterr().err
    assert told == f"pogosim flash: {name} {what}, and would be lost; choose another archive, or add --force\n"
    assert Path("x.flash").read_bytes() == data
    assert flash("make", name, "--from", "robots", "0", "a.bin", "--force") == 0
    assert Path("x.flash").read_bytes() == archive([Record(0, pages={0: b"a".ljust(PAGE, b"\xff")})])


@pytest.mark.parametrize("more", [(), ("--force",)])
def test_make_leaves_an_archive_that_a_run_writes(
    more: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("a.bin").write_bytes(b"")
    settings: dict[str, object] = {
        "simulation_time": 1e6,
        "flash_state.output_file": "y.flash",
        "enable_data_logging": False,
    }
    running = start(example("helloworld"), tmp_path, settings)
    try:
        while not Path("y.flash").exists() or Path("y.flash").stat().st_size < len(EMPTY):
            assert running.poll() is None
            time.sleep(0.01)
        assert flash("make", "y.flash", "--from", "robots", "0", "a.bin", *more) == 2
        assert capsys.readouterr().err == (
            "pogosim flash: y.flash is in use by another run; wait for it to finish, or choose another file\n"
        )
        assert Path("y.flash").read_bytes() == EMPTY
    finally:
        running.kill()
        running.communicate()
    assert flash("make", "y.flash", "--from", "robots", "0", "a.bin", *more) == 0
    assert Path("y.flash").read_bytes() == archive([Record(0)])


@pytest.mark.parametrize("data", [b"", EMPTY])
def test_make_replaces_what_has_nothing_in_it(data: bytes) -> None:
    Path("x.flash").write_bytes(data)
    Path("a.bin").write_bytes(b"")
    assert flash("make", "x.flash", "--from", "robots", "0", "a.bin") == 0
    assert Path("x.flash").read_bytes() == archive([Record(0)])


def test_extract_never_replaces_its_archive(capsys: pytest.CaptureFixture[str]) -> None:
    Path("link").symlink_to("x.flash")
    Path("hard").hardlink_to("x.flash")
    data = Path("x.flash").read_bytes()
    for source, output in (("x.flash", "x.flash"), ("x.flash", "link"), ("link", "x.flash"), ("x.flash", "hard")):
        assert flash("extract", source, "-r", "1", "-o", output) == 2
        told = capsys.readouterr().err
        assert told == f"pogosim flash: {output} is the archive, which would be lost; choose another --output\n"
    assert Path("x.flash").read_bytes() == data
