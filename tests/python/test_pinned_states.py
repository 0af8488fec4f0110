"""No result changes unnoticed: the states of examples are those that were pinned, see pinned_states.py."""

from __future__ import annotations

import warnings

import pogosim
import pytest
from pinned_states import EXAMPLES, PERIOD_STEPS, STEPS, pinned, states, toolchain
from running import ROOT, example


@pytest.mark.parametrize("name", EXAMPLES)
def test_states_develop_as_they_were_pinned(name: str) -> None:
    now = states(name)
    assert len(now) == STEPS // PERIOD_STEPS
    assert len(set(now)) == len(now)
    expected = pinned().get(toolchain())
    if expected is None:
        with warnings.catch_warnings():
            warnings.simplefilter("default")
            warnings.warn(f"no states are pinned for {toolchain()}: two runs are compared instead", stacklevel=1)
        assert now == states(name)
        return
    assert now == expected[name], (
        f"the results of {name} have changed. If that is intended, say so in CHANGELOG.md, and pin the new ones: "
        ".venv/bin/python tests/python/pinned_states.py"
    )


def test_hash_tells_states_apart_and_is_the_same_in_python(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    monkeypatch.setenv("POGOSIM_DIR", str(ROOT))
    hashes = []
    for seed, x_mm in ((1, None), (1, None), (2, None), (1, 500.0)):
        with pogosim.Simulation(example("run_and_tumble"), "conf/simple.yaml", seed=seed) as simulation:
            simulation.step(PERIOD_STEPS)
            if x_mm is not None:
                simulation.set_pose(0, x_mm, 500.0)
            hashes.append(f"{simulation.state_hash:016x}")
    assert hashes[0] == hashes[1] == states("run_and_tumble")[0]
    assert len(set(hashes)) == 3
