"""The laws of reception, fits of them, and how often to send: closed forms and known answers."""

from __future__ import annotations

import math
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from pogosim.communication.fit import fit, huber
from pogosim.communication.fit_settings import FitError, FitSettings
from pogosim.communication.measurements import MeasurementError, Measurements, read_measurements
from pogosim.communication.quality import compare, quality
from pogosim.communication.reception_law import DynamicLaw, Law, PowerLaw, configuration_block, with_point
from pogosim.communication.sending import SENDING_DEFAULTS, SendingError, best_sending, messages_per_tick
from pogosim.yaml_1_2 import parse_yaml


def made_with(law: Law, p: tuple[float, ...] = (0.1, 0.3, 0.5, 0.7, 0.9)) -> Measurements:
    """Return what would be measured without noise if a law held."""
    rows = [(m, c, chance) for m in (3.0, 20.0, 60.0, 100.0) for c in (2.0, 4.0, 7.0) for chance in p]
    frame = pd.DataFrame(rows, columns=["payload_size", "cluster_size", "p_send"])
    chance = law.probability(frame["payload_size"] + 3.0, frame["p_send"], frame["cluster_size"])
    return Measurements(frame.assign(success_probability=chance))


@pytest.mark.parametrize(
    ("m", "p", "c", "expected"),
    # Worked out by hand from the article's parameters.
    [(12, 0.5, 7, 0.8379), (12, 1.0, 7, 0.4101), (30, 0.5, 3, 0.9470), (110, 0.5, 3, 0.3126), (110, 1.0, 7, 0.0026)],
)
def test_article_law_gives_the_values_worked_out_by_hand(m: float, p: float, c: float, expected: float) -> None:
    assert float(DynamicLaw().probability(m, p, c)) == pytest.approx(expected, abs=5e-5)


def test_power_law_is_one_half_where_collisions_are_one() -> None:
    law = PowerLaw(alpha=1e-3, beta=1.0, gamma=1.0, delta=1.0)
    assert float(law.probability(100.0, 0.5, 20.0)) == pytest.approx(0.5)  # 1e-3 x 100 x 0.5 x 20 = 1


def test_probability_stays_within_0_and_1_for_all_parameters_and_sizes() -> None:
    for law in (DynamicLaw(alpha=0.5), DynamicLaw(alpha=-1.0), DynamicLaw(zeta=50.0), PowerLaw(alpha=-2.0)):
        chance = law.probability(np.array([0.0, 10.0, 382.0]), np.array([[0.0], [0.5], [1.0]]), 7.0)
        assert chance.shape == (3, 3)
        assert ((chance >= 0.0) & (chance <= 1.0)).all()
    assert float(DynamicLaw(alpha=0.5, beta=0.0).probability(10, 0, 2)) == 1.0
    assert float(DynamicLaw(alpha=-1.0, beta=0.0).probability(10, 0, 2)) == 0.0


@pytest.mark.parametrize("text", ["1.0e-05", "0.001", "2.0", "1.23456789"])
def test_numbers_of_the_configuration_have_a_point(text: str) -> None:
    assert with_point(float(text)) == text


def test_fit_finds_the_parameters_of_the_article() -> None:
    measurements = read_measurements()
    found = fit(measurements)
    reached = quality(compare(found.law, measurements))
    assert reached.r2 is not None
    assert reached.r2 >= 0.914974
    assert reached.mae == pytest.approx(0.066285, abs=1e-5)
    for name, value in asdict(DynamicLaw()).items():
        assert getattr(found.law, name) == pytest.approx(value, rel=1e-4), name


def test_published_parameters_have_the_published_quality() -> None:
    reached = quality(compare(DynamicLaw(), read_measurements()))
    assert reached.r2 == pytest.approx(0.914975, abs=5e-7)
    assert reached.mae == pytest.approx(0.066285, abs=5e-7)


@pytest.mark.parametrize(
    "law",
    [DynamicLaw(1.2, 0.01, 2.0, 1.5, 0.03, 0.05), PowerLaw(alpha=2e-4, beta=1.5, gamma=2.0, delta=1.2)],
    ids=lambda law: law.NAME,
)
@pytest.mark.parametrize("objective", ["r2", "huber"])
def test_fit_finds_the_law_that_made_the_data(law: Law, objective: str) -> None:
    found = fit(made_with(law), FitSettings(law=law.NAME, objective=objective, seed=3, restarts=0))
    for name, value in asdict(law).items():
        assert getattr(found.law, name) == pytest.approx(value, rel=1e-3), name


def test_single_strange_measurement_counts_for_less_with_huber_loss() -> None:
    law = PowerLaw(alpha=2e-4, beta=1.5, gamma=2.0, delta=1.2)
    measurements = made_with(law)
    measurements.rows.loc[0, "success_probability"] = 0.0  # nearly 1 otherwise
    errors = {}
    for objective in ("r2", "huber"):
        found = fit(measurements, FitSettings(law="power", objective=objective, huber_delta=0.01, restarts=0))
        errors[objective] = abs(compare(found.law, made_with(law))["residual"]).mean()
    assert errors["huber"] < 0.1 * errors["r2"]


def test_huber_loss_is_a_square_then_a_line_without_a_step() -> None:
    assert huber(np.array([0.0, 0.5, -1.0, 3.0]), 1.0).tolist() == [0.0, 0.125, 0.5, 2.5]
    assert huber(np.array([3.0]), math.inf).tolist() == [4.5]


def test_fixed_parameters_stay_and_bounds_hold() -> None:
    settings = FitSettings(fixed={"theta": 0.02, "gamma": 3.0}, bounds={"alpha": (1.1, 1.2)}, restarts=0)
    law = fit(read_measurements(), settings).law
    assert isinstance(law, DynamicLaw)
    assert (law.theta, law.gamma) == (0.02, 3.0)
    assert 1.1 <= law.alpha <= 1.2
    all_fixed = FitSettings(fixed=asdict(DynamicLaw()))
    assert fit(read_measurements(), all_fixed).law == DynamicLaw()
    one_free = {name: value for name, value in asdict(DynamicLaw()).items() if name != "alpha"}
    alone = fit(read_measurements(), FitSettings(fixed=one_free, restarts=0)).law
    assert alone.alpha == pytest.approx(1.03215183, rel=1e-5)


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        (FitSettings(law="power", fixed={"zeta": 1.0}), "no parameter zeta"),
        (FitSettings(bounds={"alpha": (2.0, 1.0)}), "are empty"),
        (FitSettings(bounds={"alpha": (1.0, 2.0)}, fixed={"alpha": 1.0}), "at the same time"),
    ],
)
def test_impossible_fits_are_refused(settings: FitSettings, said: str) -> None:
    with pytest.raises(FitError, match=said):
        fit(read_measurements(), settings)


def test_quality_of_a_law_that_is_off_by_a_constant() -> None:
    measured = np.array([0.0, 0.2, 0.4, 0.8])
    table = pd.DataFrame({"success_probability": measured, "residual": [0.1, -0.1, 0.1, -0.1]})
    found = quality(table)
    assert found.mae == pytest.approx(0.1)
    assert found.rmse == pytest.approx(0.1)
    assert found.r2 == pytest.approx(1.0 - 0.04 / 0.35)
    assert found.mape_percent == pytest.approx(100.0 * (0.5 + 0.25 + 0.125) / 3)
    single = quality(table.iloc[:1])
    assert (single.r2, single.mape_percent, single.shapiro_w) == (None, None, None)


def test_normal_residuals_look_more_normal_than_skewed_ones() -> None:
    random = np.random.default_rng(1)
    normal, skewed = random.normal(size=200), random.exponential(size=200)
    tables = [pd.DataFrame({"success_probability": 0.5 + 0.0 * r, "residual": r}) for r in (normal, skewed)]
    p_normal, p_skewed = (quality(table).shapiro_p for table in tables)
    assert p_normal is not None
    assert p_skewed is not None
    assert p_skewed < 1e-6 < 0.01 < p_normal


def test_cluster_size_counts_the_sender_and_neighbours_do_not(tmp_path: Path) -> None:
    (tmp_path / "n.csv").write_text("payload_size,nb_neighbors,p_send,success_probability\n3,6,0.1,0.9\n")
    (tmp_path / "c.csv").write_text("cluster_size, p_send ,payload_size,success_probability,std\n7,0.1,3,0.9,0\n")
    first, second = read_measurements(tmp_path / "n.csv"), read_measurements(tmp_path / "c.csv", header_bytes=8)
    assert first.cluster_size.tolist() == second.cluster_size.tolist() == [7.0]
    assert (first.message_bytes.tolist(), second.message_bytes.tolist()) == ([6.0], [11.0])


HEADER = b"payload_size,nb_neighbors,p_send,success_probability\n"


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "is empty"),
        (HEADER, "no row with all numbers"),
        (HEADER + b"3,6,0.1,nan\n", "no row with all numbers"),
        (b"payload_size,p_send\n1,2\n", "no column success_probability, nb_neighbors"),
        (HEADER + b"3,6,0.1,0.9\n3,6,fast,0.9\n", "row 2: p_send is fast; expected a number from 0 to 1"),
        (HEADER + b"3,6,20,0.9\n", "row 1: p_send is 20.* expected a number from 0 to 1"),
        (HEADER + b"3,6,0.1,inf\n", "success_probability is inf"),
        (HEADER + b"3,-1,0.1,0.5\n", "nb_neighbors is -1"),
        (bytes(range(256)) * 4, "is not a CSV file|has no column"),
        (b"ARROW1\0\0" + b"\xff" * 99, "is not a CSV file"),
        (b'a,b\n"1,2\n', "is not a CSV file|has no column"),
    ],
)
def test_files_without_measurements_are_refused(content: bytes, said: str, tmp_path: Path) -> None:
    (tmp_path / "data.csv").write_bytes(content)
    with pytest.raises(MeasurementError, match=said) as refused:
        read_measurements(tmp_path / "data.csv")
    assert str(tmp_path / "data.csv") in str(refused.value)
    assert "\n" not in str(refused.value)


# How often to send.

OLD = PowerLaw(**SENDING_DEFAULTS)
LAWS: list[Law] = [OLD, PowerLaw(), DynamicLaw(), DynamicLaw(theta=0.3), DynamicLaw(alpha=0.4, theta=0.0)]


@pytest.mark.parametrize(("cluster", "size", "expected"), [(7, 110, 0.2507), (3, 110, 0.3870), (7, 12, 1.0)])
def test_best_chance_to_send_has_the_known_values(cluster: float, size: float, expected: float) -> None:
    assert best_sending(OLD, size, cluster).send_probability == pytest.approx(expected, abs=5e-5)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("cluster", "size"), [(2.0, 11.0), (7.0, 50.0), (7.0, 110.0), (30.0, 385.0)])
def test_no_other_chance_to_send_gets_more_messages_through(law: Law, cluster: float, size: float) -> None:
    best = best_sending(law, size, cluster)
    others = [messages_per_tick(law, size, float(p), cluster) for p in np.geomspace(1e-6, 1.0, 5001)]
    assert best.messages_per_tick >= max(others) * (1.0 - 1e-9)
    assert best.messages_per_tick == pytest.approx(max(others), rel=1e-3)
    assert best.messages_per_tick == pytest.approx(cluster * best.send_probability * best.reception_probability)


@pytest.mark.parametrize("law", LAWS[:4])
def test_messages_per_tick_have_no_slope_at_the_best_chance(law: Law) -> None:
    best = best_sending(law, 110.0, 7.0, clip=False).send_probability
    step = 1e-5 * best
    low, high = (messages_per_tick(law, 110.0, best + d, 7.0) for d in (-step, step))
    assert abs(high - low) / (2.0 * step) < 1e-5 * high / best


def test_without_clipping_the_root_of_the_derivative_is_given() -> None:
    expected = (1.0 / (1e-6 * 12**3.0708 * 7**1.1897 * 1.3234)) ** (1 / 2.3234)
    assert best_sending(OLD, 12, 7, clip=False).send_probability == pytest.approx(expected)
    assert expected > 1.0


def test_law_without_a_maximum_says_so_and_is_clipped_to_always() -> None:
    law = PowerLaw(gamma=0.9)
    assert best_sending(law, 100, 7).send_probability == 1.0
    with pytest.raises(SendingError, match="always better"):
        best_sending(law, 100, 7, clip=False)
    for impossible in (DynamicLaw(zeta=100.0), DynamicLaw(alpha=-1.0), PowerLaw(alpha=-1.0)):
        with pytest.raises(SendingError, match="cannot be computed"):
            best_sending(impossible, 100, 7)


def test_configuration_block_says_what_the_simulator_needs_to_know() -> None:
    six = parse_yaml(configuration_block(DynamicLaw()))["msg_success_rate"]
    four = parse_yaml(configuration_block(PowerLaw(alpha=1e-12)))["msg_success_rate"]
    assert six == {"type": "dynamic"} | asdict(DynamicLaw())
    assert four == {"type": "dynamic"} | asdict(PowerLaw(alpha=1e-12))
