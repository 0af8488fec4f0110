"""The message log has, for each message, the robots in range and the outcome."""

from __future__ import annotations

import math
import re
import signal
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
import yaml
from batches import batch, write_options
from pogosim import recover
from pogosim.command.recover import main as recover_command
from pogosim.communication.reception_law import DynamicLaw
from pogosim.utils import load_dataframe, read_table
from running import ROOT, Run, compile_program, example, run, start, wait_for_rows, write_scene

# All send for a second, counts what it sends, and what comes to it copy by copy.
COUNTS = """
#include "pogobase.h"
typedef struct { uint32_t sent; uint32_t got; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
static bool send(void) {
    uint16_t payload[2] = {pogobot_helper_getid(), (uint16_t)mydata->sent};
    if (pogobot_ticks >= 60) { return false; }
    mydata->sent++;
    return (mydata->sent %% 2 ? pogobot_infrared_sendShortMessage_omni : pogobot_infrared_sendLongMessage_omniGen)(
        (uint8_t*)payload, sizeof(payload)) == 0;
}
static void get(message_t* message) { (void)message; mydata->got++; }
void user_init(void) {
    max_nb_processed_msg_per_tick = 100;
    percent_msgs_sent_per_ticks = 70;
    msg_tx_fn = send;
    msg_rx_fn = get;
}
void user_step(void) { %s }
static void schema(void) { data_add_column_int32("sent"); data_add_column_int32("got"); }
static void row(void) {
    data_set_value_int32("sent", (int32_t)mydata->sent);
    data_set_value_int32("got", (int32_t)mydata->got);
}
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_create_data_schema, schema);
    SET_CALLBACK(callback_export_data, row);
    return 0;
}
"""
LOGGED = {"message_log": "m.feather", "objects.robots.nb": 25, "arena_surface": 1.0e5}
LONG = {**LOGGED, "simulation_time": 1.0e6, "save_data_period": 0.02}


@cache
def compiled(folder: Path, step: str = "") -> Path:
    source = folder / "counts.c"
    source.write_text(COUNTS % step)
    return compile_program(folder / "counts", source)


@pytest.fixture(scope="module")
def counts(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compiled(tmp_path_factory.mktemp("counts"))


@pytest.fixture(scope="module")
def busy(counts: Path, tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A crowd that hears each other."""
    result = run(counts, tmp_path_factory.mktemp("busy"), LOGGED)
    assert (result.code, result.errors) == (0, "")
    return result


def faces(mask: pd.Series) -> pd.Series:
    """Return how many faces a mask has."""
    return mask.astype(int).map(int.bit_count)


def test_counts_are_those_of_the_program(busy: Run) -> None:
    log, rows = busy.frame("m.feather"), busy.frame()
    last = rows[rows["time"] == rows["time"].max()].set_index("robot_id")
    sent = log.groupby("sender_id")["message"].nunique().reindex(last.index, fill_value=0)
    got = log.groupby("receiver_id")["copies"].sum().reindex(last.index, fill_value=0)
    assert (sent == last["sent"]).all()
    assert (got == last["got"]).all()
    assert sent.sum() > 500
    assert got.sum() > 500
    assert sorted(log["message"].unique()) == list(range(sent.sum()))


def test_rows_of_a_message_agree_with_each_other(busy: Run) -> None:
    log = busy.frame("m.feather")
    assert log["message"].is_monotonic_increasing
    of_message = log.groupby("message")
    same = ["time", "step", "sender", "kind", "payload", "message_bytes", "cluster_size", "send_probability"]
    assert (of_message[same].nunique() == 1).all(axis=None)
    in_reach = of_message["receiver"].count()
    assert (in_reach + 1 == of_message["cluster_size"].first()).all()
    np.testing.assert_allclose(log["time"], 0.01 * log["step"], rtol=1e-6)
    assert set(log["kind"]) == {"short", "long"}
    size = log["payload"].map(len) + np.where(log["kind"] == "short", 3, 8)
    assert (size == log["message_bytes"]).all()
    ids = log["payload"].map(lambda payload: int.from_bytes(payload[:2], "little"))
    assert (ids == log["sender_id"]).all()
    assert (log["sender_faces"] == 15).all()
    there = log[log["receiver"].notna()]
    assert there["distance"].between(0.0, 80.0).all()
    assert (there["receiver"] != there["sender"]).all()
    assert (there["copies"] == faces(there["receiver_faces"]).where(there["outcome"] == "heard", 0)).all()


def test_probability_is_that_of_the_configured_law_and_so_is_the_frequency(busy: Run) -> None:
    log = busy.frame("m.feather")
    tried = log[log["receiver"].notna()]
    law = DynamicLaw().probability(tried["message_bytes"], tried["send_probability"], tried["cluster_size"])
    np.testing.assert_allclose(tried["probability"], law, rtol=1e-6)
    for _, group in tried.groupby(["cluster_size", "kind"]):
        p = group["probability"].astype(float)
        received = (group["outcome"] != "lost").sum()
        assert abs(received - p.sum()) < 4.0 * math.sqrt((p * (1.0 - p)).sum()) + 1.0


def test_drops_are_those_that_the_run_reports(counts: Path, tmp_path: Path) -> None:
    still = {"objects.robots.msg_success_rate": {"type": "static", "rate": 1.0}, "objects.robots.message_queue_size": 1}
    result = run(counts, tmp_path, {**LOGGED, **still})
    reported = re.search(r"(\d+) messages to robots of category 'robots' were lost", result.text)
    assert reported is not None
    log = result.frame("m.feather")
    there = log[log["receiver"].notna()]
    dropped = faces(there["receiver_faces"]) - there["copies"]
    assert dropped.sum() == int(reported[1])
    assert ((there["outcome"] == "queue_full") == (there["copies"] == 0)).all()
    assert set(there["outcome"]) == {"heard", "queue_full"}


def test_faces_are_those_of_robots_placed_by_hand(counts: Path, tmp_path: Path) -> None:
    # On the screen, y points down: the second robot is to the right of the first, and looks away from it.
    poses = [[500.0, 500.0, 0.0], [500.0, 600.0, math.pi / 2.0]]
    robots = {"objects.robots.nb": 2, "objects.robots.poses": poses}
    result = run(counts, tmp_path, {"message_log": "m.feather", **robots})
    log = result.frame("m.feather")
    first = log.drop_duplicates("sender").set_index("sender")
    columns = ["receiver", "reaching_faces", "receiver_faces"]
    assert first.loc[[0, 1], columns].to_numpy().tolist() == [[1, 0b0010, 0b0100], [0, 0b0100, 0b0010]]
    assert first["distance"].tolist() == pytest.approx([47.0, 47.0], abs=0.01)


def test_lonely_robot_has_a_row_without_a_receiver_for_each_message(counts: Path, tmp_path: Path) -> None:
    result = run(counts, tmp_path, {"message_log": "m.feather", "objects.robots.nb": 1})
    log = result.frame("m.feather")
    assert len(log) == log["message"].nunique() == result.frame()["sent"].max() > 20
    nothing = ["receiver", "receiver_id", "receiver_category", "distance", "reaching_faces", "receiver_faces"]
    assert log[[*nothing, "probability"]].isna().all(axis=None)
    assert set(log["outcome"]) == {"nobody_in_reach"}
    assert set(log["cluster_size"]) == {1}


def test_log_of_robots_that_send_nothing_is_empty(tmp_path: Path) -> None:
    result = run(example("helloworld"), tmp_path, {"message_log": "m.feather"})
    assert (result.code, len(result.frame("m.feather"))) == (0, 0)


def test_columns_are_those_of_the_documentation(busy: Run) -> None:
    page = (ROOT / "docs" / "message_log.md").read_text()
    documented = [
        (name, type_of)
        for names, type_of in re.findall(r"^\| (`[^|]*`) \| (\w+) \|", page, re.MULTILINE)
        for name in re.findall(r"`(\w+)`", names)
    ]
    schema = busy.table("m.feather").schema
    names = {"float": "float32", "double": "float64"}
    written = [(field.name, names.get(str(field.type), str(field.type))) for field in schema]
    assert written == documented


def test_metadata_are_those_of_the_data_file(busy: Run) -> None:
    assert busy.table("m.feather").schema.metadata == busy.table().schema.metadata
    _, metadata = load_dataframe(busy.folder / "m.feather")
    assert metadata["configuration"]["message_log"] == "m.feather"
    assert metadata["resolved_configuration"]["message_log"] == "m.feather"


def test_log_changes_no_other_row_and_is_the_same_each_time(busy: Run, counts: Path, tmp_path: Path) -> None:
    again = run(counts, tmp_path / "again", LOGGED)
    assert (again.folder / "m.feather").read_bytes() == (busy.folder / "m.feather").read_bytes()
    without = run(counts, tmp_path / "without", {**LOGGED, "message_log": ""})
    assert without.table().equals(busy.table())
    assert not (without.folder / "m.feather").exists()


def test_empty_name_leaves_the_data_file_as_it_is_without_the_key(counts: Path, tmp_path: Path) -> None:
    metadata = run(counts, tmp_path, {}).table().schema.metadata
    assert b"message_log" not in metadata[b"configuration"]
    assert b"message_log" not in metadata[b"resolved_configuration"]


def test_command_line_sets_it_and_no_data_file_is_needed(counts: Path, tmp_path: Path) -> None:
    write_scene(tmp_path, {"enable_data_logging": False})
    result = run(counts, tmp_path, {"enable_data_logging": False}, ["--set", "message_log=a/b/m.feather"])
    assert (result.code, result.errors) == (0, "")
    assert len(result.frame("a/b/m.feather")) > 0
    assert not (tmp_path / "data.feather").exists()


# ---- runs that end early ----


def test_interrupted_run_completes_both_files(counts: Path, tmp_path: Path) -> None:
    process = start(counts, tmp_path, LONG)
    wait_for_rows(tmp_path / "m.feather")
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate()
    assert process.returncode == 130
    assert "'data.feather' contains all rows up to that point, the message log 'm.feather' all messages" in errors
    for name in ("data.feather", "m.feather"):
        assert recover.is_complete(tmp_path / name)
        assert len(Run(0, "", "", tmp_path).frame(name)) > 0
    assert not list(tmp_path.glob("*.pogosim-*"))


def test_crash_of_the_program_completes_both_files(tmp_path: Path) -> None:
    program = compiled(tmp_path, "if (pogobot_ticks == 50) { *(volatile int*)0 = 1; }")
    result = run(program, tmp_path, LOGGED)
    assert result.code == 3
    assert "the message log 'm.feather' all messages" in result.errors
    for name in ("data.feather", "m.feather"):
        assert recover.is_complete(tmp_path / name)
    assert len(result.frame("m.feather")) > 0


def test_killed_run_leaves_its_first_messages(counts: Path, busy: Run, tmp_path: Path) -> None:
    process = start(counts, tmp_path, LONG)
    wait_for_rows(tmp_path / "m.feather")
    process.kill()
    process.communicate()
    path = tmp_path / "m.feather"
    with pytest.warns(RuntimeWarning, match=r"is incomplete: .* up to t = .* s; .*pogosim-recover"):
        rows, _ = load_dataframe(path)
    pd.testing.assert_frame_equal(rows, busy.frame("m.feather").iloc[: len(rows)], check_dtype=False)
    assert recover_command([str(path)]) == 0
    pd.testing.assert_frame_equal(load_dataframe(path)[0], rows)
    assert read_table(path).schema.field("payload").type == pa.binary()


def test_full_disk_ends_the_run_with_the_first_messages_and_all_rows(counts: Path, tmp_path: Path) -> None:
    limited = tmp_path / "limited"
    limited.write_text(f"#!/bin/sh\nulimit -f 120\nexec '{counts}' \"$@\"\n")  # 512 or 1024 bytes each
    limited.chmod(0o755)
    result = run(limited, tmp_path, {**LOGGED, "objects.robots.nb": 60, "arena_surface": 3.0e5})
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert "cannot write the message log 'm.feather' (message_log): File too large. It contains the rows up to" in line
    assert "pogosim-recover 'm.feather'" in line
    assert len(recover.read_unfinished(tmp_path / "m.feather").table) > 0
    assert recover.is_complete(tmp_path / "data.feather")
    assert len(result.frame()) > 0


# ---- bad values ----


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("folder", "cannot write the message log 'folder' (message_log): Is a directory"),
        (
            "scene.yaml/m.feather",
            "'scene.yaml/m.feather' (message_log): cannot make the folder 'scene.yaml': Not a directory",
        ),
        ("/dev/null", "cannot write the message log '/dev/null' (message_log): it is a device"),
        ("/dev/full", "cannot write the message log '/dev/full' (message_log): No space left on device"),
        ("/proc/m.feather", "cannot write the message log '/proc/m.feather' (message_log): "),
        ("data.feather", "message_log: 'data.feather' is the same file as data_filename 'data.feather' (scene.yaml:"),
        ("./data.feather", "message_log: './data.feather' is the same file as data_filename 'data.feather'"),
        ("data.feather.pogosim-new", "is the same file as message_log 'data.feather.pogosim-new' (scene.yaml:"),
        ("scene.yaml", "message_log: 'scene.yaml' is the same file as the configuration file 'scene.yaml'"),
        (["a"], "message_log: expected a string, found a list"),
        ({"a": 1}, "message_log: expected a string, found a map"),
    ],
)
def test_bad_value_is_one_message(counts: Path, name: object, said: str, tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    result = run(counts, tmp_path, {"message_log": name, "data_filename": "data.feather"})
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert line.startswith("Error: ")
    assert said in line
    assert not (tmp_path / "data.feather").exists()
    assert yaml.safe_load((tmp_path / "scene.yaml").read_text())["seed"] == 1


def test_place_where_it_is_put_together_counts_as_an_output(counts: Path, tmp_path: Path) -> None:
    result = run(counts, tmp_path, {"message_log": "m.feather", "data_filename": "m.feather.pogosim-new"})
    assert result.code == 2
    assert "(used to assemble the message log) is the same file as data_filename" in result.errors


def test_second_run_that_writes_the_same_log_is_refused(counts: Path, tmp_path: Path) -> None:
    process = start(counts, tmp_path, LONG)
    wait_for_rows(tmp_path / "m.feather")
    second = run(counts, tmp_path, {**LOGGED, "data_filename": "b.feather"})
    process.kill()
    process.communicate()
    assert second.code == 2
    assert "'m.feather' (message_log): in use by another run" in second.errors
    assert not (tmp_path / "b.feather").exists()


# ---- batches ----


def test_batch_puts_it_into_the_folder_of_each_run(counts: Path, tmp_path: Path) -> None:
    write_options(tmp_path, {"message_log": "elsewhere/m.feather", "objects.robots.nb": 3})
    result = batch(tmp_path, "-r", "2", "--keep-temp", program=counts)
    assert result.code == 0, result.text
    logs = sorted((tmp_path / "tmp").rglob("m.feather"))
    assert [log.parent.name for log in logs] == ["frames", "frames"]
    assert all(len(load_dataframe(log)[0]) > 0 for log in logs)
    assert not (tmp_path / "elsewhere").exists()
    assert "message_log" not in load_dataframe(tmp_path / "results" / "result.feather")[1]["resolved_configuration"]
