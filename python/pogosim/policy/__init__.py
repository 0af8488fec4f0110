"""Policies of robots, small neural networks: stepped in Python by arrays, exported as C by `pogosim export-policy`."""

from __future__ import annotations

from pogosim.policy.errors import PolicyError
from pogosim.policy.network import Dense, Elman, Gru, Network, network_of
from pogosim.policy.policy import Policy

__all__ = ["Dense", "Elman", "Gru", "Network", "Policy", "PolicyError", "network_of"]
