"""Runs that are killed leave the rows up to there; pogosim-recover makes a Feather file of them."""

from __future__ import annotations

import shlex
import signal
import sys
import time
from pathlib import Path

import pandas as pd
import pyarrow as pa
import pytest
from pogosim import recover
from pogosim.command.recover import main as recover_command
from pogosim.utils import load_dataframe, read_table
from pyarrow import feather, ipc
from running import Run, compile_program, example, run, run_command, start, wait_for_rows

LONG = {"simulation_time": 1.0e6, "save_data_period": 0.02}
PROGRAM = """
#include "pogobase.h"
#include <unistd.h>
typedef struct { int unused; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
void user_init(void) {}
void user_step(void) { if (pogobot_ticks == 1000) { %s } }
int main(void) { pogobot_init(); pogobot_start(user_init, user_step); return 0; }
"""


def killed_run(folder: Path, settings: dict[str, object] | None = None) -> Path:
    """Kill a run in its midst; returns its data file."""
    process = start(example("helloworld"), folder, {**LONG, **(settings or {})})
    wait_for_rows(folder / "data.feather")
    process.kill()
    process.communicate()
    return folder / "data.feather"


def read_incomplete(path: Path) -> tuple[pd.DataFrame, dict[str, object]]:
    with pytest.warns(RuntimeWarning, match=r"is incomplete: .* up to t = .* s; .*pogosim-recover") as caught:
        result = load_dataframe(path)
    assert caught[0].filename == __file__
    return result


def full_run(folder: Path, end_s: float) -> pd.DataFrame:
    """Rows of the same run, not killed, up to a time."""
    result = run(example("helloworld"), folder, {**LONG, "simulation_time": end_s})
    assert (result.code, result.errors) == (0, "")
    return result.frame()


@pytest.mark.parametrize("flush_row_count", [50, 1048576])
def test_killed_run_leaves_its_first_rows_as_they_would_have_been(tmp_path: Path, flush_row_count: int) -> None:
    path = killed_run(tmp_path, {"data_logger_flush_row_count": flush_row_count})
    rows, metadata = read_incomplete(path)
    assert "is still going on, or it was killed" in str(metadata["incomplete"])
    assert metadata["configuration"]["seed"] == 1  # type: ignore[index]
    expected = full_run(tmp_path / "full", float(rows["time"].max()))
    pd.testing.assert_frame_equal(rows, expected.iloc[: len(rows)])


def test_rows_are_on_the_disk_every_few_seconds(tmp_path: Path) -> None:
    process = start(example("helloworld"), tmp_path, LONG)
    path = tmp_path / "data.feather"
    wait_for_rows(path)
    before = recover.read_unfinished(path).table.num_rows
    time.sleep(8.0)  # 2 s, 4 s on a slow disk; and other programs want the processor, too
    after = recover.read_unfinished(path).table.num_rows
    process.kill()
    process.communicate()
    assert after > before


@pytest.mark.parametrize("end", ["_exit(0);", "_exit(5);", "raise(SIGKILL);", "raise(SIGVTALRM);"])
def test_program_that_ends_at_once_leaves_a_readable_file(tmp_path: Path, end: str) -> None:
    source = tmp_path / "main.c"
    source.write_text("#include <signal.h>\n" + PROGRAM % end)
    run(compile_program(tmp_path / "main", source, flags=["-D_GNU_SOURCE"]), tmp_path, LONG)
    rows = recover.read_unfinished(tmp_path / "data.feather")
    assert rows.says_so
    assert set(rows.table["robot_id"].to_pylist()) <= {0, 1, 2}


def test_limit_on_processor_time_ends_a_run_like_ctrl_c(tmp_path: Path) -> None:
    program = tmp_path / "limited"
    program.write_text(f"#!/bin/sh\nulimit -St 1\nexec '{example('helloworld')}' \"$@\"\n")
    program.chmod(0o755)
    result = run(program, tmp_path, LONG)
    assert result.code == 130
    assert "interrupted at t = " in result.errors
    assert len(result.frame()) > 0


def test_disk_that_fills_up_leaves_the_rows_up_to_there_and_says_how_to_have_them(tmp_path: Path) -> None:
    program = tmp_path / "limited"
    program.write_text(f"#!/bin/sh\nulimit -f 200\nexec '{example('helloworld')}' \"$@\"\n")
    program.chmod(0o755)
    result = run(program, tmp_path, {**LONG, "objects.robots.nb": 20})
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert "cannot write the data file 'data.feather' (data_filename): File too large. It contains" in line
    rows, _ = read_incomplete(tmp_path / "data.feather")
    assert f"up to t = {rows['time'].max():.4f} s" in line
    assert not list(tmp_path.glob("*.pogosim-new"))
    command = shlex.split(line[line.index("pogosim-recover") :])
    assert recover_command([str(tmp_path / command[1])]) == 0
    assert len(result.frame()) == len(rows)


def test_next_run_writes_over_the_file_of_a_killed_one(tmp_path: Path) -> None:
    killed_run(tmp_path)
    assert full_run(tmp_path, 2.0)["time"].max() == pytest.approx(2.0)


# ---- two runs ----


@pytest.mark.parametrize("name", ["data.feather", "./data.feather", "link.feather"])
def test_second_run_that_writes_the_same_data_file_is_refused(tmp_path: Path, name: str) -> None:
    process = start(example("helloworld"), tmp_path, LONG)
    wait_for_rows(tmp_path / "data.feather")
    (tmp_path / "link.feather").symlink_to("data.feather")
    second = run(example("helloworld"), tmp_path, {"data_filename": name})
    assert second.code == 2
    assert f"'{name}' (data_filename): in use by another run" in second.errors
    process.send_signal(signal.SIGINT)
    process.communicate()
    assert process.returncode == 130
    assert len(Run(0, "", "", tmp_path).frame()) > 0


def test_child_of_a_program_does_not_keep_the_next_run_from_its_file(tmp_path: Path) -> None:
    source = tmp_path / "main.c"
    source.write_text(PROGRAM % "if (pogobot_helper_getid() == 0 && fork() == 0) { sleep(10); _exit(0); }")
    program = compile_program(tmp_path / "main", source, flags=["-D_GNU_SOURCE"])
    settings = {"simulation_time": 20.0}
    for _ in range(2):
        process = start(program, tmp_path, settings)
        assert process.wait(timeout=15) == 0  # its child holds the pipes open
        for pipe in (process.stdout, process.stderr):
            assert pipe is not None
            pipe.close()
    assert len(Run(0, "", "", tmp_path).frame()) > 0


# ---- pogosim-recover ----


def recovered(capsys: pytest.CaptureFixture[str], *arguments: object) -> tuple[int, str, str]:
    code = recover_command([str(argument) for argument in arguments])
    said = capsys.readouterr()
    return code, said.out, said.err


def test_recovered_file_is_a_feather_file_with_all_rows_and_metadata(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = killed_run(tmp_path)
    rows, _ = read_incomplete(path)
    before = recover.read_unfinished(path).table.schema.metadata
    code, output, errors = recovered(capsys, path)
    assert (code, errors) == (0, "")
    assert output == f"{path}: {len(rows)} rows, up to t = {rows['time'].max():.9g} s\n"
    pd.testing.assert_frame_equal(pd.read_feather(path), rows)
    after = read_table(path).schema.metadata
    assert b"did not end by itself" in after[b"recovered"]
    del before[b"incomplete"], after[b"recovered"]
    assert after == before
    assert sorted(file.name for file in tmp_path.iterdir()) == ["data.feather", "scene.yaml"]


def test_recovery_to_another_file_leaves_the_input(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = killed_run(tmp_path)
    before = path.read_bytes()
    assert recovered(capsys, path, "-o", tmp_path / "b.feather")[0] == 0
    assert path.read_bytes() == before
    assert len(pd.read_feather(tmp_path / "b.feather")) == recover.read_unfinished(path).table.num_rows


def test_failed_recovery_leaves_the_input_and_nothing_else(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    path = killed_run(tmp_path)
    before = path.read_bytes()

    def fail(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(ipc, "new_file", fail)
    code, _, errors = recovered(capsys, path)
    assert code == 2
    assert "No space left on device" in errors
    assert path.read_bytes() == before
    assert sorted(file.name for file in tmp_path.iterdir()) == ["data.feather", "scene.yaml"]


def test_file_of_a_run_that_goes_on_is_not_replaced(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    process = start(example("helloworld"), tmp_path, LONG)
    path = tmp_path / "data.feather"
    wait_for_rows(path)
    code, _, errors = recovered(capsys, path)
    assert code == 2
    assert f"{path} is in use by a run; choose another file with -o" in errors
    assert recovered(capsys, path, "-o", tmp_path / "b.feather")[0] == 0
    process.kill()
    process.communicate()


def test_complete_file_needs_no_recovery(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    full_run(tmp_path, 1.0)
    before = (tmp_path / "data.feather").read_bytes()
    code, _, errors = recovered(capsys, tmp_path / "data.feather")
    assert code == 2
    assert "is already complete; nothing to recover" in errors
    assert (tmp_path / "data.feather").read_bytes() == before


def test_complete_file_that_was_cut_off_can_be_recovered(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run(example("helloworld"), tmp_path, {"data_logger_flush_row_count": 10})
    path = tmp_path / "data.feather"
    rows = len(pd.read_feather(path))
    path.write_bytes(path.read_bytes()[:-1])
    with pytest.raises(ValueError, match="it is truncated; to recover it: pogosim-recover"):
        load_dataframe(path)
    assert recovered(capsys, path)[0] == 0
    assert len(pd.read_feather(path)) == rows


@pytest.mark.parametrize(
    "content", [b"", b"ARROW1\0\0", b"ARROW1\0\0" + 100 * b"x", b"a,b\n1,2\n", b"ARROW1\0\0" + bytes(99)]
)
def test_file_of_another_kind_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str], content: bytes) -> None:
    path = tmp_path / "data.feather"
    path.write_bytes(content)
    code, _, errors = recovered(capsys, path)
    assert code == 2
    assert errors.startswith(f"pogosim-recover: {path} ")
    assert path.read_bytes() == content


def test_tables_of_other_programs_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "data.feather"
    feather.write_feather(pa.table({"a": [1]}), path)
    path.write_bytes(path.read_bytes()[:-1])
    code, _, errors = recovered(capsys, path)
    assert code == 2
    assert "is not a data file of the simulator" in errors


def test_missing_file_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, _, errors = recovered(capsys, tmp_path / "none.feather")
    assert code == 2
    assert "none.feather" in errors


def test_command_is_installed() -> None:
    command = Path(sys.executable).parent / "pogosim-recover"
    assert "usage: pogosim-recover" in run_command(command, Path.cwd(), ["-h"]).output


# ---- what the message of a crash says of the data file ----


DISK_FULL = "struct rlimit limit = {.rlim_cur = 100, .rlim_max = 100}; setrlimit(RLIMIT_FSIZE, &limit);"


@pytest.mark.parametrize("end", ["abort();", "*(volatile int *) 8 = 1;", "exit(4);", "pogobot_ticks = 0; exit(0);"])
def test_message_of_an_end_calls_no_file_complete_that_could_not_be_completed(tmp_path: Path, end: str) -> None:
    source = tmp_path / "main.c"
    for full in (False, True):
        source.write_text(
            "#include <stdlib.h>\n#include <sys/resource.h>\n" + PROGRAM % ((DISK_FULL if full else "") + end)
        )
        program = compile_program(tmp_path / "main", source, flags=["-D_GNU_SOURCE"])
        result = run(program, tmp_path, LONG)
        first, *others = result.errors.splitlines()
        assert "the user program " in first
        assert " in user_step of robot #0 " in first
        assert ("The data file 'data.feather' contains all rows up to that point" in first) == (not full)
        if full:
            (reason,) = others
            assert "cannot write the data file 'data.feather' (data_filename): File too large" in reason
            assert "complete up to" not in result.errors
            assert result.code == 2
        else:
            assert others == []
            assert len(result.frame()) > 0
