"""What a configuration leaves to a search: domains, variables, and the configuration that values make."""

from __future__ import annotations

import copy
import math
from collections import Counter
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pogosim.batch.configurations.combinations import combinations_of
from pogosim.batch.configurations.option_words import CombinationsError, OptionsError
from pogosim.optimize.domain import Categorical, Real, Whole, domain_of
from pogosim.optimize.variables import Space, variables_of

POSITIONS = st.floats(0.0, 1.0)


def node(**domain: Any) -> dict[str, Any]:
    """Return a node of a configuration with a domain."""
    return {"optimization_domain": domain}


# ---- Domains ----


@given(POSITIONS, st.booleans())
def test_position_and_value_of_a_real_number_belong_together(position: float, is_log: bool) -> None:
    domain = Real(0.01, 100.0, is_log, 1.0)
    value = domain.value_at(position)
    assert 0.01 <= value <= 100.0
    assert domain.position_of(value) == pytest.approx(position, abs=1e-9)


def test_half_way_is_the_mean_of_the_ends_or_of_their_logarithms() -> None:
    assert Real(0.0, 10.0, is_log=False, init=1.0).value_at(0.5) == 5.0
    assert Real(0.01, 100.0, is_log=True, init=1.0).value_at(0.5) == pytest.approx(1.0)


@given(st.integers(-50, 50), st.integers(1, 1000), POSITIONS)
def test_whole_numbers_have_parts_of_the_same_size(low: int, span: int, position: float) -> None:
    domain = Whole(low, low + span, is_log=False, init=low)
    value = domain.value_at(position)
    assert isinstance(value, int)
    assert low <= value <= low + span
    assert abs(domain.position_of(value) - position) <= 0.5 / (span + 1) + 1e-9


def test_random_positions_give_all_whole_numbers_and_choices_the_same_chance() -> None:
    positions = np.linspace(0.0, 1.0, 4001)[:-1]
    counts = Counter(Whole(3, 6, is_log=False, init=3).value_at(x) for x in positions)
    assert counts == {3: 1000, 4: 1000, 5: 1000, 6: 1000}
    assert Counter(Categorical(("a", "b"), 0).value_at(x) for x in positions) == {"a": 2000, "b": 2000}


def test_whole_numbers_by_orders_of_magnitude_are_as_likely_as_their_share_of_the_logarithm() -> None:
    positions = np.linspace(0.0, 1.0, 100_001)[:-1]
    domain = Whole(1, 999, is_log=True, init=1)
    values = np.array([domain.value_at(x) for x in positions])
    for low, high in ((1, 9), (10, 99), (100, 999)):
        assert np.mean((values >= low) & (values <= high)) == pytest.approx(1.0 / 3.0, abs=1e-4)
    assert all(domain.value_at(domain.position_of(value)) == value for value in range(1, 1000))


def test_the_ends_are_reached() -> None:
    for domain in (Whole(10, 1000, is_log=False, init=50), Whole(10, 1000, is_log=True, init=50)):
        assert (domain.value_at(0.0), domain.value_at(1.0)) == (10, 1000)
    assert Real(1e-3, 1e3, is_log=True, init=1.0).value_at(1.0) == 1e3


@pytest.mark.parametrize(
    ("entries", "expected"),
    [
        (node(type="int", min=10, max=1000, init=50), Whole(10, 1000, is_log=False, init=50)),  # the article's
        (node(type="float", min=1, max=2), Real(1.0, 2.0, is_log=False, init=1.5)),
        (
            node(type="float", min=1, max=100, log=True),
            Real(1.0, 100.0, is_log=True, init=math.pow(1.0, 0.5) * math.pow(100.0, 0.5)),
        ),
        ({"default_option": 7, **node(type="int", min=0, max=10)}, Whole(0, 10, is_log=False, init=7)),
        ({"default_option": 7, **node(type="int", min=0, max=10, init=2)}, Whole(0, 10, is_log=False, init=2)),
        (node(type="categorical", choices=["a", "b"], init="b"), Categorical(("a", "b"), 1)),
        (node(choices=[True, False]), Categorical((True, False), 0)),
        ({"batch_options": [1, 2, 3], "default_option": 3, **node()}, Categorical((1, 2, 3), 2)),
        (node(choices=[1, True]), Categorical((1, True), 0)),  # not the same
    ],
)
def test_domain_says_what_the_configuration_says(entries: dict[str, Any], expected: object) -> None:
    domain = domain_of(entries)
    assert (type(domain), vars(domain)) == (type(expected), vars(expected))


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"optimization_domain": 5}, "expected a map such as {type: int, min: 10, max: 1000}, found 5"),
        (node(type="int", min=1, max=2, step=1), "unknown key 'step'; known are type, min, max, init, log, choices"),
        (node(min=1, max=2), "type: expected int, float or categorical, found nothing"),
        (node(type="real", min=1, max=2), "type: expected int, float or categorical, found 'real'"),
        (node(type="int", min=1), "max: expected a whole number, found nothing"),
        (node(type="int", min=1.5, max=3), "min: expected a whole number, found 1.5"),
        (node(type="float", min="low", max=3), "min: expected a number, found 'low'"),
        (node(type="float", min=float("nan"), max=3), "min: expected a number, found nan"),
        (node(type="float", min=0, max=float("inf")), "max: expected a number, found inf"),
        (node(type="float", min=3, max=3), "expected min below max, found 3 and 3"),
        (node(type="float", min=0, max=3, log=True), "log: true needs a min above 0, found 0"),
        (node(type="float", min=1, max=3, log=1), "log: expected true or false, found 1"),
        (node(type="int", min=1, max=3, init=4), "init: expected a whole number from 1 to 3, found 4"),
        (node(type="int", min=1, max=3, choices=[1]), "choices go with type: categorical, not with int"),
        (node(type="categorical"), "choices: expected a list of values, found nothing"),
        (node(choices=[]), "choices: expected a list of values, found []"),
        (node(choices=["a", "b", "a"]), "choices: 'a' is there twice"),
        (node(choices=["a"], init="b"), "init: 'b' is none of the choices"),
        (node(choices=["a"], min=1), "min does not go with type: categorical, which has choices"),
    ],
)
def test_wrong_domain_is_one_line(entries: dict[str, Any], message: str) -> None:
    with pytest.raises(OptionsError) as error:
        domain_of(entries)
    assert str(error.value) == f"optimization_domain: {message}"


# ---- Variables ----

TREE: dict[str, Any] = {
    "density": node(type="float", min=0.0, max=1.0),
    "objects": {
        "robots": {
            "nb": 10,
            "batch_hierarchical_options": {
                "name": "kind",
                "default": {"speed": 5},
                "slow": {"speed": node(type="int", min=1, max=9), "led": "red"},
                "fast": {"speed": 100},
            },
        }
    },
    "list": [1, {"deep": node(choices=["x", "y"])}],
    "radius": {"batch_options": [1, 2], "default_option": 2},
    "optimization": {"qd": node(type="int", min=1, max=2)},
}


def test_variables_are_found_wherever_they_are_and_alternatives_are_one_of_them() -> None:
    names = [variable.name for variable in variables_of(TREE)]
    assert names == ["density", "kind", "objects.robots.slow.speed", "list.1.deep"]


def test_point_is_a_configuration_with_the_chosen_alternative_and_the_options_that_remain() -> None:
    space = Space(copy.deepcopy(TREE))
    slow = space.values_at([0.25, 0.0, 0.5, 0.9])
    assert slow == {"density": 0.25, "kind": "slow", "objects.robots.slow.speed": 5, "list.1.deep": "y"}
    fast = space.values_at([0.25, 0.9, 0.5, 0.9])
    assert fast == {"density": 0.25, "kind": "fast", "list.1.deep": "y"}  # no speed to choose
    made = combinations_of(space.configuration(slow))
    assert [combination["radius"] for combination in made] == [1, 2]
    assert made[0]["objects"]["robots"] == {"nb": 10, "speed": 5, "led": "red"}
    assert (made[0]["kind"], made[0]["_batch_choice_names"]) == ("slow", {"objects.robots": "slow"})
    assert space.entries == TREE


def test_flat_configuration_has_no_alternatives_any_more() -> None:
    space = Space(copy.deepcopy(TREE))
    flat = space.configuration(space.values_at([0.25, 0.9, 0.5, 0.1]), is_flat=True)
    assert flat["objects"] == {"robots": {"nb": 10, "speed": 100}}
    assert (flat["kind"], flat["list"], flat["density"]) == ("fast", [1, {"deep": "x"}], 0.25)
    assert (flat["radius"], flat["optimization"]) == (TREE["radius"], TREE["optimization"])


def test_names_of_variables_are_their_own_even_if_labels_are_not() -> None:
    alternatives = {"batch_hierarchical_options": {"name": "kind", "a": {}, "b": {}}}
    names = [variable.name for variable in Space({"one": alternatives, "two": alternatives}).variables]
    assert names == ["one", "two"]


def test_search_starts_where_the_configuration_says() -> None:
    entries = {"a": node(type="float", min=0, max=4, init=1), "b": node(choices=[1, 2, 3, 4], init=4)}
    assert Space(entries).init.tolist() == [0.25, 0.875]


def test_configuration_without_a_domain_is_nothing_to_optimise() -> None:
    with pytest.raises(CombinationsError, match="nothing to optimise: no key has an optimization_domain"):
        Space({"arena_file": "a.csv", "n": {"batch_options": [1, 2]}})


def test_place_of_a_wrong_domain_is_known() -> None:
    with pytest.raises(CombinationsError) as error:
        Space({"parameters": {"a": node(type="int", min=2, max=1)}})
    assert error.value.path == ("parameters", "a")
