"""A policy that does not do on an emulated robot what it does here is told from a run that fails in another way."""

from __future__ import annotations

import re
import sys

import pytest
from pogosim.installation import Installation, find_installation
from pogosim.policy import Policy, PolicyError
from pogosim.policy.c_header import header_of
from pogosim.policy.example_steps import example_steps
from pogosim.policy.measuring import measure
from random_policies import ALL, random_network
from running import build_folder


@pytest.fixture
def installation(monkeypatch: pytest.MonkeyPatch) -> Installation:
    """The simulator under test; what the measuring run says goes to this process' standard error."""
    monkeypatch.setenv("POGOSIM_DIR", str(build_folder()))
    monkeypatch.setattr(sys, "stdout", sys.__stdout__)
    monkeypatch.setattr(sys, "stderr", sys.__stderr__)
    return find_installation()


def header(name: str) -> str:
    policy = Policy(random_network(ALL[name]), numbers="int16")
    return header_of(policy, example_steps(policy, None), "policy", "a").text


@pytest.mark.parametrize("name", ["plain", "gated"])
def test_wrong_weight_fails_the_self_test(name: str, installation: Installation) -> None:
    is_recurrent = name == "gated"
    text = header(name)
    assert measure(text, "policy", is_recurrent, installation).cycles > 1000
    changed, count = re.subn(r"(policy_weights_0\[\d+\] = \{\s+)[^,]+,", r"\g<1>0,", text)
    assert count == 1
    with pytest.raises(PolicyError, match="the self test of the policy fails on an emulated robot"):
        measure(changed, "policy", is_recurrent, installation)


def test_run_that_fails_has_its_exit_code(installation: Installation) -> None:
    text = header("plain")
    trapped = text.replace("    return true;", "    __builtin_trap();")
    assert trapped != text
    with pytest.raises(PolicyError, match=r"that measures the policy ended with exit code \d+; the messages above"):
        measure(trapped, "policy", False, installation)
