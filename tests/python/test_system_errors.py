"""What the system refuses is told with the file that it is about, and as what was tried: reading or writing."""

from __future__ import annotations

import errno
import os
from pathlib import Path
from typing import NoReturn

import numpy as np
import pytest
from batches import batch, write_options
from pogosim.batch.runs import attempts
from pogosim.command.main import main
from pogosim.optimize import history
from pogosim.outputs import partial_output
from searches import search, write_search
from swarms import metadata_of, rows_of, write_rows


def disk_is_full(*_: object, **__: object) -> NoReturn:
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@pytest.fixture
def data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A data file, in the working folder."""
    monkeypatch.chdir(tmp_path)
    position = np.tile([[100.0, 100.0], [200.0, 200.0]], (3, 1, 1))
    return write_rows(tmp_path / "data.feather", rows_of(position), metadata_of())


@pytest.mark.parametrize("command", [("picture", "out.png"), ("film", "-o", "out.html"), ("film", "-o", "out.mp4")])
@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("no*such.feather", "cannot read 'no*such.feather': no file fits the pattern 'no*such.feather'"),
        ("none.feather", "cannot read 'none.feather': no such file"),
        ("loop", "cannot read 'loop': too many levels of symbolic links"),
        ("folder", "cannot read 'folder': is a directory"),
        ("data.feather/x", "cannot read 'data.feather/x': not a directory"),
        ("[l]oo[p].feather", "cannot read '[l]oo[p].feather': no file fits the pattern '[l]oo[p].feather'"),
        ("x" * 300, f"cannot read '{'x' * 300}': file name too long"),
    ],
)
def test_data_that_cannot_be_read_are_not_said_to_be_written(
    command: tuple[str, ...], name: str, reason: str, data: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (data.parent / "loop").symlink_to("loop")
    (data.parent / "folder").mkdir()
    tool, *output = command
    assert main([tool, name, *output]) == 2
    assert capsys.readouterr().err == f"pogosim {tool}: {reason}\n"


def test_picture_that_cannot_be_written_is_told_by_its_name(
    data: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Path, "write_bytes", disk_is_full)
    for tool, output in (("picture", ["out.png"]), ("film", ["-o", "out.html"])):
        assert main([tool, str(data), *output]) == 2
        assert capsys.readouterr().err == f"pogosim {tool}: cannot write '{output[-1]}': no space left on device\n"


def test_full_disk_of_temporary_files_is_not_told_by_the_name_of_the_program(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_options(tmp_path)
    monkeypatch.setattr(attempts, "configuration_in", disk_is_full)
    result = batch(tmp_path)
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert line.endswith(f": the disk of {tmp_path}/tmp is full; free space, then give the same command again")


def test_journal_that_cannot_be_written_is_told_by_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_search(tmp_path)
    monkeypatch.setattr(history, "line_of", disk_is_full)
    result = search(tmp_path, "--max-evals", "2")
    assert result.code == 2
    assert "[ERROR] cannot write opt_out/search.jsonl: No space left on device; free space, " in result.errors


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EACCES, errno.EROFS])
def test_partial_file_is_told_by_the_name_of_the_output(number: int, tmp_path: Path) -> None:
    with pytest.raises(OSError, match=r"out\.csv") as caught, partial_output(tmp_path / "out.csv"):
        raise OSError(number, os.strerror(number))
    assert caught.value.filename == str(tmp_path / "out.csv")
    assert list(tmp_path.iterdir()) == []
