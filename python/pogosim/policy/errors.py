"""What keeps a policy from being read, exported or stepped."""

from __future__ import annotations

from pogosim.errors import ToolError


class PolicyError(ToolError, ValueError):
    """A policy, its data or an observation cannot be used so; says where, what was expected, and what to do."""
