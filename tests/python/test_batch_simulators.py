"""How a batch runs its simulators: how many at once, with which command, and until which signal."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from batches import batch, script, start_batch, wait_for_simulators, wait_until_gone, write_options
from pogosim.batch.ending import catch_signals
from pogosim.pogobatch import PogobotBatchRunner

ENDING = [signal.SIGHUP, signal.SIGINT, signal.SIGTERM]

# Counts those that are at work, waits until as many as may be are, and a moment longer, in which more might come.
COUNT = """
cd "$(dirname "$0")"
touch begun.$seed; touch at_work.$seed
ls at_work.* | wc -l >> counts
for i in $(seq 200); do [ "$(ls begun.* | wc -l)" -ge "$EXPECTED" ] && break; sleep 0.05; done
sleep 0.1
ls at_work.* | wc -l >> counts
rm at_work.$seed
cd - > /dev/null
"""


@pytest.mark.parametrize(
    ("options", "expected"), [(["-j", "1"], 1), (["-j", "2"], 2), (["--backend", "sequential", "-j", "2"], 1)]
)
def test_as_many_simulators_run_at_once_as_are_asked_for_and_no_more(
    options: list[str], expected: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_options(tmp_path, {"objects.robots.nb": 2})
    monkeypatch.setenv("EXPECTED", str(expected))
    result = batch(tmp_path, "-r", str(2 * expected), *options, program=script(tmp_path / "counted", COUNT))
    assert (result.code, result.errors) == (0, "")
    assert max(map(int, (tmp_path / "counts").read_text().split())) == expected


@pytest.mark.parametrize(("options", "last"), [([], ["-g"]), (["--gui"], [])])
def test_simulators_are_quiet_and_print_no_robots_and_have_a_window_only_if_asked_for(
    options: list[str], last: list[str], tmp_path: Path
) -> None:
    write_options(tmp_path, {"objects.robots.nb": 2})
    program = script(tmp_path / "listed", 'echo "$@" > "$(dirname "$0")/arguments"; exit 3')
    assert batch(tmp_path, "-R", "0", *options, program=program).code == 3
    flag, configuration, *others = (tmp_path / "arguments").read_text().split()
    assert (flag, Path(configuration).name) == ("-c", "test.yaml")
    assert others == ["-nr", "-q", "--seed", "0", *last]


def test_time_of_simulators_is_added_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_options(tmp_path, {"objects.robots.nb": 2})
    monkeypatch.chdir(tmp_path)
    program = script(tmp_path / "slow", "sleep 0.1")
    runner = PogobotBatchRunner("many.yaml", 3, str(program), "tmp", "results", workers=3)
    runner.run_all()
    assert runner.simulator_s >= 3 * 0.1  # however fast the machine


# ---- Signals ----


@pytest.fixture
def usual_signals() -> Iterator[None]:
    """Put the handlers of signals back afterwards."""
    handlers = {number: signal.getsignal(number) for number in ENDING}
    yield
    for number, handler in handlers.items():
        signal.signal(number, handler)


@pytest.mark.usefixtures("usual_signals")
@pytest.mark.parametrize("number", ENDING)
def test_signal_that_ends_programs_ends_a_batch_as_ctrl_c_does(number: signal.Signals) -> None:
    signal.signal(number, signal.SIG_DFL)
    catch_signals()
    with pytest.raises(KeyboardInterrupt):
        os.kill(os.getpid(), number)


@pytest.mark.usefixtures("usual_signals")
@pytest.mark.parametrize("number", ENDING)
def test_signal_that_is_ignored_as_under_nohup_stays_ignored(number: signal.Signals) -> None:
    signal.signal(number, signal.SIG_IGN)
    catch_signals()
    os.kill(os.getpid(), number)
    assert signal.getsignal(number) == signal.SIG_IGN


@pytest.mark.skipif(sys.platform != "linux", reason="needs /proc")
def test_closed_terminal_ends_a_batch_and_its_simulators_in_good_order(tmp_path: Path) -> None:
    write_options(tmp_path)
    process = start_batch(tmp_path, "-r", "2", program=script(tmp_path / "slow", "sleep 60"))
    assert wait_for_simulators(tmp_path, process)
    process.send_signal(signal.SIGHUP)
    _, errors = process.communicate(timeout=30)
    assert (process.returncode, errors) == (
        130,
        "pogobatch: interrupted; finished runs are kept in tmp: the same command continues\n",
    )
    wait_until_gone(tmp_path)
    # What a run has left in tmp is removed by the next batch.
    assert {path.name for path in tmp_path.iterdir()} - {"tmp"} == {"many.yaml", "results", "slow"}
    assert list((tmp_path / "results").iterdir()) == []
