"""Times of data files: 64 bits, and the decimals that are meant."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
from pogosim.batch.result_files.parts import Part
from pogosim.batch.result_files.results import write_results
from pogosim.batch.runs.run_data import read_run
from pogosim.film.making import frame_times
from pogosim.picture.swarm import read_recording
from pogosim.times import as_float64
from pogosim.utils import load_dataframe
from pyarrow import feather
from running import compile_text, example, run

RARE = """
#include "pogobase.h"
typedef struct { uint8_t none; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
void user_init(void) { main_loop_hz = 1; }
void user_step(void) {}
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
"""


def test_times_are_the_numbers_that_are_written(tmp_path: Path) -> None:
    for step in (0.01, 0.0125, 0.005):
        result = run(example("helloworld"), tmp_path / str(step), {"time_step": step, "simulation_time": 1.0})
        assert result.frame()["time"].unique().tolist() == [round(0.1 * i, 1) for i in range(11)]


def test_rows_have_times_of_their_own_after_days(tmp_path: Path) -> None:
    settings = {"simulation_time": 300_000, "time_step": 0.9, "save_data_period": 1.0, "objects.robots.nb": 1}
    program = compile_text(tmp_path, RARE)  # of which 300 000 s are no more than as many ticks
    result = run(program, tmp_path, {**settings, "data_logger_fields": ["time"]})
    assert result.code == 0, result.text
    times = result.frame()["time"].to_numpy()
    assert len(np.unique(times)) == len(times) > 100_000
    assert (np.diff(times) > 0.8).all()


def test_times_of_32_bits_become_the_decimals_that_were_meant() -> None:
    for period in (0.1, 0.01, 1 / 3):
        exact = np.round(period * np.arange(1000), 6 if period == 1 / 3 else 2)
        times = as_float64(exact.astype(np.float32))
        np.testing.assert_allclose(times, exact, rtol=1e-7)
    assert as_float64(np.array([0.1, 0.3, 1234.5], np.float32)).tolist() == [0.1, 0.3, 1234.5]
    assert np.isnan(as_float64(np.array([np.nan, 1.0], np.float32))).tolist() == [True, False]


def old_file(path: Path) -> Path:
    """Write a data file with times of 32 bits."""
    times = pa.array(np.float32(0.1) * np.arange(5, dtype=np.float32), pa.float32())
    table = pa.table({"time": times, "x": pa.array([0.0] * 5, pa.float32())})
    feather.write_feather(
        table.replace_schema_metadata({"program_version": "v0.10.0", "configuration": "{}"}), str(path)
    )
    return path


def new_file(path: Path) -> Path:
    """Write one with times of 64 bits."""
    table = pa.table({"time": pa.array([0.0, 0.1, 0.2, 0.3, 0.4]), "x": pa.array([1.0] * 5, pa.float32())})
    feather.write_feather(
        table.replace_schema_metadata({"program_version": "v0.11.0", "configuration": "{}"}), str(path)
    )
    return path


def test_rows_of_old_and_new_files_have_the_same_times(tmp_path: Path) -> None:
    files = [old_file(tmp_path / "old.feather"), new_file(tmp_path / "new.feather")]
    rows, _ = load_dataframe(files)
    assert rows["time"].dtype == np.float64
    assert rows.groupby("time").size().tolist() == [2] * 5
    write_results(str(tmp_path / "r.feather"), [Part({}, [read_run(file, i, i) for i, file in enumerate(files)])], "{}")
    joined = pd.read_feather(tmp_path / "r.feather")
    assert joined.groupby("time").size().tolist() == [2] * 5


def test_late_moments_are_told_apart(tmp_path: Path) -> None:
    times = np.round(270_000.0 + 0.1 * np.arange(5), 1)
    rows = pd.DataFrame({"time": times, "robot_id": 0, "x": np.arange(5.0), "y": 0.0})
    path = tmp_path / "late.feather"
    rows.attrs["program_version"] = "v0.11.0"
    rows.to_feather(path)
    recording = read_recording(path)
    assert [recording.until(time_s).end_s for time_s in times] == times.tolist()
    assert recording.until(270_000.15).end_s == 270_000.1
    assert len(frame_times(times[0], times[-1], 1.0, 10.0)) == 5
