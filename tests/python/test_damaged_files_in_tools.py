"""Whatever has become of a data file, a tool reads its rows, or says in one line which file is damaged."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from pogosim.analysis.stored_runs import runs_of
from pogosim.analysis.trajectories import trajectories_of
from pogosim.command.main import main
from pogosim.errors import DamagedFileError
from pogosim.recover import MAGIC
from pogosim.reports.command import ANALYSES
from pogosim.row_batches import RowFile, row_batches
from pogosim.utils import load_dataframe
from pyarrow import feather, ipc, parquet
from swarms import brownian_walk, metadata_of, rows_of, write_rows

BATCH = 32  # rows
KINDS = ("feather, compressed", "feather", "parquet", "feather of pandas", "parquet of pandas")

TOOLS = {
    **{f"analyze {name}": f"analyze {name} -i {{data}} -o {{out}}" for name in ANALYSES.own},
    "analyze two files": "analyze network -i {data} {whole} -o {out}",
    "report": "report {data} -o {out}/report.html",
    "compare": "compare {data} {whole}",
    "picture": "picture {data} {out}/picture.png",
    "film": "film {data} -o {out}/replay.html",
    "recover": "recover {data} -o {out}/recovered.feather",
    "join": "join {data} {whole} -o {out}/joined.feather",
}


def run(tool: str, data: Path, whole: Path, out: Path) -> int:
    """Run a tool in this process. Returns its exit code."""
    return main([word.format(data=data, whole=whole, out=out) for word in TOOLS[tool].split()])


def swarm() -> pd.DataFrame:
    """Rows of a few robots."""
    heading = np.random.default_rng(0).uniform(-3.0, 3.0, (30, 4))
    return rows_of(np.clip(500.0 + brownian_walk(30, 4, 20.0), 30.0, 970.0), heading, 0.1)


def messages() -> pd.DataFrame:
    """Rows of a message log."""
    source = np.random.default_rng(0)
    return pd.DataFrame(
        {
            "time": np.repeat(0.1 * np.arange(20), 3),
            "message": np.arange(60),
            "sender_category": ["robots"] * 60,
            "receiver": source.integers(0, 4, 60),
            "distance": source.uniform(10.0, 80.0, 60),
            "cluster_size": source.integers(0, 5, 60),
            "probability": source.uniform(0.0, 1.0, 60),
            "outcome": source.choice(["heard", "lost"], 60),
        }
    )


def file_of(kind: str, rows: pd.DataFrame, path: Path) -> Path:
    """Write rows as the simulator does, or as pandas does."""
    write_rows(path, rows, metadata_of())
    table = feather.read_table(path)
    if kind == "parquet":
        parquet.write_table(table, path, row_group_size=BATCH, compression="none")
    elif kind == "feather of pandas":
        rows.to_feather(path)
    elif kind == "parquet of pandas":
        rows.to_parquet(path)
    else:
        options = ipc.IpcWriteOptions(compression="zstd" if "compressed" in kind else None)
        with ipc.new_file(path, table.schema, options=options) as writer:
            writer.write_table(table, max_chunksize=BATCH)
    return path


def damaged(whole: bytes, source: random.Random) -> bytes:
    """Return a file's bytes without its end, or with wrong ones at some places, often in its footer."""
    if source.random() < 0.3:
        return whole[: source.randrange(len(whole))]
    content = bytearray(whole)
    for _ in range(source.choice([1, 1, 4, 20])):
        last = len(content) if source.random() < 0.6 else min(len(content), 1000)
        place = len(content) - 1 - source.randrange(last)
        wrong = source.choice([bytes([content[place] ^ 1]), b"\0", b"\xff", b"\x80\x80\x80\x80", b"\xff\xff\xff\x7f"])
        content[place : place + len(wrong)] = wrong
    return bytes(content)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("tool", TOOLS)
def test_damaged_file_is_read_or_told_in_one_line_that_names_it(
    tool: str, kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("pogosim.reports.figures.FORMATS", ())
    monkeypatch.setattr("pogosim.reports.locomotion.draw_traces", lambda *_: None)
    path = file_of(kind, messages() if tool == "analyze messages" else swarm(), tmp_path / "whole.feather")
    content = path.read_bytes()
    source = random.Random(f"{tool} {kind}")
    data = tmp_path / "damaged.feather"
    for number in range(8):
        data.write_bytes(damaged(content, source))
        out = tmp_path / str(number)
        out.mkdir()
        code = run(tool, data, path, out)
        lines = capsys.readouterr().err.splitlines()
        errors = [line for line in lines if ": warning: " not in line]
        assert len(set(lines)) == len(lines)
        if code == 2:
            (line,) = errors
            assert "damaged.feather" in line or (tool == "join" and "whole.feather" in line)
        else:
            assert code == 0 or (code == 1 and tool == "compare")
            assert not errors


@pytest.mark.parametrize("kind", ["feather", "parquet"])
def test_all_tools_say_the_same_of_a_damaged_file(
    kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    whole = file_of(kind, swarm(), tmp_path / "whole.feather")
    data = tmp_path / "damaged.feather"
    data.write_bytes(whole.read_bytes()[: whole.stat().st_size // 2])
    said = set()
    for tool in sorted(set(TOOLS) - {"recover", "join"}):
        assert run(tool, data, whole, tmp_path / "out") == 2
        (line,) = capsys.readouterr().err.splitlines()
        said.add(line.partition(": ")[2])
    (line,) = said
    assert line.startswith(f"{data} is ")
    assert "; to recover it: pogosim-recover " in line or "; copy it again, or repeat its run" in line


def unfinished_swarm(path: Path) -> tuple[Path, int]:
    """Write a data file as a run that goes on has it. Returns how many bytes come before its rows, too."""
    write_rows(path, swarm(), metadata_of())
    table = feather.read_table(path)
    table = table.replace_schema_metadata({**table.schema.metadata, b"incomplete": b"yes"})
    with path.open("wb") as file:
        file.write(MAGIC)
        ipc.new_stream(file, table.schema).write_table(table)
    return path, len(MAGIC) + table.schema.serialize().size


def test_part_without_rows_may_be_left_out_but_not_one_that_is_damaged(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, before_rows = unfinished_swarm(tmp_path / "unfinished.feather")
    unfinished = path.read_bytes()
    whole = file_of("feather", swarm(), tmp_path / "whole.feather")
    data = tmp_path / "damaged.feather"

    def told(tool: str, content: bytes) -> str:
        data.write_bytes(content)
        assert run(tool, data, whole, tmp_path) == 2
        (line,) = capsys.readouterr().err.splitlines()
        return line

    for count in (len(MAGIC), len(MAGIC) + 5, len(MAGIC) + 8, before_rows - 1):
        assert "damaged.feather is truncated before its first row" in told("recover", unfinished[:count])
        assert f"no run goes on from a saved state in {whole}" in told("join", unfinished[:count])
    for content in (unfinished, whole.read_bytes(), whole.read_bytes()[:-20]):
        place = 24  # in the message that says what columns there are
        damage = content[:place] + bytes(50) + content[place + 50 :]
        for tool in ("recover", "join"):
            assert "damaged.feather is damaged before its first row; copy it again" in told(tool, damage)


def test_heading_that_no_robot_can_have_is_none(tmp_path: Path) -> None:
    rows = swarm()
    rows.loc[[5, 17], "angle"] = [np.inf, -np.inf]
    path = write_rows(tmp_path / "d.feather", rows, metadata_of())
    (stored,), (whole,) = runs_of(path), trajectories_of(*load_dataframe(path))
    for run_of_file in (stored.whole(), whole):
        assert np.argwhere(np.isnan(run_of_file.heading_rad)).tolist() == [[1, 1], [4, 1]]


def test_texts_that_lie_outside_of_their_column_are_damage(tmp_path: Path) -> None:
    names = [f"robot{number}" for number in range(100)]
    table = pa.table({"time": np.zeros(100), "robot_category": names})
    path = tmp_path / "d.feather"
    with ipc.new_file(path, table.schema) as writer:
        writer.write_table(table)
    whole = path.read_bytes()
    begins = np.cumsum([0, *map(len, names)]).astype("<i4").tobytes()
    assert whole.count(begins) == 1
    path.write_bytes(whole.replace(begins, begins[:40] + b"\xff\xff\xff\x7f" + begins[44:]))
    with pytest.raises(DamagedFileError, match=r"d\.feather is "):
        load_dataframe(path)
    with pytest.raises(DamagedFileError, match=r"d\.feather is "):
        list(RowFile(path).read())
    with pytest.raises(DamagedFileError, match=r"d\.feather is "):
        list(row_batches(path).batches)


@pytest.mark.parametrize("kind", ["feather", "feather, compressed", "parquet"])
def test_pieces_have_the_rows_of_the_file(kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pogosim.row_batches.PIECE", 10)
    path = file_of(kind, swarm(), tmp_path / "rows.feather")
    file = RowFile(path)
    assert file.count == 120
    assert [piece.length for piece in file.pieces] == 3 * [10, 10, 10, 2] + [10, 10, 4]
    whole = pa.concat_tables(piece for _, piece in file.read())
    assert whole.to_pandas().equals(swarm())
    some = [(number, piece.column("x").to_pylist()) for number, piece in file.read(["x"], [2, 4])]
    assert some == [(2, list(swarm()["x"][20:30])), (4, list(swarm()["x"][32:42]))]
    assert pa.Table.from_batches(row_batches(path).batches).equals(whole)
