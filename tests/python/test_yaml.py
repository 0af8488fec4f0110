"""The fast loader of YAML gives what the other one gives, and does not crash."""

from __future__ import annotations

import pytest
import yaml
from pogosim.yaml_1_2 import WRONG_VALUES, ConfigurationLoader, parse_yaml
from running import ROOT

TEXTS = [
    "a: 1e3\nb: 010\nc: 0x1F\nd: 2001-01-01\ne: .inf\nf: 1.0e6\ng: =\nh: 1_000\non: yes\n",
    "!!int x",
    "a: [",
    "&a [*a]",
    "a:\n  - b\n \tc",
    "",
    "\x01",
    "[" * 40 + "]" * 40,
    "- " * 200 + "x",
]


def outcome(load: object, text: str) -> str:
    """Return what a loader makes of a text: a value, or an error."""
    assert callable(load)
    try:
        return repr(load(text))
    except WRONG_VALUES:
        return "an error"


def slowly(text: str) -> object:
    return yaml.load(text, Loader=ConfigurationLoader)


@pytest.mark.parametrize("text", TEXTS)
def test_values_and_errors_are_those_of_the_slow_loader(text: str) -> None:
    assert outcome(parse_yaml, text) == outcome(slowly, text)


def test_all_configurations_are_read_as_by_the_slow_loader() -> None:
    files = sorted((ROOT / "conf").rglob("*.yaml"))
    assert len(files) > 10
    assert [file for file in files if parse_yaml(file.read_text()) != slowly(file.read_text())] == []


@pytest.mark.parametrize(
    "text",
    ["[" * 100_000, "{a: " * 100_000, '"' + "]" * 100_000 + '"\n' + "[" * 100_000, "- " * 100_000],
)
def test_text_that_is_nested_without_end_is_an_error_and_no_crash(text: str) -> None:
    with pytest.raises(WRONG_VALUES):
        parse_yaml(text)
