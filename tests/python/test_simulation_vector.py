"""Many runs that go on by one call: arrays of all of them, and brains whose rows are runs and robots."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import numpy as np
import pogosim
import pytest
from running import example, write_scene

ROBOTS = 3
SCENE: dict[str, Any] = {
    "arena_surface": 1e6,
    "simulation_time": 10,
    "enable_data_logging": False,
    "objects.robots.nb": ROBOTS,
    "objects.robots.brain": "host",
    "objects.robots.msg_success_rate": {"type": "static", "rate": 1.0},
}


def many(folder: Path, runs: int = 4, threads: int = 2, **changes: Any) -> pogosim.VectorSimulation:
    """Begin runs that this process drives."""
    return pogosim.VectorSimulation(None, write_scene(folder, SCENE | changes), range(runs), threads=threads)


def powers(step: int, run: int) -> np.ndarray[Any, Any]:
    """Return powers of the robots of a run for a step."""
    return np.random.default_rng((step, run)).integers(-1023, 1024, (ROBOTS, 3))


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_brain_of_many_runs_does_what_brains_of_each_do(threads: int, tmp_path: Path) -> None:
    path = write_scene(tmp_path, SCENE)
    with pogosim.VectorSimulation(None, path, range(4), threads=threads) as runs:
        brain = runs.brain("robots")
        assert brain is runs.brain("robots")
        assert (brain.motors.shape, brain.leds.shape) == ((4, ROBOTS, 3), (4, ROBOTS, 5, 3))
        seen = []
        for step in range(50):
            brain.motors = np.stack([powers(step, run) for run in range(4)])
            brain.leds[..., 0, 0] = step
            assert runs.step(2) == [2] * 4
            seen.append(brain.acceleration.copy())
        hashes = [sim.state_hash for sim in runs]
    for run in range(4):
        with pogosim.Simulation(None, path, seed=run) as sim:
            own = sim.brain("robots")
            for step in range(50):
                own.motors[:] = powers(step, run)
                own.leds[:, 0, 0] = step
                sim.step(2)
                assert np.array_equal(own.acceleration, seen[step][run])
            assert sim.state_hash == hashes[run]


def test_arrays_of_many_runs_are_those_of_each(tmp_path: Path) -> None:
    with many(tmp_path) as runs:
        runs.brain("robots").motors[:] = 500
        runs.brain("robots").leds[:] = 7
        runs.step(30)
        for name in (
            "positions",
            "headings",
            "velocities",
            "angular_velocities",
            "leds",
            "light_levels",
            "messages_sent",
            "messages_received",
        ):
            found, expected = getattr(runs, name), np.stack([getattr(sim, name) for sim in runs])
            assert found.dtype == expected.dtype
            assert np.array_equal(found, expected)
            assert not np.shares_memory(found, getattr(runs, name))
        assert (runs.velocities != 0).any()
        assert (runs.leds == 7).all()


def test_user_data_and_columns_of_many_runs_are_those_of_each(hosted: Path, tmp_path: Path) -> None:
    path = write_scene(tmp_path, {"simulation_time": 3, "objects.robots.nb": ROBOTS})
    with pogosim.VectorSimulation(hosted, path, range(3), threads=2) as runs:
        runs.step(150)
        own = np.stack([sim.user_data for sim in runs])
        assert all(np.array_equal(runs.user_data[name], own[name]) for name in own.dtype.names or ())
        assert own["age"].all()
        assert len(runs[0].columns) == 2
        assert not np.shares_memory(runs.user_data, runs[0].user_data)
        for name in runs[0].columns:
            found, expected = runs.column(name), [sim.columns[name] for sim in runs]
            assert found.dtype == expected[0].dtype
            assert np.array_equal(found.mask, np.stack([values.mask for values in expected]))
            assert np.array_equal(found.filled(0), np.stack([values.filled(0) for values in expected]))


def test_received_messages_of_all_runs_are_those_of_each(tmp_path: Path) -> None:
    with many(tmp_path, arena_surface=4e4) as runs:
        brain = runs.brain("robots")
        assert len(brain.received) == len(brain.received_bytes) == 0
        brain.send_bytes[1:3, 0, 0] = [7, 8]
        brain.send_length[1:3, 0] = 1
        runs.step(10)
        messages, payloads = brain.received, brain.received_bytes
        assert set(messages["run"].tolist()) == {1, 2}
        for run in (1, 2):
            own = runs[run].brain("robots")
            of_run = messages[messages["run"] == run]
            assert of_run[["robot", "sender", "face", "length"]].tolist() == [
                (*message.item()[:3], message.item()[3]) for message in own.received
            ]
            assert payloads[of_run["offset"]].tolist() == [6 + run] * len(own.received)
        brain.clear_received()
        assert len(brain.received) == 0


@pytest.mark.parametrize("which", [[False, True, False, True], [1, 3], np.array([3, 1])])
def test_some_begin_again_and_the_others_go_on(which: Any, tmp_path: Path) -> None:
    with many(tmp_path) as runs:
        runs.step(5)
        runs.reset([11, 13], which=which)
        assert [sim.steps for sim in runs] == [5, 0, 5, 0]
        seeds = [0, 11, 2, 13] if np.asarray(which)[0] != 3 else [0, 13, 2, 11]
        assert [sim.seed for sim in runs] == seeds
        runs.reset(which=2)
        assert [(sim.steps, sim.seed) for sim in runs][2] == (0, 2)
        runs.reset(which=runs.is_over)  # none
        assert [sim.steps for sim in runs] == [5, 0, 0, 0]


def test_wrong_choice_of_runs_is_refused(tmp_path: Path) -> None:
    with many(tmp_path) as runs:
        for which, message in (
            ([1, 4], "which: there is no run 4: the simulation has 4"),
            ([True], "which: expected 4 values of True or False, one for each, found 1"),
            ([0, True], "which: expected indices, or True or False for each, but not both"),
            ([0.5], "which: expected an index, an array of indices, or True or False for each run"),
            ([1, 1], "which: each run can be named once only"),
        ):
            with pytest.raises(pogosim.ConfigurationError, match=message):
                runs.reset(which=which)
        with pytest.raises(pogosim.ConfigurationError, match="seeds: expected 2, one for each run, found 1"):
            runs.reset([5], which=[0, 1])


def test_messages_go_out_once(tmp_path: Path) -> None:
    with many(tmp_path) as runs:
        brain = runs.brain("robots")
        brain.send_bytes[:, 0, :2] = [1, 2]
        brain.send_length[:, 0] = 2
        runs.step(10)
        assert (brain.send_length == -1).all()
        assert [sim.messages_sent.tolist() for sim in runs] == [[1, 0, 0]] * 4
        assert np.array_equal(brain.received_count, [sim.brain("robots").received_count for sim in runs])


def test_rows_of_a_run_that_begins_again_are_those_of_the_new_one(tmp_path: Path) -> None:
    with many(tmp_path) as runs:
        brain = runs.brain("robots")
        brain.motors[..., :2] = [500, -500]
        turns = brain.angular_velocity
        runs.step(20)
        assert (turns[..., 2] != 0).all()
        runs[2].reset()
        assert brain.angular_velocity is turns
        assert (turns[2] == 0).all()
        assert (turns[[0, 1, 3], :, 2] != 0).all()
        assert runs.step() == [1] * 4
        assert [sim.steps for sim in runs] == [21, 21, 1, 21]


@pytest.mark.parametrize("again", [True, False])
def test_arrays_that_are_kept_over_a_reset_drive_the_new_runs(again: bool, tmp_path: Path) -> None:
    way_mm = []
    with many(tmp_path) as runs:
        motors = runs.brain("robots").motors
        motors[..., :2] = 800
        for _ in range(3):
            before = runs.positions
            if again:
                motors[..., :2] = 800
            runs.step(50)
            way_mm.append(np.linalg.norm(runs.positions - before, axis=-1).mean())
            runs.reset(range(4))
    assert way_mm[0] > 10
    assert way_mm == [way_mm[0]] * 3


def test_messages_are_sent_that_wait_over_a_reset(tmp_path: Path) -> None:
    with many(tmp_path) as runs:
        brain = runs.brain("robots")
        length = brain.send_length
        runs.reset()
        length[:] = 1
        runs[1].reset()
        brain.clear_received()
        assert (brain.send_length == 1).all()
        runs.step(10)
        assert [sim.messages_sent.tolist() for sim in runs] == [[1] * ROBOTS] * 4
        assert (length == -1).all()


def test_messages_of_all_runs_are_forgotten(tmp_path: Path) -> None:
    with many(tmp_path, arena_surface=4e4) as runs:
        brain = runs.brain("robots")
        brain.send_length = 1
        runs.step(10)
        assert brain.received_count.sum() == sum(sim.brain("robots").received_count.sum() for sim in runs) > 0
        brain.clear_received()
        assert brain.received_count.sum() == 0
        assert sum(len(sim.brain("robots").received) for sim in runs) == 0


def test_runs_that_are_over_wait_for_the_others(tmp_path: Path) -> None:
    with many(tmp_path, simulation_time=0.5) as runs:
        runs[1].step(20)
        assert runs.step(40) == [40, 30, 40, 40]
        assert runs.step(40) == [10, 0, 10, 10]
        assert runs.is_over.all()
        assert runs.step(40) == [0] * 4
        assert runs.step(0) == [0] * 4


def test_run_in_use_elsewhere_is_refused(tmp_path: Path) -> None:
    with many(tmp_path, simulation_time=1e6) as runs:
        stepping = threading.Thread(target=runs[3].step, args=(50_000,))
        stepping.start()
        refused = 0
        while stepping.is_alive() and not refused:
            try:
                runs.step()
            except pogosim.SimulationError as error:
                assert "in use by another thread" in str(error)
                refused += 1
        stepping.join()
        assert refused
        assert runs.step() == [1] * 4  # no lock is left


def test_what_does_not_fit_is_one_line(tmp_path: Path) -> None:
    path = write_scene(tmp_path, SCENE)
    with many(tmp_path) as runs:
        with pytest.raises(pogosim.ConfigurationError, match="there is no category 'robot'"):
            runs.brain("robot")
        brain = runs.brain("robots")
        with pytest.raises(ValueError, match="could not broadcast"):
            brain.motors = np.zeros((4, 2, 3))
        with pytest.raises(pogosim.ConfigurationError, match=r"brain\.motors takes whole numbers .* found 0\.8"):
            brain.motors = 0.8
        for name, value in (("send_length", 1.7), ("send_face", 300), ("send_bytes", 256), ("send_length", 2**40)):
            with pytest.raises(pogosim.ConfigurationError, match=rf"brain\.{name} takes whole numbers"):
                setattr(brain, name, value)
        with pytest.raises(AttributeError):
            brain.motor = 3  # type: ignore[attr-defined]
        runs[1].reset(set={"objects.robots.nb": ROBOTS + 1})
        with pytest.raises(pogosim.ConfigurationError, match="run 1 has 4 robots in category 'robots' since its reset"):
            runs.step()
        runs[1].reset(set={"objects.robots.nb": ROBOTS})
        assert runs.step() == [1] * 4
        runs.simulations[1] = pogosim.Simulation(None, path, set={"objects.robots.nb": ROBOTS + 1})
        with pytest.raises(pogosim.SimulationError, match=r"the same number of robots in each, found 3 and 4"):
            _ = runs.positions
    for use in (runs.step, lambda: runs.positions, lambda: brain.motors, lambda: runs.brain("robots")):
        with pytest.raises(pogosim.SimulationError, match="closed"):
            use()
    with (
        pogosim.VectorSimulation(
            f"{example('hanabi')}.so", path, range(2), set={"objects.robots.brain": "program"}
        ) as run,
        pytest.raises(pogosim.ConfigurationError, match="is not driven by the host"),
    ):
        run.brain("robots")


def test_runs_in_use_are_not_closed(tmp_path: Path) -> None:
    with many(tmp_path, simulation_time=1e6) as runs:
        stepping = threading.Thread(target=runs[3].step, args=(50_000,))
        stepping.start()
        while stepping.is_alive():
            try:
                with runs[3]._lock:
                    pass
                runs.close()
                break  # it was over
            except pogosim.SimulationError as error:
                assert "in use by another thread" in str(error)
                assert runs[0].step() == 1
                break
        stepping.join()


def test_no_runs_make_no_steps(tmp_path: Path) -> None:
    with many(tmp_path, runs=0) as runs:
        assert runs.step() == []
        with pytest.raises(pogosim.SimulationError, match="no runs"):
            _ = runs.positions


def test_brain_of_many_runs_shows_what_they_go_on_from(tmp_path: Path) -> None:
    with many(tmp_path) as runs:
        brain = runs.brain("robots")
        names = ("angular_velocity", "acceleration", "photosensors", "received_count", "battery_mv")
        brain.motors = [1023, 0, 0]
        runs.step(20)
        states = [sim.save() for sim in runs]
        before = {name: getattr(brain, name).copy() for name in names}
        brain.motors = [0, 1023, 0]
        runs.step(50)
        assert not np.array_equal(brain.angular_velocity, before["angular_velocity"])
        runs[2].restore(states[2])
        assert np.array_equal(brain.angular_velocity[2], before["angular_velocity"][2])
        assert not np.array_equal(brain.angular_velocity[1], before["angular_velocity"][1])
        for sim, state in zip(runs, states, strict=True):
            sim.restore(state)
        for name in names:
            assert np.array_equal(getattr(brain, name), before[name])
            assert np.array_equal(getattr(brain, name)[1], getattr(runs[1].brain("robots"), name))


def test_runs_that_are_over_are_told_apart(tmp_path: Path) -> None:
    with many(tmp_path, simulation_time=1.0) as runs:
        assert runs.is_over.tolist() == [False] * 4
        runs[1].step(1000)
        runs[3].close()
        assert runs.is_over.tolist() == [False, True, False, True]
    assert runs.is_over.tolist() == [True] * 4


def test_some_runs_go_on_and_the_others_wait(tmp_path: Path) -> None:
    with many(tmp_path) as runs:
        brain = runs.brain("robots")
        brain.motors[..., :2] = 1023
        assert (brain.photosensors == -1).all()
        assert runs.step(30, which=[0, 2]) == [30, 0, 30, 0]
        assert [sim.steps for sim in runs] == [30, 0, 30, 0]
        assert brain.photosensors[:, 0, 0].tolist() == [0, -1, 0, -1]  # before the first tick, there is none
        assert runs.step(5, which=np.array([False, True, False, False])) == [0, 5, 0, 0]
        assert runs.step(1) == [1] * 4
        assert runs.step(3, which=[]) == [0] * 4
        with pytest.raises(pogosim.ConfigurationError, match="which: there is no run 4: the simulation has 4"):
            runs.step(which=[4])
        hashes = [sim.state_hash for sim in runs]
    for run, steps in ((0, 31), (1, 6), (3, 1)):
        with pogosim.Simulation(None, write_scene(tmp_path, SCENE), seed=run) as sim:
            sim.brain("robots").motors[:, :2] = 1023
            sim.step(steps)
            assert sim.state_hash == hashes[run]


def test_runs_begin_again_with_keys_of_their_own(tmp_path: Path) -> None:
    key = "objects.robots.linear_noise_stddev"
    with many(tmp_path) as runs:
        runs.reset(seeds=[5, 5, 5], which=[0, 1, 3], set=[{key: 0.1}, {key: 0.2}, {key: 0.1}])
        runs.brain("robots").motors[...] = 1023
        runs.step(50)
        hashes = [sim.state_hash for sim in runs]
        assert hashes[0] == hashes[3] != hashes[1]
        runs.reset(seeds=[5] * 4, set={key: 0.2})
        runs.step(50)
        assert [sim.state_hash for sim in runs] == [hashes[1]] * 4
        with pytest.raises(pogosim.ConfigurationError, match="set: expected 4 maps, one for each run, found 2"):
            runs.reset(set=[{}, {}])
