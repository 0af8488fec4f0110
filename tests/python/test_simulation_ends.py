"""How runs inside of this process end: interrupted, collected, forgotten at the end of a script, in a forked child."""

from __future__ import annotations

import gc
import inspect
import os
import signal
import subprocess
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import pogosim
import pytest
from pogosim.simulation.library import library
from pogosim.utils import load_dataframe
from running import ROOT, write_scene
from threads_of_a_run import SPECIAL, names_of

FOLDER = Path(pogosim.simulation.__file__).parent


@pytest.fixture(autouse=True)
def _folders(monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory) -> None:
    monkeypatch.setenv("POGOSIM_DIR", str(ROOT))
    monkeypatch.setenv("TMPDIR", str(tmp_path_factory.mktemp("t")))  # short: names of sockets have 107 characters


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """A configuration of three robots and 2 s."""
    return write_scene(tmp_path, {"arena_file": str(ROOT / "arenas" / "disk.csv"), "save_data_period": 0.5})


def interrupt_in(function: str, call: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let Ctrl-C come while a function of the library is called for the so-manieth time."""
    real, calls = getattr(library(), function), []

    def interrupted(*arguments: Any) -> Any:
        status = real(*arguments)
        calls.append(status)
        if len(calls) == call:
            signal.raise_signal(signal.SIGINT)
        return status

    monkeypatch.setattr(library(), function, interrupted)


def test_run_is_over_though_ctrl_c_came_in_its_last_step(
    hosted: Path, scene: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pogosim.Simulation(hosted, scene) as simulation:
        interrupt_in("pogosim_run_take_turn", 1, monkeypatch)
        with pytest.raises(KeyboardInterrupt):
            simulation.run()
        assert simulation.steps == simulation.step_count
        assert simulation.is_over
        assert simulation.run() == 0


@pytest.mark.parametrize("function", ["pogosim_run_end", "pogosim_run_close"])
@pytest.mark.parametrize("is_closed", [True, False])
def test_ctrl_c_while_a_run_is_freed_reaches_the_program(
    is_closed: bool, function: str, hosted: Path, scene: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    interrupt_in(function, 1, monkeypatch)
    simulations = [pogosim.Simulation(hosted, scene)]

    def forget() -> None:
        if is_closed:
            simulations[0].close()
        simulations.clear()
        gc.collect()
        time.sleep(10)  # the program goes on

    # Python drops what is raised in callbacks of its garbage collector and of weak references: keep those of other
    # tests' libraries and objects out.
    callbacks = gc.callbacks[:]
    gc.callbacks.clear()
    gc.collect()
    gc.freeze()
    try:
        with pytest.raises(KeyboardInterrupt):
            forget()
    finally:
        gc.unfreeze()
        gc.callbacks.extend(callbacks)
    simulations.clear()


@pytest.mark.parametrize("function", ["pogosim_run_open", "pogosim_run_end", "pogosim_run_number"])
def test_reset_that_ctrl_c_interrupted_can_be_done_again(
    function: str, hosted: Path, scene: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pogosim.Simulation(hosted, scene, seed=4) as simulation:
        simulation.step(20)
        with monkeypatch.context() as patch:
            interrupt_in(function, 1, patch)
            with pytest.raises(KeyboardInterrupt):
                simulation.reset()
        simulation.reset()
        assert (simulation.seed, simulation.steps, simulation.step(5)) == (4, 0, 5)


def interrupted_at(moment: int, what: Callable[[], Any]) -> bool:
    """Let Ctrl-C come when a function of pogosim.simulation begins or returns.

    Args:
        moment: Which one of these moments, from 1.
        what: What is interrupted.

    Returns:
        Whether there are so many.
    """
    left = moment

    def tracer(frame: FrameType, event: str, _argument: Any) -> Any:
        nonlocal left
        if Path(frame.f_code.co_filename).parent != FOLDER:
            return None
        frame.f_trace_lines = False
        left -= event in ("call", "return")
        if left == 0:
            sys.settrace(None)
            raise KeyboardInterrupt
        return tracer

    sys.settrace(tracer)
    try:
        what()
    except KeyboardInterrupt:
        return True
    finally:
        sys.settrace(None)
    return False


def left_over() -> list[str]:
    """What runs have left in the folder for temporary files."""
    folder = Path(os.environ["TMPDIR"])
    if any(folder.glob("pogosim*")):
        gc.collect()
    return sorted(path.name for path in folder.glob("pogosim*"))


def test_ctrl_c_at_any_moment_of_the_construction_leaves_no_file(hosted: Path, scene: Path) -> None:
    pogosim.Simulation(hosted, scene).close()  # has imported and loaded everything
    moment, made = 1, list[pogosim.Simulation]()
    while interrupted_at(moment, lambda: made.append(pogosim.Simulation(hosted, scene))):
        assert not left_over(), f"moment {moment}"
        moment += 1
    assert moment > 40
    made.pop().close()
    assert not left_over()


@pytest.mark.parametrize("action", ["reset", "close"])
def test_ctrl_c_at_any_moment_of_reset_or_close_leaves_no_file(action: str, hosted: Path, scene: Path) -> None:
    moment, is_interrupted = 1, True
    while is_interrupted:
        simulation = pogosim.Simulation(hosted, scene)
        positions = simulation.positions  # keeps the memory of the run
        is_interrupted = interrupted_at(moment, getattr(simulation, action))
        simulation.close()
        assert positions.shape == (3, 2)
        del simulation, positions
        assert not left_over(), f"moment {moment}"
        moment += 1
    assert moment > 10


def test_ctrl_c_at_random_moments_of_the_construction_leaves_no_file(hosted: Path, scene: Path) -> None:
    script = """
import os, random, signal, sys, threading, time, pogosim
pogosim.Simulation(*sys.argv[1:]).close()
draw, interrupts = random.Random(1), 0
for round in range(100):
    try:
        threading.Timer(draw.uniform(0, 0.02), os.kill, (os.getpid(), signal.SIGINT)).start()
        for _ in range(200):
            pogosim.Simulation(*sys.argv[1:])
    except KeyboardInterrupt:
        interrupts += 1
print(interrupts)
"""
    command = [sys.executable, "-c", script, str(hosted), str(scene)]
    result = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert result.returncode == 0, result.stderr
    assert int(result.stdout) > 50  # Python ignores those in finalisers, and says so
    assert not left_over()


HEAD = """
import glob, multiprocessing, os, sys, threading, pogosim
def left():
    return glob.glob(os.environ['TMPDIR'] + '/pogosim-*')
def make(**options):
    simulation = pogosim.Simulation(sys.argv[1], sys.argv[2], **options)
    simulation.step(60)
    return simulation
def forget():
    global kept
    kept = make()
"""
ENDINGS = {
    "alive at the end of the script": "kept = make()",
    "collected": "make(); assert not left()",
    "collected in a circle": "import gc\nloop = [make()]; loop.append(loop); del loop; gc.collect()\nassert not left()",
    "an exception": "kept = make(); error = 1 / 0",
    "sys.exit": "kept = make(); sys.exit(3)",
    "its arrays are kept": "positions = make().positions; columns = make().columns",
    "reset": "kept = make(); kept.reset(); kept.step(10)",
    "closed": "kept = make(); kept.close(); kept.close()",
    "a thread": "thread = threading.Thread(target=make); thread.start(); thread.join()\nassert not left()",
    "a thread that still steps": "kept = make(set={'simulation_time': 1e7, 'save_data_period': -1})\n"
    "threading.Thread(target=kept.run, daemon=True).start()",
    "a failing program": "kept = make(set={'parameters.fail_at_tick': 5})",
    "a wrong configuration": "kept = make(set={'objects.robots.nb': -5})",
    "many": "kept = pogosim.VectorSimulation(*sys.argv[1:], seeds=range(3)); kept.step(10)",
    "a forked child": "kept = make(); child = os.fork()\n"
    "if child: os.waitpid(child, 0); print(len(kept.to_dataframe()))",
    "fork": "child = multiprocessing.get_context('fork').Process(target=forget); child.start(); child.join()\n"
    "assert not left()",
    "forkserver": "if __name__ == '__main__':\n"
    "    child = multiprocessing.get_context('forkserver').Process(target=forget); child.start(); child.join()\n"
    "    assert not left()",
    "a pool": "pool = multiprocessing.get_context('fork').Pool(2)\n"
    "pool.map(type(forget)(forget.__code__, globals()), []) \npool.close(); pool.join()",
}


@pytest.mark.parametrize("ending", ENDINGS)
def test_temporary_files_are_removed_however_a_script_ends(
    ending: str, hosted: Path, scene: Path, tmp_path: Path
) -> None:
    script = tmp_path / "script.py"
    script.write_text(HEAD + ENDINGS[ending] + "\n")
    ended = subprocess.run(
        [sys.executable, script, hosted, scene], capture_output=True, text=True, timeout=60, check=False
    )
    fails = {"an exception": 1, "sys.exit": 3, "a failing program": 1, "a wrong configuration": 1}
    assert ended.returncode == fails.get(ending, 0), ended.stderr
    assert "Exception ignored" not in ended.stderr
    assert [found.name for found in Path(os.environ["TMPDIR"]).iterdir() if found.name.startswith("pogosim-")] == []
    if ending == "a forked child":
        assert ended.stdout == "6\n"


def test_named_file_of_a_forgotten_run_is_complete(hosted: Path, scene: Path, tmp_path: Path) -> None:
    file = tmp_path / "rows.feather"
    simulation = pogosim.Simulation(hosted, scene, data_file=file)
    simulation.step(60)
    positions = simulation.positions
    del simulation
    gc.collect()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rows, _ = load_dataframe(file)
    assert len(rows) == 6
    assert positions.shape == (3, 2)


def in_a_child(check: Callable[[], str]) -> str:
    """Return what a check returns in a forked child."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            text = check()
        except BaseException as error:
            text = f"{type(error).__name__}: {error}"
        os.write(writer, text.encode())
        os._exit(0)
    os.close(writer)
    with os.fdopen(reader) as pipe:
        text = pipe.read()
    os.waitpid(child, 0)
    return text


def closed_quietly(runs: pogosim.Simulation | pogosim.VectorSimulation) -> str:
    """Close, as a `with` block does."""
    runs.close()
    return "quiet"


ARGUMENTS: dict[str, Any] = {
    "robot": 0,
    "x": 500,
    "y": 500,
    "name": "steps_of_all",
    "value": 1,
    "file": "/dev/null",
    "category": "robots",
    "state": None,
    "a": 0,
    "b": 1,
    "links": [],
}


def answers_in_a_child(simulation: pogosim.Simulation) -> str:
    """Use everything of a simulation; returns what did not say that it belongs to another process."""
    silent = []
    for name in names_of(pogosim.Simulation):
        if name in ("close", "lamps", "objects", "parameters", *SPECIAL):  # see below
            continue
        try:
            value = getattr(simulation, name)
            if callable(value):
                needed = [one.name for one in inspect.signature(value).parameters.values() if one.default is one.empty]
                value(*(ARGUMENTS[argument] for argument in needed))
            silent.append(name)
        except pogosim.SimulationError as error:
            assert "which has forked this one: make one of its own here" in str(error)
    return " ".join(silent)


def test_forked_child_gets_an_error_for_all_that_it_asks(hosted: Path, scene: Path) -> None:
    with pogosim.Simulation(hosted, scene) as simulation:
        simulation.step(60)
        positions, columns, objects = simulation.positions, simulation.columns, list(simulation.objects)
        assert in_a_child(lambda: answers_in_a_child(simulation)) == ""
        assert "belongs to process" in in_a_child(lambda: str(columns.time))
        assert "belongs to process" in in_a_child(lambda: str(objects[0].position))
        assert "belongs to process" in in_a_child(lambda: str(len(simulation.lamps)))
        assert "belongs to process" in in_a_child(lambda: str(simulation.parameters.update(gain=3.0)))
        assert in_a_child(lambda: str(positions.shape)) == "(3, 2)"
        assert in_a_child(lambda: closed_quietly(simulation)) == "quiet"
        assert "closed" in in_a_child(lambda: repr(simulation))
        assert len(simulation.to_dataframe()) == 6
        simulation.run()
        assert len(simulation.to_dataframe()) == 15


@pytest.mark.parametrize("use", ["in_a_forked_child", "of_a_closed_one"])
def test_rows_are_refused_before_pandas_is_read(use: str, hosted: Path, scene: Path) -> None:
    script = scene.parent / "script.py"
    script.write_text(
        "import os, sys, pogosim\n"
        f"simulation = pogosim.Simulation({str(hosted)!r}, {str(scene)!r})\n"
        "def look():\n"
        "    try:\n        simulation.to_dataframe()\n"
        "    except pogosim.SimulationError:\n"
        "        print('pandas' in sys.modules, flush=True)\n"
        "def in_a_forked_child():\n"
        "    child = os.fork()\n"
        "    if child == 0:\n        look()\n        os._exit(0)\n"
        "    os.waitpid(child, 0)\n"
        "def of_a_closed_one():\n    simulation.close()\n    look()\n"
        f"{use}()\n"
    )
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout == "False\n", done.stderr


def test_many_runs_in_a_forked_child_do_not_wait_for_threads_that_it_lacks(hosted: Path, scene: Path) -> None:
    with pogosim.VectorSimulation(hosted, scene, seeds=range(2)) as runs:
        runs.step(5)
        for use in (lambda: runs.step(5), runs.reset, lambda: runs.positions, lambda: runs.is_over):
            assert "belongs to process" in in_a_child(lambda use=use: str(use()))  # type: ignore[misc]
        assert in_a_child(lambda: closed_quietly(runs)) == "quiet"
        assert runs.step(5) == [5, 5]


def test_interrupted_reset_can_be_repeated(hosted: Path, scene: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pogosim.Simulation(hosted, scene, seed=1) as sim:
        with monkeypatch.context() as patch:
            interrupt_in("pogosim_run_open", 1, patch)
            with pytest.raises(KeyboardInterrupt):
                sim.reset()
        with pytest.raises(pogosim.SimulationError, match="the last reset failed or was interrupted: reset again"):
            sim.step()
        sim.reset()
        assert sim.step(10) == 10
