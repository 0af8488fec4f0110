"""No value of a parameter makes an example crash or hang: it runs, or it says what is wrong with the value."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from running import ROOT, example, run

NUMBER = re.compile(r"^(?:u?int(?:8|16|32)_t|float) (\w+) = [^;{]*;", re.MULTILINE)
READ = re.compile(r"\binit_from_configuration\((\w+)\)")


def numeric_parameters() -> list[tuple[str, str]]:
    """Return every example with every number that it reads from the configuration."""
    found = []
    for source in sorted(ROOT.glob("examples/*/main.c*")):
        code = source.read_text()
        numbers = set(NUMBER.findall(code))
        found += [(source.parent.name, name) for name in READ.findall(code) if name in numbers]
    return found


PARAMETERS = numeric_parameters()


def test_every_example_with_parameters_is_among_them() -> None:
    assert {name for name, _ in PARAMETERS} >= {"neighbor_counter", "push_sum", "ssr", "vicsek", "run_and_tumble"}
    assert len(PARAMETERS) > 80


@pytest.mark.parametrize(("name", "parameter"), PARAMETERS, ids=[".".join(pair) for pair in PARAMETERS])
def test_parameter_at_its_limits_runs_or_is_refused_with_one_message(name: str, parameter: str, tmp_path: Path) -> None:
    settings = {"simulation_time": 2.0, "enable_data_logging": False, "user_code_timeout": 2.0}
    for value in (0, -1, 4294967295, 3.0e38, float("nan")):
        result = run(example(name), tmp_path, {**settings, f"parameters.{parameter}": value})
        assert result.code in (0, 2), f"{value}: {result.text}"
        assert len(result.errors.splitlines()) <= 1, f"{value}: {result.text}"
        if result.code == 2:
            assert re.search(rf"scene\.yaml:\d+: parameters\.{parameter}: expected ", result.errors), result.text


@pytest.mark.parametrize("name", ["IMU", "phototaxis", "phototaxis_gradient", "run_and_tumble", "walls"])
def test_durations_from_nothing_to_the_largest_integer_are_refused(name: str, tmp_path: Path) -> None:
    parameters = {"run_duration_min": 0, "run_duration_max": 4294967295}
    result = run(example(name), tmp_path, {"parameters": parameters})
    assert result.code == 2
    assert "parameters.run_duration_max: expected a number from 0 to 10000000, found 4294967295" in result.errors


def test_neighbor_counter_without_heartbeats_is_refused(tmp_path: Path) -> None:
    result = run(example("neighbor_counter"), tmp_path, {"parameters.heartbeat_hz": 0})
    assert result.code == 2
    assert "parameters.heartbeat_hz: expected a number from 1 to 1000, found 0" in result.errors
