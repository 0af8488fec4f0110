"""Whatever has become of a data file: readers get its good rows or one clear error, and recovery destroys nothing."""

from __future__ import annotations

import io
import os
import random
import socket
import stat
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pyarrow as pa
import pytest
from pogosim import recover
from pogosim.command.recover import main as recover_command
from pogosim.utils import load_dataframe
from pyarrow import feather, ipc

METADATA = {"incomplete": "yes", "program_version": "1", "configuration": "seed: 1"}
COLUMNS = {
    "time": pa.array([0.0, 0.0, 1.0, 1.0], pa.float32()),
    "robot_category": pa.array(["robots"] * 4),
    "robot_id": pa.array([0, 1, 0, None], pa.int32()),
    "yes": pa.array([True] * 4),
}
BATCHES = 3
END_OF_BATCHES = 3 * len(COLUMNS["time"])


def table(columns: Sequence[tuple[str, pa.Array]] = tuple(COLUMNS.items()), **metadata: str) -> pa.Table:
    schema = pa.schema([(name, values.type) for name, values in columns], metadata=METADATA | metadata)
    batch = pa.RecordBatch.from_arrays([values for _, values in columns], schema=schema)
    return pa.Table.from_batches([batch] * BATCHES)


def unfinished_bytes(rows: pa.Table) -> bytes:
    sink = io.BytesIO(recover.MAGIC)
    sink.seek(0, io.SEEK_END)
    writer = ipc.new_stream(sink, rows.schema, options=ipc.IpcWriteOptions(compression="lz4"))
    writer.write_table(rows)
    return sink.getvalue()  # without the end of a stream


def complete_bytes(rows: pa.Table) -> bytes:
    sink = io.BytesIO()
    with ipc.new_file(sink, rows.schema, options=ipc.IpcWriteOptions(compression="zstd")) as writer:
        writer.write_table(rows)
    return sink.getvalue()


def unfinished_file(folder: Path, content: bytes | None = None) -> Path:
    path = folder / "data.feather"
    path.write_bytes(unfinished_bytes(table()) if content is None else content)
    return path


def recovered(capsys: pytest.CaptureFixture[str], *arguments: object) -> tuple[int, str]:
    """Code, and what was said: one line."""
    code = recover_command([str(argument) for argument in arguments])
    said = capsys.readouterr()
    (line,) = (said.err if code else said.out).splitlines()
    return code, line


def row_count(path: Path) -> int:
    return int(feather.read_table(path, memory_map=False).num_rows)


# ---- damaged bytes ----


@pytest.mark.parametrize("length", [b"\xff" * 8, b"\xff" * 7 + b"\x7f", b"\0\0\0\0\0\1\0\0", b"\0\0\0\x40\0\0\0\0"])
def test_rows_before_a_damaged_length_are_kept(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], length: bytes
) -> None:
    whole = unfinished_bytes(table())
    one_batch = len(unfinished_bytes(table())) - len(unfinished_bytes(table().slice(0, END_OF_BATCHES - 4)))
    for place in range(len(whole) - one_batch, len(whole) - 8, 8):
        path = unfinished_file(tmp_path, whole[:place] + length + whole[place + 8 :])
        assert recovered(capsys, path)[0] == 0
        assert row_count(path) in {END_OF_BATCHES - 4, END_OF_BATCHES}, place


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("complete", [False, True])
def test_damaged_bytes_never_end_in_another_error_than_the_documented_ones(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], seed: int, complete: bool
) -> None:
    whole = complete_bytes(table()) if complete else unfinished_bytes(table())
    source = random.Random(seed)
    for _ in range(200):
        damaged = bytearray(whole)
        for _ in range(source.choice([1, 1, 4])):
            place = source.randrange(len(whole))
            damaged[place : place + 4] = source.choice([b"\0", b"\xff", b"\x80\x80\x80\x80", b"\xff\xff\xff\x7f"])
        path = unfinished_file(tmp_path, bytes(damaged))
        try:
            with pytest.warns(RuntimeWarning):
                load_dataframe(path)
        except (ValueError, pytest.fail.Exception):  # an error as it is promised, or no warning
            pass
        code, _ = recovered(capsys, path, "-o", tmp_path / "out.feather")
        assert code in {0, 2}
        if code == 0:
            assert row_count(tmp_path / "out.feather") <= END_OF_BATCHES
            (tmp_path / "out.feather").unlink()
        assert not list(tmp_path.glob(".pogosim*"))


def test_complete_file_with_a_damaged_batch_is_an_error_that_says_how_to_save_the_rows_before(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    whole = complete_bytes(table())
    magic_of_zstd = b"\x28\xb5\x2f\xfd"
    last = whole.rindex(magic_of_zstd)
    path = unfinished_file(tmp_path, whole[:last] + b"\0\0\0\0" + whole[last + 4 :])
    with pytest.raises(ValueError, match=r"is damaged: .*8 rows, up to t = 1 s.*pogosim-recover .* -o "):
        load_dataframe(path)
    before = path.read_bytes()
    code, line = recovered(capsys, path)
    assert code == 2
    assert f"{path} is damaged; to save the rows before the damage, choose another file with -o" in line
    assert path.read_bytes() == before
    assert recovered(capsys, path, "-o", tmp_path / "b.feather")[0] == 0
    assert row_count(tmp_path / "b.feather") == 8


def test_footer_that_does_not_verify_is_a_value_error_or_the_rows(tmp_path: Path) -> None:
    whole = complete_bytes(table())
    for place in range(len(whole) - 300, len(whole)):
        path = unfinished_file(tmp_path, whole[:place] + bytes([whole[place] ^ 0x80]) + whole[place + 1 :])
        try:
            with pytest.warns(RuntimeWarning, match="12 rows"):
                load_dataframe(path)
        except (ValueError, pytest.fail.Exception):
            pass


TWO_TIMES = [*COLUMNS.items(), ("time", COLUMNS["time"])]
NO_TIMES = [("time", pa.nulls(4, pa.float32()))]
STRANGE_TIMES = [("time", pa.array(["a", "b", "c", "d"]))]
HALF_TIMES = [("time", pa.array([1.0] * 4, pa.float16()))]
LIST_TIMES = [("time", pa.array([[1.0]] * 4))]


@pytest.mark.parametrize("columns", [TWO_TIMES, NO_TIMES, STRANGE_TIMES, HALF_TIMES, LIST_TIMES])
def test_rows_without_one_column_of_times_are_recovered_all_the_same(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], columns: list[tuple[str, pa.Array]]
) -> None:
    path = unfinished_file(tmp_path, unfinished_bytes(table(columns)))
    assert recovered(capsys, path) == (0, f"{path}: 12 rows")
    assert row_count(path) == 12


def test_column_whose_name_is_no_text_is_recovered_under_its_number(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = unfinished_file(tmp_path, unfinished_bytes(table()).replace(b"robot_id", b"robot\xffid"))
    assert recovered(capsys, path) == (0, f"{path}: 12 rows, up to t = 1 s")
    assert feather.read_table(path).column_names == ["time", "robot_category", "column_2", "yes"]


# ---- names ----


def test_files_may_have_names_that_are_no_text(tmp_path: Path) -> None:
    path = Path(os.fsdecode(os.fsencode(tmp_path) + b"/data\xff.feather"))
    for content in (unfinished_bytes(table()), complete_bytes(table())):
        path.write_bytes(content)
        if content.endswith(b"ARROW1"):
            assert len(load_dataframe(path)[0]) == END_OF_BATCHES
        ended = subprocess.run([sys.executable, "-m", "pogosim.recover", path], capture_output=True, check=False)
        assert rb"data\udcff.feather" in ended.stdout + ended.stderr
        assert len((ended.stdout + ended.stderr).splitlines()) == 1
    assert ended.returncode == 2  # complete


@pytest.mark.parametrize("output", ["", "folder", "none/out.feather", "text.txt/out.feather", "loop", "new/"])
def test_output_that_is_no_file_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str], output: str) -> None:
    path = unfinished_file(tmp_path)
    (tmp_path / "folder").mkdir()
    (tmp_path / "text.txt").write_text("text")
    (tmp_path / "loop").symlink_to("loop")
    before = sorted(tmp_path.iterdir())
    code, line = recovered(capsys, path, "-o", f"{tmp_path}/{output}" if output else "")
    assert code == 2
    assert output in line
    assert sorted(tmp_path.iterdir()) == before


def test_output_that_is_a_pipe_socket_or_device_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    path = unfinished_file(tmp_path)
    os.mkfifo(tmp_path / "pipe")
    monkeypatch.chdir(tmp_path)
    with socket.socket(socket.AF_UNIX) as own:
        own.bind("socket")
        for name in ("pipe", "socket"):
            code, line = recovered(capsys, path, "-o", name)
            assert (code, f"{name} is a {name}, not a file; choose another output" in line) == (2, True)
            code, line = recovered(capsys, name)
            assert (code, f"{name} is not a file" in line) == (2, True)
    try:
        os.mknod(tmp_path / "device", stat.S_IFCHR | 0o600, os.makedev(1, 3))
    except PermissionError:
        return
    code, line = recovered(capsys, path, "-o", "device")
    assert (code, "device is a device, not a file" in line) == (2, True)
    assert stat.S_ISCHR((tmp_path / "device").stat().st_mode)


@pytest.mark.parametrize("content", [b"objects: {}\n", b"", recover.MAGIC, complete_bytes(pa.table({"a": [1]}))])
@pytest.mark.parametrize("link", ["none", "symbolic", "hard"])
def test_output_that_is_a_file_of_another_kind_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], content: bytes, link: str
) -> None:
    path = unfinished_file(tmp_path)
    other = tmp_path / "other"
    other.write_bytes(content)
    name = tmp_path / ("other" if link == "none" else "name")
    if link == "symbolic":
        name.symlink_to("other")
    if link == "hard":
        name.hardlink_to(other)
    code, line = recovered(capsys, path, "-o", name)
    assert code == 2
    assert "it will not be overwritten: choose another file with -o" in line
    assert other.read_bytes() == content
    assert name.is_symlink() == (link == "symbolic")


@pytest.mark.parametrize("output", [(), ("-o", "data.feather"), ("-o", "symbolic"), ("-o", "hard")])
def test_links_stay_links_to_the_recovered_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, output: tuple[str, ...]
) -> None:
    monkeypatch.chdir(tmp_path)
    path = unfinished_file(tmp_path)
    path.write_bytes(path.read_bytes() + bytes(10000))  # longer than the recovered one
    Path("hard").hardlink_to(path)
    Path("symbolic").symlink_to("data.feather")
    assert recovered(capsys, "symbolic" if output else "data.feather", *output)[0] == 0
    assert path.samefile("hard")
    assert Path("symbolic").is_symlink()
    assert row_count(path) == END_OF_BATCHES
    assert sorted(file.name for file in tmp_path.iterdir()) == ["data.feather", "hard", "symbolic"]


def test_output_through_links_is_made_or_replaced_where_they_lead(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = unfinished_file(tmp_path)
    target = tmp_path / "target.feather"
    link = tmp_path / "link"
    link.symlink_to("target.feather")
    for _ in range(2):  # the first one makes the file
        assert recovered(capsys, path, "-o", link)[0] == 0
        assert link.is_symlink()
        assert row_count(target) == END_OF_BATCHES
        target.write_bytes(complete_bytes(table().slice(0, 4)))
        (tmp_path / "other_name").unlink(missing_ok=True)
        (tmp_path / "other_name").hardlink_to(target)
    assert recovered(capsys, path, "-o", link)[0] == 0
    assert row_count(tmp_path / "other_name") == END_OF_BATCHES


def test_full_disk_under_a_hard_link_leaves_the_rows_in_the_file_that_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    path = unfinished_file(tmp_path)
    (tmp_path / "hard").hardlink_to(path)

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pogosim.recover.shutil.copyfileobj", fail)
    code, line = recovered(capsys, path)
    assert code == 2
    assert "No space left on device. All rows are in " in line
    assert row_count(Path(line.split("All rows are in ")[1])) == END_OF_BATCHES


def test_broken_standard_output_is_said_in_one_line(tmp_path: Path) -> None:
    path = unfinished_file(tmp_path)
    command = f"{sys.executable} -m pogosim.recover {path} > /dev/full"
    ended = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False)
    assert ended.returncode == 2
    (line,) = ended.stderr.splitlines()
    assert line == (
        f"pogosim-recover: {path} is complete, but the standard output cannot be written: No space left on device"
    )
    assert row_count(path) == END_OF_BATCHES
