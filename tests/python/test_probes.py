"""Whole simulations lose as many messages as the article's equation says."""

from __future__ import annotations

import math

import pytest
from reception_profile import (
    MEASUREMENTS,
    TOLERANCE,
    Count,
    Setting,
    equation,
    read_measurements,
    read_parameters,
    simulate,
    simulate_all,
)

SEEDS = range(3)
SETTINGS = list(read_measurements())


@pytest.fixture(scope="module")
def counts() -> dict[Setting, Count]:
    return simulate_all(SETTINGS, SEEDS)


def test_all_45_settings_of_the_measurements_are_simulated() -> None:
    assert len(SETTINGS) == 45
    assert {s.payload_size for s in SETTINGS} == {3, 20, 100}
    assert {s.neighbors for s in SETTINGS} == {1, 2, 6}
    assert {s.send_percent for s in SETTINGS} == {10, 20, 50, 80, 100}


@pytest.mark.parametrize(
    ("setting", "expected"),
    [
        # Worked out by hand from the article's parameters.
        (Setting(9, 6, 50), 0.8379),
        (Setting(9, 6, 100), 0.4101),
        (Setting(27, 2, 50), 0.9470),
        (Setting(107, 2, 50), 0.3126),
        (Setting(107, 6, 100), 0.0026),
    ],
)
def test_equation_gives_the_published_values(setting: Setting, expected: float) -> None:
    assert equation(setting, read_parameters()) == pytest.approx(expected, abs=5e-5)


def test_equation_fits_the_measurements_as_well_as_published() -> None:
    measured = read_measurements(MEASUREMENTS)
    fitted = {setting: equation(setting, read_parameters()) for setting in measured}
    mean = sum(measured.values()) / len(measured)
    residual = sum((measured[s] - fitted[s]) ** 2 for s in measured)
    r2 = 1.0 - residual / sum((value - mean) ** 2 for value in measured.values())
    assert r2 == pytest.approx(0.914975, abs=1e-4)


@pytest.mark.parametrize("setting", SETTINGS, ids=lambda s: f"{s.payload_size}-{s.neighbors}-{s.send_percent}")
def test_share_of_received_messages_is_that_of_the_equation(setting: Setting, counts: dict[Setting, Count]) -> None:
    count = counts[setting]
    expected = equation(setting, read_parameters())
    assert abs(count.share - expected) <= TOLERANCE
    # Five standard deviations of the count, and what is on its way at the end.
    assert abs(count.share - expected) <= 5.0 * count.standard_error(expected) + 2.0 / count.sent


def test_robots_send_as_often_as_their_chance_says(counts: dict[Setting, Count]) -> None:
    ticks = len(SEEDS) * 60.0 * 62.5
    for setting, count in counts.items():
        chance = setting.send_percent / 100.0
        sent = count.sent / setting.neighbors
        assert abs(sent - chance * ticks) <= 5.0 * math.sqrt(ticks * chance * (1.0 - chance)) + len(SEEDS)


def test_count_repeats_with_the_seed_and_changes_with_another() -> None:
    setting = Setting(20, 6, 80)
    assert simulate(setting, 1, 10.0) == simulate(setting, 1, 10.0)
    assert simulate(setting, 1, 10.0) != simulate(setting, 2, 10.0)


def test_runs_of_the_table_have_nothing_to_warn_of(capfd: pytest.CaptureFixture[str]) -> None:
    for setting in SETTINGS[::15]:
        simulate(setting, 1, 1.0)
    assert capfd.readouterr().err == ""
