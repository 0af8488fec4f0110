"""What a batch says about the logs of its runs."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path
from typing import cast

import pytest
from batches import batch, script, start_batch, write_options
from pogosim.batch.reports import SHOWN_WARNINGS, report_warnings
from pogosim.batch.runs.run_log import LOG, LOG_LINES, MAX_WARNINGS, tail, warnings_in
from pogosim.batch.runs.running import Running, Watch
from running import compile_text


def write_log(folder: Path, lines: list[str]) -> Path:
    """Write the log of a run."""
    path = folder / LOG
    path.write_text("".join(f"{line}\n" for line in lines))
    return path


def test_warning_before_many_other_lines_is_shown_and_each_once(tmp_path: Path) -> None:
    write_options(tmp_path, {"objects.robots.nb": 2})
    lines = "echo '[2026] [warning] too hot'; yes chatter | head -n 10000"
    result = batch(tmp_path, "-r", "2", program=script(tmp_path / "warns", lines))
    assert (result.code, result.errors) == (0, "pogobatch: warning of a run: too hot\n")


def test_warnings_of_a_log_have_no_dates_no_temporary_names_and_nothing_twice(tmp_path: Path) -> None:
    place = f"{tmp_path}/test.yaml"
    lines = ["[1] [warning] a", "other", f"[2] [warning] b ({place}:3)", "[3] [warning] a", "[4] [warning] \x1b[1mc"]
    write_log(tmp_path, lines)
    assert warnings_in(tmp_path).splitlines() == ["a", "b (<configuration>:3)", "\\x1b[1mc"]


def test_endless_log_is_read_in_pieces_and_only_so_many_warnings_are_kept(tmp_path: Path) -> None:
    with (tmp_path / LOG).open("wb") as log:
        log.truncate(3_000_000)  # one line
    with (tmp_path / LOG).open("a") as log:
        log.writelines(f"\n[warning] {number}" for number in range(2 * MAX_WARNINGS))
    assert warnings_in(tmp_path).splitlines() == [str(number) for number in range(MAX_WARNINGS)]


def test_run_without_a_log_has_no_warnings(tmp_path: Path) -> None:
    assert (warnings_in(tmp_path), tail(tmp_path / LOG)) == ("", "")


@pytest.mark.parametrize("more", [0, 1, 20])
def test_of_many_warnings_the_first_are_shown_and_the_others_counted(
    more: int, caplog: pytest.LogCaptureFixture
) -> None:
    report_warnings(f"w{number}" for number in range(SHOWN_WARNINGS + more))
    shown = [f"warning of a run: w{number}" for number in range(SHOWN_WARNINGS)]
    counted = f"not shown: {more} more warning(s) of runs; a single run prints its own"
    assert caplog.messages == [*shown, *([counted] if more else [])]


def test_last_ten_lines_of_a_failed_run_are_shown_and_nothing_that_a_terminal_obeys(tmp_path: Path) -> None:
    write_log(tmp_path, [*map(str, range(10_000)), "\x1b[2Jlast\tword"])
    assert LOG_LINES == 10
    assert tail(tmp_path / LOG).splitlines() == [*map(str, range(9991, 10_000)), "\\x1b[2Jlast\\tword"]
    write_options(tmp_path, {"objects.robots.nb": 2})
    result = batch(tmp_path, "-R", "0", program=script(tmp_path / "broken", "seq 100; exit 3"))
    assert [line.split("| ")[1] for line in result.errors.splitlines() if "| " in line] == [*map(str, range(91, 101))]


BLOCKS = """
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <time.h>
#include "pogobase.h"
typedef struct { int unused; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
static void user_init(void) {}
static void user_step(void) {
#ifdef AGAIN
    struct timespec wait = {0, 500000000};
    nanosleep(&wait, NULL);
#else
    struct timespec wait = {6, 0};
    for (int i = 0; i < 1200000 && pogobot_ticks == 3; i++) fputc(i % 100 == 99 ? '\\n' : '.', stderr);
    if (pogobot_ticks == 3) nanosleep(&wait, NULL);
#endif
}
int main(void) { pogobot_init(); pogobot_start(user_init, user_step); return 0; }
"""


@pytest.mark.parametrize(
    ("how", "text"), [("", "has blocked for 2 s"), ("#define AGAIN\n", "blocks again and again: for 2 s")]
)
def test_blocked_run_is_said_once_while_it_lasts(tmp_path: Path, how: str, text: str) -> None:
    program = compile_text(tmp_path, how + BLOCKS)
    write_options(tmp_path, {"objects.robots.nb": 1, "simulation_time": 0.2})
    with start_batch(tmp_path, "-r", "2", "-j", "2", program=program) as process:
        assert process.stderr is not None
        said = next(line for line in process.stderr if "is blocked" in line)
        assert process.poll() is None
        match = re.search(r"a run is blocked, and goes on: user_step of robot #0 .* \(its log: (.*)\)$", said.strip())
        assert match is not None, said
        assert text in Path(match[1]).read_text()
        _, errors = process.communicate(timeout=60)
    assert process.returncode == 0
    assert "is blocked" not in errors


def test_time_without_an_end_of_a_run_is_said_in_ever_longer_intervals(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The clock of the test stands for the hours that such runs take."""
    watch = Watch()
    watch.begin()
    now_s = [watch.last_end_s]
    monkeypatch.setattr("pogosim.batch.runs.running.time.monotonic", lambda: now_s[0])
    running = Running(cast("subprocess.Popen[bytes]", None), tmp_path / "log.txt")
    caplog.set_level("INFO", logger="pogobatch")
    for minute in range(1, 11):
        now_s[0] = running.started_s + 60.0 * minute
        watch.look_at([running])
    assert [record.getMessage().split(";")[0] for record in caplog.records] == [
        f"no run has ended for {seconds} s" for seconds in (60, 120, 240, 480)
    ]
    assert str(tmp_path / "log.txt") in caplog.text
