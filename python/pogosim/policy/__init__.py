"""Policies of robots, small neural networks: stepped in Python by arrays, exported as C by `pogosim export-policy`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pogosim.deferred import on_demand

if TYPE_CHECKING:
    from pogosim.policy.errors import PolicyError
    from pogosim.policy.network import Dense, Elman, Gru, Network, network_of
    from pogosim.policy.policy import Policy

__all__ = ["Dense", "Elman", "Gru", "Network", "Policy", "PolicyError", "network_of"]

# The modules they are in, imported when one is asked for: a command line is read without NumPy.
MODULES = {
    **dict.fromkeys(("Dense", "Elman", "Gru", "Network", "network_of"), "network"),
    "Policy": "policy",
    "PolicyError": "errors",
}
__getattr__, __dir__ = on_demand(__name__, MODULES)
